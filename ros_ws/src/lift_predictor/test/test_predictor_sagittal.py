# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Angles of the sagittal model from a motion, wherever the person stands and looks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from human_model.frames import matrix_from_quaternion, quaternion_from_matrix
from human_model.motion import BodyMotion
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.plane import SagittalPlane, sagittal_motion


def turned(motion: BodyMotion, heading: float, forward: float, left: float) -> BodyMotion:
    """Return the same motion somewhere else in the laboratory."""
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    shift = turn @ np.array([forward, left, 0.0])
    return replace(
        motion,
        points=motion.points @ turn.T + shift,
        box_position=motion.box_position @ turn.T + shift,
        ground_force=motion.ground_force @ turn.T,
        frames=quaternion_from_matrix(turn @ matrix_from_quaternion(motion.frames)),
    )


@settings(max_examples=10, deadline=None)
@given(heading=st.floats(-3.0, 3.0), forward=st.floats(-2.0, 2.0), left=st.floats(-2.0, 2.0))
def test_recovers_the_coordinates_from_the_points(
    make_lift, person, heading: float, forward: float, left: float
) -> None:
    motion = make_lift(7.0).window
    moved = turned(motion, heading, forward, left)
    plane = SagittalPlane.of(moved)
    assert plane.heading == pytest.approx(heading, abs=1e-9)
    assert plane.lateral == pytest.approx(left, abs=1e-9)
    seen = sagittal_motion(moved, float(motion.time[0]), person.neutral, plane)
    for column, joint in enumerate(JOINTS):
        np.testing.assert_allclose(seen.q[:, column], motion.coordinate(joint), atol=1e-7)
    np.testing.assert_allclose(seen.side_difference, 0.0, atol=1e-7)
    np.testing.assert_allclose(seen.grip[:, 0], motion.point('hand_r')[:, 0] + forward, atol=1e-9)
    np.testing.assert_allclose(
        seen.ground_force[:, 1], motion.ground_force[:, :, 2].sum(axis=1), atol=1e-9
    )
    at = plane.to_world(np.zeros(3))
    np.testing.assert_allclose(at[:2], plane.rotation()[:2, 1] * left, atol=1e-9)


def test_rates_are_those_of_the_recording(make_lift, person) -> None:
    motion = make_lift(7.0).window
    seen = sagittal_motion(motion, 0.0, person.neutral, SagittalPlane.of(motion))
    for column, joint in enumerate(JOINTS):
        at = motion.coordinates.index(joint)
        np.testing.assert_allclose(seen.dq[:, column], motion.velocity[:, at], atol=5e-3)
        np.testing.assert_allclose(seen.ddq[5:-5, column], motion.acceleration[5:-5, at], atol=0.5)


def test_averages_the_sides(make_lift, person) -> None:
    """Both knees moved apart by the same distance: the mean angle hardly moves, the sides do."""
    motion = make_lift(7.0).window
    points = motion.points.copy()
    for side, sign in (('r', 1.0), ('l', -1.0)):
        points[:, motion.point_names.index(f'knee_{side}'), 0] += sign * 0.01
    apart = replace(motion, points=points)
    plane = SagittalPlane.of(motion)
    before, after = (sagittal_motion(m, 0.0, person.neutral, plane) for m in (motion, apart))
    assert np.abs(after.q - before.q).max() < 0.005
    knee = JOINTS.index('knee_angle')
    assert after.side_difference[:, knee].min() > 0.03


def test_refuses_feet_without_direction(make_lift) -> None:
    motion = make_lift(7.0).window
    points = motion.points.copy()
    for side in 'rl':
        toe, heel = (motion.point_names.index(f'{name}_{side}') for name in ('toe', 'heel'))
        points[:, toe] = points[:, heel]
    with pytest.raises(TaskError, match='heel and toe points coincide'):
        SagittalPlane.of(replace(motion, points=points))


def test_refuses_too_few_samples(make_lift, person) -> None:
    motion = make_lift(7.0).window[:5]
    with pytest.raises(TaskError, match='5 samples'):
        sagittal_motion(motion, 0.0, person.neutral, SagittalPlane.of(motion))
