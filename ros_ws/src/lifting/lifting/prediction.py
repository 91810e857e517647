# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Optimal lifts: of a measured lift, or of a task without a recording."""

from __future__ import annotations

from dataclasses import dataclass, replace

import lift_predictor
from human_model.report import SolveReport
from human_model.subject import Subject
from human_model.task import Box
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.planned_lift import PlannedLift
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.predictor import LiftPredictor
from lifting.exceptions import IncompleteLiftError, NoSolutionError
from lifting.lift import Lift


@dataclass(frozen=True, eq=False)
class Prediction:
    """An optimal lift, or the reason why there is none.

    Attributes
    ----------
    subject : Subject
    result : lift_predictor.Prediction
        Torques, limits, support, verification, comparison with the measured lift, nearest
        feasible lift.
    measured : Lift or None
        The measured lift of the prediction.
    plan : PlannedLift or None
        Feet and technique of a task without a recording.
    """

    subject: Subject
    result: lift_predictor.Prediction
    measured: Lift | None = None
    plan: PlannedLift | None = None

    @property
    def report(self) -> SolveReport:
        """Report of the solver; its message names the infeasible constraint."""
        return self.result.report

    @property
    def box_mass(self) -> float:
        """Mass of the box [kg]."""
        return self.result.box_mass

    @property
    def lift(self) -> Lift:
        """The optimal lift; raises NoSolutionError if there is none."""
        if self.result.lift is None:
            raise NoSolutionError(self.result.lift_id, self.report)
        work = None if self.measured is None else self.measured.work
        return Lift.of(self.result.lift, self.subject, work=work)


def predict(
    lift: Lift | PlanTask, subject: Subject | None = None, options: PredictorOptions | None = None
) -> Prediction:
    """Predict the lift with the least joint effort.

    Parameters
    ----------
    lift : Lift or PlanTask
        A measured lift, or a task without a recording.
    subject : Subject, optional
        Needed with a task.
    options : PredictorOptions, optional

    Raises
    ------
    IncompleteLiftError
        If subject or box is missing.
    """
    predictor = LiftPredictor(options)
    if isinstance(lift, PlanTask):
        if subject is None:
            raise IncompleteLiftError(lift.name, 'the subject')
        plan = LiftPlanner(predictor).plan(subject, lift)
        return Prediction(subject, plan.prediction, plan=plan)
    return Prediction(lift.subject, predictor.predict(lift.subject, lift, _box(lift)), lift)


def maximum_weight(lift: Lift | PlanTask, subject: Subject | None = None) -> Prediction:
    """Predict the lift with the largest feasible mass.

    The parameters are those of `predict`; the mass of their box is not used.
    """
    if isinstance(lift, PlanTask):
        return predict(replace(lift, box_mass=None), subject)
    found = LiftPredictor().maximum_weight(lift.subject, lift, _box(lift))
    return Prediction(lift.subject, found.prediction, lift)


def _box(lift: Lift) -> Box:
    if lift.box is None:
        raise IncompleteLiftError(lift.lift_id, 'the box')
    return lift.box
