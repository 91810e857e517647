# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Curves of the muscle of Thelen 2003 (J Biomech Eng 125:70), as OpenSim's ``Thelen2003Muscle``.

Its force-velocity relation depends on the activation; as in OpenSim's static optimisation, the one
of the fully active muscle is taken, and its force is scaled by the activation.  Default values are
those of OpenSim 4.6.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from muscle_analyzer.core.osim_model import Muscle

Array = NDArray[np.float64]

KIND = 'Thelen2003Muscle'
DEFAULTS = {
    'KshapeActive': 0.45,
    'KshapePassive': 5.0,
    'FmaxMuscleStrain': 0.6,
    'Af': 0.25,
    'Flen': 1.4,
    'fv_linear_extrap_threshold': 0.95,
}


class ThelenCurves:
    """
    Multipliers of the Thelen muscles among a model's muscles.

    Parameters
    ----------
    muscles
        All muscles of a model.

    Attributes
    ----------
    members : (n,)
        Which of them have these curves.
    """

    def __init__(self, muscles: Sequence[Muscle]) -> None:
        self.members = np.array([k for k, m in enumerate(muscles) if m.kind == KIND], np.int64)
        of_kind = [muscles[k] for k in self.members]
        self._width, self._shape, self._strain, self._af, self._most, self._threshold = (
            np.array([muscle.properties.get(name, default) for muscle in of_kind])
            for name, default in DEFAULTS.items()
        )

    def active(self, length: Array) -> Array:
        """Give the active multiplier (equation 4) at fibre over optimal lengths (n,)."""
        return np.asarray(np.exp(-((length - 1.0) ** 2) / self._width))

    def passive(self, length: Array) -> Array:
        """Give the passive multiplier (equation 3), without force below the optimal length."""
        stretch = np.maximum(length - 1.0, 0.0)
        return np.asarray(
            np.expm1(self._shape * stretch / self._strain) / np.expm1(self._shape)
        )

    def rate(self, velocity: Array) -> Array:
        """
        Give the force-velocity multiplier (equations 6 and 7 solved for the force).

        `velocity` is the fibres' over the maximum contraction velocity (n,), lengthening positive.
        Beyond a share of the greatest force the relation goes on as a straight line.
        """
        shortening = (1.0 + velocity) / (1.0 - np.minimum(velocity, 0.0) / self._af)
        steep = (2.0 + 2.0 / self._af) / (self._most - 1.0)
        faster = np.maximum(velocity, 0.0) * steep
        lengthening = (1.0 + faster * self._most) / (1.0 + faster)
        force = self._threshold * self._most
        left = self._most - force
        start = (force - 1.0) / (steep * left)
        slope = (1.0 / left + (force - 1.0) / left**2) / steep
        beyond = force + (velocity - start) / slope
        lengthening = np.where(velocity > start, beyond, lengthening)
        return np.asarray(np.where(velocity < 0.0, shortening, lengthening))
