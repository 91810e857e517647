# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Feasibility restoration: the nearest point where the constraints' violation has a minimum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.constants import (
    DAMPING_DECAY,
    DAMPING_GROWTH,
    FIRST_DAMPING,
    LARGEST_DAMPING,
    LEAST_GRADIENT_RATIO,
    STALLED,
    STALLED_STEPS,
    STATIONARY,
)
from lift_predictor.core.solvers.newton import cholesky, cholesky_solve
from lift_predictor.core.solvers.scaling import ScaledNlp


@dataclass(frozen=True)
class Restored:
    """End of a restoration: point, iterations, and whether the violation has a minimum there."""

    x: Array
    iterations: int
    minimum: bool


def restore(
    problem: ScaledNlp,
    x: Array,
    goal: float,
    max_iterations: int,
    late: Callable[[], bool] = lambda: False,
) -> Restored:
    """Reduce half the squared violation of the constraints by a damped, projected Newton method.

    Parameters
    ----------
    problem : ScaledNlp
        The problem.
    x : array
        Where to begin, inside the bounds.
    goal : float
        Largest violation at which to stop early.
    max_iterations : int
        Iterations at most.
    late : callable, optional
        Asked before each iteration whether to end there.
    """
    low, high = problem.lower[: problem.n], problem.upper[: problem.n]
    damping, stalled = FIRST_DAMPING, 0
    violation = constraint_violation(problem, problem.values(x)[1])
    value = 0.5 * float(violation @ violation)
    for iteration in range(max_iterations):
        if float(np.abs(violation).max(initial=0.0)) <= goal or late():
            return Restored(x, iteration, False)
        point = problem.linearise(x)
        gradient = point.transposed(violation)
        held = ((x <= low) & (gradient > 0.0)) | ((x >= high) & (gradient < 0.0))
        free = np.flatnonzero(~held)
        steep = float(np.abs(gradient[free]).max(initial=0.0))
        hopeless = float(np.abs(gradient[free]).sum()) <= LEAST_GRADIENT_RATIO * value
        if steep <= STATIONARY * max(1.0, float(np.abs(violation).max())) or hopeless:
            return Restored(x, iteration, True)
        active = (violation != 0.0).astype(float)
        matrix = point.condensed(0.0, violation, active)[np.ix_(free, free)]
        size = max(1.0, float(np.abs(np.diagonal(matrix)).max()))
        while True:
            step = _descent(matrix + damping * size * np.eye(len(free)), gradient[free])
            trial = x.copy()
            trial[free] += step
            trial = np.clip(trial, low, high)
            g = problem.values(trial)[1]
            after = constraint_violation(problem, g)
            new = 0.5 * float(after @ after)
            # A constraint or step that is not finite makes the comparison false.
            if new < value:
                break
            damping *= DAMPING_GROWTH
            if damping > LARGEST_DAMPING:
                return Restored(x, iteration, True)
        stalled = stalled + 1 if value - new <= STALLED * value else 0
        x, violation, value = trial, after, new
        damping = max(damping * DAMPING_DECAY, FIRST_DAMPING)
        if stalled == STALLED_STEPS:
            return Restored(x, iteration + 1, True)
    return Restored(x, max_iterations, False)


def constraint_violation(problem: ScaledNlp, g: Array) -> Array:
    """Signed distance of every constraint to its bounds; 0 where they are met."""
    violation = np.zeros(problem.m)
    violation[problem.equal] = g[problem.equal] - problem.target
    inside, n = g[problem.unequal], problem.n
    violation[problem.unequal] = inside - np.clip(inside, problem.lower[n:], problem.upper[n:])
    return violation


def _descent(matrix: Array, gradient: Array) -> Array:
    """Newton step, or none (not a number) if the matrix is not positive."""
    factor = cholesky(matrix)
    return np.full(len(gradient), np.nan) if factor is None else -cholesky_solve(factor, gradient)
