# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Semismooth Newton method on the dual of the static optimisation, compiled.

The problem (equation 4.10 of the thesis with exponent p and weights w, and reserve actuators)::

    min  sum w_i a_i^p + sum c_j^2   subject to   A a + D c = tau,   l <= a <= u

has with multipliers y of the balance the minimisers ``a(y) = clip((A^T y / (p w))^(1/(p-1)), l,
u)`` and ``c(y) = D y / 2``.  The dual function is concave, its gradient ``tau - A a(y) - D c(y)``
for p = 2 piecewise linear, so each Newton step solves a symmetric positive definite system with
one unknown a coordinate (Qi and Sun 1993, A nonsmooth version of Newton's method).  Exponent and
weights enter through `_minimiser` alone; the cost of the reserves is their square for every
exponent, which keeps the system definite.
"""

from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array, IntArray
from muscle_analyzer.core.recruitment.false_position import crossing, narrowed, whole_step

#: A step is taken when the slope of the dual along it is at most this fraction of the first.
SLOPE_FRACTION = 0.1
#: Limit of trials of one line search.
LINE_TRIALS = 60


class Columns(NamedTuple):
    """Matrix A (n_c, n_m), torque of each muscle at full activation, column by column.

    Attributes
    ----------
    start : (n_m + 1,)
        Entries of column i are ``start[i]`` to ``start[i + 1] - 1``.
    row : (n,)
        Row of each entry, rising within a column.
    value : (n,)
        The entries [N m].
    """

    start: IntArray
    row: IntArray
    value: Array


@njit(error_model='numpy')
def _minimiser(
    pull: float, low: float, high: float, weight: float, exponent: float
) -> tuple[float, float]:
    """Minimise ``w a^p - pull a`` over [low, high]; return the minimiser and its slope."""
    if exponent == 2.0:
        slope = 0.5 / weight
        free = slope * pull
    elif pull <= 0.0:
        return low, 0.0
    else:
        free = (pull / (exponent * weight)) ** (1.0 / (exponent - 1.0))
        slope = free / ((exponent - 1.0) * pull)
    if free <= low:
        return low, 0.0
    if free >= high:
        return high, 0.0
    return free, slope


@njit(error_model='numpy')
def columns_of(matrix: Array) -> Columns:
    """Return the non-zero entries of a matrix."""
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
    fill = np.empty(n_columns, np.int64)
    for i in range(n_columns):
        fill[i] = start[i]
    for j in range(n_rows):
        for i in range(n_columns):
            if matrix[j, i] != 0.0:
                row[fill[i]] = j
                value[fill[i]] = matrix[j, i]
                fill[i] += 1
    return Columns(start, row, value)


@njit(error_model='numpy')
def cholesky_solve(matrix: Array, vector: Array) -> bool:
    """Solve in place; the solution replaces `vector`.  False if not positive definite.

    Of `matrix` only the lower triangle is used.  Entries left of a row's first non-zero stay zero
    in the factor and are skipped: most entries, because most muscles cross few joints.
    """
    n = vector.size
    first = np.empty(n, np.int64)
    for i in range(n):
        first[i] = 0
        while matrix[i, first[i]] == 0.0 and first[i] < i:
            first[i] += 1
        for j in range(first[i], i + 1):
            entry = matrix[i, j]
            for k in range(max(first[i], first[j]), j):
                entry -= matrix[i, k] * matrix[j, k]
            if j < i:
                matrix[i, j] = entry / matrix[j, j]
            elif entry > 0.0:
                matrix[i, i] = np.sqrt(entry)
            else:
                return False
    for i in range(n):
        for k in range(first[i], i):
            vector[i] -= matrix[i, k] * vector[k]
        vector[i] /= matrix[i, i]
    for i in range(n - 1, -1, -1):
        vector[i] /= matrix[i, i]
        for k in range(first[i], i):
            vector[k] -= matrix[i, k] * vector[i]
    return True


@njit(error_model='numpy')
def _copy(source: Array, target: Array) -> None:
    """Copy element by element (slices cost the compiler seconds)."""
    for i in range(source.size):
        target[i] = source[i]


@njit(error_model='numpy')
def _evaluate(
    columns: Columns,
    reserve: Array,
    torque: Array,
    lower: Array,
    upper: Array,
    weight: Array,
    exponent: float,
    multiplier: Array,
    activation: Array,
    slope: Array,
    gradient: Array,
) -> float:
    """Fill activations, their slopes and the dual's gradient; return its largest entry."""
    start, row, value = columns
    for j in range(torque.size):
        gradient[j] = torque[j] - 0.5 * reserve[j] * reserve[j] * multiplier[j]
    for i in range(activation.size):
        pull = 0.0
        for k in range(start[i], start[i + 1]):
            pull += value[k] * multiplier[row[k]]
        activation[i], slope[i] = _minimiser(pull, lower[i], upper[i], weight[i], exponent)
        for k in range(start[i], start[i + 1]):
            gradient[row[k]] -= value[k] * activation[i]
    worst = 0.0
    for j in range(torque.size):
        size = abs(gradient[j])
        if not size <= worst:
            worst = size
    return worst


@njit(error_model='numpy')
def _hessian(columns: Columns, reserve: Array, slope: Array, hessian: Array) -> None:
    """Fill the lower triangle of minus the dual's generalised Hessian."""
    start, row, value = columns
    for j in range(reserve.size):
        for k in range(reserve.size):
            hessian[j, k] = 0.0
        hessian[j, j] = 0.5 * reserve[j] * reserve[j]
    for i in range(slope.size):
        if slope[i] > 0.0:
            for k in range(start[i], start[i + 1]):
                scaled = slope[i] * value[k]
                for other in range(start[i], k + 1):
                    hessian[row[k], row[other]] += scaled * value[other]


@njit(error_model='numpy')
def dot(a: Array, b: Array) -> float:
    """Return the product of two vectors."""
    total = 0.0
    for j in range(a.size):
        total += a[j] * b[j]
    return total


@njit(error_model='numpy')
def _step_size(
    columns: Columns,
    reserve: Array,
    lower: Array,
    upper: Array,
    weight: Array,
    exponent: float,
    multiplier: Array,
    step: Array,
    first_slope: float,
    whole_slope: float,
) -> float:
    """Return the fraction of a step that is too long at which the slope of the dual is small.

    The slope falls along the step, from `first_slope` (positive) to `whole_slope` (negative).  Its
    zero is found by false position with the Illinois rule.  Along one line the pull on each muscle
    is linear too, so the matrix is not needed.
    """
    start, row, value = columns
    n_m = lower.size
    pull, turn, before = np.empty(n_m), np.empty(n_m), np.empty(n_m)
    for i in range(n_m):
        pull[i], turn[i] = 0.0, 0.0
        for k in range(start[i], start[i + 1]):
            pull[i] += value[k] * multiplier[row[k]]
            turn[i] += value[k] * step[row[k]]
        before[i] = _minimiser(pull[i], lower[i], upper[i], weight[i], exponent)[0]
    bend = 0.0
    for j in range(step.size):
        bend += 0.5 * (reserve[j] * step[j]) ** 2
    bracket = whole_step(first_slope, whole_slope, -1)
    size = crossing(bracket)
    for _ in range(LINE_TRIALS):
        here = first_slope - size * bend
        for i in range(n_m):
            now = _minimiser(pull[i] + size * turn[i], lower[i], upper[i], weight[i], exponent)[0]
            here -= turn[i] * (now - before[i])
        if abs(here) <= SLOPE_FRACTION * first_slope:
            break
        bracket = narrowed(bracket, size, here)
        size = crossing(bracket)
    return size


@njit(error_model='numpy')
def solve_dual(
    columns: Columns,
    reserve: Array,
    torque: Array,
    lower: Array,
    upper: Array,
    weight: Array,
    exponent: float,
    multiplier: Array,
    tolerance: float,
    max_iterations: int,
) -> tuple[Array, Array, int, bool]:
    """Maximise the dual from a starting point.

    Parameters
    ----------
    columns
        A (n_c, n_m): moment arm times force at full activation [N m].
    reserve
        D (n_c,): torque of each reserve at unit control [N m], all positive.
    torque
        tau (n_c,) [N m].
    lower, upper
        Bounds of the activations (n_m,).
    weight
        Of each muscle in the cost (n_m,), all positive.
    exponent
        Of the activations in the cost, at least 2.
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
    n_c, n_m = torque.size, lower.size
    activation, slope = np.empty(n_m), np.empty(n_m)
    gradient, step, trial = np.empty(n_c), np.empty(n_c), np.empty(n_c)
    hessian = np.empty((n_c, n_c))
    iterations = 0
    worst = _evaluate(
        columns, reserve, torque, lower, upper, weight, exponent, multiplier,
        activation, slope, gradient,
    )  # fmt: skip
    while not worst <= tolerance:
        if iterations == max_iterations or not np.isfinite(worst):
            return activation, gradient, iterations, False
        _hessian(columns, reserve, slope, hessian)
        _copy(gradient, step)
        if not cholesky_solve(hessian, step):
            return activation, gradient, iterations, False
        iterations += 1
        first_slope = dot(gradient, step)
        for j in range(n_c):
            trial[j] = multiplier[j] + step[j]
        worst = _evaluate(
            columns, reserve, torque, lower, upper, weight, exponent, trial,
            activation, slope, gradient,
        )  # fmt: skip
        whole_slope = dot(gradient, step)
        if whole_slope < -SLOPE_FRACTION * first_slope and worst > tolerance:
            size = _step_size(
                columns, reserve, lower, upper, weight, exponent, multiplier, step,
                first_slope, whole_slope,
            )  # fmt: skip
            for j in range(n_c):
                trial[j] = multiplier[j] + size * step[j]
            worst = _evaluate(
                columns, reserve, torque, lower, upper, weight, exponent, trial,
                activation, slope, gradient,
            )  # fmt: skip
        _copy(trial, multiplier)
    return activation, gradient, iterations, True
