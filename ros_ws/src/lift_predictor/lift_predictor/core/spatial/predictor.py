# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The spatial pipeline: a task in, the optimal lift for the same person and task out."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from human_model.anthropometry import SegmentParameters
from human_model.exceptions import HumanModelError
from human_model.motion import Lift
from human_model.report import SolveReport, SolveStatus
from human_model.subject import Subject
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.nearest_lift import INFEASIBLE_STATUSES, with_nearest
from lift_predictor.core.sagittal.task import Box
from lift_predictor.core.sampling import sample_times
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.solvers.solution import InteriorPointOptions, Solution, Status
from lift_predictor.core.solvers.solve import solve
from lift_predictor.core.solvers.spline_nlp import Assembler
from lift_predictor.core.solvers.stop import StopFlag
from lift_predictor.core.spatial.comparison import SpatialComparison, compare
from lift_predictor.core.spatial.evaluation import evaluate, sample
from lift_predictor.core.spatial.feasibility import lighter_lift
from lift_predictor.core.spatial.grid import SpatialGrid
from lift_predictor.core.spatial.lift_motion import body_motion, feet_moved, joint_torques
from lift_predictor.core.spatial.multistart import Progress, runs_from
from lift_predictor.core.spatial.person import COEFFICIENT_SET, SpatialPerson
from lift_predictor.core.spatial.prediction import PredictedLift3D, SpatialOptimum
from lift_predictor.core.spatial.programme import (
    spatial_assembler,
    spatial_library,
    spatial_programme,
)
from lift_predictor.core.spatial.recorded_task import recorded_task
from lift_predictor.core.spatial.refine import Refiner
from lift_predictor.core.spatial.starts import SpatialStart, leads_right, recorded_starts
from lift_predictor.core.spatial.task import SpatialTask, Windows, without_ground_windows
from lift_predictor.core.spatial.verify import SpatialVerification

FOOT_TOLERANCE: Final = 1e-6
"""Distance of the feet from their place above which there are no data [m]."""
_STATUS: Final = {
    Status.INFEASIBLE: SolveStatus.PREDICTOR_INFEASIBLE,
    Status.TIME_LIMIT: SolveStatus.PREDICTOR_TIME_LIMIT,
}


@dataclass(frozen=True)
class SpatialOptions:
    """Settings of the prediction.

    Attributes
    ----------
    n_control : int
        Control points per coordinate.
    n_nodes : int
        Time nodes; see `grid.SpatialGrid`.
    windows : Windows
        How near to stay to a recorded lift (3.15, 3.16, 5.1).
    coefficient_set : str
        Published strength data, a name of `human_model.strength.coefficient_sets`.
    max_iterations : int
        Iterations of one run at most.
    time_limit : float
        Wall time of one run at most, and time after which none is begun any more [s].
    refinements : int
        How often the lift is solved again with a margin when the dense grid shows a violation.
    barrier : float
        First barrier parameter of the interior-point method: a larger one leaves the start.
    hops : int
        Runs from the best solution, displaced, in search of a better one.
    warm_barrier, warm_bound_push : float
        Barrier parameter and least distance from bounds after a warm start: found on lifts whose
        box changed by up to 1 kg and 4 cm; smaller barriers save steps for small changes only.
    """

    n_control: int = 7
    n_nodes: int = 25
    windows: Windows = field(default_factory=Windows)
    coefficient_set: str = COEFFICIENT_SET
    max_iterations: int = 400
    time_limit: float = 30.0
    refinements: int = 5
    barrier: float = 1e-3
    hops: int = 3
    warm_barrier: float = 1e-7
    warm_bound_push: float = 1e-3

    def interior_point(self, barrier: float | None = None) -> InteriorPointOptions:
        """Return the settings of the method, perhaps with another first barrier parameter."""
        return InteriorPointOptions(
            max_iterations=self.max_iterations,
            time_limit=self.time_limit,
            barrier=barrier or self.barrier,
            warm_barrier=self.warm_barrier,
            warm_bound_push=self.warm_bound_push,
        )


class SpatialPredictor:
    """Predicts lifts of one subject in space.

    Parameters
    ----------
    options : SpatialOptions
        Settings.

    Notes
    -----
    Building loads the compiled functions, or compiles them (half a minute, once per machine).
    Another thread may set `stop` to end the work between two iterations (`CancelledError`).
    """

    def __init__(self, options: SpatialOptions | None = None) -> None:
        self.options = options or SpatialOptions()
        self.person: SpatialPerson | None = None
        self.subject: Subject | None = None
        self.grid = SpatialGrid(self.options.n_control, self.options.n_nodes)
        self.library: NodeLibrary = spatial_library()
        self.assembler = spatial_assembler(self.library, self.grid)
        self._with_technique: Assembler | None = None
        self.stop = StopFlag()

    def configure(self, subject: Subject, segments: SegmentParameters | None = None) -> None:
        """Set the subject, and the segments of the skeleton if they are not to be estimated.

        Raises
        ------
        TaskError
            The subject cannot be turned into the spatial model; names field and value.
        """
        try:
            self.person = SpatialPerson.of(subject, self.options.coefficient_set, segments)
        except HumanModelError as error:
            raise TaskError(str(error)) from error
        self.subject = subject

    def task(
        self,
        lift: Lift,
        box: Box,
        mass: tuple[float, float] | None = None,
        ground_windows: bool = True,
    ) -> SpatialTask:
        """Task of a recorded lift with this predictor's windows; see `task.recorded_task`.

        Without ground windows (3.16, 5.1) the weight may be another one.
        """
        if self.person is None:
            raise TaskError('subject: none was configured before the first lift')
        if not lift.report.ok:
            raise TaskError(
                f'{lift.lift_id}: the recorded lift is not good data '
                f'({lift.report.status.name}: {lift.report.message})'
            )
        task = recorded_task(self.person, lift, box, self.grid, self.options.windows, mass)
        return task if ground_windows else without_ground_windows(task)

    def predict(self, lift: Lift, box: Box) -> PredictedLift3D:
        """Solve the task of one recorded lift for the given weight.

        Parameters
        ----------
        lift : Lift
            The recorded lift, on the 3D skeleton.
        box : Box
            What was lifted.

        Returns
        -------
        PredictedLift3D
            Its report says whether there is a solution; without one there are no data.

        Raises
        ------
        TaskError
            No subject was configured.
        """
        return self.predict_and_compare(lift, box)[0]

    def predict_and_compare(
        self, lift: Lift, box: Box, progress: Progress | None = None
    ) -> tuple[PredictedLift3D, SpatialComparison | None]:
        """Do as `predict`; compare if there is a solution; `progress` is told after each start."""
        if self.person is None:
            raise TaskError('subject: none was configured before the first lift')
        begin = time.perf_counter()
        try:
            task = self.task(lift, box)
        except (TaskError, HumanModelError) as error:
            report = SolveReport(
                SolveStatus.PREDICTOR_BAD_INPUT, str(error), build_time=time.perf_counter() - begin
            )
            duration = lift.end - lift.start
            return PredictedLift3D.failed(lift.lift_id, box.mass, duration, report), None
        starts = recorded_starts(task, self.grid)
        prediction = self.solve_task(task, starts, progress, begin, hops=self.options.hops)
        if not prediction.report.ok:
            if prediction.report.status not in INFEASIBLE_STATUSES:
                return prediction, None
            # Ground reactions were recorded with another weight.
            free = without_ground_windows(task)
            nearest = lighter_lift(self.solve_task, free, starts, self.grid)
            return with_nearest(prediction, nearest), None
        return prediction, compare(self.library, task, prediction)

    def solve_task(
        self,
        task: SpatialTask,
        starts: Sequence[SpatialStart],
        progress: Progress | None = None,
        begin: float | None = None,
        warm: Solution | None = None,
        hops: int = 0,
    ) -> PredictedLift3D:
        """Solve a task from given starts; the best solution is kept.

        Parameters
        ----------
        task : SpatialTask
            Recorded or placed.
        starts : sequence of SpatialStart
            Initial guesses, the most promising first.
        progress : callable, optional
            Told after each start; what it raises ends the work between two starts.
        begin : float, optional
            When the work began, on the clock of `time.perf_counter`.
        warm : Solution, optional
            Solution of a similar task: its multipliers are the first ones.
        hops : int
            Runs from the best solution, displaced, after those from the starts.
        """
        now = time.perf_counter()
        begin = now if begin is None else begin
        deadline = now + self.options.time_limit
        # Half of the time is for margins.
        until = (deadline, 0.5 * (now + deadline))
        optima = runs_from(
            lambda start: self.run(task, start, warm), starts, hops, self.grid, until, progress,
            leads_right(task),
        )  # fmt: skip
        refiner = Refiner(self.library, self.grid, self.run, self.options.refinements)
        optima, check = refiner.best_that_holds(task, optima, deadline)
        return self._finish(task, optima, check, now - begin, time.perf_counter() - now)

    def run(
        self, task: SpatialTask, start: SpatialStart, warm: Solution | None = None
    ) -> SpatialOptimum:
        """Solve a task from one start at the nodes, not checked between them."""
        assembler = self.assembler
        if task.bounds.technique:
            if self._with_technique is None:
                self._with_technique = spatial_assembler(self.library, self.grid, technique=True)
            assembler = self._with_technique
        programme = spatial_programme(assembler, self.grid, task.parameters, task.bounds)
        x0 = np.clip(start.variables(), programme.lower, programme.upper)
        options = replace(self.options.interior_point(start.barrier), stop=self.stop)
        return SpatialOptimum(start.name, solve(programme, x0, options, warm))

    def _finish(
        self,
        task: SpatialTask,
        optima: tuple[SpatialOptimum, ...],
        check: SpatialVerification | None,
        build_time: float,
        solve_time: float,
    ) -> PredictedLift3D:
        best = optima[0].solution
        mass, duration = (float(v) for v in best.x[-2:])
        status, message = _judge(optima[0], check)
        notes = (*task.notes, self.library.backend)
        report = SolveReport(
            status,
            '; '.join((message, *notes)),
            iterations=sum(run.solution.iterations for run in optima),
            objective=best.objective,
            primal_residual=best.primal,
            dual_residual=max(best.dual, best.complementarity),
            build_time=build_time,
            solve_time=solve_time,
        )
        if status is not SolveStatus.OK:
            return PredictedLift3D.failed(
                task.lift_id, mass, duration, report, optima, check, notes
            )
        times = sample_times(duration)
        control = best.x[:-2].reshape(self.grid.spline.n_free, -1)
        splined = sample(self.grid, control, times / duration, duration)
        loads = evaluate(self.library, *splined, mass, task.parameters)
        motion = body_motion(task, task.start + times, splined, loads, mass > 0.0)
        slipped = feet_moved(task, motion)
        if slipped > FOOT_TOLERANCE:
            message = f'the feet are {1e3 * slipped:.3g} mm off their place; {message}'
            report = replace(
                report, status=SolveStatus.PREDICTOR_VERIFICATION_FAILED, message=message
            )
            return PredictedLift3D.failed(
                task.lift_id, mass, duration, report, optima, check, notes
            )
        torque, lower, upper = joint_torques(task, motion)
        sole = np.array(
            [[a[0] + np.cos(t) * s for s in task.parameters.sole] for a, t in zip(
                task.parameters.ankle, task.parameters.foot_turn, strict=True,
            )]
        )  # fmt: skip
        return PredictedLift3D(
            lift_id=task.lift_id,
            box_mass=mass,
            duration=duration,
            report=report,
            lift=Lift(
                lift_id=task.lift_id,
                source='predicted',
                start=task.start,
                end=task.start + duration,
                box_mass=mass,
                motion=motion,
                report=report,
            ),
            torque_names=task.person.skeleton.coordinates[-torque.shape[1] :],
            torque=torque,
            torque_lower=lower,
            torque_upper=upper,
            zmp=loads.zmp[:, 0],
            support=np.array([sole.min(), sole.max()]),
            loads=loads,
            optima=optima,
            verification=check,
            notes=notes,
        )


def _judge(best: SpatialOptimum, check: SpatialVerification | None) -> tuple[SolveStatus, str]:
    solution = best.solution
    if best.converged and check is not None and check.passed:
        return SolveStatus.OK, f'optimal from the start "{best.start}"'
    if best.converged and check is not None:
        return (
            SolveStatus.PREDICTOR_VERIFICATION_FAILED,
            f'between the nodes constraints are violated: {check.failures()}',
        )
    violated = ', '.join(f'{name} ({value:.3g})' for name, value in solution.violated)
    return (
        _STATUS.get(solution.status, SolveStatus.PREDICTOR_NOT_CONVERGED),
        f'{solution.status} after {solution.iterations} iterations; violated most: '
        f'{violated or "nothing"}',
    )
