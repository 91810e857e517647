# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Feasibility restoration: the nearest point where the rows' violation has a minimum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lift_predictor.core.solvers.scaling import ScaledProgramme

Array = NDArray[np.float64]

FIRST_DAMPING, DAMPING_GROWTH, DAMPING_DECAY = 1e-6, 10.0, 0.1
LARGEST_DAMPING = 1e12
STATIONARY = 1e-8
"""Projected gradient, relative to the violation, at which a minimum is reached."""
STALLED = 1e-10
"""Relative decrease of the squared violation that counts as none, three times in a row."""


@dataclass(frozen=True)
class Restored:
    """End of a restoration: point, iterations, and whether the violation has a minimum there."""

    x: Array
    iterations: int
    minimum: bool


def restore(programme: ScaledProgramme, x: Array, goal: float, max_iterations: int) -> Restored:
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
    """
    low, high = programme.lower[: programme.n], programme.upper[: programme.n]
    damping, stalled = FIRST_DAMPING, 0
    violation = row_violation(programme, programme.values(x)[1])
    value = 0.5 * float(violation @ violation)
    for iteration in range(max_iterations):
        if float(np.abs(violation).max(initial=0.0)) <= goal:
            return Restored(x, iteration, False)
        point = programme.linearise(x)
        gradient = point.transposed(violation)
        held = ((x <= low) & (gradient > 0.0)) | ((x >= high) & (gradient < 0.0))
        free = np.flatnonzero(~held)
        steep = float(np.abs(gradient[free]).max(initial=0.0))
        if steep <= STATIONARY * max(1.0, float(np.abs(violation).max())):
            return Restored(x, iteration, True)
        active = (violation != 0.0).astype(float)
        matrix = point.condensed(0.0, violation, active)[np.ix_(free, free)]
        while True:
            trial = x.copy()
            trial[free] += _descent(matrix, damping, gradient[free])
            trial = np.clip(trial, low, high)
            rows = programme.values(trial)[1]
            after = row_violation(programme, rows)
            new = 0.5 * float(after @ after)
            # A row that is not finite makes the comparison false.
            if new < value:
                break
            damping *= DAMPING_GROWTH
            if damping > LARGEST_DAMPING:
                return Restored(x, iteration, True)
        stalled = stalled + 1 if value - new <= STALLED * value else 0
        x, violation, value = trial, after, new
        damping = max(damping * DAMPING_DECAY, FIRST_DAMPING)
        if stalled == 3:
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


def _descent(matrix: Array, damping: float, gradient: Array) -> Array:
    """Newton step of the matrix made positive by its eigenvalues' sizes and the damping."""
    values, vectors = np.linalg.eigh(matrix)
    sizes = np.abs(values) + damping * max(1.0, float(np.abs(values).max()))
    return np.asarray(-vectors @ ((vectors.T @ gradient) / sizes))
