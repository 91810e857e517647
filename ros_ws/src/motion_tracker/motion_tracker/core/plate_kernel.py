# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled reaction of the ground on one foot, the same for a live sample and for a whole lift."""

import numba
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]


@numba.njit(cache=True)
def reaction(force: Array, moment: Array, rotation: Array, origin: Array, surface: float,
             threshold: float) -> tuple[Array, Array, Array, BoolArray]:
    """Force, centre of pressure and free moment (n, 3) in the world, and whether loaded (n,).

    The arguments, the results and the equations are those of `force_plates.ground_reaction`.
    """
    n = force.shape[0]
    total, free_moment = np.zeros((n, 3)), np.zeros((n, 3))
    cop = np.full((n, 3), np.nan)
    loaded = np.zeros(n, dtype=np.bool_)
    f, m = np.empty(3), np.empty(3)
    height = surface - origin[2]
    for k in range(n):
        for i in range(3):
            f[i] = m[i] = 0.0
            for j in range(3):
                f[i] += rotation[i, j] * force[k, j]
                m[i] += rotation[i, j] * moment[k, j]
        loaded[k] = f[2] > threshold
        if not loaded[k]:
            continue
        x = (height * f[0] - m[1]) / f[2]
        y = (m[0] + height * f[1]) / f[2]
        total[k] = f
        cop[k, 0], cop[k, 1], cop[k, 2] = x + origin[0], y + origin[1], surface
        free_moment[k, 2] = m[2] - x * f[1] + y * f[0]
    return total, cop, free_moment, loaded
