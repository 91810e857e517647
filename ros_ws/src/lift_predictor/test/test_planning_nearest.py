# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Plans that cannot be done, and the nearest that can."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from human_model.report import SolveReport, SolveStatus
from lift_predictor.core.models.sagittal.way import standard, standard_ways
from lift_predictor.core.planning.plan_task import (
    STANDARD_DISTANCE,
    STANDARD_HEIGHT,
    PlanTask,
)
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.problem.nearest_lift import relax_placement
from lift_predictor.core.problem.prediction import NearestLift, Prediction

TASK = PlanTask(
    'to a shelf', 5.0, (0.3, 0.3, 0.2), (0.4, 0.0, 0.5), (0.45, 0.0, 1.2), feet=(0.0, 0.0)
)


def outcome(feasible: bool) -> Prediction:
    status = SolveStatus.OK if feasible else SolveStatus.PREDICTOR_UNREACHABLE
    report = SolveReport(status, 'task.end: too far')
    return Prediction(model='sagittal', lift_id='plan', box_mass=5.0, duration=1.0, report=report)


def nearest_plan(plan, task: PlanTask) -> NearestLift | None:
    for ways in standard_ways(task):

        def attempt(fraction: float, ways=ways) -> Prediction:
            return plan(replace(task, **{name: way.at(fraction) for name, way in ways.items()}))

        found = relax_placement(attempt, outcome(False), ways)
        if found is not None:
            return found
    return None


def test_standard_location_is_that_of_the_lifting_equation() -> None:
    x, y, z = standard(TASK, 'end')
    assert (x, y, z) == pytest.approx((STANDARD_DISTANCE + 0.15, 0.0, STANDARD_HEIGHT))
    grip = replace(TASK, box_from_grip=(0.05, 0.1))
    assert standard(grip, 'end') == pytest.approx((0.4, 0.0, 0.85))
    assert standard(replace(TASK, feet=None), 'end')[0] == TASK.end[0]


@pytest.mark.parametrize(('fault', 'other'), [('end', 'start'), ('start', 'end')])
def test_only_the_place_at_fault_is_moved(fault: str, other: str) -> None:
    asked = replace(TASK, **{fault: (0.9, 0.0, 1.4)})
    done = []

    def plan(task: PlanTask) -> Prediction:
        feasible = getattr(task, fault)[2] <= 1.0
        if feasible:
            done.append(task)
        return outcome(feasible)

    nearest = nearest_plan(plan, asked)
    assert nearest is not None
    assert getattr(done[-1], other) == getattr(asked, other)
    assert getattr(done[-1], fault)[2] == pytest.approx(1.0, abs=5e-3)
    assert f'the {fault} ' in nearest.change
    assert f'the {other} ' not in nearest.change


def test_nothing_is_offered_where_nothing_works() -> None:
    assert nearest_plan(lambda task: outcome(False), TASK) is None


def test_too_heavy_a_plan_gives_the_largest_mass(subject) -> None:
    planned = LiftPlanner().plan(subject, replace(TASK, box_mass=80.0))
    report, nearest = planned.report, planned.prediction.nearest
    assert report.status is SolveStatus.PREDICTOR_INFEASIBLE
    assert 'kg instead of 80.00 kg' in report.message
    assert nearest is not None
    assert nearest.prediction.report.ok
    assert nearest.prediction.verification.passed
    assert 5.0 < nearest.prediction.box_mass < 80.0


def test_too_high_a_shelf_gives_a_lower_one(subject) -> None:
    high = replace(TASK, end=(0.4, 0.0, subject.stature + 0.6))
    planned = LiftPlanner().plan(subject, high)
    assert planned.report.status is SolveStatus.PREDICTOR_UNREACHABLE
    assert planned.prediction.lift is None
    nearest = planned.prediction.nearest
    assert nearest is not None
    assert 'lower than asked for' in nearest.change
    height = nearest.prediction.lift.motion.box_position[-1, 2]
    assert STANDARD_HEIGHT < height < subject.stature + 0.6
    assert np.all(np.isfinite(nearest.prediction.torque))
