# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings made with earlier definitions, and of other packages, are read in today's form.

`reference/earlier_definitions` is an excerpt of the simulated lift of 7 kg and of its results,
written when markers were messages of their own, names lists, and the avoidable load had another
name; its messages are as they were written.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from injury_monitor import conversions as monitor_messages
from lifting_messages import decode, message_type
from lifting_messages.conversions import motion_from_msg
from lifting_messages.current_form import current_type, is_current
from lifting_messages.names import split
from lifting_recordings.reader import BagReader

EARLIER = Path(__file__).parent / 'reference' / 'earlier_definitions'
BAG = Path(__file__).parents[4] / 'bags' / 'symmetric_7kg'
MOCAP = """
std_msgs/Header header
uint32 frame_number
mocap4r2_msgs/Marker[] markers
================================================================================
MSG: mocap4r2_msgs/Marker
int8 USE_NAME=0
int8 USE_INDEX=1
int8 USE_BOTH=2
int8 id_type
int32 marker_index
string marker_name
geometry_msgs/Point translation
"""


@pytest.fixture(scope='module')
def messages():
    """Return the messages by topic, in today's form."""
    found = {}
    with BagReader(EARLIER) as bag:
        assert not is_current('lifting_interfaces/msg/Markers', bag.types)
        for topic, _, message in bag.messages():
            found.setdefault(topic.strip('/'), []).append(message)
    return found


def test_all_messages_have_the_fields_of_today(messages):
    for found in messages.values():
        for message in found:
            kind = message_type(message.__msgtype__)
            assert [*vars(message)] == [*kind.__dataclass_fields__], kind


def test_markers_are_those_of_the_file(messages):
    with BagReader(EARLIER) as bag:
        store = bag.types
        raw = [
            store.deserialize_cdr(data, 'lifting_interfaces/msg/Markers')
            for _, _, data in bag.raw_messages(['/markers'])
        ]
    for before, now in zip(raw, messages['markers'], strict=True):
        assert split(now.names) == tuple(m.marker_name for m in before.markers)
        places = now.positions.reshape(-1, 3)
        for place, marker in zip(places, before.markers, strict=True):
            at = marker.translation
            assert place.tolist() == [at.x, at.y, at.z]
        assert now.header.stamp.sec == before.header.stamp.sec


def test_names_of_columns_fit_the_numbers(messages):
    for message in messages['muscle_analysis']:
        assert len(split(message.muscle_names)) == message.activation.size == 318
    for message in messages['joint_torques']:
        assert len(split(message.joint_names)) == message.torque.size
    for message in messages['joint_reactions']:
        assert 3 * len(split(message.joint_names)) == message.force.size


def test_motion_inside_a_lift(messages):
    (lift,) = messages['predicted_lift']
    motion = motion_from_msg(lift.motion)
    assert motion.coordinates[0] == split(lift.motion.coordinate_names)[0]
    assert len(motion) > 10


def test_values_that_had_another_name_or_were_not_there(messages):
    (assessment,) = messages['risk_assessment']
    with BagReader(EARLIER) as bag:
        ((_, _, data),) = bag.raw_messages(['/risk_assessment'])
        before = bag.types.deserialize_cdr(data, 'lifting_interfaces/msg/RiskAssessment')
    assert assessment.avoidable_compression == before.unnecessary_compression
    assert assessment.avoidable_shear == before.unnecessary_shear
    for message in messages['spine_load']:
        assert math.isnan(message.filter_delay)
        assert monitor_messages.spine_from_msg(message).compression.size == message.status.size


def test_serialised_messages_are_those_of_today():
    with BagReader(EARLIER) as bag:
        for topic, _, data in bag.current_messages(list(bag.topics)):
            kind = bag.topics[topic].msgtype
            assert decode(data, kind).__msgtype__ == kind


def test_todays_messages_are_not_touched():
    with BagReader(BAG) as bag:
        assert all(is_current(topic.msgtype, bag.types) for topic in bag.topics.values())
        raw = next(bag.raw_messages(['/markers']))
        assert next(bag.current_messages(['/markers'])) == raw


def test_frames_of_mocap4r2(tmp_path):
    """Markers as drivers of mocap4r2 publish them, one with a number in place of a name."""
    store = get_typestore(Stores.ROS2_JAZZY)
    store.register(get_types_from_msg(MOCAP, 'mocap4r2_msgs/msg/Markers'))
    types = store.types
    stamp = types['builtin_interfaces/msg/Time'](7, 250_000_000)
    frame = types['mocap4r2_msgs/msg/Markers'](
        header=types['std_msgs/msg/Header'](stamp, 'world'),
        frame_number=3,
        markers=[
            types['mocap4r2_msgs/msg/Marker'](
                id_type=2,
                marker_index=index,
                marker_name=name,
                translation=types['geometry_msgs/msg/Point'](0.1 * index, 2.0, 3.0),
            )
            for index, name in enumerate(['C7', ''])
        ],
    )
    with Writer(tmp_path / 'bag', version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        kind = 'mocap4r2_msgs/msg/Markers'
        connection = writer.add_connection('/markers', kind, typestore=store)
        writer.write(connection, 7_250_000_000, store.serialize_cdr(frame, kind))
    with BagReader(tmp_path / 'bag') as bag:
        ((_, _, message),) = bag.messages()
        assert message.__msgtype__ == current_type(kind) == 'lifting_interfaces/msg/Markers'
    assert (message.frame_number, message.header.frame_id) == (3, 'world')
    assert split(message.names) == ('C7', '1')
    np.testing.assert_array_equal(message.positions, [0.0, 2.0, 3.0, 0.1, 2.0, 3.0])
