# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages to core types and back, values and refusals."""

import math

import numpy as np
import pytest

pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from lifting_interfaces.msg import (
    AlarmEvent,
    BodyMotion,
    JointTorques,
    MeasuredLift,
    MuscleAnalysis,
    SpineLoad,
    Subject,
    Task,
)
from rclpy.serialization import serialize_message

from human_model.task import Coupling
from injury_monitor import conversions
from injury_monitor.core.alarm import AlarmState
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.loads import LiftLoads
from injury_monitor.core.monitor import InjuryMonitor
from lifting_messages import decode
from lifting_messages.stamps import to_seconds, to_stamp

SUBJECT = Subject(pseudonym='P01', mass=63.5)
TASK = Task(
    task_id='symmetric_12kg',
    box_mass=12.0,
    coupling=Task.COUPLING_FAIR,
    lifts_per_minute=1.0,
    lifts_per_day=500.0,
    duration_hours=2.0,
)


def stamped(message, seconds):
    message.header.stamp = to_stamp(seconds)
    return message


def measured_lift():
    """Return a lift from 10 to 11 s whose hands rise from 0.3 to 0.9 m, 0.4 m before the feet."""
    time = np.arange(0.0, 1.21, 0.1)
    names = 'hand_r\nhand_l\nankle_r\nankle_l'
    points = np.zeros((len(time), 4, 3))
    points[:, :2, 0] = 0.4
    points[:, 0, 1], points[:, 1, 1] = -0.15, 0.15
    points[:, :2, 2] = 0.3 + 0.6 * np.clip(time, 0.0, 1.0)[:, None]
    points[:, 2:, 1] = (-0.1, 0.1)
    motion = stamped(
        BodyMotion(time_from_start=list(time), point_names=names, points=points.ravel().tolist()),
        10.0,
    )
    return stamped(MeasuredLift(lift_id='lift_001', duration=1.0, motion=motion), 10.0)


def test_assignment_has_everything_and_a_recording_name_of_its_own():
    found = conversions.assignment_from_msg(SUBJECT, stamped(TASK, 12.5))
    assert (found.subject, found.body_mass, found.box_mass) == ('P01', 63.5, 12.0)
    assert (found.work.lifts_per_day, found.work.coupling) == (500.0, Coupling.FAIR)
    assert found.recording == 'symmetric_12kg@12.500'
    with pytest.raises(InvalidInputError, match=r'Task\.coupling'):
        conversions.assignment_from_msg(SUBJECT, Task(task_id='t', coupling=0))


def test_spine_load_with_status_per_sample():
    message = stamped(
        SpineLoad(
            source=SpineLoad.MEASURED,
            time_from_start=[0.0, 0.01],
            compression=[1.0, 2.0],
            anterior_shear=[3.0, 4.0],
            status=[0, 302],
        ),
        7.0,
    )
    series = conversions.spine_from_msg(message)
    np.testing.assert_allclose(series.time, [7.0, 7.01])
    np.testing.assert_array_equal(series.solved, [True, False])
    assert conversions.lift_source(message) == 'measured'
    message.compression = [1.0]
    with pytest.raises(InvalidInputError, match=r'SpineLoad\.compression'):
        conversions.spine_from_msg(message)
    message.status = [0]
    with pytest.raises(InvalidInputError, match=r'SpineLoad\.status'):
        conversions.spine_from_msg(message)
    message.source = 9
    with pytest.raises(InvalidInputError, match=r'SpineLoad\.source'):
        conversions.lift_source(message)


def test_row_major_blocks_keep_samples_and_columns_apart():
    torques = conversions.torques_from_msg(
        JointTorques(
            time_from_start=[0.0, 0.1],
            joint_names='hip\nknee',
            torque=[1.0, 2.0, 3.0, 4.0],
            torque_lower=[-1.0] * 4,
            torque_upper=[9.0] * 4,
            status=[0, 0],
        )
    )
    np.testing.assert_array_equal(torques.torque, [[1.0, 2.0], [3.0, 4.0]])
    active = conversions.activations_from_msg(
        MuscleAnalysis(
            time_from_start=[0.0],
            muscle_names='a\nb\nc',
            activation=[0.1, 0.2, 0.3],
            status=[0],
        )
    )
    np.testing.assert_array_equal(active.activation, [[0.1, 0.2, 0.3]])


@pytest.mark.parametrize(
    ('message', 'read'),
    [
        (
            SpineLoad(
                source=SpineLoad.MEASURED,
                time_from_start=[0.0, 0.1],
                compression=[1.0, 2.0],
                anterior_shear=[3.0, 4.0],
                status=[0, 302],
            ),
            conversions.spine_from_msg,
        ),
        (
            JointTorques(
                source=JointTorques.PREDICTED,
                time_from_start=[0.0],
                joint_names='a\nb',
                torque=[1.0, 2.0],
                torque_lower=[-1.0, math.nan],
                torque_upper=[5.0, math.nan],
                status=[0],
            ),
            conversions.torques_from_msg,
        ),
        (
            MuscleAnalysis(
                source=MuscleAnalysis.LIVE,
                time_from_start=[0.0],
                muscle_names='a\nb',
                activation=[0.1, 0.2],
                force=[10.0, 20.0],
                status=[0],
            ),
            conversions.activations_from_msg,
        ),
    ],
)
def test_what_the_node_sees_of_a_message_is_what_is_in_it(message, read):
    stamped(message, 1_763_000_000.25).lift_id = 'lift_001'
    kind = type(message)
    view = decode(serialize_message(message), kind.__name__)
    assert view.lift_id == 'lift_001'
    assert conversions.lift_source(view) == conversions.lift_source(message)
    seen, expected = vars(read(view)), vars(read(message))
    for name, value in expected.items():
        np.testing.assert_array_equal(seen[name], value)
    view.status = view.status[:0]
    with pytest.raises(InvalidInputError, match=rf'{kind.__name__}\.status'):
        read(view)


def test_ends_of_a_lift_are_taken_at_its_start_and_end():
    ends = conversions.ends_from_msg(measured_lift())
    np.testing.assert_allclose(ends.origin.grip, [0.4, 0.0, 0.3], atol=1e-12)
    np.testing.assert_allclose(ends.destination.grip, [0.4, 0.0, 0.9], atol=1e-12)
    np.testing.assert_allclose(ends.origin.ankles, [[0.0, -0.1, 0.0], [0.0, 0.1, 0.0]])
    lacking = measured_lift()
    lacking.motion.point_names = 'hand_r\nx\nankle_r\nankle_l'
    with pytest.raises(InvalidInputError, match='hand_l'):
        conversions.ends_from_msg(lacking)
    short = measured_lift()
    short.header.stamp = to_stamp(20.0)
    with pytest.raises(InvalidInputError, match='duration'):
        conversions.ends_from_msg(short)


def test_alarm_message_carries_value_limit_margin_and_codes_of_the_interface():
    monitor = InjuryMonitor('cell_1')
    monitor.configure(conversions.assignment_from_msg(SUBJECT, TASK))
    events = []
    for k in range(10):
        events += monitor.update_spine_load(5.0 + k / 100.0, 4000.0, 0.0, True, 'lift_001')
    message = conversions.alarm_to_msg(events[0], 0.04)
    assert message.state == AlarmEvent.UNACKNOWLEDGED_ACTIVE
    assert message.previous_state == AlarmEvent.NORMAL
    assert (message.value, message.limit, message.margin) == (4000.0, 3400.0, -600.0)
    assert (
        to_seconds(message.header.stamp) == to_seconds(message.stamp_raised) == pytest.approx(5.05)
    )
    assert to_seconds(message.stamp_returned) == 0.0
    assert (message.filter_delay, message.lift_id, message.station) == (0.04, 'lift_001', 'cell_1')
    assert 'P01' not in repr(message)


@pytest.mark.parametrize('state', list(AlarmState))
def test_state_codes_agree_with_the_interface(state):
    assert getattr(AlarmEvent, state.name) == int(state)


def test_assessment_message_stands_alone():
    monitor = InjuryMonitor()
    monitor.configure(conversions.assignment_from_msg(SUBJECT, TASK))
    time = 10.0 + np.arange(11) / 10.0
    bump = np.sin(np.pi * (time - 10.0))
    good = np.ones(11, bool)
    measured = LiftLoads('lift_001', 10.0, time, 3600.0 * bump, 500.0 * bump, good)
    predicted = LiftLoads('lift_001', 10.0, time, 2400.0 * bump, 400.0 * bump, good)
    ends = conversions.ends_from_msg(measured_lift())
    message = conversions.assessment_to_msg(monitor.assess(measured, predicted, ends), 10.0)
    n = len(message.criterion)
    columns = ('source', 'value', 'limit', 'margin', 'unit', 'limit_source', 'time_from_start')
    assert n == 6 and all(len(getattr(message, name)) == n for name in columns)
    np.testing.assert_allclose(np.array(message.limit) - np.array(message.value), message.margin)
    assert message.avoidable_compression == pytest.approx(1200.0)
    assert (message.zone, message.subject) == (message.ZONE_ACTION, 'P01')
    assert message.lifting_index == pytest.approx(12.0 / (23.0 * np.prod(message.multipliers)))
    assert message.recommended_weight_limit * message.lifting_index == pytest.approx(12.0)
    assert message.limiting_multiplier == 'HM'
    assert math.isnan(message.activation_index) and message.torque_index_joints == []
    assert 'no joint torques' in message.summary
