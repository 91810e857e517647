# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What carries the net moment at each lumbar level.

The net moment follows from motion and external forces alone.  Muscles carry a part of it.  The
rest is the moment of the joint reaction.  With `levels` the reserves of the level carry it.  With
`coupled` the constraint of the lumbar rhythm carries it, and no anatomical structure stands for
that.  Its part from the abdominal body is known: the coupler gives the body the sum of the
rotations of all levels, so the moment M of the muscles on the body does the same work as a moment
M at every level.  The other part redistributes moment between levels; its work along the rhythm is
that of the reserves of the coupled coordinates.

The model has no passive structures and no abdominal pressure, so both parts are zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from muscle_analyzer.core.loads.analysis import MuscleAnalysis
from muscle_analyzer.core.loads.joint_loads import read_loaded_joints
from muscle_analyzer.core.loads.lumbar_balance import AbdomenSupport, LumbarBalance


@dataclass(frozen=True, eq=False)
class LumbarMoments:
    """Parts of the net moment at n_l lumbar levels, n samples.

    All arrays but the last are ndarrays, shape (n, n_l, 3), in the frames of the discs (anterior,
    left, cranial) [N m]: moments of the lower segment on the upper one, so extension is negative
    about the second axis.

    Attributes
    ----------
    levels : tuple of str, n_l
    net
        To be carried; the sum of the other parts.
    muscles
        Of muscles, passive fibre forces among them.
    passive
        Of ligaments and discs.
    pressure
        Of the abdominal pressure.
    reserve
        Of the reserves of the level.
    abdomen
        Of the constraint between the lumbar rhythm and the abdominal body.
    rhythm
        Of the constraint between the levels.
    unassigned : ndarray, shape (n,)
        Largest magnitude, over the levels, of the moment carried by constraints, relative to the
        largest magnitude of the net moment of the level over the samples.
    """

    levels: tuple[str, ...]
    net: Array
    muscles: Array
    passive: Array
    pressure: Array
    reserve: Array
    abdomen: Array
    rhythm: Array

    @property
    def unassigned(self) -> Array:
        """See the attributes."""
        size = np.linalg.norm(self.abdomen + self.rhythm, axis=2)
        return np.asarray((size / np.nanmax(np.linalg.norm(self.net, axis=2), axis=0)).max(axis=1))


def lumbar_moments(analysis: MuscleAnalysis) -> LumbarMoments:
    """Return the parts of the net moment at each lumbar level.

    Parameters
    ----------
    analysis
        Samples that are not good data stay NaN.
    """
    discs = [joint.name for joint in read_loaded_joints() if joint.disc]
    levels = tuple(name for name in analysis.joint_names if name in discs)
    rows = [analysis.joint_names.index(name) for name in levels]
    net, kept = analysis.joint_net_moment[:, rows], analysis.joint_moment[:, rows]
    zero = np.zeros_like(net)
    reserve, abdomen, rhythm = zero, zero, kept
    if analysis.lumbar_balance == LumbarBalance.LEVELS:
        reserve, rhythm = kept, zero
    elif analysis.abdomen == AbdomenSupport.RHYTHM:
        abdomen = np.broadcast_to(-analysis.abdomen_moment[:, None], net.shape)
        rhythm = kept - abdomen
    return LumbarMoments(levels, net, net - kept, zero, zero, reserve, abdomen, rhythm)
