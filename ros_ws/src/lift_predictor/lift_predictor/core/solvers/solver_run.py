# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Initial guesses of a lift and where the optimiser took them."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Protocol

from human_model.typing import Array

FEASIBILITY_TOLERANCE: Final = 1e-5
"""Largest violation of a scaled constraint that counts as met."""
ACTIVE_MULTIPLIER: Final = 1e-5
"""Smallest multiplier of an active constraint: far above what the barrier leaves."""


Progress = Callable[[int, int, float], None]
"""Called after each run: starts tried, number of starts, best objective so far (NaN: none yet)."""


@dataclass(frozen=True)
class Start:
    """Named initial guess: free control values, shape (n_free, 6) [rad], and box mass [kg].

    The mass is moved into its bounds, and so needs no value where the weight is given. A start
    that is near a minimum (it solves a similar lift) is not led away from it: the interior-point
    method begins with a small barrier there.
    """

    name: str
    control: Array
    box_mass: float = 0.0
    near: bool = False


class Guess(Protocol):
    """An initial guess: name, free control values, box mass [kg]."""

    @property
    def name(self) -> str:
        """Name, for messages."""
        ...

    @property
    def control(self) -> Array:
        """Free control values [rad]."""
        ...

    @property
    def box_mass(self) -> float:
        """[kg]."""
        ...


@dataclass(frozen=True)
class SolverRun:
    """Where one run of an optimiser ended.

    Attributes
    ----------
    start : str
        Name of the start.
    converged : bool
        Whether the solver reports a solution within `FEASIBILITY_TOLERANCE`.
    status : str
        Status of the solver, in its own terms.
    control : array, shape (n_free, 6)
        Free control values [rad].
    box_mass : float
        [kg].
    objective : float
        a effort [s] - b log(W + 10); the effort where the weight is given.
    iterations : int
        Iterations.
    violation : float
        Largest violation of a bound or scaled constraint.
    violated : str
        Name of that constraint; empty when nothing is violated.
    active_constraints : tuple of (str, float)
        Limits that hold the objective back, with their multipliers, the strongest first.
    stationarity, complementarity : float
        Largest element of the Lagrangian's gradient, and of multiplier times slack.
    solve_time : float
        Wall time [s].
    """

    start: str
    converged: bool
    status: str
    control: Array
    box_mass: float
    objective: float
    iterations: int
    violation: float
    violated: str
    active_constraints: tuple[tuple[str, float], ...]
    stationarity: float
    complementarity: float
    solve_time: float

    def as_start(self) -> Start:
        """Use the end of this run as a start."""
        return Start(self.start, self.control, self.box_mass, near=True)


def runs_until(
    deadline: float,
    run: Callable[[Guess], SolverRun],
    starts: Sequence[Guess],
    progress: Progress | None = None,
) -> list[SolverRun]:
    """Run from every start in turn; none but the first is begun after the deadline.

    Parameters
    ----------
    deadline : float
        On the clock of `time.perf_counter` [s].
    run : callable
        The optimiser.
    starts : sequence of Start
        The most promising first.
    progress : callable, optional
        Called after each run; an exception of it ends the work.
    """
    runs: list[SolverRun] = []
    for start in starts:
        if runs and time.perf_counter() > deadline:
            break
        runs.append(run(start))
        if progress is not None:
            progress(len(runs), len(starts), best_objective(runs))
    return runs


def best_first(runs: Sequence[SolverRun]) -> tuple[SolverRun, ...]:
    """Sort converged runs first, by objective; the others by violation."""
    return tuple(
        sorted(runs, key=lambda r: (not r.converged, r.objective if r.converged else r.violation))
    )


def best_objective(runs: Sequence[SolverRun]) -> float:
    """Objective of the best converged run; NaN: none."""
    return min((run.objective for run in runs if run.converged), default=float('nan'))
