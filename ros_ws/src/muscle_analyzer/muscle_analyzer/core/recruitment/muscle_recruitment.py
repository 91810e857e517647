# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""One frame of the static optimisation with its account of the solution, compiled."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array, BoolArray, IntArray
from muscle_analyzer.core.recruitment.dual_newton import Columns, solve_dual

#: A coordinate is not balanced by its muscles when the reserve takes more than this share of the
#: net moment of its joint, all coordinates of the joint together: half of what OpenSim's guide
#: allows (page "Reserves and Residuals": peak reserve below 10 % of the peak joint torque), and
#: the share of the external force that Hicks et al. 2015 (J Biomech Eng 137:020905, section
#: 3.1.3) allow residual forces ...
RESERVE_SHARE = 0.05
#: ... and more than its unit torque, below which a share means nothing.
RESERVE_CONTROL = 1.0


class Actuators(NamedTuple):
    """Muscles and reserves of the optimisation and what it is told.

    Attributes
    ----------
    unit : (n_c,)
        Torque of each reserve at unit control [N m].
    muscle_driven : (n_c,) bool
        Whether muscles must balance the coordinate.
    joint : (n_c,) int
        Number of the joint that the coordinate belongs to.
    lower, upper, weight : (n_m,)
        Bounds of the activations, and their weights in the cost.
    exponent : float
        Of the activations in the cost.
    tolerance : float
        Largest balance residual of a solution, relative to the largest torque (or 1 N m).
    max_iterations : int
        Limit of Newton steps.
    """

    unit: Array
    muscle_driven: BoolArray
    joint: IntArray
    lower: Array
    upper: Array
    weight: Array
    exponent: float
    tolerance: float
    max_iterations: int


class Account(NamedTuple):
    """What there is to say about a solution.

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


@njit(error_model='numpy')
def residual_limit(actuators: Actuators, torque: Array) -> float:
    """Give the largest balance residual of a solution [N m]."""
    largest = 1.0
    for j in range(torque.size):
        largest = max(largest, abs(torque[j]))
    return actuators.tolerance * largest


@njit(error_model='numpy')
def first_guess(past: Array) -> Array:
    """Give multipliers (n_c,) to start a frame from: on as the two frames before it went.

    `past` (2, n_c) holds theirs, the last first; zeros are no frame.
    """
    guess = np.empty(past.shape[1])
    for j in range(guess.size):
        guess[j] = 2.0 * past[0, j] - past[1, j]
    return guess


@njit(error_model='numpy')
def remember(past: Array, multiplier: Array, converged: bool) -> None:
    """Put a frame's multipliers (n_c,) in front of `past`, or forget all if it failed."""
    first = not past[0].any()
    for j in range(multiplier.size):
        if not converged:
            past[0, j], past[1, j] = 0.0, 0.0
            continue
        past[1, j] = multiplier[j] if first else past[0, j]
        past[0, j] = multiplier[j]


@njit(error_model='numpy')
def share_torque(
    actuators: Actuators, columns: Columns, torque: Array, multiplier: Array
) -> tuple[Array, Array, int, bool]:
    """Minimise a power of the activations from a warm start, and if that fails from a cold one.

    Parameters
    ----------
    actuators
        Muscles and reserves.
    columns
        Torque of each muscle at full activation [N m].
    torque
        To balance (n_c,) [N m].
    multiplier
        Start on entry, solution on return (n_c,).

    Returns
    -------
    activation : (n_m,)
    residual : (n_c,)
        Of the balance [N m].
    iterations : int
    converged : bool
    """
    limit = residual_limit(actuators, torque)
    iterations = 0
    for attempt in range(2):
        if attempt == 1:
            # A start far from this frame's solution: once more from nothing.
            for j in range(torque.size):
                multiplier[j] = 0.0
        activation, residual, more, converged = solve_dual(
            columns, actuators.unit, torque, actuators.lower, actuators.upper, actuators.weight,
            actuators.exponent, multiplier, limit, actuators.max_iterations,
        )  # fmt: skip
        iterations += more
        if converged:
            break
    return activation, residual, iterations, converged


@njit(error_model='numpy')
def account(
    actuators: Actuators,
    columns: Columns,
    torque: Array,
    activation: Array,
    residual: Array,
    multiplier: Array,
    share: float,
    cap: float,
    reserve: Array,
    weak: BoolArray,
) -> Account:
    """Give an account of a solution, and what its reserves do.

    Parameters
    ----------
    actuators, columns, torque, activation, residual, multiplier
        See `share_torque`.
    share
        Factor of the powers in the cost.
    cap
        Largest activation allowed.
    reserve, weak : (n_c,)
        Take the torques of the reserves [N m], and whether muscles are too weak at a coordinate.
    """
    n_c, n_m = torque.size, activation.size
    squares = np.zeros(n_c)
    primal = 0.0
    for j in range(n_c):
        squares[actuators.joint[j]] += torque[j] ** 2
        if not abs(residual[j]) <= primal:
            primal = abs(residual[j])
    objective, dual = 0.0, 0.0
    for j in range(n_c):
        control = 0.5 * actuators.unit[j] * multiplier[j]
        reserve[j] = actuators.unit[j] * control
        objective += control**2
        weak[j] = (
            actuators.muscle_driven[j]
            and abs(reserve[j]) > RESERVE_SHARE * np.sqrt(squares[actuators.joint[j]])
            and abs(control) > RESERVE_CONTROL
        )
    for i in range(n_m):
        a = activation[i]
        # The exponents are whole numbers: products are many times as fast as a power.
        before = a if actuators.exponent == 2.0 else a ** (actuators.exponent - 1.0)
        before *= share * actuators.weight[i]
        objective += before * a
        gradient = actuators.exponent * before
        for k in range(columns.start[i], columns.start[i + 1]):
            gradient -= columns.value[k] * multiplier[columns.row[k]]
        projected = max(a - gradient, actuators.lower[i])
        off = abs(min(projected, actuators.upper[i], cap) - a)
        if not off <= dual:
            dual = off
    return Account(objective, primal, dual)
