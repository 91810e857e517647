# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifts to the side, planned: technique, ends, feet, sides, and what can be done instead."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from human_model.report import SolveStatus
from human_model.subject import Subject
from lift_predictor.core.models.sagittal.lowering import stoop_squat_index
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.spatial.evaluation import lowering
from lift_predictor.core.models.spatial.parameters import SPLINED
from lift_predictor.core.models.spatial.planned.feet import allowed, candidates
from lift_predictor.core.models.spatial.planned.plan_postures import near_guess
from lift_predictor.core.models.spatial.way import way_of
from lift_predictor.core.planning.plan_task import FARTHEST, NEAREST, Feet, PlanTask
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.planning.summary import summarise
from lift_predictor.core.planning.technique import technique
from lift_predictor.core.predictor import LiftPredictor

TASK = PlanTask(
    'to the side', 5.0, (0.238, 0.305, 0.127), (0.4, 0.0, 0.3), (0.3, 0.3, 1.0), (0.0, 0.0)
)
ORIGIN = Feet(0.0, 0.0)


# Whole plans in space take several seconds each: two minutes together.
pytestmark = pytest.mark.long


@pytest.fixture(scope='module')
def planner() -> LiftPlanner:
    return LiftPlanner(LiftPredictor())


@pytest.fixture(scope='module')
def spatial(planner):
    return planner.predictor.spatial.model


@pytest.fixture(scope='module')
def free(planner, subject):
    return planner.plan(subject, TASK)


def test_plan_holds_the_box_at_both_places_and_is_checked(free) -> None:
    assert free.report.ok, free.report.message
    assert free.prediction.model == 'spatial'
    motion = free.prediction.lift.motion
    assert motion.skeleton == '3d_40dof'
    np.testing.assert_allclose(motion.box_position[[0, -1]], [TASK.start, TASK.end], atol=1e-3)
    assert free.prediction.verification.passed
    summary = summarise(free)
    assert summary.effort == pytest.approx(free.report.objective, rel=0.05)
    assert summary.box_path[-1][1:] == pytest.approx(TASK.end, abs=1e-3)
    assert free.prediction.active_constraints
    assert all(' at ' in name for name in free.prediction.active_constraints)
    assert not any(
        '(3.13)' in name or '(3.11)' in name for name in free.prediction.active_constraints
    )


def test_right_side_is_the_mirror_image(planner) -> None:
    """For a woman: the published trunk rotation of men differs by 1 % between the sides."""
    woman = Subject(pseudonym='w', sex='female', mass=60.0, stature=1.65, age=31.0)
    left, right = (
        planner.plan(woman, replace(TASK, end=(0.3, side * 0.35, 1.0))) for side in (1.0, -1.0)
    )
    assert left.report.ok and right.report.ok
    assert right.prediction.effort == pytest.approx(left.prediction.effort, rel=1e-3)
    assert right.index == pytest.approx(left.index, abs=0.1)
    one, other = (plan.prediction.lift.motion for plan in (left, right))
    np.testing.assert_allclose(
        one.ground_force[:, ::-1] * [1, -1, 1], other.ground_force, atol=1.0
    )
    for side, opposite in ('rl', 'lr'):
        np.testing.assert_allclose(
            one.coordinate(f'knee_angle_{side}'), other.coordinate(f'knee_angle_{opposite}'),
            atol=0.01,
        )  # fmt: skip


def test_technique_is_kept_and_costs_effort(planner, subject, free) -> None:
    asked = replace(TASK, technique='squat', end_posture='upright')
    squat = planner.plan(subject, asked)
    assert squat.report.ok, squat.report.message
    assert technique('squat').holds(squat.index - 1e-4)
    assert not technique('squat').holds(free.index)
    assert squat.prediction.effort > free.prediction.effort
    assert any(
        name.startswith(('technique', 'window')) for name in squat.prediction.active_constraints
    )


def test_index_is_that_of_the_plane(spatial, subject, person, parameters) -> None:
    """A symmetric posture has the same Stoop-Squat-Index in both models."""
    plan = spatial.plan(subject, TASK, ORIGIN)
    q = np.radians([[-20.0, 60, 10, 80, 70, 20], [-50.0, 80, 5, 70, 10, 0]])
    full = np.zeros((2, len(SPLINED)))
    same = {
        'arm_flex': ('arm_flex_r', 'arm_flex_l'), 'elbow_flex': ('elbow_flex_r', 'elbow_flex_l'),
        'hip_flexion': ('hip_mean',), 'knee_angle': ('knee_angle_r', 'knee_angle_l'),
        'ankle_angle': ('ankle_mean',), 'lumbar_extension': ('lumbar_extension',),
    }  # fmt: skip
    for column, joint in enumerate(JOINTS):
        for name in same[joint]:
            full[:, SPLINED.index(name)] = q[:, column]
    hips, c7 = lowering(spatial.library, full, plan.task.parameters)
    flat = replace(parameters, ankle=np.array([0.0, person.ankle_height]))
    np.testing.assert_allclose(
        100.0 * (1.0 - hips / c7), stoop_squat_index(q, person, flat), atol=1e-6
    )


@pytest.mark.parametrize('name', ['squat', 'semi_squat', 'stoop'])
@pytest.mark.parametrize('place', [(0.4, 0.0, 0.3), (0.3, -0.25, 0.1), (0.1, 0.4, 0.4)])
def test_posture_of_a_technique_holds_the_box(spatial, subject, name: str, place) -> None:
    plan = spatial.plan(subject, replace(TASK, start=place, technique=name), ORIGIN)
    posture = near_guess('semi-squat', plan.task, 0, spatial.library, technique(name))
    assert posture.good
    hips, c7 = lowering(spatial.library, posture.q[None], plan.task.parameters)
    assert technique(name).holds(100.0 * (1.0 - hips[0] / c7[0]))


def test_candidates_for_the_feet_are_allowed_and_differ() -> None:
    task = replace(TASK, feet=None)
    found = candidates(task)
    assert len(found) == len(set(found)) >= 4
    assert all(allowed(feet, task) for feet in found)
    # On the line through both places the lift is in one vertical plane.
    line = [f for f in found if abs(f.heading) > 1e-6]
    for feet in line:
        angles = [
            np.arctan2(y - feet.left, x - feet.forward) - feet.heading
            for x, y, _ in (task.start, task.end)
        ]
        assert np.allclose(angles, 0.0, atol=1e-3) or np.isclose(sum(angles), 0.0, atol=1e-3)
    assert not allowed(Feet(0.4 - NEAREST + 0.05, 0.0), task)
    assert not allowed(Feet(-FARTHEST, 0.0), task)


def test_free_feet_are_the_best_that_were_tried(planner, subject, monkeypatch) -> None:
    monkeypatch.setattr('lift_predictor.core.models.spatial.planned.feet.HALVINGS', -1)
    told = []
    task = replace(TASK, feet=None, start=(0.4, -0.2, 0.5))
    planned = planner.plan(subject, task, told.append)
    assert planned.report.ok, planned.report.message
    assert len(planned.placements) == len(candidates(task))
    best = min(planned.placements, key=lambda placement: placement.value)
    assert planned.feet == best.feet
    # A margin between the nodes costs a little.
    assert planned.prediction.effort <= best.value * 1.01
    motion = planned.prediction.lift.motion
    np.testing.assert_allclose(motion.box_position[[0, -1]], [task.start, task.end], atol=1e-3)
    ankles = 0.5 * (motion.point('ankle_r') + motion.point('ankle_l'))[0]
    np.testing.assert_allclose(ankles[:2], [planned.feet.forward, planned.feet.left], atol=1e-6)
    toe, heel = motion.point('toe_r')[0], motion.point('heel_r')[0]
    assert np.arctan2(*(toe - heel)[1::-1]) == pytest.approx(planned.feet.heading, abs=1e-6)
    assert {progress.stage for progress in told} == {'feet', 'lift'}


def test_way_to_the_standard_location_keeps_the_side_first() -> None:
    way = way_of(TASK, 'end', Feet(0.0, 0.0, np.pi / 4.0), turned=False)
    assert way.at(1.0) == pytest.approx(TASK.end)
    assert way.near == pytest.approx((0.0, 0.2 + 0.119, 0.75))
    turned = way_of(TASK, 'end', ORIGIN, turned=True)
    assert turned.at(0.0) == pytest.approx((0.319, 0.0, 0.75))
    assert turned.missing(0.5).endswith('lower and 22 deg less to the side')


def test_too_high_a_shelf_at_the_side_gives_a_lower_one(planner, subject, monkeypatch) -> None:
    monkeypatch.setattr('lift_predictor.core.problem.nearest_lift.PLACE_TOLERANCE', 0.2)
    high = replace(TASK, end=(0.25, 0.25, subject.stature + 0.6))
    planned = planner.plan(subject, high)
    assert planned.report.status is SolveStatus.PREDICTOR_UNREACHABLE
    nearest = planned.prediction.nearest
    assert nearest is not None
    assert nearest.prediction.report.ok
    assert 'the end ' in nearest.change
    assert 'lower' in nearest.change
    assert 'the start' not in nearest.change
    reached = nearest.prediction.lift.motion.box_position[-1]
    assert 0.75 < reached[2] < high.end[2]
    assert np.arctan2(reached[1], reached[0]) == pytest.approx(np.pi / 4.0, abs=1e-2)


def test_too_heavy_a_box_at_the_side_names_a_limit_and_a_mass(planner, subject) -> None:
    planned = planner.plan(subject, replace(TASK, box_mass=90.0))
    assert planned.report.status is SolveStatus.PREDICTOR_INFEASIBLE
    assert 'breaks first' in planned.report.message
    assert 'kg instead of 90.00 kg' in planned.report.message
    nearest = planned.prediction.nearest.prediction
    assert nearest.report.ok
    assert 5.0 < nearest.box_mass < 90.0
