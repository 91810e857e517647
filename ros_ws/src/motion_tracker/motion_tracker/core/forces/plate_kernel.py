# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled reaction of the ground on feet, the same for a live sample and for a whole lift."""

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array, BoolArray


@njit
def _foot(
    force: Array,
    moment: Array,
    rotation: Array,
    origin: Array,
    surface: float,
    threshold: float,
    total: Array,
    centre_of_pressure: Array,
    free_moment: Array,
) -> bool:
    """Write force, centre of pressure and free moment of one foot (3,); whether it is loaded."""
    f, m = np.zeros(3), np.zeros(3)
    for i in range(3):
        for j in range(3):
            f[i] += rotation[i, j] * force[j]
            m[i] += rotation[i, j] * moment[j]
    total[:] = 0.0
    centre_of_pressure[:] = np.nan
    free_moment[:] = 0.0
    if not f[2] > threshold:
        return False
    height = surface - origin[2]
    x = (height * f[0] - m[1]) / f[2]
    y = (m[0] + height * f[1]) / f[2]
    total[:] = f
    centre_of_pressure[0], centre_of_pressure[1], centre_of_pressure[2] = (
        x + origin[0],
        y + origin[1],
        surface,
    )
    free_moment[2] = m[2] - x * f[1] + y * f[0]
    return True


@njit
def reaction(
    force: Array, moment: Array, rotation: Array, origin: Array, surface: float, threshold: float
) -> tuple[Array, Array, Array, BoolArray]:
    """Force, centre of pressure and free moment (n, 3) in the world, and whether loaded (n,).

    The arguments, the results and the equations are those of `force_plates.ground_reaction`.
    """
    n = force.shape[0]
    total, centre_of_pressure, free_moment = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    loaded = np.empty(n, dtype=np.bool_)
    for k in range(n):
        loaded[k] = _foot(
            force[k],
            moment[k],
            rotation,
            origin,
            surface,
            threshold,
            total[k],
            centre_of_pressure[k],
            free_moment[k],
        )
    return total, centre_of_pressure, free_moment, loaded


@njit
def feet(
    wrench: Array, rotation: Array, origin: Array, surface: Array, threshold: float
) -> tuple[Array, Array, Array]:
    """Force, centre of pressure and free moment (1, feet, 3) in the world, of one instant.

    As `reaction`, of feet on a plate each: wrenches (feet, 6), rotations (feet, 3, 3), origins
    (feet, 3) and heights of the surfaces (feet,).
    """
    shape = (1, wrench.shape[0], 3)
    total, centre_of_pressure, free_moment = np.empty(shape), np.empty(shape), np.empty(shape)
    for k in range(wrench.shape[0]):
        _foot(
            wrench[k, :3],
            wrench[k, 3:],
            rotation[k],
            origin[k],
            surface[k],
            threshold,
            total[0, k],
            centre_of_pressure[0, k],
            free_moment[0, k],
        )
    return total, centre_of_pressure, free_moment
