# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Feasibility restoration: the nearest point where the rows' violation has a minimum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.newton import cholesky, cholesky_solve
from lift_predictor.core.solvers.scaling import ScaledProgramme

FIRST_DAMPING, DAMPING_GROWTH, DAMPING_DECAY = 1e-6, 10.0, 0.1
LARGEST_DAMPING = 1e12
STATIONARY = 1e-8
"""Projected gradient, relative to the violation, at which a minimum is reached."""
HOPELESS = 0.1
"""To the first order no change of the variables by 1 takes more than this share of the squared
violation: what is left is a minimum that is not zero."""
STALLED, STALLED_STEPS = 1e-3, 10
"""Relative decrease of the squared violation that counts as none, so many times in a row."""


@dataclass(frozen=True)
class Restored:
    """End of a restoration: point, iterations, and whether the violation has a minimum there."""

    x: Array
    iterations: int
    minimum: bool


def restore(
    programme: ScaledProgramme,
    x: Array,
    goal: float,
    max_iterations: int,
    late: Callable[[], bool] = lambda: False,
) -> Restored:
    """Reduce half the squared violation of the rows by a damped, projected Newton method.

    Parameters
    ----------
    programme : ScaledProgramme
        The programme.
    x : array
        Where to begin, inside the bounds.
    goal : float
        Largest violation at which to stop early.
    max_iterations : int
        Iterations at most.
    late : callable, optional
        Asked before each iteration whether to end there.
    """
    low, high = programme.lower[: programme.n], programme.upper[: programme.n]
    damping, stalled = FIRST_DAMPING, 0
    violation = row_violation(programme, programme.values(x)[1])
    value = 0.5 * float(violation @ violation)
    for iteration in range(max_iterations):
        if float(np.abs(violation).max(initial=0.0)) <= goal or late():
            return Restored(x, iteration, False)
        point = programme.linearise(x)
        gradient = point.transposed(violation)
        held = ((x <= low) & (gradient > 0.0)) | ((x >= high) & (gradient < 0.0))
        free = np.flatnonzero(~held)
        steep = float(np.abs(gradient[free]).max(initial=0.0))
        hopeless = float(np.abs(gradient[free]).sum()) <= HOPELESS * value
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
            rows = programme.values(trial)[1]
            after = row_violation(programme, rows)
            new = 0.5 * float(after @ after)
            # A row or step that is not finite makes the comparison false.
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


def row_violation(programme: ScaledProgramme, rows: Array) -> Array:
    """Signed distance of every row to its bounds; 0 where they are met."""
    violation = np.zeros(programme.m)
    violation[programme.equal] = rows[programme.equal] - programme.target
    inside, n = rows[programme.unequal], programme.n
    violation[programme.unequal] = inside - np.clip(
        inside, programme.lower[n:], programme.upper[n:]
    )
    return violation


def _descent(matrix: Array, gradient: Array) -> Array:
    """Newton step, or none (not a number) if the matrix is not positive."""
    factor = cholesky(matrix)
    return np.full(len(gradient), np.nan) if factor is None else -cholesky_solve(factor, gradient)
