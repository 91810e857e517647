# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages written at once are read by the middleware as what was written."""

import numpy as np
import pytest

pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from hypothesis import given, settings
from hypothesis import strategies as st
from lifting_interfaces.msg import JointTorques, SpineLoad
from rclpy.serialization import deserialize_message
from std_msgs.msg import Bool

from lifting_node.message_view import MessageView
from lifting_node.message_writer import MessageWriter

TORQUES = MessageWriter(JointTorques)
NUMBERS = st.lists(st.floats(allow_nan=False), max_size=5)
TEXT = st.text(st.characters(blacklist_characters='\0', codec='utf-8'), max_size=9)


def torques(names=('knee', 'hip_r'), torque=(1.0, 2.0), frame_id='world', status=(0, 305)):
    return {
        'header': {'stamp': {'sec': 5, 'nanosec': 250_000_000}, 'frame_id': frame_id},
        'lift_id': 'lift_001',
        'source': JointTorques.MEASURED,
        'time_from_start': np.array([0.0, 0.01]),
        'joint_names': names,
        'torque': torque,
        'torque_lower': np.zeros((0, 2)),
        'torque_upper': np.arange(6.0).reshape(3, 2)[:, ::-1],
        'status': np.asarray(status, np.int64),
    }


@settings(deadline=None)
@given(
    st.lists(TEXT, max_size=4).map(tuple),
    NUMBERS,
    TEXT,
    st.lists(st.integers(0, 65535), max_size=4),
)
def test_middleware_and_view_read_what_was_written(names, torque, frame_id, status):
    values = torques(names, torque, frame_id, status)
    data = TORQUES.write(values)
    message = deserialize_message(data, JointTorques)
    assert (tuple(message.joint_names), list(message.torque)) == (names, torque)
    assert (message.header.frame_id, list(message.status)) == (frame_id, status)
    view = MessageView(JointTorques).read(data)
    assert (view.joint_names, view.header.frame_id) == (names, frame_id)
    assert list(view.torque) == torque


def test_object_has_the_values():
    message = deserialize_message(TORQUES.write(torques()), JointTorques)
    assert (message.lift_id, message.source) == ('lift_001', JointTorques.MEASURED)
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (5, 250_000_000)
    assert message.joint_names == ['knee', 'hip_r']
    assert list(message.torque_upper) == [1.0, 0.0, 3.0, 2.0, 5.0, 4.0]
    assert list(message.status) == [0, 305]


def test_names_that_change_are_written_anew():
    for names in (('a', 'bc'), ('a', 'bd'), ()):
        message = deserialize_message(TORQUES.write(torques(names)), JointTorques)
        assert message.joint_names == list(names)


def test_missing_value_is_named():
    values = torques()
    del values['torque_lower']
    with pytest.raises(KeyError, match='torque_lower'):
        TORQUES.write(values)


def test_message_within_a_message_and_single_numbers():
    writer = MessageWriter(SpineLoad)
    empty = MessageView(SpineLoad).read(writer.write(_values_of(SpineLoad())))
    assert empty.report.message == ''
    values = _values_of(SpineLoad(body_mass=63.5)) | {'box_mass': 12}
    values['report'] |= {'message': 'too weak', 'iterations': 7, 'solve_time': 0.25}
    message = deserialize_message(writer.write(values), SpineLoad)
    assert (message.body_mass, message.box_mass) == (63.5, 12.0)
    assert (message.report.message, message.report.iterations) == ('too weak', 7)


def _values_of(message):
    """Return the values of a message's fields, parts as mappings."""
    values = {name: getattr(message, name) for name in message.get_fields_and_field_types()}
    return {
        name: _values_of(value) if hasattr(value, 'SLOT_TYPES') else value
        for name, value in values.items()
    }


def test_a_kind_of_field_that_is_not_known_is_refused():
    with pytest.raises(TypeError, match=r'Bool\.data'):
        MessageWriter(Bool)
