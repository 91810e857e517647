# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Serialised wrenches and box poses are read as the messages would be."""

import numpy as np
import pytest

pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from geometry_msgs.msg import PoseStamped, WrenchStamped
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import serialize_message

from motion_tracker.conversions import box_from_cdr, wrench_from_cdr
from motion_tracker.core.exceptions import TrackerError
from motion_tracker.inputs import box_from_msg, wrench_from_msg

NUMBER = st.floats(-1e4, 1e4)


@given(st.text('abc_/é', max_size=20), st.tuples(*[NUMBER] * 6), st.integers(0, 2_000_000_000))
def test_any_wrench_is_read_like_its_message(frame, values, seconds):
    message = WrenchStamped()
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = seconds, 123_456_789
    force, torque = message.wrench.force, message.wrench.torque
    force.x, force.y, force.z, torque.x, torque.y, torque.z = values
    expected = wrench_from_msg(message)
    read = wrench_from_cdr(serialize_message(message))
    assert read[0] == expected[0]
    assert np.array_equal(read[1], expected[1])
    assert np.array_equal(read[2], expected[2])


@given(st.text('abc_/é', max_size=20), st.tuples(*[NUMBER] * 3), st.integers(0, 2_000_000_000))
def test_any_box_is_read_like_its_message(frame, values, seconds):
    message = PoseStamped()
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = seconds, 123_456_789
    at = message.pose.position
    at.x, at.y, at.z = values
    stamp, position = box_from_msg(message)
    read = box_from_cdr(serialize_message(message))
    assert read[0] == stamp
    assert np.array_equal(read[1], position)
    with pytest.raises(TrackerError, match='box: cut off'):
        box_from_cdr(serialize_message(message)[:60])


@pytest.mark.parametrize('keep', [0, 10, 40])
def test_a_cut_off_wrench_is_refused(keep):
    with pytest.raises(TrackerError, match='wrench'):
        wrench_from_cdr(serialize_message(WrenchStamped())[:keep])


def test_a_big_endian_wrench_is_refused():
    data = bytearray(serialize_message(WrenchStamped()))
    data[1] = 0
    with pytest.raises(TrackerError, match='little-endian'):
        wrench_from_cdr(bytes(data))
