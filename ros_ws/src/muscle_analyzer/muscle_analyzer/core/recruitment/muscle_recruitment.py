# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscle recruitment of one sample by any criterion, with the residuals; compiled.

Each sample starts from multipliers that are extrapolated from the two samples before it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array, BoolArray, IntArray
from muscle_analyzer.core.recruitment.dual_newton import Columns, solve_dual
from muscle_analyzer.core.recruitment.min_max import SQUARES_WEIGHT, solve_min_max

#: A coordinate is not balanced by its muscles when the reserve takes more than this fraction of
#: the net moment of its joint, all coordinates of the joint together: half of what OpenSim's guide
#: allows (page "Reserves and Residuals": peak reserve below 10 % of the peak joint torque), and
#: the fraction of the external force that Hicks et al. 2015 (J Biomech Eng 137:020905, section
#: 3.1.3) allow residual forces, and more than its limit (`Actuators.limit`).
RESERVE_FRACTION = 0.05


class Actuators(NamedTuple):
    """Muscles and reserves of the optimisation, and its settings.

    Attributes
    ----------
    unit : (n_c,)
        Torque of each reserve at unit control [N m].
    muscle_driven : (n_c,) bool
        Whether muscles must balance the coordinate.
    limit : (n_c,)
        Torque of a reserve [N m] below which a fraction of the net moment means nothing.
    joint : (n_c,) int
        Number of the joint that the coordinate belongs to.
    lower, upper, weight : (n_m,)
        Bounds of the activations, and their weights in the cost.
    min_max : bool
        Whether the largest activation is minimised instead of a power of all.
    exponent : float
        Of the activations in the cost.
    tolerance : float
        Largest balance residual of a solution, relative to the largest torque (or 1 N m).
    max_iterations : int
        Limit of Newton steps.
    """

    unit: Array
    muscle_driven: BoolArray
    limit: Array
    joint: IntArray
    lower: Array
    upper: Array
    weight: Array
    min_max: bool
    exponent: float
    tolerance: float
    max_iterations: int


class Residuals(NamedTuple):
    """Cost of a solution and its distance from the optimality conditions.

    Attributes
    ----------
    objective : float
        The cost, reserves included.
    primal, dual : float
        Largest residual of the balance [N m] and of the stationarity.
    """

    objective: float
    primal: float
    dual: float


class Recruitment(NamedTuple):
    """Solution of the static optimisation in one sample.

    Attributes
    ----------
    activation : ndarray, shape (n_m,)
    reserve, multiplier, imbalance : ndarray, shape (n_c,)
        Torque of the reserves [N m], dual solution [1 / (N m)], torque that is not balanced [N m].
    weak : ndarray of bool, shape (n_c,)
        Whether the muscles of a coordinate are too weak.
    iterations : int
    converged : bool
    residuals : Residuals
    """

    activation: Array
    reserve: Array
    multiplier: Array
    imbalance: Array
    weak: BoolArray
    iterations: int
    converged: bool
    residuals: Residuals


@njit(error_model='numpy')
def _residual_limit(actuators: Actuators, torque: Array) -> float:
    """Return the largest balance residual of a solution [N m]."""
    largest = 1.0
    for j in range(torque.size):
        largest = max(largest, abs(torque[j]))
    return actuators.tolerance * largest


@njit(error_model='numpy')
def extrapolate_warm_start(warm_start: Array) -> Array:
    """Return the multipliers (n_c,) to start from: a line through those of the two last samples.

    `warm_start` (2, n_c) holds theirs, the last sample first; zeros are no sample.
    """
    multiplier = np.empty(warm_start.shape[1])
    for j in range(multiplier.size):
        multiplier[j] = 2.0 * warm_start[0, j] - warm_start[1, j]
    return multiplier


@njit(error_model='numpy')
def store_warm_start(warm_start: Array, multiplier: Array, converged: bool) -> None:
    """Put the multipliers (n_c,) of a sample first in `warm_start`; clear it after a failure."""
    first = not warm_start[0].any()
    for j in range(multiplier.size):
        if not converged:
            warm_start[0, j], warm_start[1, j] = 0.0, 0.0
            continue
        warm_start[1, j] = multiplier[j] if first else warm_start[0, j]
        warm_start[0, j] = multiplier[j]


@njit(error_model='numpy')
def recruit(
    actuators: Actuators, columns: Columns, torque: Array, warm_start: Array
) -> Recruitment:
    """Distribute the torques of one sample over the muscles.

    Parameters
    ----------
    actuators
        Muscles and reserves.
    columns
        Torque of each muscle at full activation [N m].
    torque
        Torques to balance (n_c,) [N m].
    warm_start : ndarray, shape (2, n_c)
        See `extrapolate_warm_start`; updated.
    """
    multiplier = extrapolate_warm_start(warm_start)
    limit = _residual_limit(actuators, torque)
    factor, cap, largest = 1.0, np.inf, 0.0
    if actuators.min_max:
        activation, imbalance, iterations, converged, cap = solve_min_max(
            columns, actuators.unit, torque, actuators.lower, actuators.upper, actuators.weight,
            multiplier, limit, actuators.max_iterations,
        )  # fmt: skip
        factor, largest = SQUARES_WEIGHT, cap
    else:
        activation, imbalance, iterations, converged = _minimise_power(
            actuators, columns, torque, multiplier, limit
        )
    store_warm_start(warm_start, multiplier, converged)
    reserve, weak = np.empty(torque.size), np.empty(torque.size, np.bool_)
    _set_reserves(actuators, torque, multiplier, reserve, weak)
    residuals = _residuals(
        actuators, columns, activation, imbalance, multiplier, factor, cap, largest
    )
    return Recruitment(
        activation, reserve, multiplier, imbalance, weak, iterations, converged, residuals
    )


@njit(error_model='numpy')
def _minimise_power(
    actuators: Actuators, columns: Columns, torque: Array, multiplier: Array, limit: float
) -> tuple[Array, Array, int, bool]:
    """Minimise a power of the activations from a warm start, and if that fails from a cold one."""
    iterations = 0
    for attempt in range(2):
        if attempt == 1:
            for j in range(torque.size):
                multiplier[j] = 0.0
        activation, imbalance, more, converged = solve_dual(
            columns, actuators.unit, torque, actuators.lower, actuators.upper, actuators.weight,
            actuators.exponent, multiplier, limit, actuators.max_iterations,
        )  # fmt: skip
        iterations += more
        if converged:
            break
    return activation, imbalance, iterations, converged


@njit(error_model='numpy')
def _set_reserves(
    actuators: Actuators, torque: Array, multiplier: Array, reserve: Array, weak: BoolArray
) -> None:
    """Fill the torques (n_c,) of the reserves [N m], and where muscles are too weak."""
    squares = np.zeros(torque.size)
    for j in range(torque.size):
        squares[actuators.joint[j]] += torque[j] ** 2
    for j in range(torque.size):
        control = 0.5 * actuators.unit[j] * multiplier[j]
        reserve[j] = actuators.unit[j] * control
        weak[j] = (
            actuators.muscle_driven[j]
            and abs(reserve[j]) > RESERVE_FRACTION * np.sqrt(squares[actuators.joint[j]])
            and abs(reserve[j]) > actuators.limit[j]
        )


@njit(error_model='numpy')
def _residuals(
    actuators: Actuators,
    columns: Columns,
    activation: Array,
    imbalance: Array,
    multiplier: Array,
    factor: float,
    cap: float,
    largest: float,
) -> Residuals:
    """Return the residuals of a solution.

    `factor` multiplies the powers in the cost, `cap` is the largest activation allowed, and
    `largest` is added to the cost.
    """
    objective, primal, dual = 0.0, 0.0, 0.0
    for j in range(multiplier.size):
        objective += (0.5 * actuators.unit[j] * multiplier[j]) ** 2
        if not abs(imbalance[j]) <= primal:
            primal = abs(imbalance[j])
    for i in range(activation.size):
        a = activation[i]
        # The exponents are whole numbers: products are many times as fast as a power.
        before = a if actuators.exponent == 2.0 else a ** (actuators.exponent - 1.0)
        before *= factor * actuators.weight[i]
        objective += before * a
        gradient = actuators.exponent * before
        for k in range(columns.start[i], columns.start[i + 1]):
            gradient -= columns.value[k] * multiplier[columns.row[k]]
        projected = max(a - gradient, actuators.lower[i])
        off = abs(min(projected, actuators.upper[i], cap) - a)
        if not off <= dual:
            dual = off
    return Residuals(objective + largest, primal, dual)
