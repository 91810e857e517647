# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Initial guesses of a lift, and where the solver ended from them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.solution import Solution, Status
from lift_predictor.core.solvers.spline_nlp import SplineNlp

FEASIBILITY_TOLERANCE: Final = 1e-5
"""Largest violation of a scaled constraint that counts as met."""
ACTIVE_MULTIPLIER: Final = 1e-5
"""Smallest multiplier of an active constraint: far above what the barrier leaves."""

Progress = Callable[[int, int, float], None]
"""Called after each run: runs done, runs in all, best objective so far (NaN: none yet). An error
that it raises ends the work."""


@dataclass(frozen=True, eq=False)
class Start:
    """Named initial guess.

    Attributes
    ----------
    name : str
        For messages.
    control : ndarray, shape (n_free, n_coordinates)
        Free control values.
    box_mass : float
        [kg]; moved into its bounds, so that it needs no value where the mass is given.
    duration : float or None
        [s]; None: the task's.
    near : bool
        Whether it is near a minimum, as the solution of a similar lift: the interior-point method
        then begins with a small barrier parameter, which does not lead away from it.
    barrier : float or None
        First barrier parameter, in place of the method's: a large one leads to other minima.
    """

    name: str
    control: Array
    box_mass: float = 0.0
    duration: float | None = None
    near: bool = False
    barrier: float | None = None


@dataclass(frozen=True, eq=False)
class SolverRun:
    """Result of one run of the solver.

    Attributes
    ----------
    start : str
        Name of the initial guess.
    solution : Solution
        Variables, multipliers, residuals.
    control : ndarray, shape (n_free, n_coordinates)
        Free control values.
    box_mass, duration : float
        [kg], [s].
    violated : str
        Name of the limit that is violated most; empty: none.
    active_constraints : tuple of (str, float)
        Inequalities with a multiplier above `ACTIVE_MULTIPLIER`, the strongest first.
    """

    start: str
    solution: Solution
    control: Array
    box_mass: float
    duration: float
    violated: str
    active_constraints: tuple[tuple[str, float], ...] = ()

    @property
    def converged(self) -> bool:
        """Whether it is a solution whose constraints hold to `FEASIBILITY_TOLERANCE`."""
        return self.solution.ok and self.solution.primal <= FEASIBILITY_TOLERANCE

    @property
    def status(self) -> Status:
        """How the run ended."""
        return self.solution.status

    @property
    def objective(self) -> float:
        """A effort [s] - b log(W + 10); the effort where the weight is given."""
        return self.solution.objective

    def as_start(self, name: str = '') -> Start:
        """Use the end of this run as an initial guess, under the same name or another."""
        return Start(name or self.start, self.control, self.box_mass, self.duration, near=True)


def active_constraints(nlp: SplineNlp, solution: Solution) -> tuple[tuple[str, float], ...]:
    """Inequalities with a multiplier above `ACTIVE_MULTIPLIER`, in the order of its size."""
    free, unequal = nlp.lower < nlp.upper, nlp.g_lower < nlp.g_upper
    size = np.concatenate(
        (
            np.where(free, np.abs(solution.lam_x), 0.0),
            np.where(unequal, np.abs(solution.lam_g), 0.0),
        )
    )
    order = np.argsort(-size, kind='stable')[: np.count_nonzero(size > ACTIVE_MULTIPLIER)]

    def name(index: int) -> str:
        if index < nlp.n:
            return nlp.variable_name(index)
        return nlp.constraint_name(index - nlp.n)

    return tuple((name(int(i)), float(size[i])) for i in order)


def smooth_step(s: Array) -> Array:
    """Minimum-jerk step from 0 to 1 (Flash and Hogan 1985): rest at both ends."""
    return np.asarray(10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5)


def best_first(runs: Sequence[SolverRun]) -> tuple[SolverRun, ...]:
    """Sort converged runs first, by objective; the others by violation."""

    def rank(run: SolverRun) -> tuple[bool, float]:
        return not run.converged, run.objective if run.converged else run.solution.primal

    return tuple(sorted(runs, key=rank))


def best_objective(runs: Sequence[SolverRun]) -> float:
    """Objective of the best converged run; NaN: none."""
    return min((run.objective for run in runs if run.converged), default=float('nan'))
