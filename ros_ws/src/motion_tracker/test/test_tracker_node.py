# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The node in this process: a recording over its topics gives what the core gives."""

import time
from pathlib import Path

import numpy as np
import pytest

rclpy = pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')
reader = pytest.importorskip('lifting_recordings.reader', reason='rosbags is not installed')

from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped  # noqa: E402
from lifecycle_msgs.msg import Transition  # noqa: E402
from lifecycle_msgs.srv import ChangeState  # noqa: E402
from lifting_interfaces.msg import (  # noqa: E402
    BodyMotion,
    LiftEvent,
    Markers,
    MeasuredLift,
    Subject,
    Task,
)
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.serialization import deserialize_message  # noqa: E402
from sensor_msgs.msg import JointState  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

from human_model.report import SolveStatus  # noqa: E402
from lifting_messages.conversions import lift_from_msg  # noqa: E402
from lifting_node import qos  # noqa: E402
from motion_tracker.core.tracked import MeasuredLift as TrackedLift  # noqa: E402
from motion_tracker.core.tracked import TrackedFrame  # noqa: E402
from motion_tracker.motion_tracker_node import MotionTrackerNode  # noqa: E402
from motion_tracker.station import TrackerStation  # noqa: E402

BAG = Path(__file__).resolve().parents[4] / 'bags' / 'symmetric_7kg'
PATIENCE = 60.0
INPUTS = {
    'subject': (Subject, qos.LATCHED),
    'task': (Task, qos.LATCHED),
    'markers': (Markers, qos.FRAMES),
    'box/pose': (PoseStamped, qos.FRAMES),
    'force_plates/right/wrench': (WrenchStamped, qos.PLATES),
    'force_plates/left/wrench': (WrenchStamped, qos.PLATES),
}
OUTPUTS = {
    'joint_states': (JointState, qos.FRAMES),
    'body_motion': (BodyMotion, qos.FRAMES),
    'lift_event': (LiftEvent, qos.RESULTS),
    'measured_lift': (MeasuredLift, qos.RESULTS),
    'force_plates/right/cop': (PointStamped, qos.FRAMES),
    'ground_reaction/wrench': (WrenchStamped, qos.FRAMES),
    'ground_reaction/cop': (PointStamped, qos.FRAMES),
}


@pytest.fixture(scope='module')
def recording():
    """Topics and messages of a simulated lift, in order."""
    with reader.BagReader(BAG) as bag:
        return [
            (topic.strip('/'), deserialize_message(data, INPUTS[topic.strip('/')][0]))
            for topic, _, data in bag.raw_messages()
        ]


class Station:
    """The node and a client beside it, spun together."""

    def __init__(self, namespace):
        # Messages come as fast as they can: no stream may be given up for being late.
        rclpy.init(args=['--ros-args', '-r', f'__ns:=/{namespace}', '-p', 'wait:=3600.0'])
        self.node = MotionTrackerNode()
        self.client = rclpy.create_node('client', namespace=namespace)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.executor.add_node(self.client)
        self.received = {topic: [] for topic in OUTPUTS}
        for topic, (kind, profile) in OUTPUTS.items():
            self.client.create_subscription(kind, topic, self.received[topic].append, profile)
        self.publishers = {
            topic: self.client.create_publisher(kind, topic, profile)
            for topic, (kind, profile) in INPUTS.items()
        }

    def until(self, condition, what):
        """Spin until a condition holds; fail by name when patience is over."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, f'{what} did not happen in {PATIENCE} s'
            self.executor.spin_once(timeout_sec=0.05)

    def call(self, kind, name, request):
        """Call a service of the node and return its answer."""
        service = self.client.create_client(kind, f'motion_tracker/{name}')
        self.until(service.service_is_ready, f'service {name}')
        future = service.call_async(request)
        self.until(future.done, f'answer of {name}')
        return future.result()

    def bring_up(self):
        """Configure and activate."""
        for number in (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE):
            request = ChangeState.Request(transition=Transition(id=number))
            assert self.call(ChangeState, 'change_state', request).success
        for topic, publisher in self.publishers.items():
            self.until(lambda p=publisher: p.get_subscription_count() > 0, f'reader of {topic}')

    def close(self):
        """End everything."""
        self.executor.shutdown()
        self.client.destroy_node()
        self.node.destroy_node()
        rclpy.shutdown()


@pytest.fixture
def station(request, monkeypatch):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    result = Station(f'test_{request.node.name}')
    yield result
    result.close()


def offline(recording, values):
    """Return the results of the station alone for the same messages."""
    station = TrackerStation(values)
    outputs = [output for topic, message in recording for output in station.track(topic, message)]
    return [*outputs, *station.end()]


def test_a_recording_over_topics_gives_what_the_core_gives(station, recording):
    station.bring_up()
    markers = sum(topic == 'markers' for topic, _ in recording)
    for topic, message in recording:
        station.publishers[topic].publish(message)
        station.executor.spin_once(timeout_sec=0.0)
    station.until(lambda: station.node.station.counts['markers'] == markers, 'all marker frames')
    plates = sum(topic.endswith('wrench') for topic, _ in recording)
    station.until(
        lambda: (
            sum(n for topic, n in station.node.station.counts.items() if topic.endswith('wrench'))
            == plates
        ),
        'all plate samples',
    )
    answer = station.call(Trigger, 'flush', Trigger.Request())
    assert answer.success
    assert answer.message == '1 lifts'
    station.until(lambda: len(station.received['measured_lift']) == 1, 'measured lift')
    expected = offline(recording, station.node.values)
    frames = [o for o in expected if isinstance(o, TrackedFrame)]
    station.until(lambda: len(station.received['body_motion']) == len(frames), 'live blocks')
    (lift,) = [o.lift for o in expected if isinstance(o, TrackedLift)]
    received = lift_from_msg(station.received['measured_lift'][0])
    assert lift.lift_id == 'lift_001'
    assert received.lift_id == f'lift_001_{station.node.station.session}'
    for name in (
        'position',
        'velocity',
        'acceleration',
        'ground_force',
        'centre_of_pressure',
        'hand_force',
    ):
        assert np.array_equal(
            getattr(received.motion, name), getattr(lift.motion, name), equal_nan=True
        ), name
    for message, frame in zip(station.received['body_motion'], frames, strict=True):
        assert np.array_equal(message.position, frame.motion.position[0])
        assert message.status[0] == frame.status
        assert message.filter_delay == frame.filter_delay
    assert [e.event for e in station.received['lift_event']] == [LiftEvent.START, LiftEvent.END]
    assert len(station.received['joint_states']) == len(frames)
    assert station.received['force_plates/right/cop']
    loaded = [frame for frame in frames if frame.status != SolveStatus.TRACKER_NO_GROUND_FORCE]
    total = [m.wrench.force.z for m in station.received['ground_reaction/wrench']]
    assert total == [frame.motion.ground_force[0, :, 2].sum() for frame in loaded]
    for message, frame in zip(station.received['ground_reaction/cop'], loaded, strict=True):
        share = frame.motion.ground_force[0, :, 2] / frame.motion.ground_force[0, :, 2].sum()
        assert message.point.y == pytest.approx(
            share @ frame.motion.centre_of_pressure[0, :, 1], abs=1e-9
        )
    assert station.node.station.counts['errors'] == 0


def test_flush_without_a_recording_says_so(station):
    station.bring_up()
    answer = station.call(Trigger, 'flush', Trigger.Request())
    assert not answer.success
    assert 'no recording' in answer.message


def test_bad_frames_are_reported_and_the_node_goes_on(station, recording):
    station.bring_up()
    for topic, message in recording[:2]:
        station.publishers[topic].publish(message)
    station.until(
        lambda: station.node.station.counts['task'] == 1 == station.node.station.counts['subject'],
        'person and task',
    )
    frame = next(message for topic, message in recording if topic == 'markers')
    frame.positions = [1000.0 * value for value in frame.positions]
    station.publishers['markers'].publish(frame)
    station.until(lambda: station.node.station.counts['errors'] == 1, 'report')
    assert 'millimetres' in station.node.station.last_error
