# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compression as in the models that the limits of compression come from.

The limits of 3400 and 6400 N (NIOSH 1981) belong to models in which one equivalent muscle extends
the trunk with a constant lever arm, 5 cm (Chaffin, Andersson and Martin, Occupational
Biomechanics).  Its force is the net extension moment over the arm; compression is that force and
the net axial force of the joint.  The abdominal pressure of the original model is left out.
"""

from __future__ import annotations

import numpy as np

from human_model.typing import Array
from muscle_analyzer.core.loads.analysis import MuscleAnalysis
from muscle_analyzer.core.loads.joint_loads import LUMBOSACRAL

#: Lever arm of the equivalent extensor [m].
LEVER_ARM = 0.05


def equivalent_compression(net_force: Array, net_moment: Array) -> Array:
    """Return the compression (n,) of a disc with one equivalent muscle [N].

    Parameters
    ----------
    net_force, net_moment : ndarray, shape (n, 3)
        Of the lower segment on the upper one, joint and muscles together, in the frame of the disc
        (anterior, left, cranial) [N, N m]: extension is negative about the second axis.  A flexion
        moment is carried by a flexor with the same arm.
    """
    return np.asarray(net_force[:, 2] + np.abs(net_moment[:, 1]) / LEVER_ARM)


def equivalent_l5_s1_compression(analysis: MuscleAnalysis) -> Array:
    """Return the compression (n,) of L5-S1 with one equivalent muscle [N]."""
    k = analysis.joint_names.index(LUMBOSACRAL)
    return equivalent_compression(analysis.joint_net_force[:, k], analysis.joint_net_moment[:, k])
