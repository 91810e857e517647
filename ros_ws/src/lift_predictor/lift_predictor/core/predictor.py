# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The pipeline: a recorded lift in, the optimal lift for the same person and task out."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from human_model.exceptions import HumanModelError
from human_model.motion import Lift
from human_model.report import SolveReport, SolveStatus
from human_model.subject import Subject
from human_model.task import Box
from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.models.sagittal.lift_model import SagittalModel
from lift_predictor.core.options import SAGITTAL, PredictorOptions, choose_model
from lift_predictor.core.problem.maximum_weight import MaximumWeight, Weighting, maximum_weight
from lift_predictor.core.problem.model import T
from lift_predictor.core.problem.nearest_lift import (
    INFEASIBLE_STATUSES,
    relax_placement,
    with_nearest,
)
from lift_predictor.core.problem.prediction import Prediction
from lift_predictor.core.problem.run import Progress
from lift_predictor.core.problem.task_solver import TaskSolver
from lift_predictor.core.solvers.stop import StopFlag

if TYPE_CHECKING:
    from lift_predictor.core.models.spatial.task import SpatialTask

INPUT_ERRORS = (TaskError, UnreachableError, HumanModelError)
"""Errors of the input that become a report."""


class LiftPredictor:
    """Predicts recorded lifts.

    Parameters
    ----------
    options : PredictorOptions
        Settings.
    stop : StopFlag, optional
        Another thread sets it to end the work between two iterations (`CancelledError`).

    Attributes
    ----------
    sagittal : TaskSolver
        Solver of the sagittal model.

    Notes
    -----
    Building loads the compiled functions of the sagittal model (or compiles them, once per
    machine); those of the spatial model load when first used.
    """

    def __init__(
        self, options: PredictorOptions | None = None, stop: StopFlag | None = None
    ) -> None:
        self.options = options or PredictorOptions()
        self.stop = stop or StopFlag()
        self._sagittal_model = SagittalModel(self.options, self.stop)
        self.sagittal = TaskSolver(self._sagittal_model, self.stop)
        self._spatial: TaskSolver[SpatialTask] | None = None

    @property
    def spatial(self) -> TaskSolver[SpatialTask]:
        """Solver of the spatial model."""
        if self._spatial is None:
            # Imports CasADi, which a sagittal lift does without.
            from lift_predictor.core.models.spatial.lift_model import SpatialModel

            self._spatial = TaskSolver(SpatialModel(self.options, self.stop), self.stop)
        return self._spatial

    def predict(
        self, subject: Subject, lift: Lift, box: Box, progress: Progress | None = None
    ) -> Prediction:
        """Solve the task of one recorded lift, and compare both if there is a solution.

        Parameters
        ----------
        subject : Subject
            Person.
        lift : Lift
            The recorded lift.
        box : Box
            What was lifted.
        progress : callable, optional
            Called after each start.

        Returns
        -------
        Prediction
            Its report holds the status; without a solution there are no data.
        """
        model = SAGITTAL
        try:
            model = self._choose(subject, lift, box)
            if model == SAGITTAL:
                return _predict(self.sagittal, subject, lift, box, progress)
            return _predict(self.spatial, subject, lift, box, progress)
        except INPUT_ERRORS as error:
            return _refused(model, lift, box, error)

    def maximum_weight(
        self,
        subject: Subject,
        lift: Lift,
        box: Box,
        weighting: Weighting | None = None,
        progress: Progress | None = None,
    ) -> MaximumWeight:
        """Find the largest weight with which a recorded lift is feasible, and that lift.

        Parameters
        ----------
        subject : Subject
            Person.
        lift : Lift
            The recorded lift: postures, hand places, time.
        box : Box
            Its size; its mass is where the search begins.
        weighting : Weighting, optional
            Of effort and weight; (0.15, 0.85) if omitted.
        progress : callable, optional
            Called after each start.

        Returns
        -------
        MaximumWeight
            Its report holds the status.
        """
        model = SAGITTAL
        try:
            model = self._choose(subject, lift, box)
            if model == SAGITTAL:
                return _maximum(self.sagittal, subject, lift, box, weighting, progress)
            return _maximum(self.spatial, subject, lift, box, weighting, progress)
        except INPUT_ERRORS as error:
            refused = _refused(model, lift, box, error)
            return MaximumWeight(refused, weighting or Weighting())

    def _choose(self, subject: Subject, lift: Lift, box: Box) -> str:
        if not lift.report.ok:
            raise TaskError(
                f'{lift.lift_id}: the recorded lift is not good data '
                f'({lift.report.status.name}: {lift.report.message})'
            )
        return choose_model(
            self.options,
            lambda: self._sagittal_model.asymmetry(subject, lift, box),
            lift.motion.skeleton == '3d_40dof',
        )


def _predict(
    solver: TaskSolver[T], subject: Subject, lift: Lift, box: Box, progress: Progress | None
) -> Prediction:
    """Solve a recorded lift by one model; if it is infeasible, add the nearest feasible lift."""
    model = solver.model

    def attempt(fraction: float, progress: Progress | None = None) -> Prediction:
        begin = time.perf_counter()
        try:
            task = model.recorded_task(subject, lift, box, fraction)
        except INPUT_ERRORS as error:
            return _refused(model.name, lift, box, error)
        hops = model.method.basin_hops
        return solver.solve(task, model.starts(task), progress, begin, hops)

    failed = attempt(1.0, progress)
    if failed.report.status not in INFEASIBLE_STATUSES:
        return failed
    nearest = failed.nearest
    if failed.runs and not model.method.reduces_mass:
        task = model.recorded_task(subject, lift, box)
        nearest = solver.reduce_mass(model.with_other_mass(task), model.starts(task))
    if nearest is None:
        nearest = relax_placement(attempt, failed, model.recorded_ways(subject, lift, box))
    return with_nearest(failed, nearest)


def _maximum(
    solver: TaskSolver[T],
    subject: Subject,
    lift: Lift,
    box: Box,
    weighting: Weighting | None,
    progress: Progress | None,
) -> MaximumWeight:
    task = solver.model.maximum_weight_task(subject, lift, box)
    starts = solver.model.starts(task)
    return maximum_weight(solver, task, starts, weighting, progress=progress)


def _refused(model: str, lift: Lift, box: Box, error: Exception) -> Prediction:
    unreachable = isinstance(error, UnreachableError)
    status = SolveStatus.PREDICTOR_UNREACHABLE if unreachable else SolveStatus.PREDICTOR_BAD_INPUT
    return Prediction(
        model=model, lift_id=lift.lift_id, box_mass=box.mass, duration=lift.end - lift.start,
        report=SolveReport(status, str(error)),
    )  # fmt: skip
