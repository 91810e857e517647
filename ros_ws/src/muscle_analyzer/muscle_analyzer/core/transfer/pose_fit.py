# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Fits a tree's independent coordinates to points and orientations of bodies; compiled.

Weighted least squares by a damped Gauss-Newton method (Levenberg 1944, Marquardt 1963) with
bounds: a coordinate at its bound is left out of a step that would push it outwards, and one that
would cross its bound is stopped there while the others are solved for again.

Where points say little about a coordinate (a straight elbow leaves the split of a turn between
upper arm and forearm open), a weak pull towards a reference value decides, instead of noise.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array
from muscle_analyzer.core.multibody.kinematics import (
    BodyState,
    allocate_kinematics,
    compute_kinematics,
    forward_kinematics,
)
from muscle_analyzer.core.multibody.model import Tree
from muscle_analyzer.core.transfer.normal_equations import (
    damped_part,
    factorise,
    normal_equations,
    solution,
    solve_factorised,
    transposed_times,
)
from muscle_analyzer.core.transfer.pose_misfit import (
    Targets,
    misfit_jacobian,
    set_left_acceleration,
    set_misfit,
    set_misfit_jacobian,
)

# Damping relative to the mean diagonal of the normal matrix: first value, and the factors after an
# accepted and a rejected step. They steer the way to the solution, not the solution.
_FIRST_DAMPING = 1e-6
_DAMPING_DOWN = 0.1
_DAMPING_UP = 10.0
_SMALLEST_DAMPING = 1e-12
# Near a straight elbow the last digits of its turn come slowly and move nothing: a fit has also
# converged after so many steps that lower the cost by less than this (in squared sigmas: some
# 1e-8 m of a hand).
FLAT_COST = 1e-5
FLAT_STEPS = 3


class Rates(NamedTuple):
    """First or second time derivatives of what is fitted.

    Attributes
    ----------
    point : (n_p, 3) array
        m/s or m/s^2.
    frame : (n_f, 3) array
        Angular, rad/s or rad/s^2.
    reference : (n_q,) array
        rad/s or m/s, or per s again.
    """

    point: Array
    frame: Array
    reference: Array


class PoseFit(NamedTuple):
    """Result of a fit.

    Attributes
    ----------
    q : (n_q,) array
        Independent coordinates, rad or m.
    iterations : int
    cost : float
        Half the sum of squared weighted misfits.
    step : float
        Largest coordinate change of the last step, rad or m.
    converged : bool
    state : BodyState
        Where the bodies are at these coordinates, at rest.
    residual : (3 n_p + 3 n_f,) array
        Their `misfit`.
    """

    q: Array
    iterations: int
    cost: float
    step: float
    converged: bool
    state: BodyState
    residual: Array


@njit
def _bounded_step(
    normal: Array,
    gradient: Array,
    free: NDArray[np.bool_],
    damping: float,
    lowest: Array,
    highest: Array,
) -> Array:
    """Return the damped step (n_q,) between `lowest` and `highest`, zero where not free.

    A coordinate whose step would leave its bounds is stopped there, and the others are solved for
    again with that taken into account.
    """
    n_q = gradient.size
    moving = free.copy()
    step = np.zeros(n_q)
    while True:
        index = np.flatnonzero(moving)
        n = index.size
        if n == 0:
            return step
        right = np.empty(n)
        for i in range(n):
            right[i] = -gradient[index[i]]
            for k in range(n_q):
                if not moving[k]:
                    right[i] -= normal[index[i], k] * step[k]
        factor = damped_part(normal, index, damping)
        if factorise(factor):
            solve_factorised(factor, right)
        else:
            right[:] = np.nan
        stopped = False
        for i in range(n):
            k = index[i]
            step[k] = min(max(right[i], lowest[k]), highest[k])
            if step[k] != right[i]:
                moving[k] = False
                stopped = True
        if not stopped:
            return step


@kernel
def _cost(targets: Targets, residual: Array, q: Array) -> float:
    total = 0.0
    for i in range(residual.size):
        total += residual[i] * residual[i]
    for k in range(q.size):
        pull = targets.reference_weight[k] * (q[k] - targets.reference[k])
        total += pull * pull
    return 0.5 * total


@njit
def fit_pose(
    tree: Tree,
    targets: Targets,
    start: Array,
    lower: Array,
    upper: Array,
    fitted: NDArray[np.bool_],
    tolerance: float,
    max_iterations: int,
) -> PoseFit:
    """Return the coordinates that fit the targets best within their bounds.

    Parameters
    ----------
    tree : Tree
    targets : Targets
    start : (n_q,) array
        First guess, rad or m; coordinates that are not fitted stay there.
    lower, upper : (n_q,) arrays
        Bounds.
    fitted : (n_q,) bool array
    tolerance : float
        Step below which the fit has converged, rad or m; see also `FLAT_COST`.
    max_iterations : int
    """
    n_q = start.size
    zero = np.zeros(n_q)
    q = start.copy()
    for k in range(n_q):
        if fitted[k]:
            q[k] = min(max(q[k], lower[k]), upper[k])
    n_m = 3 * (targets.point_body.size + targets.frame_body.size)
    jacobian, spatial = np.empty((n_m, n_q)), np.empty((tree.parent.size, 6, n_q))
    residual, left = np.empty(n_m), np.empty(n_m)
    workspace, state = allocate_kinematics(tree)
    other_workspace, there = allocate_kinematics(tree)
    compute_kinematics(tree, q, zero, zero, workspace, state)
    set_misfit(targets, state, residual)
    cost = _cost(targets, residual, q)
    relative_damping = _FIRST_DAMPING
    size = np.inf
    flat = 0
    for iteration in range(1, max_iterations + 1):
        set_misfit_jacobian(tree, targets, state, spatial, jacobian)
        normal, gradient = normal_equations(jacobian, residual)
        for k in range(n_q):
            weight = targets.reference_weight[k] ** 2
            normal[k, k] += weight
            gradient[k] += weight * (q[k] - targets.reference[k])
        scale = np.trace(normal) / n_q
        free = fitted.copy()
        for k in range(n_q):
            below = q[k] <= lower[k] and gradient[k] > 0.0
            above = q[k] >= upper[k] and gradient[k] < 0.0
            free[k] = fitted[k] and not (below or above)
        while True:
            step = _bounded_step(
                normal, gradient, free, relative_damping * scale, lower - q, upper - q
            )
            trial = q + step
            for k in range(n_q):
                # Exactly on the bound, which rounding may miss.
                if step[k] == upper[k] - q[k]:
                    trial[k] = upper[k]
                elif step[k] == lower[k] - q[k]:
                    trial[k] = lower[k]
            size = np.max(np.abs(trial - q))
            compute_kinematics(tree, trial, zero, zero, other_workspace, there)
            set_misfit(targets, there, left)
            trial_cost = _cost(targets, left, trial)
            if trial_cost <= cost or size < tolerance:
                break
            if not np.isfinite(relative_damping):
                return PoseFit(q, iteration, cost, size, False, state, residual)
            relative_damping *= _DAMPING_UP
        relative_damping = max(relative_damping * _DAMPING_DOWN, _SMALLEST_DAMPING)
        flat = flat + 1 if cost - trial_cost < FLAT_COST else 0
        if trial_cost <= cost:
            q, cost = trial, trial_cost
            workspace, other_workspace = other_workspace, workspace
            state, there = there, state
            residual, left = left, residual
        if size < tolerance or flat == FLAT_STEPS:
            return PoseFit(q, iteration, cost, size, True, state, residual)
    return PoseFit(q, max_iterations, cost, size, False, state, residual)


@njit
def map_rates(
    tree: Tree,
    targets: Targets,
    q: Array,
    state: BodyState,
    fitted: NDArray[np.bool_],
    velocity: Rates,
    acceleration: Rates,
) -> tuple[Array, Array]:
    """Return rates and accelerations (n_q,) of the coordinates from those of points and frames.

    The weighted least-squares solutions of J q' = v and J q'' = a - J' q' with the fit's weights:
    no filter, hence no delay beyond that of v and a.

    Parameters
    ----------
    tree : Tree
    targets : Targets
        Their places are not used.
    q : (n_q,) array
        The fitted coordinates.
    state : BodyState
        Where the bodies are at these.
    fitted : (n_q,) bool array
    velocity, acceleration : Rates
        Of the points, frames and reference values.
    """
    n_q = q.size
    n_p = targets.point_body.size
    n_f = targets.frame_body.size
    jacobian = misfit_jacobian(tree, targets, state)
    wanted = np.empty(3 * (n_p + n_f))
    for i in range(n_p):
        for j in range(3):
            wanted[3 * i + j] = targets.point_weight[i] * velocity.point[i, j]
    for i in range(n_f):
        for j in range(3):
            wanted[3 * (n_p + i) + j] = targets.frame_weight[i] * velocity.frame[i, j]
    normal, right = normal_equations(jacobian, wanted)
    damping = _SMALLEST_DAMPING * np.trace(normal) / n_q
    pull = targets.reference_weight**2
    for k in range(n_q):
        normal[k, k] += pull[k]
    index = np.flatnonzero(fitted)
    factor = damped_part(normal, index, damping)
    solved = factorise(factor)
    rate = solution(factor, solved, index, right + pull * velocity.reference)
    # With zero coordinate accelerations the points' accelerations are J' q'.
    moving = forward_kinematics(tree, q, rate, np.zeros(n_q))
    set_left_acceleration(targets, moving, acceleration.point, acceleration.frame, wanted)
    right = transposed_times(jacobian, wanted) + pull * acceleration.reference
    return rate, solution(factor, solved, index, right)
