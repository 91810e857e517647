# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Written bytes are the messages that the conversions make."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from lifting_interfaces.msg import BodyMotion
from rclpy.serialization import deserialize_message

from human_model.report import SolveStatus
from lifting_messages import encode
from motion_tracker import conversions
from motion_tracker.core.tracked import TrackedFrame
from motion_tracker.core.tracker import MotionTracker
from motion_tracker.live_writer import LiveWriter


@pytest.fixture(scope='module')
def frames(person, marker_set, lift, solver):
    """Return samples with and without plates, with and without a box."""
    found = []
    for box in (True, False):
        tracker = MotionTracker(person, marker_set, 10.0 if box else 0.0, (0.3, 0.3, 0.2))
        for side, *wrench in lift[2]:
            if side == 'right' or wrench[0] < lift[0][20][1]:
                tracker.push_wrench(side, *wrench)
        for message in lift[1] if box else []:
            tracker.push_box(*message[1:])
        outputs = [
            output
            for message in lift[0][:40]
            for output in tracker.push_markers(message[1], solver.model.names, message[2])
        ] + tracker.flush()
        found += [output for output in outputs if isinstance(output, TrackedFrame)]
    return found


def assert_same(written, message):
    """Check that bytes are those of a message."""
    assert written == (None if message is None else encode(message))


def test_written_samples_are_those_of_the_conversions(frames):
    writer = LiveWriter()
    silent = 0
    for frame in frames:
        assert_same(writer.body_motion(frame), conversions.body_motion_to_msg(frame))
        assert_same(writer.joint_state(frame), conversions.joint_state_to_msg(frame))
        reaction = conversions.ground_reaction_to_msg(frame)
        assert_same(writer.ground_reaction(frame), reaction)
        silent += reaction is None
        for side in (None, 0, 1):
            assert_same(writer.cop(frame, side), conversions.cop_to_msg(frame, side))
    assert 0 < silent < len(frames)
    assert {frame.status for frame in frames} == {
        SolveStatus.OK,
        SolveStatus.TRACKER_NO_GROUND_FORCE,
    }


def test_another_delay_is_another_layout(frames):
    writer = LiveWriter()
    other = replace(frames[0], filter_delay=0.5)
    for frame in (frames[0], other, frames[1]):
        read = deserialize_message(writer.body_motion(frame), BodyMotion)
        assert read.filter_delay == frame.filter_delay
        assert np.array_equal(read.position, frame.motion.position[0])


def test_recordings_of_written_samples_can_be_read(frames):
    """Rosbags takes no byte too many; ROS 2 itself overlooks them."""
    typesys = pytest.importorskip('rosbags.typesys', reason='rosbags is not installed')
    store = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
    writer = LiveWriter()
    (frame,) = [frame for frame in frames if frame.status == SolveStatus.OK][:1]
    for data, name in (
        (writer.joint_state(frame), 'sensor_msgs/msg/JointState'),
        (writer.ground_reaction(frame), 'geometry_msgs/msg/WrenchStamped'),
        (writer.cop(frame), 'geometry_msgs/msg/PointStamped'),
    ):
        assert store.deserialize_cdr(data, name).header.frame_id == 'world'
