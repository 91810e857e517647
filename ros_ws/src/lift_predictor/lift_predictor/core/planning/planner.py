# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Plans a lift: task and person in, optimal lift out."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from human_model.exceptions import HumanModelError
from human_model.report import SolveReport, SolveStatus
from human_model.subject import Subject
from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.maximum_weight import Weighting
from lift_predictor.core.nearest_lift import INFEASIBLE_STATUSES, with_nearest
from lift_predictor.core.planning.feet import Placement, place_feet
from lift_predictor.core.planning.nearest import nearest_plan
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.planned_lift import PlannedLift, SagittalPlan
from lift_predictor.core.planning.solve import Listener, SolvedPlan, solve_plan
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.sagittal.prediction import PredictedLift2D

STARTS: Final = 4
"""Made-up initial guesses for the lift itself."""
PROBES: Final = 2
"""Made-up initial guesses for each place on the way to the nearest lift that can be done."""


class LiftPlanner:
    """Plans lifts with a predictor's solver.

    Parameters
    ----------
    predictor : LiftPredictor, optional
        Solves and checks; it is configured for the subject of each plan.
    weighting : Weighting, optional
        Of effort and weight, where the largest mass is asked for.
    """

    def __init__(
        self, predictor: LiftPredictor | None = None, weighting: Weighting | None = None
    ) -> None:
        self.predictor = predictor or LiftPredictor()
        self.weighting = weighting or Weighting()

    def plan(
        self,
        subject: Subject,
        task: PlanTask,
        listener: Listener | None = None,
        weighting: Weighting | None = None,
    ) -> PlannedLift:
        """Plan one lift.

        Parameters
        ----------
        subject : Subject
            Who lifts.
        task : PlanTask
            What is lifted.
        listener : callable, optional
            Told after each run of the optimiser; may raise `CancelledError`.
        weighting : Weighting, optional
            In place of the planner's own.

        Returns
        -------
        PlannedLift
            Its report says whether there is a lift, and otherwise why not: out of reach, too heavy
            (the limit that breaks first is named, and the nearest lift that can be done is in
            `prediction.nearest`), or not sagittal where the predictor's dimension is '2d'.
        """
        weights = weighting or self.weighting
        dimension = self.predictor.options.dimension
        if dimension == '3d' or (dimension == 'auto' and task.lies_aside):
            # Sagittal plans, which are most, need not load it.
            from lift_predictor.core.planning.space.planner import plan_in_space

            return plan_in_space(self.predictor, subject, task, weights, listener)
        planned = self._sagittal(subject, task, listener, weights)
        failed = planned.prediction
        if failed.report.status not in INFEASIBLE_STATUSES:
            return planned
        nearest = failed.nearest
        if nearest is None:
            nearest = nearest_plan(
                lambda other: self._sagittal(subject, other, listener, weights, PROBES).prediction,
                task,
                failed,
            )
        return replace(planned, prediction=with_nearest(failed, nearest))

    def _sagittal(
        self,
        subject: Subject,
        task: PlanTask,
        listener: Listener | None,
        weights: Weighting,
        n_starts: int = STARTS,
    ) -> SagittalPlan:
        try:
            self.predictor.configure(subject)
            if task.feet is not None:
                solved = solve_plan(
                    self.predictor, task, task.feet[0], n_starts, weights, listener=listener
                )
                return _planned(subject, task, solved, ())
            found, placements = place_feet(self.predictor, task, weights, listener)
            ankle = float(found.plan.task.parameters.ankle[0])
            if found.prediction.report.ok:
                again = solve_plan(
                    self.predictor, task, ankle, n_starts, weights, (found.start(),), listener
                )
                found = min(again, found, key=lambda solved: solved.value)
            return _planned(subject, task, found, placements)
        except (TaskError, UnreachableError, HumanModelError) as error:
            return _refused(subject, task, error)


def plan(subject: Subject, task: PlanTask, listener: Listener | None = None) -> PlannedLift:
    """Plan one lift with a predictor of default options; for many, keep a `LiftPlanner`."""
    return LiftPlanner().plan(subject, task, listener)


def _planned(
    subject: Subject, task: PlanTask, solved: SolvedPlan, placements: tuple[Placement, ...]
) -> SagittalPlan:
    return SagittalPlan(
        subject=subject,
        task=task,
        prediction=solved.prediction,
        ankle=float(solved.plan.task.parameters.ankle[0]),
        left=task.lateral,
        heading=0.0,
        index=solved.index,
        placements=placements,
        binding=solved.binding,
    )


def _refused(subject: Subject, task: PlanTask, error: Exception) -> SagittalPlan:
    unreachable = isinstance(error, UnreachableError)
    status = SolveStatus.PREDICTOR_UNREACHABLE if unreachable else SolveStatus.PREDICTOR_BAD_INPUT
    nan = float('nan')
    mass = nan if task.box_mass is None else task.box_mass
    prediction = PredictedLift2D.failed(
        task.name, mass, task.duration, SolveReport(status, str(error))
    )
    return SagittalPlan(subject, task, prediction, nan, nan, nan, nan, (), ())
