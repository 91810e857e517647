# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Curves of the muscle of Thelen 2003 (J Biomech Eng 125:70), as OpenSim's ``Thelen2003Muscle``.

Its force-velocity relation depends on the activation; as in OpenSim's static optimisation, the one
of the fully active muscle is taken, and its force is scaled by the activation.  Default values are
those of OpenSim 4.6.  Lengths are over the optimal fibre length, velocities over the maximum
contraction velocity, lengthening positive.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array
from muscle_analyzer.core.osim.model import Muscle

KIND = 'Thelen2003Muscle'
DEFAULTS = {
    'KshapeActive': 0.45,
    'KshapePassive': 5.0,
    'FmaxMuscleStrain': 0.6,
    'Af': 0.25,
    'Flen': 1.4,
    'fv_linear_extrap_threshold': 0.95,
}


def thelen_shapes(muscles: Sequence[Muscle]) -> Array:
    """Return the properties (n_m, 6) of `DEFAULTS` of a model's muscles, NaN for other kinds."""
    return np.array(
        [
            [muscle.properties.get(name, default) for name, default in DEFAULTS.items()]
            if muscle.kind == KIND
            else [np.nan] * len(DEFAULTS)
            for muscle in muscles
        ]
    ).reshape(-1, len(DEFAULTS))


@njit(error_model='numpy')
def thelen_active(shape: Array, length: float) -> float:
    """Return the active multiplier (equation 4) of a muscle of properties `shape` (6,)."""
    return float(np.exp(-((length - 1.0) ** 2) / shape[0]))


@njit(error_model='numpy')
def thelen_passive(shape: Array, length: float) -> float:
    """Return the passive multiplier (equation 3), without force below the optimal length."""
    stretch = max(length - 1.0, 0.0)
    return float(np.expm1(shape[1] * stretch / shape[2]) / np.expm1(shape[1]))


@njit(error_model='numpy')
def thelen_rate(shape: Array, velocity: float) -> float:
    """Return the force-velocity multiplier (equations 6 and 7 solved for the force).

    Beyond a fraction of the greatest force the relation continues as a straight line.
    """
    af, most = shape[3], shape[4]
    if velocity < 0.0:
        return float((1.0 + velocity) / (1.0 - velocity / af))
    steep = (2.0 + 2.0 / af) / (most - 1.0)
    force = shape[5] * most
    left = most - force
    start = (force - 1.0) / (steep * left)
    if velocity > start:
        slope = (1.0 / left + (force - 1.0) / left**2) / steep
        return float(force + (velocity - start) / slope)
    faster = velocity * steep
    return float((1.0 + faster * most) / (1.0 + faster))
