# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Our own interior-point method on the sagittal programme, from several starts, the best kept.

Where it ends without an answer from every start (neither a minimum nor a minimum of the
violation), IPOPT is tried from the same starts, and the result says so.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.sagittal.grid import Grid, LiftBounds
from lift_predictor.core.sagittal.programme import (
    sagittal_assembler,
    sagittal_library,
    sagittal_programme,
)
from lift_predictor.core.sagittal.report_function import ReportFunction
from lift_predictor.core.solvers.solution import InteriorPointOptions, Solution, Status
from lift_predictor.core.solvers.solve import solve
from lift_predictor.core.solvers.solver_run import (
    ACTIVE_MULTIPLIER,
    FEASIBILITY_TOLERANCE,
    Progress,
    SolverRun,
    Start,
    best_first,
    runs_until,
)
from lift_predictor.core.solvers.spline_nlp import SplineNlp
from lift_predictor.core.solvers.stop import StopFlag

LIFT_OPTIONS: Final = InteriorPointOptions(barrier=3e-3, bound_push=0.1)
"""Found on random lifts: a third fewer iterations than IPOPT's values for general programmes, and
minima that are no worse."""
NEAR_OPTIONS: Final = InteriorPointOptions(barrier=1e-4, bound_push=1e-2)
"""For starts that are near a minimum."""
NO_ANSWER: Final = (Status.STUCK, Status.ITERATION_LIMIT, Status.NOT_FINITE)
IPOPT_NOTE: Final = 'IPOPT'


class LiftOptimiser:
    """The sagittal programme of one grid and its solver, for any person and task.

    Parameters
    ----------
    grid : Grid
        Control points and nodes.
    time_limit : float
        Wall time of one run at most [s], as a last resort: runs are limited by iterations.
    stop : StopFlag, optional
        Ends the work between two iterations.

    Attributes
    ----------
    grid : Grid
        As given.
    backend : str
        Description of the backend: compiled, or in CasADi's virtual machine and why.
    report : ReportFunction
        Forces of a motion.
    """

    def __init__(self, grid: Grid, time_limit: float = 10.0, stop: StopFlag | None = None) -> None:
        self.grid, self.time_limit = grid, time_limit
        self.stop = stop or StopFlag()
        library = sagittal_library()
        self.backend, self.build_time = library.backend, library.build_time
        self.report = ReportFunction(library)
        self._assembler = sagittal_assembler(library, grid)

    def programme(self, parameters: Array, bounds: LiftBounds) -> SplineNlp:
        """Programme of one person and task (`LiftParameters.pack`)."""
        return sagittal_programme(self._assembler, self.grid, parameters, bounds)

    def solve(
        self,
        parameters: Array,
        bounds: LiftBounds,
        start: Start,
        warm: Solution | None = None,
        deadline: float = float('inf'),
    ) -> SolverRun:
        """Run the interior-point method from one start.

        Parameters
        ----------
        parameters : array
            `LiftParameters.pack`.
        bounds : LiftBounds
            Demands of the task.
        start : Start
            Initial guess.
        warm : Solution, optional
            Of a similar task: replaces the start.
        deadline : float
            The run ends then at the latest, on the clock of `time.perf_counter` [s].

        Raises
        ------
        CancelledError
            The stop flag was set.
        """
        begin = time.perf_counter()
        programme = self.programme(parameters, bounds)
        options = NEAR_OPTIONS if start.near else LIFT_OPTIONS
        options = replace(options, time_limit=self._left(deadline), stop=self.stop)
        x0 = np.append(start.control, start.box_mass) if warm is None else warm.x
        solution = solve(programme, x0, options, warm)
        if start.near and warm is None and not solution.ok:
            # Not near enough: what is in the way needs a large barrier.
            options = replace(LIFT_OPTIONS, time_limit=self._left(deadline), stop=self.stop)
            before, solution = solution, solve(programme, x0, options)
            iterations = before.iterations + solution.iterations
            solution = replace(solution, iterations=iterations)
        optimum = as_optimum(self.grid, programme, solution, start.name)
        return replace(optimum, solve_time=time.perf_counter() - begin)

    def _left(self, deadline: float) -> float:
        """Wall time for a run that begins now [s]."""
        return min(self.time_limit, max(deadline - time.perf_counter(), 0.0))

    def solve_all(
        self,
        parameters: Array,
        bounds: LiftBounds,
        starts: Sequence[Start],
        deadline: float = float('inf'),
        progress: Progress | None = None,
    ) -> tuple[SolverRun, ...]:
        """Run from every start; the best comes first.

        Converged runs come before the others, then the lower objective, or the smaller violation
        where none converged. The deadline (on the clock of `time.perf_counter`) is a last resort:
        the run ends then, and no further start is begun.
        """
        runs = runs_until(
            deadline,
            lambda start: self.solve(parameters, bounds, start, deadline=deadline),
            starts,
            progress,
        )
        if runs and all(run.status in NO_ANSWER for run in runs):
            runs.extend(self._by_ipopt(parameters, bounds, starts, deadline))
        return best_first(runs)

    def _by_ipopt(
        self, parameters: Array, bounds: LiftBounds, starts: Sequence[Start], deadline: float
    ) -> list[SolverRun]:
        # Imports CasADi, which is not needed otherwise.
        from lift_predictor.core.solvers.compiled import build_programme
        from lift_predictor.core.solvers.ipopt import LiftSolver

        referee = LiftSolver(build_programme(self.grid), self._left(deadline))
        runs = referee.solve_all(
            parameters, bounds, starts, deadline, lambda *_: self.stop.check()
        )
        return [replace(run, start=f'{run.start}, {IPOPT_NOTE}') for run in runs]


def as_optimum(grid: Grid, programme: SplineNlp, solution: Solution, name: str) -> SolverRun:
    """Describe a solution of the sagittal programme as one run.

    Parameters
    ----------
    grid : Grid
        Sizes.
    programme : SplineNlp
        What was solved.
    solution : Solution
        Where it ended.
    name : str
        Of the start.
    """
    violated = solution.violated[0][0] if solution.violated else ''
    return SolverRun(
        start=name,
        converged=solution.ok and solution.primal <= FEASIBILITY_TOLERANCE,
        status=solution.status,
        control=solution.x[: grid.n_angles].reshape(grid.spline.n_free, -1),
        box_mass=float(solution.x[-1]),
        objective=solution.objective,
        iterations=solution.iterations,
        violation=solution.primal,
        violated=violated,
        active_constraints=active_constraints(programme, solution),
        stationarity=solution.dual,
        complementarity=solution.complementarity,
        solve_time=solution.solve_time,
    )


def active_constraints(programme: SplineNlp, solution: Solution) -> tuple[tuple[str, float], ...]:
    """Inequalities with a multiplier above `ACTIVE_MULTIPLIER`, in the order of its size."""
    free = programme.lower < programme.upper
    unequal = programme.g_lower < programme.g_upper
    size = np.concatenate(
        (
            np.where(free, np.abs(solution.lam_x), 0.0),
            np.where(unequal, np.abs(solution.lam_g), 0.0),
        )
    )
    order = np.argsort(-size, kind='stable')[: np.count_nonzero(size > ACTIVE_MULTIPLIER)]

    def name(index: int) -> str:
        if index < programme.n:
            return programme.variable_name(index)
        return programme.constraint_name(index - programme.n)

    return tuple((name(int(i)), float(size[i])) for i in order)
