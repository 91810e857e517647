# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Small bounded least-squares problems, fast because a whole Jacobian is one call."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STEP: Final = 1e-7
"""Forward difference: the square root of the machine's precision, for unknowns of order 1."""
FIRST_DAMPING: Final = 1e-4
LARGEST_DAMPING: Final = 1e8


def minimise(
    residuals: Callable[[Array], Array],
    x: Array,
    lower: Array,
    upper: Array,
    iterations: int = 60,
    small: float = 1e-12,
) -> Array:
    """Minimise the sum of squared residuals between bounds (Levenberg 1944, Marquardt 1963).

    Steps are cut at the bounds; an unknown that lies on a bound and would leave it is held.

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
        Ends when the sum of squares falls by less than this, or is below it.
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
        part = jacobian[:, free]
        normal = part.T @ part
        normal += damping * np.diag(np.diag(normal) + 1e-12)
        trial = x.copy()
        trial[free] -= np.linalg.solve(normal, gradient[free])
        trial = np.clip(trial, lower, upper)
        new = residuals(trial + offsets)
        new_cost = float(new[0] @ new[0])
        if new_cost >= cost:
            damping *= 10.0
            continue
        gain, x, values, cost = cost - new_cost, trial, new, new_cost
        damping = max(0.1 * damping, 1e-12)
        if gain < small * max(cost, small):
            break
    return x
