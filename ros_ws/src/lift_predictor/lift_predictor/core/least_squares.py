# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Small bounded least-squares problems, fast because a whole Jacobian is one call."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from human_model.typing import Array

STEP: Final = 1e-7
"""Forward difference: the square root of the machine's precision, for unknowns of order 1."""
FIRST_DAMPING: Final = 1e-4
LARGEST_DAMPING: Final = 1e8
NEARER: Final = 0.6
"""Share of the way to a bound that one step may go: who is on a bound early is stuck there."""
TINY: Final = 1e-12
"""Keeps the normal equations regular where a residual does not depend on an unknown."""


def minimise(
    residuals: Callable[[Array], Array],
    x: Array,
    lower: Array,
    upper: Array,
    iterations: int = 60,
    small: float = 1e-12,
    longest: float = 0.3,
) -> Array:
    """Minimise the sum of squared residuals between bounds (Levenberg 1944, Marquardt 1963).

    An unknown that a step would carry over its bound goes part of the way, and the others are
    found again with it. Made for starts near the answer; it can end in a worse valley.

    Parameters
    ----------
    residuals : callable
        Takes points (k, n), returns residuals (k, m).
    x : array, shape (n,)
        Where to begin; moved between the bounds.
    lower, upper : array, shape (n,)
        Bounds.
    iterations : int
        Accepted and refused steps at most.
    small : float
        Ends when the sum of squares falls by less than this share, or is below it.
    longest : float
        Change of an unknown in one step at most; keeps the search in the valley it begins in.
    """
    x = np.clip(x, lower, upper)
    offsets = np.vstack((np.zeros(len(x)), STEP * np.eye(len(x))))
    values = residuals(x + offsets)
    cost = float(values[0] @ values[0])
    damping = FIRST_DAMPING
    for _ in range(iterations):
        jacobian = (values[1:] - values[0]).T / STEP
        gradient = jacobian.T @ values[0]
        free = ~(((x <= lower) & (gradient > 0.0)) | ((x >= upper) & (gradient < 0.0)))
        if cost < small or not free.any() or damping > LARGEST_DAMPING:
            break
        room = (NEARER * (lower - x), NEARER * (upper - x))
        step = _step(jacobian, values[0], damping, free, *room)
        trial = x + step * min(1.0, longest / max(float(np.abs(step).max()), TINY))
        new = residuals(trial + offsets)
        new_cost = float(new[0] @ new[0])
        if new_cost >= cost:
            damping *= 10.0
            continue
        gain, x, values, cost = cost - new_cost, trial, new, new_cost
        damping = max(0.1 * damping, 1e-12)
        if gain < 1e-6 * cost:
            break
    return x


def _step(
    jacobian: Array,
    values: Array,
    damping: float,
    free: NDArray[np.bool_],
    low: Array,
    high: Array,
) -> Array:
    """Damped Gauss-Newton step between bounds; unknowns reach them one round after the other."""
    step = np.zeros(len(free))
    free = free.copy()
    while free.any():
        part = jacobian[:, free]
        normal = part.T @ part
        normal += damping * np.diag(np.diag(normal) + TINY)
        step[free] = np.linalg.solve(normal, -part.T @ (values + jacobian[:, ~free] @ step[~free]))
        over = free & ((step < low) | (step > high))
        if not over.any():
            break
        step = np.clip(step, low, high)
        free &= ~over
    return step
