# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Semismooth Newton method on the dual of the static optimisation, compiled.

The problem (equation 4.10 of the thesis with exponent 2, and reserve actuators)::

    min  sum a_i^2 + sum c_j^2   subject to   A a + D c = tau,   l <= a <= u

has with multipliers y of the balance the minimisers ``a(y) = clip(A^T y / 2, l, u)`` and
``c(y) = D y / 2``.  The dual function is concave and piecewise quadratic, its gradient
``tau - A a(y) - D c(y)`` piecewise linear, so each Newton step solves a symmetric positive
definite system with one unknown a coordinate (Qi and Sun 1993, A nonsmooth version of
Newton's method).  The exponent enters through `_minimiser` alone.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Share of the first-order gain a step of the line search must reach (Armijo; Nocedal and
#: Wright 2006, section 3.1).
ARMIJO = 1e-4
#: Smallest step of the line search before the method gives up.
SMALLEST_STEP = 1e-12


@njit(cache=True)  # type: ignore[untyped-decorator]
def _minimiser(pull: float, low: float, high: float) -> tuple[float, float]:
    """Minimise ``a^2 - pull a`` over [low, high]; give the minimiser and its slope."""
    free = 0.5 * pull
    if free <= low:
        return low, 0.0
    if free >= high:
        return high, 0.0
    return free, 0.5


@njit(cache=True)  # type: ignore[untyped-decorator]
def _columns(matrix: Array) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """Give the non-zero entries of a matrix column by column (start, row, value)."""
    n_rows, n_columns = matrix.shape
    start = np.zeros(n_columns + 1, np.int64)
    for j in range(n_rows):
        for i in range(n_columns):
            if matrix[j, i] != 0.0:
                start[i + 1] += 1
    for i in range(n_columns):
        start[i + 1] += start[i]
    row = np.empty(start[n_columns], np.int64)
    value = np.empty(start[n_columns])
    fill = start[:-1].copy()
    for j in range(n_rows):
        for i in range(n_columns):
            if matrix[j, i] != 0.0:
                row[fill[i]] = j
                value[fill[i]] = matrix[j, i]
                fill[i] += 1
    return start, row, value


@njit(cache=True)  # type: ignore[untyped-decorator]
def _cholesky_solve(matrix: Array, vector: Array) -> bool:
    """Solve in place; the solution replaces `vector`.  False if not positive definite."""
    n = vector.size
    for j in range(n):
        pivot = matrix[j, j]
        for k in range(j):
            pivot -= matrix[j, k] ** 2
        if not pivot > 0.0:
            return False
        matrix[j, j] = np.sqrt(pivot)
        for i in range(j + 1, n):
            entry = matrix[i, j]
            for k in range(j):
                entry -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = entry / matrix[j, j]
    for i in range(n):
        for k in range(i):
            vector[i] -= matrix[i, k] * vector[k]
        vector[i] /= matrix[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            vector[i] -= matrix[k, i] * vector[k]
        vector[i] /= matrix[i, i]
    return True


@njit(cache=True)  # type: ignore[untyped-decorator]
def solve_dual(
    matrix: Array,
    reserve: Array,
    torque: Array,
    lower: Array,
    upper: Array,
    multiplier: Array,
    tolerance: float,
    max_iterations: int,
) -> tuple[Array, Array, int, bool]:
    """
    Maximise the dual from a starting point.

    Parameters
    ----------
    matrix
        A (n_c, n_m): moment arm times force at full activation [N m].
    reserve
        D (n_c,): torque of each reserve at unit control [N m], all positive.
    torque
        tau (n_c,) [N m].
    lower, upper
        Bounds of the activations (n_m,).
    multiplier
        y (n_c,), start on entry and solution on return.
    tolerance
        Largest balance residual of a solution [N m].
    max_iterations
        Limit of Newton steps.

    Returns
    -------
    activation : (n_m,)
    residual : (n_c,)
        tau - A a - D c [N m].
    iterations : int
    converged : bool
    """
    n_c, n_m = matrix.shape
    start, row, value = _columns(matrix)
    activation = np.empty(n_m)
    slope = np.empty(n_m)
    gradient = np.empty(n_c)
    trial = multiplier.copy()
    hessian = np.empty((n_c, n_c))
    step = np.zeros(n_c)
    size, gain, best = 1.0, 0.0, 0.0
    iterations = 0
    while True:
        # Dual value and gradient at the trial point.
        dual = 0.0
        for j in range(n_c):
            control = 0.5 * reserve[j] * trial[j]
            dual += trial[j] * torque[j] - control * control
            gradient[j] = torque[j] - reserve[j] * control
        for i in range(n_m):
            pull = 0.0
            for k in range(start[i], start[i + 1]):
                pull += value[k] * trial[row[k]]
            activation[i], slope[i] = _minimiser(pull, lower[i], upper[i])
            dual += activation[i] * (activation[i] - pull)
            for k in range(start[i], start[i + 1]):
                gradient[row[k]] -= value[k] * activation[i]
        worst = 0.0
        for j in range(n_c):
            worst = max(worst, abs(gradient[j]))
        if not np.isfinite(worst):
            return activation, gradient, iterations, False
        if worst <= tolerance:
            multiplier[:] = trial
            return activation, gradient, iterations, True
        # Rounding of the dual value must not refuse a step close to the solution.
        slack = 1e-13 * (1.0 + abs(best))
        if iterations > 0 and dual < best + ARMIJO * size * gain - slack:
            size *= 0.5
            if size < SMALLEST_STEP:
                return activation, gradient, iterations, False
            trial[:] = multiplier + size * step
            continue
        multiplier[:] = trial
        if iterations == max_iterations:
            return activation, gradient, iterations, False
        best = dual
        hessian[:] = 0.0
        for j in range(n_c):
            hessian[j, j] = 0.5 * reserve[j] * reserve[j]
        for i in range(n_m):
            if slope[i] > 0.0:
                for k in range(start[i], start[i + 1]):
                    scaled = slope[i] * value[k]
                    for other in range(start[i], k + 1):
                        hessian[row[k], row[other]] += scaled * value[other]
        step[:] = gradient
        if not _cholesky_solve(hessian, step):
            return activation, gradient, iterations, False
        gain = 0.0
        for j in range(n_c):
            gain += gradient[j] * step[j]
        size = 1.0
        trial[:] = multiplier + step
        iterations += 1
