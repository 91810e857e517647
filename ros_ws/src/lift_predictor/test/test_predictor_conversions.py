# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of predictions: what a reader gets from the message alone."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from geometry_msgs.msg import Point
from lifting_interfaces.msg import SolveReport, Task

from human_model.exceptions import BoxError
from human_model.task import Box
from lift_predictor import conversions
from lift_predictor.core.models.sagittal.verify import TOLERANCE

UNKNOWN = Point(x=np.nan, y=np.nan, z=np.nan)


def task(**fields) -> Task:
    places = {'box_start': UNKNOWN, 'box_end': UNKNOWN}
    return Task(**(places | {'box_mass': 7.0, 'box_size': [0.238, 0.305, 0.127]} | fields))


def test_box_of_a_task() -> None:
    box = conversions.box_from_msg(task(box_end=Point(x=0.5, y=0.1, z=0.9)), 7.0)
    assert (box.mass, box.size, box.start) == (7.0, (0.238, 0.305, 0.127), None)
    np.testing.assert_allclose(box.end, [0.5, 0.1, 0.9])
    assert conversions.box_from_msg(task(), 0.0).size == (0.0, 0.0, 0.0)


def test_half_known_place_of_the_box_is_refused() -> None:
    with pytest.raises(BoxError, match=r'box\.end'):
        conversions.box_from_msg(task(box_end=Point(x=0.5, y=np.nan, z=0.9)), 7.0)


def test_prediction_can_be_read_alone(outcome, subject) -> None:
    result = outcome(7.0)
    message = conversions.prediction_to_msg(result.predicted, result.lift, subject)
    n, joints = len(message.motion.time_from_start), len(message.torque_names)
    assert (message.lift_id, message.subject, message.box_mass) == ('lift_001', 'thesis', 7.0)
    assert message.header.frame_id == message.motion.header.frame_id == 'world'
    assert message.duration == pytest.approx(1.2)
    assert n == 121 and joints == 7
    for field in (message.torque, message.torque_lower, message.torque_upper):
        assert len(field) == n * joints
    torque = np.asarray(message.torque).reshape(n, joints)
    np.testing.assert_array_equal(torque, result.predicted.torque)
    assert len(message.zero_moment_point) == n
    assert message.support_rear < min(message.zero_moment_point)
    assert len(message.verified_violation) == len(TOLERANCE)
    assert set(message.verified_names) == set(TOLERANCE)
    assert all('[' in name for name in message.verified_names)
    assert message.report.status == SolveReport.OK
    assert message.report.solve_time > 0.0


def test_failed_prediction_carries_no_data(predictor, make_lift, subject) -> None:
    lift = make_lift(7.0)
    box = Box(7.0, (0.238, 0.305, 0.127), end=np.array([1.6, 0.0, 1.0]))
    failed = predictor.predict(subject, lift, box)
    message = conversions.prediction_to_msg(failed, lift, subject)
    assert message.report.status == SolveReport.PREDICTOR_UNREACHABLE
    assert 'hand position' in message.report.message
    assert not (
        message.motion.position.size + message.torque.size + message.zero_moment_point.size
    )
    assert np.isnan(message.support_rear)


def test_trajectory_has_positions_rates_and_efforts(outcome) -> None:
    result = outcome(7.0)
    message = conversions.trajectory_to_msg(result.predicted)
    motion = result.predicted.lift.motion
    assert tuple(message.joint_names) == motion.coordinates
    point = message.points[50]
    np.testing.assert_array_equal(point.positions, motion.position[50])
    np.testing.assert_array_equal(point.accelerations, motion.acceleration[50])
    time = point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec
    assert time == pytest.approx(motion.time[50] - motion.time[0], abs=1e-6)
    knee = message.joint_names.index('knee_angle')
    row = result.predicted.torque_names.index('knee_angle')
    assert point.effort[knee] == result.predicted.torque[50, row]


def test_comparison_message(outcome) -> None:
    result = outcome(12.0)
    message = conversions.comparison_to_msg(result.comparison, result.predicted, result.lift)
    assert list(message.joint_names) == ['spine', 'shoulder', 'elbow', 'hip', 'knee', 'ankle']
    assert len(message.joint_rmse) == len(message.joint_pearson) == 6
    assert len(message.torque) == len(message.time_from_start) * len(message.torque_names)
    assert 0.0 < message.predicted_effort < message.measured_effort
