# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The node in a process of its own, talked to over its topics and services."""

import os
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

rclpy = pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from diagnostic_msgs.msg import DiagnosticArray  # noqa: E402
from geometry_msgs.msg import WrenchStamped  # noqa: E402
from lifecycle_msgs.msg import Transition  # noqa: E402
from lifecycle_msgs.srv import ChangeState  # noqa: E402
from lifting_interfaces.msg import (  # noqa: E402
    BodyMotion,
    JointTorques,
    MeasuredLift,
    MuscleAnalysis,
    PredictedLift,
    SolveReport,
    SpineLoad,
    Subject,
    Task,
)
from rclpy.executors import SingleThreadedExecutor  # noqa: E402

from human_model.motion import Lift  # noqa: E402
from human_model.report import SolveReport as Report  # noqa: E402
from human_model.skeletons import Skeleton2D, Skeleton3D  # noqa: E402
from human_model.subject import Subject as Person  # noqa: E402
from lifting_messages import conversions, encode  # noqa: E402
from lifting_messages.names import split  # noqa: E402
from lifting_messages.stamps import to_seconds  # noqa: E402
from lifting_node import qos  # noqa: E402
from lifting_node.ros_messages import to_ros  # noqa: E402

PERSON = Person('p01', 'male', 63.5, 1.69, 25)
NAMESPACE = 'muscle_node_test'
PATIENCE = 60.0
OUTPUTS = {
    'muscle_analysis': MuscleAnalysis,
    'spine_load': SpineLoad,
    'joint_torques': JointTorques,
    'l5_s1/reaction': WrenchStamped,
}
INPUTS = {
    'subject': (Subject, qos.LATCHED),
    'task': (Task, qos.LATCHED),
    'body_motion': (BodyMotion, qos.FRAMES),
    'measured_lift': (MeasuredLift, qos.RESULTS),
    'predicted_lift': (PredictedLift, qos.RESULTS),
}


def standing(skeleton, time, box_weight=0.0):
    """Stand upright, the weight of body and box under the middle of the ankles."""
    n = len(time)
    q = np.tile(skeleton.standing(), (n, 1))
    still = np.zeros_like(q)
    motion = skeleton.body_motion(time, q, still, still)
    ground, hands = np.zeros((n, 2, 3)), np.zeros((n, 2, 3))
    ground[:, :, 2] = 0.5 * (PERSON.mass * 9.80665 + box_weight)
    hands[:, :, 2] = -0.5 * box_weight
    cop = np.stack([motion.point('mtp_r'), motion.point('mtp_l')], axis=1)
    return replace(motion, ground_force=ground, hand_force=hands, centre_of_pressure=cop)


class Station:
    """The node's process and a client beside it."""

    def __init__(self):
        command = [
            sys.executable,
            '-m',
            'muscle_analyzer.muscle_analyzer_node',
            '--ros-args',
            '-r',
            f'__ns:=/{NAMESPACE}',
            '-p',
            'disc_frame:=vertebral',
        ]
        self.process = subprocess.Popen(command, env=dict(os.environ))
        rclpy.init()
        self.client = rclpy.create_node('client', namespace=NAMESPACE)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.client)
        self.got = {topic: [] for topic in OUTPUTS}
        for topic, kind in OUTPUTS.items():
            self.client.create_subscription(kind, topic, self.got[topic].append, qos.FRAMES)
        self.health = {}
        self.client.create_subscription(DiagnosticArray, '/diagnostics', self._keep, 10)
        self.publishers = {
            topic: self.client.create_publisher(kind, topic, profile)
            for topic, (kind, profile) in INPUTS.items()
        }

    def _keep(self, message):
        for status in message.status:
            if status.name == f'/{NAMESPACE}/muscle_analyzer':
                self.health = {item.key: int(item.value) for item in status.values}
                self.last_error = status.message

    def until(self, condition, what):
        """Spin until a condition holds; fail by name when patience is over."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert self.process.poll() is None, f'the node ended while waiting for {what}'
            assert time.monotonic() < deadline, f'{what} did not happen in {PATIENCE} s'
            self.executor.spin_once(timeout_sec=0.05)

    def transition(self, number):
        """Ask for a lifecycle transition."""
        service = self.client.create_client(ChangeState, 'muscle_analyzer/change_state')
        self.until(service.service_is_ready, 'life cycle service')
        future = service.call_async(ChangeState.Request(transition=Transition(id=number)))
        self.until(future.done, f'transition {number}')
        assert future.result().success

    def send(self, topic, message):
        """Publish once there is a reader."""
        publisher = self.publishers[topic]
        self.until(lambda: publisher.get_subscription_count() > 0, f'reader of {topic}')
        publisher.publish(encode(message) if hasattr(message, '__msgtype__') else message)

    def take(self, topic, since, number=1):
        """Wait for messages of a topic with stamps from `since` on; return them, oldest first."""

        def new():
            return [m for m in self.got[topic] if to_seconds(m.header.stamp) > since - 1e-6]

        self.until(lambda: len(new()) >= number, f'{number} of {topic}')
        messages = new()
        self.got[topic].clear()
        assert len(messages) == number
        return messages

    def bring_up(self):
        """Configure and activate the node, enter person and task."""
        self.transition(Transition.TRANSITION_CONFIGURE)
        self.transition(Transition.TRANSITION_ACTIVATE)
        self.until(lambda: all(self.client.count_publishers(topic) for topic in OUTPUTS), 'topics')
        self.send('task', Task(task_id='box', box_mass=10.0))
        self.send('subject', conversions.subject_to_msg(PERSON, 0.0, 'none', 'test'))

    def close(self):
        """Kill the process, whatever it does."""
        self.process.kill()
        self.process.wait(timeout=10.0)
        self.executor.shutdown()
        self.client.destroy_node()
        rclpy.try_shutdown()


@pytest.fixture(scope='module')
def station():
    patch = pytest.MonkeyPatch()
    patch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    made = Station()
    try:
        made.bring_up()
        yield made
    finally:
        made.close()
        patch.undo()


def live(station, motion, status=0):
    quality = replace(
        conversions.MotionQuality.exact(len(motion)), status=np.full(len(motion), status)
    )
    station.send('body_motion', conversions.motion_to_msg(motion, quality))


def measured(lift_id, motion):
    lift = Lift(lift_id, 'measured', motion.time[0], motion.time[-1], 12.0, motion, Report())
    return conversions.lift_to_msg(lift, conversions.MotionQuality.exact(len(motion)), PERSON)


def test_live_sample_gives_all_four_messages(station):
    live(station, standing(Skeleton3D.of(PERSON), [100.25], box_weight=98.0))
    (spine,) = station.take('spine_load', 100.0)
    (muscles,) = station.take('muscle_analysis', 100.0)
    (torques,) = station.take('joint_torques', 100.0)
    (reaction,) = station.take('l5_s1/reaction', 100.0)
    for message in (spine, muscles, torques):
        assert (message.source, message.lift_id) == (SpineLoad.LIVE, '')
        assert list(message.time_from_start) == [0.0]
        assert list(message.status) == [0]
        assert to_seconds(message.header.stamp) == pytest.approx(100.25)
    assert (spine.subject, spine.body_mass, spine.box_mass) == ('p01', 63.5, 10.0)
    assert (spine.header.frame_id, spine.disc_frame) == (f'{NAMESPACE}/l5_s1', 'vertebral')
    # Half of the body and the box stand on the disc, the muscles press as well.
    assert 0.5 * 63.5 * 9.8 < spine.compression[0] < 3000.0
    assert reaction.wrench.force.z == spine.compression[0]
    assert reaction.wrench.force.x == -spine.anterior_shear[0]
    assert reaction.header == spine.header
    assert (len(spine.disc_position), len(spine.disc_orientation)) == (3, 4)
    assert len(muscles.activation) == len(split(muscles.muscle_names)) == 318
    assert len(torques.torque_upper) == len(torques.torque) == len(split(torques.joint_names))
    assert 'knee_angle_r' in split(torques.joint_names)


def test_empty_hands_carry_no_box(station):
    live(station, standing(Skeleton3D.of(PERSON), [101.0]))
    assert station.take('spine_load', 101.0)[0].box_mass == 0.0


@pytest.mark.parametrize(
    ('stamp', 'tracker', 'expected'),
    [(110.0, SolveReport.TRACKER_NO_GROUND_FORCE, SolveReport.MUSCLE_NO_GROUND_FORCE),
     (111.0, SolveReport.TRACKER_MARKERS_SWAPPED, SolveReport.MUSCLE_BAD_INPUT),
     (112.0, 199, SolveReport.MUSCLE_BAD_INPUT)],
)  # fmt: skip
def test_sample_that_the_tracker_marks_is_never_good(station, stamp, tracker, expected):
    live(station, standing(Skeleton3D.of(PERSON), [stamp]), tracker)
    for topic in ('spine_load', 'joint_torques', 'muscle_analysis'):
        assert list(station.take(topic, stamp)[0].status) == [expected]
    live(station, standing(Skeleton3D.of(PERSON), [stamp + 0.5]))
    reaction = station.take('l5_s1/reaction', stamp)[0]
    assert to_seconds(reaction.header.stamp) == pytest.approx(stamp + 0.5)


def test_lifts_are_analysed_with_their_source(station):
    motion = standing(Skeleton3D.of(PERSON), [200.0, 200.01, 200.02])
    station.send('measured_lift', measured('lift_007', motion))
    flat = standing(Skeleton2D.of(PERSON), [200.0, 200.02])
    failed, good = (
        PredictedLift(lift_id='lift_007', subject='p01', box_mass=12.0) for _ in range(2)
    )
    failed.report.status = SolveReport.PREDICTOR_INFEASIBLE
    block = conversions.motion_to_msg(flat, conversions.MotionQuality.exact(2))
    good.motion = to_ros(block, BodyMotion)
    station.send('predicted_lift', failed)
    station.send('predicted_lift', good)
    for topic in ('spine_load', 'joint_torques', 'muscle_analysis'):
        first, second = station.take(topic, 200.0, 2)
        assert (first.source, second.source) == (SpineLoad.MEASURED, SpineLoad.PREDICTED)
        assert first.lift_id == second.lift_id == 'lift_007'
        np.testing.assert_allclose(first.time_from_start, [0.0, 0.01, 0.02], atol=1e-6)
        assert len(second.status) == 2
    station.until(lambda: station.health.get('failed predictions') == 1, 'count of failures')
    assert not any(station.got[topic] for topic in ('spine_load', 'muscle_analysis'))


def test_bad_motion_is_reported_and_the_node_goes_on(station):
    motion = standing(Skeleton3D.of(PERSON), [300.0])
    points = motion.points.copy()
    points[0, motion.point_names.index('knee_r'), 0] += 0.05
    before = station.health.get('errors', 0)
    live(station, replace(motion, points=points))
    station.until(lambda: station.health.get('errors', 0) == before + 1, 'error on /diagnostics')
    assert "point 'knee_r' is 0.0500 m away" in station.last_error
    live(station, replace(motion, time=np.array([300.1])))
    assert len(station.take('spine_load', 300.0)) == 1


def test_lift_waits_for_its_person(station):
    """Last: the person of the station changes."""
    other = replace(PERSON, pseudonym='p02', mass=80.0)
    message = measured('lift_008', standing(Skeleton3D.of(other), [400.0, 400.01]))
    message.subject = 'p02'
    station.send('measured_lift', message)
    live(station, standing(Skeleton3D.of(PERSON), [399.0]))
    assert station.take('spine_load', 399.0)[0].subject == 'p01'
    station.send('subject', conversions.subject_to_msg(other, 0.0, 'none', 'test'))
    (spine,) = station.take('spine_load', 400.0)
    assert (spine.subject, spine.body_mass, spine.lift_id) == ('p02', 80.0, 'lift_008')
    assert spine.box_mass == 12.0
