# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Plans one lift in space: feet given or searched, and what can be done where it cannot."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from human_model.exceptions import HumanModelError
from human_model.report import SolveReport, SolveStatus
from human_model.subject import Subject
from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.maximum_weight import Weighting
from lift_predictor.core.nearest_lift import INFEASIBLE_STATUSES, with_nearest
from lift_predictor.core.planning.feet import Placement
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.planned_lift import SpatialPlan
from lift_predictor.core.planning.solve import Listener
from lift_predictor.core.planning.space.feet import candidates, place_feet_in_space
from lift_predictor.core.planning.space.nearest import nearest_in_space
from lift_predictor.core.planning.space.solve import (
    SolvedInSpace,
    lighter_in_space,
    solve_in_space,
)
from lift_predictor.core.planning.space.task import Feet
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.spatial.prediction import PredictedLift3D
from lift_predictor.core.spatial.refine import as_start
from lift_predictor.core.spatial.starts import SpatialStart

PROBES: Final = 1
"""Made-up initial guesses for each place on the way to the nearest lift that can be done."""


def plan_in_space(
    predictor: LiftPredictor,
    subject: Subject,
    task: PlanTask,
    weighting: Weighting,
    listener: Listener | None = None,
) -> SpatialPlan:
    """Plan a lift in space; see `LiftPlanner.plan`."""
    planned, feet = _plan(predictor, subject, task, weighting, listener)
    failed = planned.prediction
    if failed.report.status not in INFEASIBLE_STATUSES:
        return planned

    def attempt(other: PlanTask) -> PredictedLift3D:
        try:
            return solve_in_space(
                predictor, other, feet, weighting, n_starts=PROBES, listener=listener
            ).prediction
        except (TaskError, UnreachableError, HumanModelError) as error:
            return _failed(other, error)

    nearest = None
    if failed.report.status is not SolveStatus.PREDICTOR_UNREACHABLE and task.box_mass:
        nearest = lighter_in_space(predictor, task, feet)
    if nearest is None:
        nearest = nearest_in_space(attempt, task, feet, failed)
    return replace(planned, prediction=with_nearest(failed, nearest))


def _plan(
    predictor: LiftPredictor,
    subject: Subject,
    task: PlanTask,
    weighting: Weighting,
    listener: Listener | None,
) -> tuple[SpatialPlan, Feet]:
    """Return the plan, and where the feet are to stay while the nearest lift is sought."""
    feet = candidates(task)[0] if task.feet is None else Feet(*task.feet)
    placements: tuple[Placement, ...] = ()
    try:
        predictor.configure(subject)
        first: tuple[SpatialStart, ...] = ()
        if task.feet is None:
            probe, placements = place_feet_in_space(predictor, task, listener)
            feet = probe.feet
            if probe.run.converged:
                start = as_start(probe.run, predictor.spatial().grid)
                first = (replace(start, name='neighbour'),)
        found = solve_in_space(predictor, task, feet, weighting, first, listener=listener)
    except (TaskError, UnreachableError, HumanModelError) as error:
        nan = float('nan')
        refused = SpatialPlan(
            subject, task, _failed(task, error), nan, nan, nan, nan, placements, ()
        )
        return refused, feet
    return _planned(subject, task, found, placements), feet


def _planned(
    subject: Subject, task: PlanTask, solved: SolvedInSpace, placements: tuple[Placement, ...]
) -> SpatialPlan:
    feet = solved.plan.feet
    return SpatialPlan(
        subject=subject,
        task=task,
        prediction=solved.prediction,
        ankle=feet.forward,
        left=feet.left,
        heading=feet.heading,
        index=solved.index,
        placements=placements,
        binding=solved.binding,
        effort=solved.effort,
    )


def _failed(task: PlanTask, error: Exception) -> PredictedLift3D:
    unreachable = isinstance(error, UnreachableError)
    status = SolveStatus.PREDICTOR_UNREACHABLE if unreachable else SolveStatus.PREDICTOR_BAD_INPUT
    mass = float('nan') if task.box_mass is None else task.box_mass
    return PredictedLift3D.failed(task.name, mass, task.duration, SolveReport(status, str(error)))
