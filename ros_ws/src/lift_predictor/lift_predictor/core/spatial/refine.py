# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Solutions in space that hold between the nodes: solved again with a margin until they do."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.solvers.solution import Solution
from lift_predictor.core.spatial.grid import SpatialGrid
from lift_predictor.core.spatial.prediction import SpatialOptimum
from lift_predictor.core.spatial.starts import SpatialStart
from lift_predictor.core.spatial.task import SpatialTask
from lift_predictor.core.spatial.verify import SpatialVerification, verify

MARGIN_FACTOR: Final = 1.2
"""Margin against a violation between the nodes, in units of the violation."""

Run = Callable[[SpatialTask, SpatialStart, Solution | None], SpatialOptimum]


@dataclass(frozen=True)
class Refiner:
    """Checks runs on the dense grid and solves again where they fail.

    Attributes
    ----------
    library : NodeLibrary
        Functions.
    grid : SpatialGrid
        Sizes of the programme.
    run : callable
        Solves a task at the nodes from a start, perhaps warm.
    refinements : int
        Solves with a margin at most, for each run.
    """

    library: NodeLibrary
    grid: SpatialGrid
    run: Run
    refinements: int

    def best_that_holds(
        self, task: SpatialTask, optima: tuple[SpatialOptimum, ...], deadline: float
    ) -> tuple[tuple[SpatialOptimum, ...], SpatialVerification | None]:
        """Return all runs, the one kept first, and its check (None: none converged).

        The best run comes first; where no margin helps it the next is tried.

        Parameters
        ----------
        task : SpatialTask
            That was solved.
        optima : tuple of SpatialOptimum
            Runs, the best first.
        deadline : float
            On the clock of `time.perf_counter`: no run is begun after it.
        """
        failed: tuple[tuple[SpatialOptimum, ...], SpatialVerification | None] = (optima, None)
        for number, candidate in enumerate(optima):
            if not candidate.converged or (number and time.perf_counter() > deadline):
                break
            found, check = self._with_margins(task, candidate, deadline)
            others = (*optima[:number], *optima[number + 1 :])
            if check.passed:
                return (*found, *others), check
            if not number:
                failed = (*found, *others), check
        return failed

    def _with_margins(
        self, task: SpatialTask, first: SpatialOptimum, deadline: float
    ) -> tuple[tuple[SpatialOptimum, ...], SpatialVerification]:
        bounds = task.bounds
        runs: tuple[SpatialOptimum, ...] = (first,)
        for attempt in range(self.refinements + 1):
            best = runs[0]
            start = as_start(best, self.grid)
            check = verify(
                self.library, self.grid, task, start.control, start.box_mass, start.duration
            )
            late = attempt == self.refinements or time.perf_counter() > deadline
            if check.passed or late:
                break
            bounds = check.tightened(bounds, MARGIN_FACTOR)
            narrower = replace(task, bounds=bounds)
            again = self.run(narrower, start, best.solution)
            if not again.converged:
                again = self.run(narrower, start, None)
            if not again.converged:
                runs = (best, again, *runs[1:])
                break
            runs = (again, *runs)
        return runs, check


def as_start(optimum: SpatialOptimum, grid: SpatialGrid) -> SpatialStart:
    """Use the end of a run as an initial guess."""
    x = optimum.solution.x
    control = x[:-2].reshape(grid.spline.n_free, -1)
    return SpatialStart(optimum.start, control, float(x[-2]), float(x[-1]))
