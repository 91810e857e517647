# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The node in this process, talked to over its topics and services."""

import numpy as np
import pytest

rclpy = pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from lifecycle_msgs.msg import Transition  # noqa: E402
from lifting_interfaces.msg import (  # noqa: E402
    AlarmEvent,
    BodyMotion,
    JointTorques,
    MeasuredLift,
    MuscleAnalysis,
    PredictedLift,
    RiskAssessment,
    SolveReport,
    SpineLoad,
    Task,
)
from lifting_interfaces.srv import AcknowledgeAlarm, ResetAlarm, ShelveAlarm  # noqa: E402
from rclpy.serialization import serialize_message  # noqa: E402

from lifting_messages.exceptions import ParameterError  # noqa: E402
from lifting_messages.stamps import to_seconds, to_stamp  # noqa: E402

HIGH, HIGH_HIGH = 'l5_s1_compression_high', 'l5_s1_compression_high_high'
PATIENCE = 20.0


def block(kind, source, **fields):
    time_from_start = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    message = kind(
        source=source,
        lift_id='lift_001',
        time_from_start=time_from_start,
        status=[0] * 6,
        **fields,
    )
    message.header.stamp = to_stamp(10.0)
    return message


def send_analysis(station, source, compression):
    station.send(
        'spine_load',
        block(
            SpineLoad, source, compression=[compression, *[0.0] * 5], anterior_shear=[300.0] * 6
        ),
    )
    station.send(
        'joint_torques',
        block(
            JointTorques,
            source,
            joint_names='hip',
            torque=[10.0, 50.0, *[10.0] * 4],
            torque_lower=[-100.0] * 6,
            torque_upper=[100.0] * 6,
        ),
    )
    station.send(
        'muscle_analysis',
        block(MuscleAnalysis, source, muscle_names='MF_m1s_r', activation=[0.2] * 6),
    )


def send_measured_lift(station):
    points = np.array(
        [
            [[0.4, -0.1, h], [0.4, 0.1, h], [0.0, -0.1, 0.1], [0.0, 0.1, 0.1]]
            for h in (0.3, 0.6, 0.9)
        ]
    )
    motion = BodyMotion(
        time_from_start=[0.0, 0.5, 1.0],
        points=points.ravel().tolist(),
        point_names='hand_r\nhand_l\nankle_r\nankle_l',
    )
    motion.header.stamp = to_stamp(10.0)
    lift = MeasuredLift(lift_id='lift_001', duration=1.0, motion=motion)
    lift.header.stamp = to_stamp(10.0)
    station.send('measured_lift', lift)


def test_alarm_is_raised_acknowledged_and_reset(station, monkeypatch):
    station.bring_up()
    station.live(100.0, [600.0] * 50 + [7000.0] * 50 + [600.0] * 80)
    station.until(lambda: len(station.alarms) == 4, 'two alarms raised and returned')
    raised = {message.alarm_id: message for message in station.alarms[:2]}
    assert set(raised) == {HIGH, HIGH_HIGH}
    assert to_seconds(raised[HIGH].header.stamp) == pytest.approx(100.55)
    assert raised[HIGH].filter_delay == 0.045
    assert raised[HIGH].station == 'test_test_alarm_is_raised_acknowledged_and_reset'
    request = {'alarm_id': HIGH_HIGH, 'operator_id': 'panel 1'}
    refused = station.call(ResetAlarm, 'reset_alarm', ResetAlarm.Request(**request))
    assert refused.error_code == ResetAlarm.Response.NOT_IN_THIS_STATE
    assert 'LATCHED_UNACKNOWLEDGED' in refused.error_message
    done = station.call(AcknowledgeAlarm, 'acknowledge_alarm', AcknowledgeAlarm.Request(**request))
    assert done.error_code == AcknowledgeAlarm.Response.NONE
    assert station.call(ResetAlarm, 'reset_alarm', ResetAlarm.Request(**request)).error_code == 0
    station.until(lambda: len(station.alarms) == 6, 'acknowledged and reset')
    assert station.alarms[-1].state == AlarmEvent.NORMAL
    unknown = station.call(
        ShelveAlarm,
        'shelve_alarm',
        ShelveAlarm.Request(alarm_id='none', operator_id='panel 1', duration=5.0),
    )
    assert unknown.error_code == ShelveAlarm.Response.UNKNOWN_ALARM
    long = station.call(
        ShelveAlarm,
        'shelve_alarm',
        ShelveAlarm.Request(alarm_id=HIGH, operator_id='panel 1', duration=1e9),
    )
    assert long.error_code == ShelveAlarm.Response.DURATION_REFUSED


def test_lift_is_assessed_once_with_both_parts(station):
    station.bring_up()
    send_measured_lift(station)
    send_analysis(station, SpineLoad.MEASURED, 3600.0)
    send_analysis(station, SpineLoad.PREDICTED, 2400.0)
    station.until(lambda: station.assessments, 'assessment')
    result = station.assessments[0]
    assert result.avoidable_compression == pytest.approx(1200.0)
    assert result.zone == RiskAssessment.ZONE_ACTION
    assert result.torque_index_joints == ['hip']
    assert result.torque_index_measured[0] == pytest.approx(0.5)
    assert result.activation_index == pytest.approx(0.2)
    assert result.lifting_index > 0.0
    send_analysis(station, SpineLoad.PREDICTED, 2400.0)
    station.until(
        lambda: station.node.station.counts['late parts of assessed lifts'] == 3, 'late parts'
    )
    assert len(station.assessments) == 1
    assert station.alarms == []  # whole lifts are assessed, alarms come from the live stream


def test_failed_prediction_is_not_waited_for(station):
    station.bring_up()
    send_measured_lift(station)
    send_analysis(station, SpineLoad.MEASURED, 3000.0)
    failed = PredictedLift(
        lift_id='lift_001',
        report=SolveReport(status=SolveReport.PREDICTOR_INFEASIBLE, message='box too heavy'),
    )
    station.send('predicted_lift', failed)
    station.until(lambda: station.assessments, 'assessment')
    assert np.isnan(station.assessments[0].avoidable_compression)
    assert 'box too heavy' in station.assessments[0].summary


@pytest.mark.parametrize('station', [{'result_wait': 1.0}], indirect=True)
def test_silent_predictor_is_waited_for_only_so_long(station):
    station.bring_up()
    send_measured_lift(station)
    send_analysis(station, SpineLoad.MEASURED, 3000.0)
    station.until(lambda: station.assessments, 'assessment')
    assert 'none came within 1 s' in station.assessments[0].summary


def test_bad_messages_are_counted_and_the_node_goes_on(station):
    station.bring_up()
    station.send(
        'spine_load',
        SpineLoad(
            source=SpineLoad.LIVE,
            time_from_start=[0.0],
            compression=[],
            anterior_shear=[0.0],
            status=[0],
        ),
    )
    station.until(lambda: station.node.station.counts['errors'] == 1, 'first error')
    assert 'SpineLoad.compression' in station.node.station.last_error
    station.send('task', Task(task_id='bad', coupling=Task.COUPLING_GOOD, box_mass=-1.0))
    station.until(lambda: station.node.station.counts['errors'] == 2, 'second error')
    assert 'box_mass' in station.node.station.last_error
    torques = JointTorques(source=JointTorques.LIVE, joint_names='knee', torque=[1.0])
    station.send('joint_torques', serialize_message(torques).replace(b'knee', b'\xff' * 4))
    station.until(lambda: station.node.station.counts['errors'] == 3, 'third error')
    assert 'JointTorques' in station.node.station.last_error
    station.live(0.0, [7000.0] * 50, status=302)
    station.live(10.0, [7000.0] * 50)
    station.until(lambda: len(station.alarms) == 2, 'alarms from good samples')
    assert station.node.station.monitor.counts['spine_load'].unsolved == 50


def test_node_can_be_cleaned_up_and_configured_again(station):
    station.bring_up()
    assert station.transition(Transition.TRANSITION_DEACTIVATE)
    station.live(10.0, [7000.0] * 50)
    station.until(
        lambda: station.node.station.counts['samples while not active'] == 5, 'dropped samples'
    )
    assert station.transition(Transition.TRANSITION_CLEANUP)
    assert station.transition(Transition.TRANSITION_CONFIGURE)
    assert station.transition(Transition.TRANSITION_ACTIVATE)
    # Person and task are latched: the new subscriptions get them again.
    station.until(lambda: station.node.station.monitor.assignment is not None, 'configuration')
    assert station.alarms == []
    station.live(20.0, [7000.0] * 50)
    station.until(lambda: len(station.alarms) == 2, 'alarms after the second configuration')


def test_bad_parameter_is_refused(new_station):
    try:
        with pytest.raises(ParameterError, match='max_gap'):
            new_station('test_bad_parameter', {'max_gap': -1.0})
    finally:
        rclpy.try_shutdown()
