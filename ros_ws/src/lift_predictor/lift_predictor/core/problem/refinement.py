# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Solve again where constraints are violated between the nodes, until the dense grid shows none.

First with a margin at the nodes where the motion leaves its limits: cheap, and mostly enough. A
margin is too much where the motion has no room for it; the sagittal model then takes more nodes on
the same spline, at last as many as the dense grid has: the constraints then equal the verified
ones.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final, Generic, Protocol

from lift_predictor.core.problem.model import LiftModel, T
from lift_predictor.core.problem.run import SolverRun, Start
from lift_predictor.core.problem.verification import Verification
from lift_predictor.core.solvers.solution import Solution

FINER_CANDIDATES: Final = 3
"""Minima that are tried on finer grids."""
SAME: Final = 1e-4
"""Relative difference of the objective up to which two minima are one."""

Checked = tuple[tuple[SolverRun, ...], Verification | None]
"""Runs, and the check of the first; None: it did not converge."""


class StartSolver(Protocol[T]):
    """Solver of one task from one start; `TaskSolver` is one."""

    @property
    def model(self) -> LiftModel[T]:
        """Model that defines the problems."""

    def run(
        self,
        task: T,
        start: Start,
        warm: Solution | None = None,
        deadline: float = float('inf'),
    ) -> SolverRun:
        """Solve a task from one start at the nodes, not checked between them."""


class Refiner(Generic[T]):
    """Checks minima on the dense grid and improves them.

    Parameters
    ----------
    solver : StartSolver
        Runs the solver.
    finer : callable
        Returns a solver with a factor more node intervals.
    """

    def __init__(self, solver: StartSolver[T], finer: Callable[[int], StartSolver[T]]) -> None:
        self._solver, self._finer = solver, finer

    def refine(
        self, task: T, runs: Sequence[SolverRun], deadline: float = float('inf')
    ) -> Checked:
        """Return the runs, one that holds between the nodes first, and its check.

        Parameters
        ----------
        task : LiftTask
            Task that was solved.
        runs : sequence of SolverRun
            The best first.
        deadline : float
            No run begins after it, on the clock of `time.perf_counter` [s].

        Returns
        -------
        tuple of SolverRun, Verification or None
            The check is of the first run, and None if that did not converge. If nothing helps, it
            shows the violations. The runs that were given come last.
        """
        method = self._solver.model.method
        kept: Checked = tuple(runs), None
        for number, candidate in enumerate(runs[: method.margin_candidates]):
            if not candidate.converged or (number and time.perf_counter() > deadline):
                break
            found, check = self._with_margins(task, candidate, deadline)
            checked = (*found, *runs[:number], *runs[number + 1 :]), check
            if check.passed:
                return checked
            if not number:
                kept = checked
        return kept if kept[1] is None else self._on_finer_grids(task, runs, kept, deadline)

    def _with_margins(
        self, task: T, first: SolverRun, deadline: float
    ) -> tuple[tuple[SolverRun, ...], Verification]:
        model, method = self._solver.model, self._solver.model.method
        runs: tuple[SolverRun, ...] = (first,)
        narrower = task
        for attempt in range(method.refinements + 1):
            best = runs[0]
            check = model.verify(task, best)
            late = attempt == method.refinements or time.perf_counter() > deadline
            if check.passed or late:
                break
            narrower = model.tightened(narrower, check, method.margin * method.growth**attempt)
            warm = best.solution if method.warm_margins else None
            again = self._solver.run(narrower, best.as_start(), warm, deadline)
            if warm is not None and not again.converged:
                again = self._solver.run(narrower, best.as_start(), None, deadline)
            if not again.converged:
                runs = (best, again, *runs[1:])
                break
            runs = (again, *runs)
        return runs, check

    def _on_finer_grids(
        self, task: T, given: Sequence[SolverRun], kept: Checked, deadline: float
    ) -> Checked:
        runs, check = kept
        tried: list[SolverRun] = []
        for candidate in _distinct(given):
            for factor in self._solver.model.method.finer:
                if time.perf_counter() > deadline:
                    return (runs[0], *tried, *runs[1:]), check
                finer = self._finer(factor)
                again = finer.run(task, candidate.as_start(), deadline=deadline)
                again = replace(again, start=f'{again.start}, {finer.model.grid.n_nodes} nodes')
                if again.converged:
                    checked = finer.model.verify(task, again)
                    if checked.passed:
                        return (again, *tried, *runs), checked
                tried.append(again)
                if not again.converged:
                    break
        return (runs[0], *tried, *runs[1:]), check


def _distinct(runs: Sequence[SolverRun]) -> list[SolverRun]:
    """Converged runs of different objectives, the best first, `FINER_CANDIDATES` at most."""
    kept: list[SolverRun] = []
    for run in runs:
        limit = SAME * max(abs(run.objective), 1e-9)
        if run.converged and all(abs(run.objective - k.objective) > limit for k in kept):
            kept.append(run)
    return kept[:FINER_CANDIDATES]
