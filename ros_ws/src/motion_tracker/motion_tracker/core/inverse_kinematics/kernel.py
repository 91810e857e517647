# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled solver of the marker fit: damped Gauss-Newton with bounds, one frame a call.

Minimises over q, lower <= q <= upper,

    sum_i w_i |p_i(q) - x_i|^2 + sum_j v_j (q_j - r_j)^2 + sum_k c_k ((1 - s_k) q_a - s_k q_b)^2

with marker positions p, measured positions x, prior r and a share s that the lower of two joints
takes of their sum. Coordinates at a bound whose gradient points outward stay there
(Bertsekas 1982, projected Newton); the others take a Levenberg-Marquardt step, which is cut at
the bounds and accepted only if the objective falls. Gauss-Newton steps converge slowly where few
markers fit badly; after ``_GAUSS_NEWTON`` of them the second derivatives of the marker positions
are added to the Hessian (Nocedal and Wright 2006, section 10.3). Everything is summed in a fixed
order, so equal input gives equal bits.
"""

import numpy as np

from human_model.compiled import body_frames
from human_model.compiled_cache import njit
from human_model.tree import TreeArrays
from human_model.typing import Array, IntArray
from motion_tracker.core.inverse_kinematics.normal_equations import (
    add_normal_equations,
    add_pairs,
    add_second_derivatives,
    marker_positions,
)

_DAMPING_START = 1e-9
_DAMPING_MAX = 1e6
#: Steps without second derivatives; frames with a full marker set need 5 to 19 (measured).
_GAUSS_NEWTON = 20


@njit
def _objective(
    position: Array,
    target: Array,
    weight: Array,
    q: Array,
    prior: Array,
    prior_weight: Array,
    pair: IntArray,
    share: Array,
    pair_weight: Array,
) -> float:
    total = 0.0
    for i in range(weight.shape[0]):
        if weight[i] > 0.0:
            for r in range(3):
                total += weight[i] * (position[i, r] - target[i, r]) ** 2
    for j in range(q.shape[0]):
        total += prior_weight[j] * (q[j] - prior[j]) ** 2
    for k in range(pair.shape[0]):
        split = (1.0 - share[k]) * q[pair[k, 0]] - share[k] * q[pair[k, 1]]
        total += pair_weight[k] * split * split
    return total


@njit
def _solve_free(
    hessian: Array, gradient: Array, free: IntArray, damping: float, step: Array
) -> bool:
    """Cholesky solution of (H + damping I) step = -g over the free coordinates.

    Row by row of the upper factor; what is left of the matrix is reduced by each row as soon as it
    is there, so that the innermost loops run along rows.
    """
    n = free.shape[0]
    factor = np.empty((n, n))
    y = np.empty(n)
    for a in range(n):
        i = free[a]
        for b in range(a, n):
            j = free[b]
            factor[a, b] = hessian[j, i] if j >= i else hessian[i, j]
        factor[a, a] += damping
        y[a] = -gradient[i]
    for k in range(n):
        row = factor[k]
        if row[k] <= 0.0:
            return False
        pivot = np.sqrt(row[k])
        row[k] = pivot
        y[k] /= pivot
        for b in range(k + 1, n):
            row[b] /= pivot
            y[b] -= row[b] * y[k]
        for a in range(k + 1, n):
            share = row[a]
            left = factor[a]
            for b in range(a, n):
                left[b] -= share * row[b]
    for a in range(n - 1, -1, -1):
        value = y[a]
        for k in range(a + 1, n):
            value -= factor[a, k] * y[k]
        y[a] = value / factor[a, a]
    step[:] = 0.0
    for a in range(n):
        step[free[a]] = y[a]
    return True


@njit
def _bounded_step(
    hessian: Array,
    gradient: Array,
    free: IntArray,
    damping: float,
    q: Array,
    lower: Array,
    upper: Array,
    step: Array,
) -> bool:
    """Step of the free coordinates; those it would take past a bound stop there, one after all.

    The step of the others is solved again with the stopped ones in place, so that a coordinate on
    its bound does not spoil the direction of the rest.
    """
    n_q = q.shape[0]
    fixed = np.zeros(n_q)
    loose = free.copy()
    rhs = gradient.copy()
    while True:
        if not _solve_free(hessian, rhs, loose, damping, step):
            return False
        count = 0
        kept = np.empty(loose.shape[0], dtype=np.int64)
        for i in range(loose.shape[0]):
            j = loose[i]
            if q[j] + step[j] < lower[j] or q[j] + step[j] > upper[j]:
                fixed[j] = (lower[j] if step[j] < 0.0 else upper[j]) - q[j]
                for k in range(n_q):
                    rhs[k] += fixed[j] * (hessian[j, k] if j >= k else hessian[k, j])
            else:
                kept[count] = j
                count += 1
        if count == loose.shape[0]:
            break
        loose = kept[:count].copy()
    for j in range(n_q):
        step[j] += fixed[j]
    return True


@njit
def marked(position: Array, weight: Array) -> tuple[Array, Array]:
    """Measured positions (n, 3) with zeros, and weights (n,) with zeros, where not seen."""
    target, trust = np.zeros_like(position), np.zeros_like(weight)
    for i in range(weight.shape[0]):
        if np.all(np.isfinite(position[i])):
            target[i] = position[i]
            trust[i] = weight[i]
    return target, trust


@njit
def misfit(position: Array, target: Array, weight: Array) -> tuple[Array, float, float, int]:
    """Distances (n,) of the markers, their root mean square and maximum [m], and their number.

    Of those of positive weight; the distances of the others are NaN, and all is NaN without any.
    """
    distance = np.full(weight.shape[0], np.nan)
    used, total, largest = 0, 0.0, 0.0
    for i in range(weight.shape[0]):
        if weight[i] > 0.0:
            x, y, z = (
                position[i, 0] - target[i, 0],
                position[i, 1] - target[i, 1],
                position[i, 2] - target[i, 2],
            )
            square = x * x + y * y + z * z
            distance[i] = np.sqrt(square)
            total += square
            largest = max(largest, distance[i])
            used += 1
    if used == 0:
        return distance, np.nan, np.nan, 0
    return distance, np.sqrt(total / used), largest, used


@njit
def fit(
    tree: TreeArrays,
    start: Array,
    lower: Array,
    upper: Array,
    body: IntArray,
    local: Array,
    target: Array,
    weight: Array,
    prior: Array,
    prior_weight: Array,
    pair: IntArray,
    share: Array,
    pair_weight: Array,
    iterations: int,
    tolerance: float,
) -> tuple[Array, Array, int, bool, float, float]:
    """Fit one frame.

    Returns coordinates (n_q,), marker positions (n, 3) [m], iterations, whether the last step was
    below the tolerance [rad or m], objective, and the largest free component of its gradient.
    """
    n_q = start.shape[0]
    q = np.minimum(np.maximum(start, lower), upper)
    rotation, origin, axis = body_frames(tree, q)
    position = marker_positions(rotation, origin, body, local)
    value = _objective(position, target, weight, q, prior, prior_weight, pair, share, pair_weight)
    damping = _DAMPING_START
    step = np.zeros(n_q)
    converged = False
    stationarity = np.inf
    used = 0
    while used < iterations:
        used += 1
        hessian = np.zeros((n_q, n_q))
        gradient = np.zeros(n_q)
        add_normal_equations(tree, origin, axis, position, body, target, weight, hessian, gradient)
        if used > _GAUSS_NEWTON:
            add_second_derivatives(tree, origin, axis, position, body, target, weight, hessian)
        for j in range(n_q):
            hessian[j, j] += prior_weight[j]
            gradient[j] += prior_weight[j] * (q[j] - prior[j])
        for k in range(pair.shape[0]):
            a, b = pair[k, 0], pair[k, 1]
            s = share[k]
            split = (1.0 - s) * q[a] - s * q[b]
            gradient[a] += pair_weight[k] * (1.0 - s) * split
            gradient[b] -= pair_weight[k] * s * split
        add_pairs(hessian, pair, share, pair_weight)
        count = 0
        free = np.empty(n_q, dtype=np.int64)
        stationarity = 0.0
        for j in range(n_q):
            at_lower = q[j] <= lower[j] and gradient[j] > 0.0
            at_upper = q[j] >= upper[j] and gradient[j] < 0.0
            if at_lower or at_upper:
                continue
            free[count] = j
            count += 1
            stationarity = max(stationarity, abs(gradient[j]))
        accepted = False
        moved = 0.0
        while damping <= _DAMPING_MAX:
            if _bounded_step(hessian, gradient, free[:count], damping, q, lower, upper, step):
                trial = np.minimum(np.maximum(q + step, lower), upper)
                rotation, origin, axis = body_frames(tree, trial)
                position = marker_positions(rotation, origin, body, local)
                trial_value = _objective(
                    position, target, weight, trial, prior, prior_weight, pair, share, pair_weight
                )
                moved = np.max(np.abs(trial - q))
                if trial_value <= value or moved < tolerance:
                    accepted = True
                    q = trial
                    value = trial_value
                    damping = max(damping * 0.1, _DAMPING_START)
                    break
            damping *= 10.0
        if not accepted:
            rotation, origin, axis = body_frames(tree, q)
            position = marker_positions(rotation, origin, body, local)
            damping = _DAMPING_START
            break
        if moved < tolerance:
            converged = True
            break
    return q, position, used, converged, value, stationarity
