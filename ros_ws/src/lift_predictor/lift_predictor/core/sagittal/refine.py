# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Solve again what is violated between the nodes, until the dense grid shows no violation.

First with a margin at the nodes where the motion leaves its limits: cheap, and mostly enough. A
margin is too much where the motion has no room for it; then with more nodes on the same spline, at
last with as many as the dense grid has, which asks for nothing but what the check asks for.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from human_model.typing import Array
from lift_predictor.core.dense_grid import DENSITY
from lift_predictor.core.sagittal.grid import Grid
from lift_predictor.core.sagittal.optimiser import LiftOptimiser
from lift_predictor.core.sagittal.task import LiftTask2D
from lift_predictor.core.sagittal.verify import Verification, verify
from lift_predictor.core.solvers.solver_run import SolverRun

MARGIN_FACTOR: Final = 1.05
"""First margin against a violation between the nodes, in units of the violation; twice as much
each time that it does not suffice."""
FINER: Final = (2, 4, DENSITY)
"""Node intervals of the finer grids in one of the first."""
CANDIDATES: Final = 3
"""Minima that are tried on finer grids."""
SAME: Final = 1e-4
"""Relative difference of the objective up to which two minima are one."""


class Refiner:
    """Checks minima on the dense grid and improves them.

    Parameters
    ----------
    optimiser : LiftOptimiser
        That found them.
    refinements : int
        Runs with a margin at most.
    """

    def __init__(self, optimiser: LiftOptimiser, refinements: int) -> None:
        self.optimiser, self.refinements = optimiser, refinements
        self._finer: dict[int, LiftOptimiser] = {}

    def refine(
        self,
        task: LiftTask2D,
        vector: Array,
        optima: Sequence[SolverRun],
        deadline: float = float('inf'),
    ) -> tuple[tuple[SolverRun, ...], Verification | None]:
        """Return the runs, one that holds between the nodes first, and its check.

        Parameters
        ----------
        task : LiftTask2D
            What was solved.
        vector : array
            `LiftParameters.pack` of the task.
        optima : sequence of SolverRun
            Runs, the best first.
        deadline : float
            No run is begun after it, on the clock of `time.perf_counter` [s].

        Returns
        -------
        tuple of SolverRun, Verification or None
            The check is of the first run, and None if that did not converge. Where nothing helps
            it tells what is violated. The runs that were given come last.
        """
        runs, check = self._with_margins(task, vector, tuple(optima), deadline)
        if check is None or check.passed:
            return runs, check
        tried: list[SolverRun] = []
        for candidate in _distinct(optima):
            for factor in FINER:
                if time.perf_counter() > deadline:
                    return (runs[0], *tried, *runs[1:]), check
                finer = self._optimiser(factor)
                again = finer.solve(vector, task.bounds, candidate.as_start(), deadline=deadline)
                again = replace(again, start=f'{again.start}, {finer.grid.n_nodes} nodes')
                if not again.converged:
                    tried.append(again)
                    break
                checked = self._check(task, finer.grid, again)
                if checked.passed:
                    return (again, *tried, *runs), checked
                tried.append(again)
        return (runs[0], *tried, *runs[1:]), check

    def _with_margins(
        self, task: LiftTask2D, vector: Array, optima: tuple[SolverRun, ...], deadline: float
    ) -> tuple[tuple[SolverRun, ...], Verification | None]:
        bounds = task.bounds
        check: Verification | None = None
        for attempt in range(self.refinements + 1):
            best = optima[0]
            if not best.converged:
                break
            check = self._check(task, self.optimiser.grid, best)
            late = attempt == self.refinements or time.perf_counter() > deadline
            if check.passed or late:
                break
            margin = 0.0 if bounds.margin is None else bounds.margin
            factor = MARGIN_FACTOR * 2.0**attempt
            bounds = replace(bounds, margin=margin + factor * check.excess)
            again = self.optimiser.solve(vector, bounds, best.as_start(), deadline=deadline)
            if not again.converged:
                optima = (best, again, *optima[1:])
                break
            optima = (again, *optima)
        return optima, check

    def _check(self, task: LiftTask2D, grid: Grid, run: SolverRun) -> Verification:
        parameters = replace(task.parameters, box_mass=run.box_mass)
        return verify(self.optimiser.report, grid, run.control, parameters, task.bounds)

    def _optimiser(self, factor: int) -> LiftOptimiser:
        """Solver with more nodes; made when it is first needed."""
        if factor not in self._finer:
            grid = self.optimiser.grid
            finer = replace(grid, n_nodes=factor * (grid.n_nodes - 1) + 1)
            self._finer[factor] = LiftOptimiser(
                finer, self.optimiser.time_limit, self.optimiser.stop
            )
        return self._finer[factor]


def _distinct(optima: Sequence[SolverRun]) -> list[SolverRun]:
    """Converged runs of different objectives, the best first, `CANDIDATES` at most."""
    kept: list[SolverRun] = []
    for run in optima:
        limit = SAME * max(abs(run.objective), 1e-9)
        if run.converged and all(abs(run.objective - k.objective) > limit for k in kept):
            kept.append(run)
    return kept[:CANDIDATES]
