# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled search for the instant at which a constant turns into a rise."""

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array


@njit
def onset(time: Array, height: Array, instants: Array, smooth: bool) -> tuple[float, float, float]:
    """Sum of squares [m^2], instant [s] and level [m] of the best onset of one shape.

    Tries all ``instants`` before the last sample. With x the time since the instant and X its
    value at the last sample the shape is ``x^3 - x^4 / (4 X)`` if smooth, else ``x^2``; its size
    and the level before it are those of the least squares.
    """
    n = time.shape[0]
    mean = height.mean()
    best, best_instant, best_level = np.inf, time[0], height[0]
    rise = np.zeros(n)
    for instant in instants:
        last = time[-1] - instant
        for i in range(n):
            x = max(0.0, time[i] - instant)
            rise[i] = x * x * x - x * x * x * x / (4.0 * last) if smooth else x * x
        middle = rise.mean()
        product = square = 0.0
        for i in range(n):
            product += (rise[i] - middle) * (height[i] - mean)
            square += (rise[i] - middle) ** 2
        slope = product / square
        error = 0.0
        for i in range(n):
            error += (height[i] - mean - slope * (rise[i] - middle)) ** 2
        if slope > 0.0 and error < best:
            best, best_instant, best_level = error, instant, mean - slope * middle
    return best, best_instant, best_level
