# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Plans a lift: task and person in, optimal lift out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from human_model.errors import HumanModelError
from human_model.report import SolveReport, SolveStatus
from human_model.subject import Subject
from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.maximum_weight import Weighting
from lift_predictor.core.nearest_lift import HOPELESS, NearestLift, with_nearest
from lift_predictor.core.planning.build import build_plan
from lift_predictor.core.planning.feet import Placement, place_feet
from lift_predictor.core.planning.nearest import nearest_plan
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.solve import Listener, SolvedPlan, solve_plan
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.sagittal.prediction import PredictedLift2D

if TYPE_CHECKING:
    from lift_predictor.core.spatial.prediction import PredictedLift3D

STARTS: Final = 4
"""Made-up initial guesses for the lift itself."""
PROBES: Final = 2
"""Made-up initial guesses for each place on the way to the nearest lift that can be done."""


@dataclass(frozen=True, eq=False)
class PlannedLift:
    """A planned lift and how it was found.

    Attributes
    ----------
    subject : Subject
        Who lifts.
    task : PlanTask
        What was asked for.
    prediction : PredictedLift2D or PredictedLift3D
        The lift; its report says whether there is one. In space where the box lies aside.
    ankle : float
        Middle of the ankles, forward [m]; NaN where none was found or the task was refused.
    index : float
        Stoop-Squat-Index of the first posture; NaN without a lift, or where C7 is not lowered.
    placements : tuple of Placement
        Places that were tried, if the feet were free.
    binding : tuple of str
        Limits that the lift touches, the one that costs most first; sagittal plans only.
    effort : float
        Effort of a lift in space (first term of equation 3.9) [s]; otherwise NaN.
    """

    subject: Subject
    task: PlanTask
    prediction: PredictedLift2D | PredictedLift3D
    ankle: float
    index: float
    placements: tuple[Placement, ...]
    binding: tuple[str, ...]
    effort: float = float('nan')

    @property
    def report(self) -> SolveReport:
        """Report of the solve; status 0: good data."""
        return self.prediction.report


@dataclass(frozen=True, eq=False)
class SagittalPlan(PlannedLift):
    """A planned lift in the sagittal plane."""

    prediction: PredictedLift2D


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
            `prediction.nearest`), not sagittal.
        """
        weights = weighting or self.weighting
        planned = self._plan(subject, task, listener, weights)
        failed = planned.prediction
        if failed.report.status not in HOPELESS or not isinstance(failed, PredictedLift2D):
            return planned
        nearest: NearestLift[PredictedLift2D] | None = None
        if failed.report.status is not SolveStatus.PREDICTOR_UNREACHABLE and task.box_mass:
            # Where the lift was sought: with free feet, at the place that came nearest.
            nearest = self._lighter(task, planned.ankle)
        if nearest is None:
            nearest = nearest_plan(
                lambda other: self._sagittal(subject, other, listener, weights, PROBES).prediction,
                task,
                failed,
            )
        return replace(planned, prediction=with_nearest(failed, nearest))

    def _lighter(self, task: PlanTask, ankle: float) -> NearestLift[PredictedLift2D] | None:
        if self.predictor.person is None:
            raise TaskError('subject: none was configured before the plan')
        plan = build_plan(self.predictor.person, task, ankle)
        starts = plan.starts(self.predictor.programme.grid.spline, STARTS)
        return self.predictor.lighter_lift(plan.task, starts)

    def _plan(
        self, subject: Subject, task: PlanTask, listener: Listener | None, weights: Weighting
    ) -> PlannedLift:
        if task.feet is None or not task.lies_aside:
            return self._sagittal(subject, task, listener, weights)
        # Sagittal plans, which are most, need not load it.
        from lift_predictor.core.planning.aside import solve_aside

        try:
            self.predictor.configure(subject)
            solved = solve_aside(self.predictor, task, weights, listener)
        except (TaskError, UnreachableError, HumanModelError) as error:
            return _refused(subject, task, error)
        nan = float('nan')
        return PlannedLift(
            subject, task, solved.prediction, task.feet[0], nan, (), (), solved.effort
        )

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


def plan(
    subject: Subject, task: PlanTask, listener: Listener | None = None
) -> PlannedLift:
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
        index=solved.index,
        placements=placements,
        binding=solved.binding,
    )


def _refused(subject: Subject, task: PlanTask, error: Exception) -> SagittalPlan:
    unreachable = isinstance(error, UnreachableError)
    status = (
        SolveStatus.PREDICTOR_UNREACHABLE if unreachable else SolveStatus.PREDICTOR_BAD_INPUT
    )
    nan = float('nan')
    mass = nan if task.box_mass is None else task.box_mass
    prediction = PredictedLift2D.failed(
        task.name, mass, task.duration, SolveReport(status, str(error))
    )
    return SagittalPlan(subject, task, prediction, nan, nan, (), ())
