# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The node in this process: what it publishes of a person, and when it is silent."""

import time
from functools import partial

import numpy as np
import pytest

rclpy = pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')
pytest.importorskip('tf2_msgs.msg', reason='tf2_msgs is neither built nor installed')

from builtin_interfaces.msg import Time  # noqa: E402
from geometry_msgs.msg import PoseStamped  # noqa: E402
from lifting_interfaces.msg import (  # noqa: E402
    BodyMotion,
    MeasuredLift,
    PredictedLift,
    SpineLoad,
    Subject,
    Task,
)
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from std_msgs.msg import String  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402
from visualization_msgs.msg import Marker, MarkerArray  # noqa: E402

from lifting_messages import encode  # noqa: E402
from lifting_messages.conversions import MotionQuality, motion_to_msg, subject_to_msg  # noqa: E402
from lifting_messages.stamps import to_stamp  # noqa: E402
from lifting_node import qos  # noqa: E402
from lifting_node.ros_messages import to_ros  # noqa: E402
from lifting_visualization.lifting_visualization_node import (  # noqa: E402
    LiftingVisualizationNode,
)

PATIENCE = 20.0


class Station:
    """The node and a client beside it, spun together."""

    def __init__(self, parameters):
        arguments = ['--ros-args', '-r', '__ns:=/cell_3']
        for name, value in parameters.items():
            arguments += ['-p', f'{name}:={value}']
        rclpy.init(args=arguments)
        self.node = LiftingVisualizationNode()
        self.client = rclpy.create_node('client', namespace='cell_3')
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.executor.add_node(self.client)
        self.markers, self.transforms, self.fixed, self.urdf = {}, [], [], []
        take = self.client.create_subscription
        take(MarkerArray, 'visualization', self._on_markers, qos.VIEW)
        take(TFMessage, '/tf', partial(self._on_transforms, self.transforms), qos.TRANSFORMS)
        take(TFMessage, '/tf_static', partial(self._on_transforms, self.fixed), qos.LATCHED)
        take(String, 'robot_description', self.urdf.append, qos.LATCHED)
        topics = {
            'subject': (Subject, qos.LATCHED),
            'task': (Task, qos.LATCHED),
            'body_motion': (BodyMotion, qos.FRAMES),
            'spine_load': (SpineLoad, qos.FRAMES),
            'box/pose': (PoseStamped, qos.FRAMES),
            'measured_lift': (MeasuredLift, qos.RESULTS),
            'predicted_lift': (PredictedLift, qos.RESULTS),
        }
        self.publishers = {
            topic: self.client.create_publisher(kind, topic, profile)
            for topic, (kind, profile) in topics.items()
        }

    @staticmethod
    def _on_transforms(taken, message):
        # /tf has no namespace: other graphs of the machine may be on it.
        if message.transforms[0].child_frame_id.startswith('cell_3/'):
            taken.append(message)

    def _on_markers(self, message):
        for marker in message.markers:
            if marker.action == Marker.DELETEALL:
                self.markers.clear()
            elif marker.action == Marker.DELETE:
                self.markers.pop((marker.ns, marker.id), None)
            else:
                self.markers[marker.ns, marker.id] = marker

    def until(self, condition, what):
        """Spin until a condition holds; fail by name when patience is over."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, f'{what} did not happen in {PATIENCE} s'
            self.executor.spin_once(timeout_sec=0.05)

    def spin(self, duration):
        """Spin for so long [s]."""
        end = time.monotonic() + duration
        while time.monotonic() < end:
            self.executor.spin_once(timeout_sec=0.02)

    def send(self, topic, message):
        """Publish once there is a reader."""
        publisher = self.publishers[topic]
        self.until(lambda: publisher.get_subscription_count() > 0, f'reader of {topic}')
        publisher.publish(encode(message) if hasattr(message, '__msgtype__') else message)

    def close(self):
        """End everything."""
        self.executor.shutdown()
        self.client.destroy_node()
        self.node.destroy_node()
        rclpy.shutdown()


@pytest.fixture
def station(request):
    """Return an active station; parametrise indirectly with node parameters."""
    made = Station(getattr(request, 'param', {}))
    made.node.trigger_configure()
    made.node.trigger_activate()
    yield made
    made.close()


def motion_message(motion, status=0):
    """Return the message of a motion whose samples have a status."""
    quality = MotionQuality.exact(len(motion))
    quality.status[:] = status
    return motion_to_msg(motion, quality)


def test_person_motion_and_load(station, woman, motion_at):
    station.send('subject', subject_to_msg(woman, 1.0, '', ''))
    station.send('task', Task(task_id='t', box_size=[0.3, 0.4, 0.2]))
    station.until(lambda: station.urdf and station.fixed, 'robot_description and /tf_static')
    assert '<robot name="S04">' in station.urdf[-1].data
    assert station.fixed[-1].transforms[0].child_frame_id == 'cell_3/head'
    station.send('body_motion', motion_message(motion_at(2.0, box_position=[[0.4, 0.0, 0.1]])))
    station.until(lambda: station.transforms and ('box', 0) in station.markers, 'a picture')
    names = {entry.child_frame_id for entry in station.transforms[-1].transforms}
    assert len(names) == 40
    assert 'cell_3/pelvis' in names
    assert ('l5_s1', 0) not in station.markers
    station.send('spine_load', load_message(2.0))
    station.until(lambda: ('l5_s1', 1) in station.markers, 'the arrow of the load')
    assert station.markers['l5_s1', 1].text == '6500 N'


def load_message(stamp, **fields):
    """Return the message of a live load on a disc that leans forward by 30 degrees."""
    half = np.deg2rad(15.0)
    message = SpineLoad(
        **{
            'source': SpineLoad.LIVE,
            'time_from_start': [0.0],
            'compression': [6500.0],
            'status': [0],
            'disc_position': [0.1, 0.02, 1.0],
            'disc_orientation': [0.0, np.sin(half), 0.0, np.cos(half)],
        }
        | fields
    )
    message.header.stamp = to_ros(to_stamp(stamp), Time)
    message.header.frame_id = 'cell_3/l5_s1'
    return message


def test_tf_has_the_frame_that_loads_are_given_in(station, woman):
    station.send('spine_load', load_message(2.0))
    station.until(lambda: station.transforms, 'the frame of the disc')
    (entry,) = station.transforms[-1].transforms
    load = load_message(2.0)
    assert (entry.header.frame_id, entry.child_frame_id) == ('world', load.header.frame_id)
    assert entry.header.stamp == load.header.stamp
    place, turn = entry.transform.translation, entry.transform.rotation
    assert [place.x, place.y, place.z] == list(load.disc_position)
    assert [turn.x, turn.y, turn.z, turn.w] == list(load.disc_orientation)
    # The arrow stands on the disc and leans with it.
    station.until(lambda: ('l5_s1', 0) in station.markers, 'the arrow of the load')
    tail, tip = ([p.x, p.y, p.z] for p in station.markers['l5_s1', 0].points)
    assert tip == pytest.approx([0.1, 0.02, 1.0])
    assert np.subtract(tail, tip) == pytest.approx([0.325, 0.0, 0.65 * np.cos(np.pi / 6.0)])


def test_a_disc_whose_place_is_not_known_stays_away(station, woman):
    unknown = {'disc_position': [np.nan] * 3, 'disc_orientation': [np.nan] * 4}
    station.send('spine_load', load_message(2.0, status=[305], **unknown))
    station.send('spine_load', load_message(2.5, source=SpineLoad.MEASURED))
    station.send('spine_load', load_message(3.0))
    station.until(lambda: station.transforms, 'the frame of the disc')
    station.spin(0.2)
    (message,) = station.transforms
    assert message.transforms[0].header.stamp == Time(sec=3)


def test_a_sample_that_was_not_solved_moves_no_link(station, woman, motion_at):
    station.send('subject', subject_to_msg(woman, 1.0, '', ''))
    station.until(lambda: station.urdf, 'robot_description')
    station.send('body_motion', motion_message(motion_at(2.0), status=101))
    station.until(lambda: ('person', 0) in station.markers, 'a picture')
    station.spin(0.2)
    assert station.transforms == []
    assert station.markers['person', 0].color.a < 1.0


def test_predicted_lift_goes_round(station, woman, skeleton):
    station.send('subject', subject_to_msg(woman, 1.0, '', ''))
    n = 5
    q = np.tile(skeleton.standing(), (n, 1))
    q[:, skeleton.index('pelvis_tx')] += np.linspace(0.0, 0.4, n)
    motion = skeleton.body_motion(3.0 + np.linspace(0.0, 0.4, n), q, 0 * q, 0 * q)
    message = PredictedLift(
        lift_id='lift_001',
        box_mass=9.0,
        motion=to_ros(motion_to_msg(motion, MotionQuality.exact(n)), BodyMotion),
    )
    station.send('predicted_lift', message)
    places = set()
    station.until(lambda: ('predicted', 0) in station.markers, 'the predicted lift')

    def moved():
        places.add(station.markers['predicted', 0].points[0].x)
        return len(places) > 1

    station.until(moved, 'another posture of the predicted lift')
    assert ('hand_paths', 1) in station.markers
    message.report.status = 201
    station.send('predicted_lift', message)
    station.until(lambda: ('predicted', 0) not in station.markers, 'its end')


@pytest.mark.parametrize('station', [{'transforms': False}], indirect=True)
def test_tf_can_be_left_to_robot_state_publisher(station, woman, motion_at):
    station.send('subject', subject_to_msg(woman, 1.0, '', ''))
    station.until(lambda: station.urdf, 'robot_description')
    station.send('body_motion', motion_message(motion_at(2.0)))
    station.until(lambda: ('person', 0) in station.markers, 'a picture')
    station.send('spine_load', load_message(2.0))
    station.until(lambda: ('l5_s1', 0) in station.markers, 'the arrow of the load')
    station.spin(0.2)
    assert station.transforms == station.fixed == []


def test_bad_input_is_counted_and_the_node_goes_on(station, woman, motion_at):
    station.send('subject', subject_to_msg(woman, 1.0, '', ''))
    station.send('body_motion', BodyMotion(skeleton='3d_40dof'))
    station.until(lambda: station.node.station.counts['errors'] == 1, 'the error')
    station.send('body_motion', motion_message(motion_at(2.0)))
    station.until(lambda: ('person', 0) in station.markers, 'a picture')


def test_silent_until_active(woman, motion_at):
    station = Station({})
    try:
        station.node.trigger_configure()
        station.send('subject', subject_to_msg(woman, 1.0, '', ''))
        station.send('body_motion', motion_message(motion_at(2.0)))
        station.until(
            lambda: station.node.station.counts['samples while not active'] == 1, 'the sample'
        )
        station.spin(0.2)
        assert not (station.markers or station.transforms or station.urdf)
        station.node.trigger_activate()
        station.until(lambda: station.urdf, 'robot_description')
    finally:
        station.close()
