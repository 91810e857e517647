# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The task made of a recorded lift, and the lifts that cannot be one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from human_model.exceptions import BoxError
from human_model.motion import Lift
from human_model.task import Box
from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.models.sagittal.kinematics import chain_positions, reach
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.task import PLACE_ALLOWANCE, build_task
from lift_predictor.core.options import POSTURE_TOLERANCE

BOX_SIZE = (0.238, 0.305, 0.127)

BOX = Box(mass=7.0, size=BOX_SIZE)


def with_points(lift: Lift, change) -> Lift:
    points = lift.motion.points.copy()
    change(points, lift.motion.point_names.index)
    return replace(lift, motion=replace(lift.motion, points=points))


def test_takes_feet_hands_time_and_postures_from_the_recording(make_lift, person) -> None:
    lift = make_lift(7.0)
    task = build_task(person, lift, BOX)
    motion = lift.motion
    assert task.parameters.duration == pytest.approx(1.2)
    assert task.parameters.box_mass == 7.0
    np.testing.assert_allclose(task.parameters.box_half, (0.119, 0.0635))
    np.testing.assert_allclose(
        task.parameters.ankle, motion.point('ankle_r')[0, [0, 2]], atol=1e-12
    )
    np.testing.assert_allclose(
        task.parameters.support, [motion.point(name)[0, 0] for name in ('heel_r', 'toe_r')]
    )
    np.testing.assert_allclose(task.parameters.ground_height, 0.0, atol=1e-9)
    np.testing.assert_allclose(task.bounds.hand, motion.point('hand_r')[[0, -1]][:, [0, 2]])
    for row, sample in enumerate((0, len(motion) // 2, -1)):
        for column, joint in enumerate(JOINTS):
            q = motion.coordinate(joint)[sample]
            limits = person.angle_lower[column], person.angle_upper[column]
            low, high = np.clip((q - 0.15, q + 0.15), *limits)
            assert task.bounds.posture_lower[row, column] == pytest.approx(low)
            assert task.bounds.posture_upper[row, column] == pytest.approx(high)
    assert POSTURE_TOLERANCE == 0.15
    grips = chain_positions(task.ends, task.parameters).joints['hand']
    np.testing.assert_allclose(grips, task.bounds.hand, atol=1e-4)


def test_box_hangs_where_it_was_tracked(make_lift, person) -> None:
    lift = make_lift(7.0)
    lower = replace(lift.motion, box_position=lift.motion.box_position - [0.0, 0.0, 0.05])
    task = build_task(person, replace(lift, motion=lower), BOX)
    np.testing.assert_allclose(task.parameters.box_from_hand, [0.0, -0.05], atol=1e-12)
    untracked = replace(lift.motion, box_position=np.full((len(lift.motion), 3), np.nan))
    task = build_task(person, replace(lift, motion=untracked), BOX)
    np.testing.assert_array_equal(task.parameters.box_from_hand, [0.0, 0.0])


def test_places_of_the_box_may_be_given(make_lift, person) -> None:
    lift = make_lift(7.0)
    end = lift.motion.box_position[-1] + [0.02, 0.0, -0.01]
    task = build_task(person, lift, replace(BOX, end=end))
    np.testing.assert_allclose(task.bounds.hand[1], end[[0, 2]], atol=1e-12)
    np.testing.assert_allclose(task.bounds.hand[0], lift.motion.box_position[0, [0, 2]])


def test_circles_never_exclude_the_recorded_lift(make_lift, person) -> None:
    lift = make_lift(7.0)
    task = build_task(person, lift, replace(BOX, size=(0.40, 0.305, 0.30)))
    assert task.notes
    assert any('collision circles were reduced' in note for note in task.notes)
    gaps = chain_positions(task.measured.q, task.parameters, task.measured.grip).gaps
    assert gaps.min() > -1e-9
    assert np.all(task.parameters.circle[:, 2] <= person.circle[:, 2])


def test_without_a_box_there_is_no_collision(make_lift, person) -> None:
    task = build_task(person, make_lift(0.0), Box(mass=0.0))
    assert not task.parameters.circle.any()


def test_unreachable_target_names_end_distance_and_joints(make_lift, person) -> None:
    far = np.array([1.5, 0.0, 1.0])
    with pytest.raises(UnreachableError, match=r'at the end: the grip stays \d+ mm') as error:
        build_task(person, make_lift(7.0), replace(BOX, end=far))
    assert 'arm_flex' in str(error.value)


def test_turned_shoulders_are_asymmetric(make_lift, person) -> None:
    def turn(points, index) -> None:
        for name in ('shoulder_r', 'elbow_r', 'hand_r'):
            points[:, index(name), 0] += 0.10

    with pytest.raises(TaskError, match='line of the shoulders'):
        build_task(person, with_points(make_lift(7.0), turn), BOX)


def test_box_set_down_aside_is_asymmetric(make_lift, person) -> None:
    lift = make_lift(7.0)
    ramp = np.linspace(0.0, 0.3, len(lift.motion))

    def aside(points, index) -> None:
        for side in 'rl':
            points[:, index(f'hand_{side}'), 1] += ramp

    with pytest.raises(TaskError, match='the grip, seen from the ankles'):
        build_task(person, with_points(lift, aside), BOX)


def test_one_bent_knee_is_asymmetric(make_lift, person) -> None:
    def bend(points, index) -> None:
        points[:, index('knee_r'), 0] += 0.12

    with pytest.raises(TaskError, match=r'right and left are .* at the start'):
        build_task(person, with_points(make_lift(7.0), bend), BOX)


def test_a_step_is_no_lift_with_fixed_feet(make_lift, person) -> None:
    lift = make_lift(7.0)
    walk = np.linspace(0.0, 0.4, len(lift.motion))

    def step(points, index) -> None:
        for name in ('heel_r', 'toe_r'):
            points[:, index(name), 0] += walk

    with pytest.raises(TaskError, match=r'the right foot moves 0\.40 m'):
        build_task(person, with_points(lift, step), BOX)


def test_posture_beyond_the_joint_limits_is_named(make_lift, person) -> None:
    stiff = replace(person, angle_upper=np.where(np.arange(6) == 4, 0.5, person.angle_upper))
    with pytest.raises(TaskError, match=r'knee_angle at the start .* outside its limits'):
        build_task(stiff, make_lift(7.0), BOX)


@pytest.mark.parametrize(
    ('fields', 'words'),
    [
        ({'mass': -1.0}, r'box\.mass = -1'),
        ({'mass': np.nan}, r'box\.mass = nan'),
        ({'mass': 7.0, 'size': (np.inf, 0.0, 0.0)}, r'box\.size = \(inf'),
        ({'mass': 7.0, 'end': np.array([1.0, 0.0, np.nan])}, r'box\.end = '),
    ],
)
def test_bad_box_is_named(fields: dict, words: str) -> None:
    with pytest.raises(BoxError, match=words):
        Box(**fields)


def test_reach_finds_the_nearest_posture(parameters, person) -> None:
    rng = np.random.default_rng(4)
    low, high = np.maximum(person.angle_lower, -1.0), np.minimum(person.angle_upper, 1.5)
    for _ in range(5):
        posture = rng.uniform(low, high)
        grip = chain_positions(posture, parameters).joints['hand'][0]
        if not chain_positions(posture, parameters).gaps.min() > 0.0:
            continue
        found, distance = reach(grip, posture, low, high, parameters)
        assert distance < 1e-4
        assert np.all((found >= low) & (found <= high))


def test_the_box_is_not_carried_below_the_lower_of_its_places(person, make_lift) -> None:
    lift = make_lift(7.0)
    task = build_task(person, lift, Box(7.0, BOX_SIZE))
    lower = lift.motion.box_position[[0, -1], 2].min()
    assert task.parameters.lowest_grip == pytest.approx(lower - PLACE_ALLOWANCE, abs=1e-6)
    place = np.array([*lift.motion.box_position[0, :2], lower + 0.05])
    higher = build_task(person, lift, Box(7.0, BOX_SIZE, start=place))
    assert higher.parameters.lowest_grip == pytest.approx(lower + 0.05 - PLACE_ALLOWANCE, abs=1e-6)


def test_empty_hands_may_go_down_to_the_floor(person, make_lift) -> None:
    task = build_task(person, make_lift(0.0), Box(0.0))
    assert task.parameters.lowest_grip == pytest.approx(task.parameters.ground_height)
