# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Solves tasks of one model: from several starts, checked between the nodes, the best kept.

There are many local minima. After the given starts the spatial model runs from its best solution,
displaced: basin hopping (Wales and Doye 1997, Global optimization by basin-hopping, J. Phys. Chem.
A 101) that only goes downhill. The number of hops is given and their seed is fixed, so that the
result does not depend on the clock unless the time limit is met.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final, Generic

import numpy as np

from human_model.motion import Lift
from human_model.report import SolveReport, SolveStatus
from lift_predictor.core.problem.comparison import compare
from lift_predictor.core.problem.model import LiftModel, T
from lift_predictor.core.problem.nearest_lift import (
    INFEASIBLE_STATUSES,
    REGULARISATION,
    reduced_mass,
)
from lift_predictor.core.problem.prediction import NearestLift, Prediction
from lift_predictor.core.problem.refinement import Checked, Refiner
from lift_predictor.core.problem.run import (
    Progress,
    SolverRun,
    Start,
    active_constraints,
    best_first,
    best_objective,
)
from lift_predictor.core.problem.sampling import sample_times
from lift_predictor.core.problem.verification import Verification
from lift_predictor.core.solvers.solution import Solution, Status
from lift_predictor.core.solvers.solve import solve
from lift_predictor.core.solvers.spline_nlp import SplineNlp
from lift_predictor.core.solvers.stop import StopFlag

HOP_SPREAD: Final = 0.3
"""Standard deviation of the displacements: the best of 0.15 and 0.3 on ten random lifts [rad]."""
HOP_SEED: Final = 7
NO_ANSWER: Final = (Status.STUCK, Status.ITERATION_LIMIT, Status.NOT_FINITE)
REFERENCE_NOTE: Final = 'IPOPT'
_STATUSES: Final = {
    Status.TIME_LIMIT: (SolveStatus.PREDICTOR_TIME_LIMIT, 'time limit reached'),
    Status.INFEASIBLE: (SolveStatus.PREDICTOR_INFEASIBLE, 'no feasible motion was found'),
}


class TaskSolver(Generic[T]):
    """Solves tasks of one model.

    Parameters
    ----------
    model : LiftModel
        Defines the problems.
    stop : StopFlag, optional
        Ends the work between two iterations (`CancelledError`).
    """

    def __init__(self, model: LiftModel[T], stop: StopFlag | None = None) -> None:
        self.model: LiftModel[T] = model
        self.stop = stop or StopFlag()
        self._finer: dict[int, TaskSolver[T]] = {}
        self._refiner = Refiner(self, self.finer)

    def finer(self, factor: int) -> TaskSolver[T]:
        """Return a solver with a factor more node intervals; built when first needed."""
        if factor not in self._finer:
            self._finer[factor] = TaskSolver(self.model.finer(factor), self.stop)
        return self._finer[factor]

    def run(
        self,
        task: T,
        start: Start,
        warm: Solution | None = None,
        deadline: float = float('inf'),
    ) -> SolverRun:
        """Solve a task from one start at the nodes, not checked between them.

        Parameters
        ----------
        task : LiftTask
            Task.
        start : Start
            Initial guess.
        warm : Solution, optional
            Solution of a similar task: its multipliers are the first ones.
        deadline : float
            The run ends then at the latest, on the clock of `time.perf_counter` [s].

        Raises
        ------
        CancelledError
            The stop flag was set.
        """
        nlp, method = self.model.nlp(task), self.model.method
        x0 = self.model.variables(task, start)

        def attempt(near: bool) -> Solution:
            options = method.near if near else method.cold
            left = min(method.time_limit, max(deadline - time.perf_counter(), 0.0))
            barrier = start.barrier or options.barrier
            options = replace(options, time_limit=left, barrier=barrier, stop=self.stop)
            return solve(nlp, x0, options, warm)

        solution = attempt(start.near)
        if start.near and warm is None and not solution.ok and method.near != method.cold:
            # Not near enough: a large barrier parameter leads away from the start.
            before, solution = solution, attempt(near=False)
            iterations = before.iterations + solution.iterations
            solution = replace(solution, iterations=iterations)
        return self._as_run(task, nlp, start.name, solution)

    def _as_run(self, task: T, nlp: SplineNlp, name: str, solution: Solution) -> SolverRun:
        model, x = self.model, solution.x
        names = [name for name, _ in solution.violated]
        limits = [name for name in names if not any(t in name for t in model.task_constraints)]
        violated = limits[0] if limits else 'reach of the hands' if names else ''
        mass = float(x[model.grid.n_splined])
        control = model.grid.control(x)
        return SolverRun(
            name, solution, control, mass, model.duration(task, x), violated,
            active_constraints(nlp, solution),
        )  # fmt: skip

    def runs(
        self,
        task: T,
        starts: Sequence[Start],
        deadline: float = float('inf'),
        progress: Progress | None = None,
        basin_hops: int = 0,
    ) -> tuple[SolverRun, ...]:
        """Run from all starts, then from the best solution so far, displaced; the best is first.

        Converged runs come before the others, then the lower objective, or the smaller violation
        where none converged.

        Parameters
        ----------
        task : LiftTask
            Task.
        starts : sequence of Start
            Initial guesses, the most promising first.
        deadline : float
            No start but the first begins after it, on the clock of `time.perf_counter` [s]; no
            displaced run after half of the time to it, as the rest is for margins.
        progress : callable, optional
            Called after each run.
        basin_hops : int
            Displaced runs; none where no start led to a solution.
        """
        runs: list[SolverRun] = []
        half = 0.5 * (time.perf_counter() + deadline)
        for start in self._all_starts(task, starts, basin_hops, runs):
            if runs and time.perf_counter() > (deadline if len(runs) < len(starts) else half):
                break
            runs.append(self.run(task, start, deadline=deadline))
            if progress is not None:
                progress(len(runs), len(starts) + basin_hops, best_objective(runs))
        unanswered = bool(runs) and all(run.status in NO_ANSWER for run in runs)
        if unanswered and self.model.method.uses_reference:
            for run in self.reference_runs(task, starts, deadline):
                runs.append(replace(run, start=f'{run.start}, {REFERENCE_NOTE}'))
        return best_first(runs)

    def _all_starts(
        self, task: T, starts: Sequence[Start], basin_hops: int, runs: list[SolverRun]
    ) -> Iterator[Start]:
        yield from starts
        rng = np.random.default_rng(HOP_SEED)
        for number in range(basin_hops):
            best = best_first(runs)[0]
            if not best.converged:
                break
            yield self.displaced(task, best.as_start(), number, rng)

    def displaced(self, task: T, start: Start, number: int, rng: np.random.Generator) -> Start:
        """Displace a start: in turn all of the motion of a coordinate, and each control value."""
        rows = start.control.shape[0] if number % 2 else 1
        shift = HOP_SPREAD * rng.normal(size=(rows, start.control.shape[1]))
        control = start.control + self.model.displacement(task, shift)
        return Start(f'basin hop {number + 1}', control, start.box_mass, start.duration)

    def reference_runs(
        self, task: T, starts: Sequence[Start], deadline: float = float('inf')
    ) -> Iterator[SolverRun]:
        """Solve a task by IPOPT from every start; none but the first begins after the deadline.

        Parameters
        ----------
        task : LiftTask
            Task.
        starts : sequence of Start
            Initial guesses.
        deadline : float
            On the clock of `time.perf_counter` [s].
        """
        # Imports CasADi, which is not needed otherwise.
        from lift_predictor.core.solvers.ipopt import IpoptSolver

        nlp = self.model.nlp(task)
        for number, start in enumerate(starts):
            self.stop.check()
            left = deadline - time.perf_counter()
            if number and left <= 0.0:
                break
            limit = max(min(self.model.method.time_limit, left), 1e-3)  # must be positive
            x0 = self.model.variables(task, start)
            solution = IpoptSolver(nlp, x0, {'max_wall_time': limit}).solve(nlp, x0)
            yield self._as_run(task, nlp, start.name, solution)

    def solve(
        self,
        task: T,
        starts: Sequence[Start],
        progress: Progress | None = None,
        begin: float | None = None,
        basin_hops: int = 0,
        deadline: float | None = None,
    ) -> Prediction:
        """Solve a task from given starts and check the solution; compare if it was recorded.

        Parameters
        ----------
        task : LiftTask
            Person, box, feet and demands on the motion.
        starts : sequence of Start
            Initial guesses, the most promising first.
        progress : callable, optional
            Called after each run.
        begin : float, optional
            Time at which the task's construction began, on the clock of `time.perf_counter` [s].
        basin_hops : int
            Runs from the best solution, displaced, after those from the starts.
        deadline : float, optional
            No run begins after it [s]; by default the time limit from now on.

        Returns
        -------
        Prediction
            Its report holds the status; without a solution there are no data.

        Raises
        ------
        CancelledError
            `stop` was set.
        """
        now = time.perf_counter()
        method = self.model.method
        deadline = now + method.time_limit if deadline is None else deadline
        every = (*starts, *self.model.library_starts(task))
        runs = self.runs(task, every, deadline, progress, basin_hops)
        runs, check = self._refiner.refine(task, runs, deadline)
        nearest: NearestLift | None = None
        if method.reduces_mass and judge(runs[0], check)[0] in INFEASIBLE_STATUSES:
            (runs, check), nearest = self._over_lighter(task, starts, (runs, check), deadline)
        begin = now if begin is None else begin
        times = (now - begin, time.perf_counter() - now)
        return self._finish(task, runs, check, nearest, times)

    def largest_mass(
        self, task: T, starts: Sequence[Start], deadline: float | None = None
    ) -> Prediction | None:
        """Solve the same lift for the largest mass up to the task's; None: no mass to reduce.

        Parameters
        ----------
        task : LiftTask
            Without a solution for its mass.
        starts : sequence of Start
            Initial guesses.
        deadline : float, optional
            As in `solve`.
        """
        least, asked = task.mass
        if asked == 0.0 or least < asked:
            return None
        opened = task.with_mass(0.0, asked).with_objective(REGULARISATION, 1.0)
        light = self.model.method.light * asked
        begun = [replace(start, box_mass=light) for start in starts]
        return self.solve(opened, begun, deadline=deadline)

    def reduce_mass(self, task: T, starts: Sequence[Start]) -> NearestLift | None:
        """Return the same lift with the largest feasible mass as the nearest, if there is one."""
        found = self.largest_mass(task, starts)
        return None if found is None else reduced_mass(found, task.mass[1])

    def _over_lighter(
        self, task: T, starts: Sequence[Start], kept: Checked, deadline: float
    ) -> tuple[Checked, NearestLift | None]:
        """Seek a solution that no start led to from the same lift with the largest feasible mass.

        If less than the mass is feasible, that lift is the nearest.
        """
        runs, check = kept
        found = self.largest_mass(task, starts, deadline)
        if found is None or not found.report.ok:
            return kept, None
        nearest = reduced_mass(found, task.mass[1])
        if nearest is not None:
            return kept, nearest
        again = self.run(task, found.runs[0].as_start(), deadline=deadline)
        more, second = self._refiner.refine(task, (again,), deadline)
        if second is not None and second.passed:
            return ((*more, *runs), second), None
        return ((runs[0], *more, *runs[1:]), check), None

    def _finish(
        self,
        task: T,
        runs: tuple[SolverRun, ...],
        check: Verification | None,
        nearest: NearestLift | None,
        times: tuple[float, float],
    ) -> Prediction:
        model, best = self.model, runs[0]
        solution = best.solution
        status, message = judge(best, check)
        notes = (*task.notes, model.library.backend)
        report = SolveReport(
            status,
            '; '.join((message, *notes)),
            iterations=sum(run.solution.iterations for run in runs),
            objective=solution.objective,
            primal_residual=solution.primal,
            dual_residual=max(solution.dual, solution.complementarity),
            build_time=times[0],
            solve_time=times[1],
        )
        failed = Prediction(
            model=model.name, lift_id=task.lift_id, box_mass=best.box_mass,
            duration=best.duration, report=report, runs=runs, verification=check, notes=notes,
            nearest=nearest,
        )  # fmt: skip
        if status is not SolveStatus.OK:
            return failed
        time_ = sample_times(best.duration)
        result = model.result(task, best, time_)
        if result.problem:
            status = SolveStatus.PREDICTOR_VERIFICATION_FAILED
            refused = replace(report, status=status, message=f'{result.problem}; {message}')
            return replace(failed, report=refused)
        lift = Lift(
            lift_id=task.lift_id,
            source='predicted',
            start=task.start,
            end=task.start + best.duration,
            box_mass=best.box_mass,
            motion=result.motion,
            report=report,
        )
        return replace(
            failed,
            lift=lift,
            torque_names=result.torque_names,
            torque=result.torque,
            torque_lower=result.torque_lower,
            torque_upper=result.torque_upper,
            zmp=result.zmp,
            support=result.support,
            ground_force=result.ground_force,
            effort=model.effort(task, best),
            sampled_effort=float(np.trapezoid(result.loads.effort, time_)),
            active_constraints=model.active_constraints(task, best),
            comparison=None if result.curves is None else compare(result.curves),
        )


def judge(best: SolverRun, check: Verification | None) -> tuple[SolveStatus, str]:
    """Return the status of the best run and its check, and its meaning in words.

    Parameters
    ----------
    best : SolverRun
        The run that is kept.
    check : Verification or None
        On the dense grid; None if the run did not converge.
    """
    if best.converged and check is not None:
        if check.passed:
            return SolveStatus.OK, f'optimal from the start "{best.start}"'
        return (
            SolveStatus.PREDICTOR_VERIFICATION_FAILED,
            f'between the nodes constraints are violated: {check.failures()}',
        )
    status, words = _STATUSES.get(
        best.status, (SolveStatus.PREDICTOR_NOT_CONVERGED, f'not solved: {best.status}')
    )
    worst = f'{best.violated or "none"} ({best.solution.primal:.3g})'
    return status, f'{words}; largest violation: {worst}'
