# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The min/max criterion of muscle recruitment by a semismooth Newton method on its dual, compiled.

The largest activation is made as small as the torques allow (Rasmussen, Damsgaard and Voigt 2001,
J Biomech 34:409).  That alone leaves the muscles below the largest activation undetermined, so a
small multiple e of their squares decides among them::

    min  b + e sum w_i a_i^2 + sum c_j^2   subject to   A a + D c = tau,   l <= a <= b <= u

For given multipliers y of the balance the minimisers are ``c(y) = D y / 2``, ``a(y) = clip(A^T y /
(2 e w), l, b)`` and the b at which the multipliers of the muscles at b add up to 1, the
cost of one unit of b (`_largest`).  They are unique, so the dual function is concave with a
piecewise linear gradient, as that of the other criteria is, and the same method finds its maximum
(see `dual_newton`).  In the Hessian the muscles at b stand as one, with the sum of their columns.

Hardly any muscle is strictly between its bounds where e is small, and from a start far away Newton
steps then go from one set of bounds to the next, a thousand times or without end.  From nothing, e
therefore falls from 1 to its value by tens, each problem starting from the solution of the one
before.  That does not depend on how much the muscles can do: where they are far too weak, b is u
and the reserves take the rest.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from human_model.compiled_cache import njit
from human_model.typing import Array
from muscle_analyzer.core.recruitment.dual_newton import (
    LINE_TRIALS,
    SLOPE_FRACTION,
    Columns,
    cholesky_solve,
    dot,
)
from muscle_analyzer.core.recruitment.false_position import crossing, narrowed, whole_step

Places = NDArray[np.int8]

#: e of the header: the largest activation exceeds the smallest possible one by at most e times
#: the sum of squares that this saves.
SQUARES_WEIGHT = 1e-3
#: From nothing, the problems have these weights, one after the other.
SQUARES_WEIGHTS = (1.0, 0.1, 0.01, SQUARES_WEIGHT)
#: Limit of Newton steps from a warm start: from farther away it is quicker to start from nothing.
WARM_STEPS = 30
#: Limit of the refinement steps against rounding errors.
REFINEMENTS = 3
#: Places of an activation: at its lower bound, between its bounds, at b.
LOW, FREE, HIGH = -1, 0, 1


class _Problem(NamedTuple):
    """The problem with one weight e of the squares.

    Attributes
    ----------
    columns, reserve, torque
        See `dual_newton.solve_dual`.
    lower : (n_m,)
        Bounds of the activations.
    floor, top : float
        Bounds of b: the largest lower bound, and u.
    curvature : (n_m,)
        2 e w.
    """

    columns: Columns
    reserve: Array
    torque: Array
    lower: Array
    floor: float
    top: float
    curvature: Array


class _Iterate(NamedTuple):
    """Minimisers for given multipliers.

    Attributes
    ----------
    multiplier : (n_c,)
    pull : (n_m,)
        A^T y.
    activation : (n_m,)
    place : (n_m + 1,)
        Of the activations, and of b between floor and top.
    gradient : (n_c,)
        Of the dual: what is not balanced [N m].
    """

    multiplier: Array
    pull: Array
    activation: Array
    place: Places
    gradient: Array


@njit(error_model='numpy')
def _largest(problem: _Problem, pull: Array, guess: float) -> float:
    """Return the b that muscles of these pulls press on with 1, or the bound of b next to it.

    What they press with falls with b, piecewise linear and convex: from a guess one Newton step
    leads to the left of the solution, and from there the steps rise to it.
    """
    b = min(max(guess, problem.floor), problem.top)
    for trial in range(pull.size + 2):
        pressed, stiffness = -1.0, 0.0
        for i in range(pull.size):
            excess = pull[i] - problem.curvature[i] * b
            if excess > 0.0:
                pressed += excess
                stiffness += problem.curvature[i]
        following = problem.floor
        if stiffness > 0.0:
            following = min(max(b + pressed / stiffness, problem.floor), problem.top)
        if following == b or (trial > 0 and following < b):
            break
        b = following
    return b


@njit(error_model='numpy')
def _pull(columns: Columns, multiplier: Array, pull: Array) -> None:
    """Fill A^T y."""
    start, row, value = columns
    for i in range(pull.size):
        pull[i] = 0.0
        for k in range(start[i], start[i + 1]):
            pull[i] += value[k] * multiplier[row[k]]


@njit(error_model='numpy')
def _unbalanced(problem: _Problem, point: _Iterate) -> float:
    """Fill the imbalance of activations and multipliers; return its largest entry."""
    start, row, value = problem.columns
    gradient = point.gradient
    for j in range(gradient.size):
        d = problem.reserve[j]
        gradient[j] = problem.torque[j] - 0.5 * d * d * point.multiplier[j]
    for i in range(point.activation.size):
        for k in range(start[i], start[i + 1]):
            gradient[row[k]] -= value[k] * point.activation[i]
    worst = 0.0
    for j in range(gradient.size):
        if not abs(gradient[j]) <= worst:
            worst = abs(gradient[j])
    return worst


@njit(error_model='numpy')
def _evaluate(problem: _Problem, point: _Iterate, guess: float) -> tuple[float, float, int]:
    """Fill the minimisers for the multipliers of an iterate.

    Returns b, the largest entry of the gradient, and the number of changed places.
    """
    _pull(problem.columns, point.multiplier, point.pull)
    b = _largest(problem, point.pull, guess)
    changed = 0
    for i in range(point.pull.size):
        free = point.pull[i] / problem.curvature[i]
        place = FREE
        if free >= b:
            free, place = b, HIGH
        elif free <= problem.lower[i]:
            free, place = problem.lower[i], LOW
        point.activation[i] = free
        changed += place != point.place[i]
        point.place[i] = place
    place = LOW if b <= problem.floor else HIGH if b >= problem.top else FREE
    changed += place != point.place[-1]
    point.place[-1] = place
    return b, _unbalanced(problem, point), changed


@njit(error_model='numpy')
def _step(problem: _Problem, place: Places, step: Array) -> tuple[bool, float]:
    """Solve for the Newton step in place of the gradient; return success and the change of b.

    Minus the dual's Hessian is that of reserves and free muscles, and of b if it is free.
    """
    start, row, value = problem.columns
    n = step.size
    hessian, together = np.zeros((n, n)), np.zeros(n)
    stiffness = 0.0
    for j in range(n):
        hessian[j, j] = 0.5 * problem.reserve[j] * problem.reserve[j]
    for i in range(place.size - 1):
        if place[i] == HIGH:
            stiffness += problem.curvature[i]
            for k in range(start[i], start[i + 1]):
                together[row[k]] += value[k]
        elif place[i] == FREE:
            for k in range(start[i], start[i + 1]):
                scaled = value[k] / problem.curvature[i]
                for other in range(start[i], k + 1):
                    hessian[row[k], row[other]] += scaled * value[other]
    if place[-1] == FREE:
        for j in range(n):
            if together[j] != 0.0:
                for k in range(j + 1):
                    hessian[j, k] += together[j] / stiffness * together[k]
    if not cholesky_solve(hessian, step):
        return False, 0.0
    return True, dot(together, step) / stiffness if place[-1] == FREE else 0.0


@njit(error_model='numpy')
def _step_size(
    problem: _Problem, multiplier: Array, step: Array, guess: float, first: float, whole: float
) -> float:
    """Return the fraction of a step that is too long at which the slope of the dual is small.

    As in `dual_newton` by false position with the Illinois rule, between the slopes `first`
    (positive) at the beginning and `whole` (negative) at the end.
    """
    n_m = problem.lower.size
    pull, turn, here, before = np.empty(n_m), np.empty(n_m), np.empty(n_m), np.empty(n_m)
    _pull(problem.columns, multiplier, pull)
    _pull(problem.columns, step, turn)
    b = _largest(problem, pull, guess)
    bend = 0.0
    for i in range(n_m):
        before[i] = min(max(pull[i] / problem.curvature[i], problem.lower[i]), b)
    for j in range(step.size):
        bend += 0.5 * (problem.reserve[j] * step[j]) ** 2
    bracket = whole_step(first, whole, 0)
    size = crossing(bracket)
    for _ in range(LINE_TRIALS):
        for i in range(n_m):
            here[i] = pull[i] + size * turn[i]
        b = _largest(problem, here, b)
        slope = first - size * bend
        for i in range(n_m):
            now = min(max(here[i] / problem.curvature[i], problem.lower[i]), b)
            slope -= turn[i] * (now - before[i])
        if abs(slope) <= SLOPE_FRACTION * first:
            break
        bracket = narrowed(bracket, size, slope)
        size = crossing(bracket)
    return size


@njit(error_model='numpy')
def _maximise(
    problem: _Problem, point: _Iterate, tolerance: float, max_iterations: int
) -> tuple[float, int, bool]:
    """Maximise the dual from the multipliers of an iterate; return b, the steps, and success.

    A whole step after which every activation is where it was has found the solution, but for
    rounding.  A step cut short ends where some muscle reaches or leaves a bound.  If the next step
    treated that muscle as fixed, the two steps could alternate without end.  It is therefore
    treated as free; the step stays an ascent direction.
    """
    multiplier = point.multiplier
    begin, step = np.empty_like(multiplier), np.empty_like(multiplier)
    here, before = np.empty_like(point.place), np.empty_like(point.place)
    b, worst, _ = _evaluate(problem, point, problem.floor)
    iterations, short = 0, False
    while not worst <= tolerance:
        if iterations == max_iterations or not np.isfinite(worst):
            return b, iterations, False
        here[:] = point.place
        freed = 0
        if short:
            for i in range(here.size - 1):
                if before[i] == FREE and here[i] != FREE:
                    here[i] = FREE
                    freed += 1
        before[:] = point.place
        begin[:], step[:] = multiplier, point.gradient
        if not _step(problem, here, step)[0]:
            return b, iterations, False
        iterations += 1
        first, guess = dot(point.gradient, step), b
        multiplier[:] = begin + step
        b, worst, changed = _evaluate(problem, point, guess)
        if changed == 0 and freed == 0:
            break
        whole = dot(point.gradient, step)
        short = whole < -SLOPE_FRACTION * first and worst > tolerance
        if short:
            multiplier[:] = begin + step * _step_size(problem, begin, step, guess, first, whole)
            b, worst, _ = _evaluate(problem, point, b)
    return b, iterations, True


@njit(error_model='numpy')
def _refine(problem: _Problem, point: _Iterate, b: float) -> tuple[float, float]:
    """Reduce the rounding error of the balance; return b and the remaining error.

    Changes are added to the activations: to divide the whole pull by the small curvature again
    would lose them again.
    """
    worst = _unbalanced(problem, point)
    n_m = point.pull.size
    change, before = np.empty(n_m), np.empty(n_m)
    step = np.empty_like(point.gradient)
    for _ in range(REFINEMENTS):
        step[:], before[:] = point.gradient, point.activation
        found, rise = _step(problem, point.place, step)
        if not found:
            break
        _pull(problem.columns, step, change)
        for i in range(n_m):
            if point.place[i] == HIGH:
                point.activation[i] = b + rise
            elif point.place[i] == FREE:
                moved = before[i] + change[i] / problem.curvature[i]
                point.activation[i] = min(max(moved, problem.lower[i]), b + rise)
        point.multiplier[:] += step
        left = _unbalanced(problem, point)
        if not left < worst:
            point.multiplier[:] -= step
            point.activation[:] = before
            _unbalanced(problem, point)
            break
        b, worst = b + rise, left
    return b, worst


@njit(error_model='numpy')
def solve_min_max(
    columns: Columns,
    reserve: Array,
    torque: Array,
    lower: Array,
    upper: Array,
    weight: Array,
    multiplier: Array,
    tolerance: float,
    max_iterations: int,
) -> tuple[Array, Array, int, bool, float]:
    """Make the largest activation smallest.

    Parameters are those of `dual_newton.solve_dual`, without the exponent; the limit of Newton
    steps is that for each weight of the squares.

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
    n_c, n_m = torque.size, lower.size
    floor, top = lower.max(), upper.min()
    point = _Iterate(
        multiplier, np.empty(n_m), np.empty(n_m), np.zeros(n_m + 1, np.int8), np.empty(n_c)
    )
    iterations, b, found = 0, floor, False
    problem = _Problem(columns, reserve, torque, lower, floor, top, 2.0 * SQUARES_WEIGHT * weight)
    if multiplier.any():
        limit = min(WARM_STEPS, max_iterations)
        b, iterations, found = _maximise(problem, point, tolerance, limit)
    if not found:
        multiplier[:] = 0.0
        for squares_weight in SQUARES_WEIGHTS:
            problem = _Problem(
                columns, reserve, torque, lower, floor, top, 2.0 * squares_weight * weight
            )
            b, more, found = _maximise(problem, point, tolerance, max_iterations)
            iterations += more
            if not found:
                return point.activation, point.gradient, iterations, False, b
    b, left = _refine(problem, point, b)
    return point.activation, point.gradient, iterations, left <= tolerance, b
