# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Serialised marker frames are read as their messages would be."""

import numpy as np
import pytest

pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from hypothesis import given
from hypothesis import strategies as st
from lifting_interfaces.msg import Marker, Markers
from rclpy.serialization import serialize_message

from motion_tracker.core.exceptions import TrackerError
from motion_tracker.inputs import markers_from_msg
from motion_tracker.marker_cdr import MarkerReader

NUMBER = st.floats(-10.0, 10.0) | st.just(np.nan)
MARKER = st.tuples(st.text('ABé_', max_size=6), NUMBER, NUMBER, NUMBER)


def frame(markers, stamp=0, name='world'):
    message = Markers(frame_number=stamp)
    message.header.frame_id = name
    message.header.stamp.sec, message.header.stamp.nanosec = stamp, 123_456_789
    for index, (label, x, y, z) in enumerate(markers):
        marker = Marker(marker_name=label, marker_index=index)
        marker.translation.x, marker.translation.y, marker.translation.z = x, y, z
        message.markers.append(marker)
    return message


def assert_read(reader, message):
    stamp, names, positions = reader.read(serialize_message(message))
    expected = markers_from_msg(message)
    assert stamp == expected[0]
    assert list(names) == expected[1]
    np.testing.assert_array_equal(positions, expected[2])


@given(
    st.text('abc_/é', max_size=9), st.lists(st.lists(MARKER, max_size=5), min_size=1, max_size=5)
)
def test_any_frames_in_a_row_are_read_like_their_messages(name, frames):
    """One reader for all: what it remembers of one frame must not get into another."""
    reader = MarkerReader()
    for stamp, markers in enumerate(frames):
        assert_read(reader, frame(markers, stamp, name))


def test_names_of_the_same_length_do_not_keep_the_ones_before():
    reader = MarkerReader()
    for label in ('RASI', 'LASI', 'RASI'):
        assert_read(reader, frame([(label, 1.0, 2.0, 3.0), ('C7', 4.0, 5.0, 6.0)]))


@pytest.mark.parametrize('keep', [0, 10, 20, 50])
def test_a_cut_off_frame_is_refused(keep):
    data = serialize_message(frame([('RASI', 1.0, 2.0, 3.0)]))
    with pytest.raises(TrackerError, match='markers'):
        MarkerReader().read(data[:keep])


def test_a_name_that_is_no_text_is_refused():
    data = serialize_message(frame([('RASI', 1.0, 2.0, 3.0)]))
    with pytest.raises(TrackerError, match='UTF-8'):
        MarkerReader().read(data.replace(b'RASI', b'\xff\xfe\xfd\xfc'))
