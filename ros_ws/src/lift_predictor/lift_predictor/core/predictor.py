# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The pipeline: a recorded lift in, the optimal lift for the same person and task out."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from human_model.anthropometry import SegmentParameters
from human_model.exceptions import HumanModelError
from human_model.motion import Lift
from human_model.report import SolveReport, SolveStatus
from human_model.subject import Subject
from human_model.typing import Array
from lift_predictor.core.exceptions import AsymmetricLiftError, TaskError, UnreachableError
from lift_predictor.core.nearest_lift import (
    INFEASIBLE_STATUSES,
    NearestLift,
    closer_lift,
    with_nearest,
)
from lift_predictor.core.options import IN_THE_PLANE, PredictorOptions
from lift_predictor.core.sagittal.comparison import LiftComparison, compare
from lift_predictor.core.sagittal.evaluation import evaluate, sample, total_effort
from lift_predictor.core.sagittal.feasibility import as_nearest, largest_mass, missing_way, way_to
from lift_predictor.core.sagittal.lift_motion import body_motion, mtp_torque
from lift_predictor.core.sagittal.optimiser import LiftOptimiser
from lift_predictor.core.sagittal.outcome import judge
from lift_predictor.core.sagittal.person import Person
from lift_predictor.core.sagittal.prediction import TORQUE_NAMES, PredictedLift2D
from lift_predictor.core.sagittal.refine import Refiner
from lift_predictor.core.sagittal.solved_lifts import library_starts
from lift_predictor.core.sagittal.starts import make_starts
from lift_predictor.core.sagittal.task import Box, LiftTask2D, build_task
from lift_predictor.core.sagittal.verify import Verification
from lift_predictor.core.sampling import sample_times
from lift_predictor.core.solvers.solver_run import Progress, SolverRun, Start
from lift_predictor.core.solvers.stop import StopFlag

if TYPE_CHECKING:
    # They import CasADi, which a lift in the plane does without.
    from lift_predictor.core.spatial.comparison import SpatialComparison
    from lift_predictor.core.spatial.prediction import PredictedLift3D
    from lift_predictor.core.spatial.predictor import SpatialPredictor


class LiftPredictor:
    """Predicts recorded lifts of one subject.

    Parameters
    ----------
    options : PredictorOptions
        Settings.
    stop : StopFlag, optional
        Another thread sets it to end the work between two iterations (`CancelledError`).

    Notes
    -----
    Building loads the compiled functions (or compiles them, once per machine), so that `predict`
    has the optimiser ready.
    """

    def __init__(
        self, options: PredictorOptions | None = None, stop: StopFlag | None = None
    ) -> None:
        self.options = options or PredictorOptions()
        self.stop = stop or StopFlag()
        self.person: Person | None = None
        self._subject: Subject | None = None
        self._spatial: SpatialPredictor | None = None
        self.programme = LiftOptimiser(self.options.grid, self.options.time_limit, self.stop)
        self._refiner = Refiner(self.programme, self.options.refinements)

    def configure(self, subject: Subject, segments: SegmentParameters | None = None) -> None:
        """Set the subject, and the segments of the skeleton if they are not to be estimated.

        Raises
        ------
        TaskError
            The subject cannot be turned into the sagittal model; names field and value.
        """
        try:
            self.person = Person.of(subject, self.options.coefficient_set, segments)
        except HumanModelError as error:
            raise TaskError(str(error)) from error
        self._subject = subject

    def predict(self, lift: Lift, box: Box) -> PredictedLift2D | PredictedLift3D:
        """Solve the task of one recorded lift.

        Parameters
        ----------
        lift : Lift
            The recorded lift.
        box : Box
            What was lifted.

        Returns
        -------
        PredictedLift2D or PredictedLift3D
            Its report says whether there is a solution; without one there are no data.

        Raises
        ------
        TaskError
            No subject was configured.
        """
        return self.predict_and_compare(lift, box)[0]

    def predict_and_compare(
        self, lift: Lift, box: Box, progress: Progress | None = None
    ) -> tuple[PredictedLift2D | PredictedLift3D, LiftComparison | SpatialComparison | None]:
        """Solve the task of one recorded lift; compare if there is a solution.

        Parameters are those of `predict`; `progress` is told after each start.
        """
        if self.person is None:
            raise TaskError('subject: none was configured before the first lift')
        if self.options.dimension == '3d':
            return self.spatial().predict_and_compare(lift, box, progress)
        try:
            failed, comparison = self._attempt(lift, box, progress)
        except AsymmetricLiftError:
            return self.spatial().predict_and_compare(lift, box, progress)
        if failed.report.status not in INFEASIBLE_STATUSES:
            return failed, comparison
        return self._explained(failed, lift, box), None

    def spatial(self) -> SpatialPredictor:
        """Predictor of lifts in space for the same subject; its functions load when first used."""
        if self._subject is None:
            raise TaskError('subject: none was configured before the first lift')
        if self._spatial is None:
            from lift_predictor.core.spatial.predictor import SpatialPredictor

            self._spatial = SpatialPredictor(self.options.spatial)
            self._spatial.stop = self.stop
        if self._spatial.subject is not self._subject:
            self._spatial.configure(self._subject)
        return self._spatial

    def _attempt(
        self, lift: Lift, box: Box, progress: Progress | None = None, share: float = 1.0
    ) -> tuple[PredictedLift2D, LiftComparison | None]:
        """Predict with a share of the way from the recorded places to those asked for."""
        begin = time.perf_counter()
        duration = lift.end - lift.start
        try:
            _require_good(lift)
            task = self._task(lift, box, share)
        except (TaskError, UnreachableError, HumanModelError) as error:
            in_space = self.options.dimension == 'auto' and lift.motion.skeleton == '3d_40dof'
            message = str(error)
            if in_space and isinstance(error, AsymmetricLiftError):
                if self.options.static_ends == 'velocity':
                    raise
                message = f'{error}; {IN_THE_PLANE}'
            status = (
                SolveStatus.PREDICTOR_UNREACHABLE
                if isinstance(error, UnreachableError)
                else SolveStatus.PREDICTOR_BAD_INPUT
            )
            report = SolveReport(status, message, build_time=time.perf_counter() - begin)
            return PredictedLift2D.failed(lift.lift_id, box.mass, duration, report), None
        return self._solve(task, begin, make_starts(task, self.programme.grid.spline), progress)

    def _task(self, lift: Lift, box: Box, share: float = 1.0) -> LiftTask2D:
        if self.person is None:
            raise TaskError('subject: none was configured before the first lift')
        return build_task(self.person, lift, box, self.options.posture_tolerance, share)

    def _explained(self, failed: PredictedLift2D, lift: Lift, box: Box) -> PredictedLift2D:
        """Add the limit that breaks first, and the nearest feasible lift, to a failed result."""
        nearest = failed.nearest
        if nearest is None and not (box.start is None and box.end is None):
            way = way_to(self._task(lift, box, 0.0), box)
            nearest = closer_lift(
                lambda share: self._attempt(lift, box, None, share)[0],
                failed,
                float(np.linalg.norm(way, axis=1).max()),
                lambda share: missing_way(way, share),
            )
        return with_nearest(failed, nearest)

    def solve_task(
        self, task: LiftTask2D, starts: Sequence[Start], progress: Progress | None = None
    ) -> PredictedLift2D:
        """Solve a task that was built already, from given starts; planned lifts come this way.

        Parameters
        ----------
        task : LiftTask2D
            Person, box, feet and what is demanded of the motion.
        starts : sequence of Start
            Initial guesses, the most promising first.
        progress : callable, optional
            Told after each start; what it raises ends the work between two starts.

        Raises
        ------
        CancelledError
            `stop` was set.
        """
        return self.solve_and_compare(task, starts, progress)[0]

    def solve_and_compare(
        self, task: LiftTask2D, starts: Sequence[Start], progress: Progress | None = None
    ) -> tuple[PredictedLift2D, LiftComparison | None]:
        """Do as `solve_task`; compare if the task was recorded and there is a solution."""
        return self._solve(task, time.perf_counter(), starts, progress)

    def _solve(
        self,
        task: LiftTask2D,
        begin: float,
        starts: Sequence[Start],
        progress: Progress | None,
        deadline: float | None = None,
    ) -> tuple[PredictedLift2D, LiftComparison | None]:
        build_time = time.perf_counter() - begin
        if deadline is None:
            deadline = begin + self.options.time_limit
        vector = task.parameters.pack()
        given = starts
        if task.measured is None:
            starts = (*starts, *library_starts(self.programme.grid.spline))
        optima = self.programme.solve_all(vector, task.bounds, starts, deadline, progress)
        optima, check = self._refiner.refine(task, vector, optima, deadline)
        status, message = judge(optima[0], check)
        nearest: NearestLift[PredictedLift2D] | None = None
        if status in INFEASIBLE_STATUSES:
            runs, second, nearest = self._over_lighter(task, vector, given, deadline)
            solved = second is not None and second.passed
            optima = (*runs, *optima) if solved else (optima[0], *runs, *optima[1:])
            if solved:
                check = second
                status, message = judge(optima[0], check)
        notes = (*task.notes, self.programme.backend)
        report = SolveReport(
            status,
            '; '.join((message, *notes)),
            iterations=sum(run.iterations for run in optima),
            objective=optima[0].objective,
            primal_residual=optima[0].violation,
            dual_residual=max(optima[0].stationarity, optima[0].complementarity),
            build_time=build_time,
            solve_time=time.perf_counter() - begin - build_time,
        )
        if status is not SolveStatus.OK:
            failed = PredictedLift2D.failed(
                task.lift_id, task.parameters.box_mass, task.parameters.duration, report, optima,
                check, notes,
            )  # fmt: skip
            return replace(failed, nearest=nearest), None
        return self._result(task, report, optima, check, notes)

    def _over_lighter(
        self, task: LiftTask2D, vector: Array, starts: Sequence[Start], deadline: float
    ) -> tuple[tuple[SolverRun, ...], Verification | None, NearestLift[PredictedLift2D] | None]:
        """Seek a lift that no start led to over lifts of less mass; or the nearest such lift."""

        def solve_lighter(other: LiftTask2D, starts: Sequence[Start]) -> PredictedLift2D:
            return self._solve(other, time.perf_counter(), starts, None, deadline)[0]

        found = largest_mass(solve_lighter, task, starts)
        if found is None or not found.report.ok:
            return (), None, None
        nearest = as_nearest(found, task)
        if nearest is not None:
            return (), None, nearest
        start = found.optima[0].as_start()
        again = self.programme.solve(vector, task.bounds, start, deadline=deadline)
        runs, check = self._refiner.refine(task, vector, (again,), deadline)
        return runs, check, None

    def _result(
        self,
        task: LiftTask2D,
        report: SolveReport,
        optima: tuple[SolverRun, ...],
        check: Verification | None,
        notes: tuple[str, ...],
    ) -> tuple[PredictedLift2D, LiftComparison | None]:
        parameters = replace(task.parameters, box_mass=optima[0].box_mass)
        function = self.programme.report
        times = sample_times(parameters.duration)
        s = times / parameters.duration
        q, dq, ddq = sample(self.programme.grid.spline, optima[0].control, s, parameters.duration)
        loads = evaluate(function, q, dq, ddq, parameters)
        low, high = (np.full((len(s), 1), bound) for bound in task.person.mtp_limits)
        lift = Lift(
            lift_id=task.lift_id,
            source='predicted',
            start=task.start,
            end=task.start + parameters.duration,
            box_mass=parameters.box_mass,
            motion=body_motion(task, task.start + times, q, dq, ddq, loads),
            report=report,
        )
        predicted = PredictedLift2D(
            lift_id=task.lift_id,
            box_mass=parameters.box_mass,
            duration=parameters.duration,
            report=report,
            lift=lift,
            torque_names=TORQUE_NAMES,
            torque=np.column_stack((loads.torque, mtp_torque(task, loads))),
            torque_lower=np.hstack((loads.lower, low)),
            torque_upper=np.hstack((loads.upper, high)),
            zmp=loads.zmp,
            support=np.array(parameters.support),
            optima=optima,
            verification=check,
            notes=notes,
        )
        if task.measured is None:
            return predicted, None
        effort = total_effort(function, self.programme.grid, optima[0].control, parameters)
        return predicted, compare(function, task, times, q, loads, effort)


def _require_good(lift: Lift) -> None:
    if not lift.report.ok:
        raise TaskError(
            f'{lift.lift_id}: the recorded lift is not good data '
            f'({lift.report.status.name}: {lift.report.message})'
        )
