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
with a row per coordinate, and b is left as a single unknown beside it.  Its solution stays off
the bounds by the root of what is left of the complementarity; from near it an active set method
finds the bounds that are met, and with them the exact solution.  Only that counts as converged.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: e of the header: the largest activation exceeds the smallest possible one by at most e times
#: the sum of squares that this saves.
SQUARES_SHARE = 1e-3
#: Mean product of multiplier and slack from which on the bounds that are met are tried for the
#: exact solution, and the one beyond which that is given up.
NEARLY, COMPLEMENTARITY = 1e-7, 1e-13
#: By so much an activation may pass a bound that is not taken for met.
OVERSHOOT = 1e-9
#: Size of a multiplier, as a share of the largest pull, that is as good as none.
ROUNDING = 1e-12
#: Limit of rounds in which the bounds that are met are put right.
POLISHES = 12
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
def _on_bounds(
    matrix: Array, curvature: Array, reserve: Array, torque: Array, lower: Array, fixed: float,
    low: Flags, high: Flags,
) -> tuple[Array, Array, Array]:
    """
    Solve with the bounds that are met given, and b too unless `fixed` is NaN.

    Gives the activations, (y, b) and what is unbalanced.
    """  # fmt: skip
    free = np.isnan(fixed)
    n = reserve.size
    softness = np.where(low | high, 0.0, 1.0 / curvature)
    at_low, at_high = np.where(low, lower, 0.0), high.astype(np.float64)
    system, right = np.zeros((n + 1, n + 1)), np.zeros(n + 1)
    system[:n, :n] = (matrix * softness) @ matrix.T
    system[:n, n] = matrix @ at_high
    system[n, n] = -(curvature @ at_high)
    right[:n] = torque - matrix @ at_low
    right[n] = 1.0 if free else fixed
    for j in range(n):
        system[j, j] += 0.5 * reserve[j] * reserve[j]
    if free:
        system[n, :n] = system[:n, n]
    else:
        system[n, n] = 1.0
    solved, rest = np.zeros(n + 1), right.copy()
    found, residual = at_low.copy(), right[:n].copy()
    # Later rounds take off what the first one lost by rounding.  They add to the activations: to
    # divide the whole pull by the small curvature again would lose it anew.
    for _ in range(3):
        step = np.linalg.solve(system, rest)
        solved += step
        pull = matrix.T @ np.ascontiguousarray(step[:n])
        found += softness * pull + step[n] * at_high
        residual = torque - matrix @ found - 0.5 * reserve * reserve * solved[:n]
        rest[:n], rest[n] = residual, 0.0
    return found, solved, residual


@njit(cache=True, error_model='numpy')
def _polish(
    matrix: Array, curvature: Array, reserve: Array, torque: Array, lower: Array, upper: float,
    tolerance: float, point: _Point,
) -> bool:
    """
    Solve for the activations exactly, from the bounds that are met; changes the iterate.

    An interior point stays off its bounds by the root of the complementarity where multipliers are
    small, so that some bounds are taken for met that are not, or the other way round.  These are
    put right one round after the other, as a solution with wrong bounds shows which they are
    (primal-dual active set method, Hintermueller, Ito and Kunisch 2002, SIAM J Optim 13:865).
    Returns False, and changes nothing, if that does not come to an end.
    """  # fmt: skip
    a, z, v, y, scalar = point
    b, t = scalar
    # Without its bound a muscle would go on by its multiplier over its curvature.
    low = z > curvature * (a - lower)
    high = (v > curvature * (b - a)) & ~low
    n, floor = reserve.size, lower.max()
    fixed = upper if t > upper - b else np.nan
    for _ in range(POLISHES):
        if np.isnan(fixed) and not high.any():
            # Nothing presses on b: it falls to the largest of the lower bounds.
            fixed = floor
        found, solved, residual = _on_bounds(
            matrix, curvature, reserve, torque, lower, fixed, low, high
        )
        largest = solved[n]
        pull = matrix.T @ np.ascontiguousarray(solved[:n])
        force = pull - curvature * found
        slack = ROUNDING * (1.0 + np.abs(pull).max())
        free = ~low & ~high
        to_low = free & (found < lower - OVERSHOOT)
        to_high = free & (found > largest + OVERSHOOT)
        freed = (low & (force > slack)) | (high & (force < -slack))
        # What the muscles at b press on it, less what a unit of b costs.
        pressed = np.where(high, force, 0.0).sum() - 1.0
        wanted = fixed
        lifted = fixed == floor and pressed > slack
        if lifted or (fixed == upper and pressed < -slack):
            wanted = np.nan
        elif np.isnan(fixed) and largest > upper + OVERSHOOT:
            wanted = upper
        elif np.isnan(fixed) and largest < floor - OVERSHOOT:
            wanted = floor
        same = wanted == fixed or (np.isnan(wanted) and np.isnan(fixed))
        if same and not (to_low.any() or to_high.any() or freed.any()):
            if not np.abs(residual).max() <= tolerance:
                return False
            largest = min(max(largest, floor), upper)
            a[:] = np.minimum(np.maximum(found, lower), largest)
            y[:] = solved[:n]
            scalar[0] = largest
            return True
        low = (low & ~freed) | to_low
        high = (high & ~freed) | to_high
        fixed = wanted
    return False


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
        share = product / (1.0 + point.scalar[1])
        if share <= NEARLY and _polish(
            matrix, curvature, reserve, torque, lower, top, tolerance, point
        ):
            residual = torque - matrix @ point.a - 0.5 * reserve * reserve * point.y
            break
        # Without the exact solution it is none.  Slacks that round to nothing end the method.
        slack = min((point.a - lower).min(), (point.scalar[0] - point.a).min())
        lost = min(slack, top - point.scalar[0]) <= 0.0 or share <= COMPLEMENTARITY
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
