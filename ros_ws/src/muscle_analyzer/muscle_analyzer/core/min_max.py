# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
The min/max criterion of muscle recruitment by an interior-point method, compiled.

The largest activation is made as small as the torques allow (Rasmussen, Damsgaard and Voigt 2001,
J Biomech 34:409).  That alone leaves the muscles below the largest activation undetermined, so a
small multiple of their squares decides among them::

    min  b + e sum w_i a_i^2 + sum c_j^2   subject to   A a + D c = tau,   l <= a <= b <= u

The dual Newton method of the other criteria does not fit, as hardly any muscle is strictly between
its bounds.  This is a predictor-corrector method for convex quadratic programmes (Mehrotra 1992,
SIAM J Optim 2:575): activations and slacks are eliminated, so that each step factors one matrix
with a row per coordinate, and b is left as a single unknown beside it.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: e of the header: the largest activation exceeds the smallest possible one by at most e times
#: the sum of squares that this saves.
SQUARES_SHARE = 1e-3
#: Mean product of multiplier and slack of a solution.
COMPLEMENTARITY = 1e-13
#: The same from which on the bounds that are met are tried for the exact solution.
NEARLY = 1e-7
#: Relative stationarity of a solution.
STATIONARITY = 1e-9
#: Share of the way to the boundary that a step may go.
TO_BOUNDARY = 0.995


class _Point(NamedTuple):
    """Activations; multipliers of a >= l, a <= b and the balance; b and the one of b <= u."""

    a: Array
    z: Array
    v: Array
    y: Array
    scalar: Array


@njit(cache=True, error_model='numpy')
def _direction(
    matrix: Array,
    curvature: Array,
    reserve: Array,
    torque: Array,
    lower: Array,
    upper: float,
    point: _Point,
    target: _Point,
) -> _Point:
    """Give the Newton step towards complementarity products `target`."""
    a, z, v, y = point.a, point.z, point.v, point.y
    b, t = point.scalar
    s, r, q = a - lower, b - a, upper - b
    k = v / r
    theta = 1.0 / (curvature + z / s + k)
    pull = matrix.T @ y
    rest_a = -(curvature * a - pull - target.z / s + target.v / r)
    rest_b = -(1.0 - (target.v / r).sum() + target.scalar[1] / q)
    rest_y = torque - matrix @ a - 0.5 * reserve * reserve * y
    system = (matrix * theta) @ matrix.T
    for j in range(reserve.size):
        system[j, j] += 0.5 * reserve[j] * reserve[j]
    border = matrix @ (theta * k)
    right = np.empty((reserve.size, 2))
    right[:, 0] = rest_y - matrix @ (theta * rest_a)
    right[:, 1] = border
    solved = np.linalg.solve(system, right)
    size = k.sum() + t / q - (theta * k * k).sum()
    db = rest_b + (theta * k * rest_a).sum() + border @ np.ascontiguousarray(solved[:, 0])
    db /= size + border @ np.ascontiguousarray(solved[:, 1])
    dy = solved[:, 0] - solved[:, 1] * db
    da = theta * (rest_a + matrix.T @ dy + k * db)
    dz = target.z / s - z - z / s * da
    dv = target.v / r - v - k * (db - da)
    dt = target.scalar[1] / q - t + t / q * db
    return _Point(da, dz, dv, dy, np.array([db, dt]))


@njit(cache=True, error_model='numpy')
def _longest(values: Array, step: Array) -> float:
    """Give the longest step, at most 1, that keeps positive values positive."""
    longest = 1.0
    for i in range(values.size):
        if step[i] < 0.0:
            longest = min(longest, -TO_BOUNDARY * values[i] / step[i])
    return longest


@njit(cache=True, error_model='numpy')
def _steps(lower: Array, upper: float, point: _Point, step: _Point) -> tuple[float, float]:
    """Give the longest steps of the unknowns and of the multipliers."""
    b, t = point.scalar
    db, dt = step.scalar
    primal = min(_longest(point.a - lower, step.a), _longest(b - point.a, db - step.a))
    primal = min(primal, _longest(np.array([upper - b]), np.array([-db])))
    dual = min(_longest(point.z, step.z), _longest(point.v, step.v))
    return primal, min(dual, _longest(np.array([t]), np.array([dt])))


@njit(cache=True, error_model='numpy')
def _moved(point: _Point, step: _Point, primal: float, dual: float) -> _Point:
    scalar = point.scalar + np.array([primal, dual]) * step.scalar
    return _Point(
        point.a + primal * step.a,
        point.z + dual * step.z,
        point.v + dual * step.v,
        point.y + dual * step.y,
        scalar,
    )


@njit(cache=True, error_model='numpy')
def _mean_product(lower: Array, upper: float, point: _Point) -> float:
    b, t = point.scalar
    total = (point.z * (point.a - lower)).sum() + (point.v * (b - point.a)).sum() + t * (upper - b)
    return float(total) / (2 * point.a.size + 1)


@njit(cache=True, error_model='numpy')
def _polish(
    matrix: Array, curvature: Array, reserve: Array, torque: Array, lower: Array, upper: float,
    tolerance: float, point: _Point,
) -> bool:
    """
    Solve for the activations exactly, the bounds that are met being known; changes the iterate.

    An interior point stays off its bounds by the root of the complementarity where multipliers are
    small.  Returns False, and changes nothing, if the bounds found are not those of a solution.
    """  # fmt: skip
    a, z, v, y, scalar = point
    b, t = scalar
    # Without its bound a muscle would go on by its multiplier over its curvature.
    low, high, full = z > curvature * (a - lower), v > curvature * (b - a), t > upper - b
    n = reserve.size
    system, right = np.zeros((n + 1, n + 1)), np.zeros(n + 1)
    right[:n] = torque
    right[n] = upper if full else 1.0
    for j in range(n):
        system[j, j] = 0.5 * reserve[j] * reserve[j]
    for i in range(a.size):
        column = matrix[:, i]
        if low[i]:
            right[:n] -= column * lower[i]
        elif high[i]:
            system[:n, n] += column
            system[n, n] -= curvature[i]
        else:
            system[:n, :n] += np.outer(column, column) / curvature[i]
    if full:
        system[n, n] = 1.0
    else:
        system[n, :n] = system[:n, n]
    solved = np.zeros(n + 1)
    rest = right.copy()
    found, residual = a.copy(), right[:n].copy()
    # The second round takes off what the first one lost by rounding.
    for _ in range(2):
        solved += np.linalg.solve(system, rest)
        pull = matrix.T @ np.ascontiguousarray(solved[:n])
        largest = solved[n]
        found = np.where(low, lower, np.where(high, largest, pull / curvature))
        residual = torque - matrix @ found - 0.5 * reserve * reserve * solved[:n]
        rest[:n], rest[n] = residual, 0.0
    force = pull - curvature * found
    slack = STATIONARITY * (1.0 + np.abs(pull).max())
    right_sign = ((~low | (force <= slack)) & (~high | (force >= -slack))).all()
    inside = ((found >= lower - STATIONARITY) & (found <= largest + STATIONARITY)).all()
    if not (right_sign and inside and largest <= upper + STATIONARITY):
        return False
    if not np.abs(residual).max() <= tolerance:
        return False
    found = np.minimum(np.maximum(found, lower), largest)
    a[:] = found
    y[:] = solved[:n]
    scalar[0] = largest
    return True


@njit(cache=True, error_model='numpy')
def solve_min_max(
    matrix: Array,
    reserve: Array,
    torque: Array,
    lower: Array,
    upper: Array,
    weight: Array,
    multiplier: Array,
    tolerance: float,
    max_iterations: int,
) -> tuple[Array, Array, int, bool, float]:
    """
    Make the largest activation smallest.

    Parameters are those of `dual_newton.solve_dual`, without the exponent; there is no warm start,
    and `multiplier` only takes the solution.

    Returns
    -------
    activation : (n_m,)
    residual : (n_c,)
        tau - A a - D c [N m].
    iterations : int
    converged : bool
    cap : float
        The largest activation b.
    """
    n_c, n_m = matrix.shape
    top = upper.min()
    curvature = 2.0 * SQUARES_SHARE * weight
    start = 0.5 * (lower.max() + top)
    even = np.full(n_m, 1.0 / n_m)
    point = _Point(
        0.5 * (lower + start), even.copy(), even.copy(), np.zeros(n_c), np.array([start, 1.0])
    )
    iterations = 0
    while True:
        y = point.y
        residual = torque - matrix @ point.a - 0.5 * reserve * reserve * y
        product = _mean_product(lower, top, point)
        stationarity = curvature * point.a - matrix.T @ y - point.z + point.v
        worst = np.abs(stationarity).max() / (1.0 + np.abs(y).max())
        at_end = abs(1.0 - point.v.sum() + point.scalar[1]) / (1.0 + point.scalar[1])
        share = product / (1.0 + point.scalar[1])
        if share <= NEARLY and _polish(
            matrix, curvature, reserve, torque, lower, top, tolerance, point
        ):
            residual = torque - matrix @ point.a - 0.5 * reserve * reserve * point.y
            break
        if (
            share <= COMPLEMENTARITY
            and np.abs(residual).max() <= tolerance
            and max(worst, at_end) <= STATIONARITY
        ):
            break
        # Slacks that round to nothing end the method without a solution.
        slack = min((point.a - lower).min(), (point.scalar[0] - point.a).min())
        lost = min(slack, top - point.scalar[0]) <= 0.0
        if lost or iterations == max_iterations or not np.isfinite(product):
            multiplier[:] = y
            return point.a, residual, iterations, False, point.scalar[0]
        none = np.zeros(n_m)
        target = _Point(none, none, none, y, np.zeros(2))
        step = _direction(matrix, curvature, reserve, torque, lower, top, point, target)
        primal, dual = _steps(lower, top, point, step)
        ahead = _mean_product(lower, top, _moved(point, step, primal, dual))
        centre = (ahead / product) ** 3 * product
        da, db = step.a, step.scalar[0]
        target = _Point(
            none,
            centre - da * step.z,
            centre - (db - da) * step.v,
            y,
            np.array([0.0, centre + db * step.scalar[1]]),
        )
        step = _direction(matrix, curvature, reserve, torque, lower, top, point, target)
        primal, dual = _steps(lower, top, point, step)
        point = _moved(point, step, primal, dual)
        iterations += 1
    multiplier[:] = point.y
    return point.a, residual, iterations, True, point.scalar[0]
