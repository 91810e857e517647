# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Views of serialised messages have what the messages have."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lifting_interfaces.msg import (
    BodyMotion,
    JointTorques,
    MuscleAnalysis,
    RiskAssessment,
    SolveReport,
    SpineLoad,
)
from rclpy.serialization import deserialize_message, serialize_message

from lifting_node.cdr import CdrError
from lifting_node.message_view import MessageView, viewed

TYPES = (BodyMotion, JointTorques, MuscleAnalysis, SpineLoad)
#: One view of each type for all examples: what it remembers must not get into another message.
VIEWS = {message_type: MessageView(message_type) for message_type in TYPES}

NUMBER = st.floats(-1e6, 1e6, width=64) | st.sampled_from([np.nan, np.inf])
TEXT = st.text('abé_1', max_size=6)
VALUES = {
    'double': NUMBER,
    'string': TEXT,
    'uint8': st.integers(0, 255),
    'uint16': st.integers(0, 2**16 - 1),
    'uint32': st.integers(0, 2**32 - 1),
    'sequence<double>': st.lists(NUMBER, max_size=5),
    'sequence<string>': st.lists(TEXT, max_size=4),
    'sequence<uint16>': st.lists(st.integers(0, 2**16 - 1), max_size=5),
}


def filled(draw, message_type):
    """Return a message with something in every field."""
    message = message_type()
    for name, kind in message_type.get_fields_and_field_types().items():
        if kind == 'std_msgs/Header':
            message.header.frame_id = draw(TEXT)
            message.header.stamp.sec = draw(st.integers(-(2**31), 2**31 - 1))
            message.header.stamp.nanosec = draw(st.integers(0, 10**9 - 1))
        elif kind == 'lifting_interfaces/SolveReport':
            setattr(message, name, filled(draw, SolveReport))
        else:
            setattr(message, name, draw(VALUES[kind]))
    return message


@st.composite
def messages(draw):
    """Return a message of any of the types."""
    return filled(draw, draw(st.sampled_from(TYPES)))


def assert_same(view, message):
    """Compare a view with the message as a reader of messages gets it."""
    assert type(view).__name__ == type(message).__name__
    assert list(vars(view)) == list(message.get_fields_and_field_types())
    for name, kind in message.get_fields_and_field_types().items():
        found, expected = getattr(view, name), getattr(message, name)
        if '/' in kind:
            assert_same(found, expected)
        elif kind == 'sequence<string>':
            assert found == tuple(expected)
        else:
            np.testing.assert_array_equal(found, expected)


@settings(deadline=None)
@given(st.lists(messages(), min_size=1, max_size=4))
def test_any_messages_in_a_row_are_seen_as_they_are(row):
    for message in row:
        data = serialize_message(message)
        view = VIEWS[type(message)].read(data)
        assert_same(view, deserialize_message(data, type(message)))


def test_arrays_lie_as_compiled_code_wants_them_and_cannot_be_written():
    message = BodyMotion(skeleton='3d_40dof', position=[1.0, 2.0, 3.0])
    position = VIEWS[BodyMotion].read(serialize_message(message)).position
    assert position.flags.aligned and position.dtype == np.float64
    with pytest.raises(ValueError, match='read-only'):
        position[0] = 0.0


def test_names_are_made_once_and_known_again_whatever_fills_up():
    names = ['a', 'bcd', 'efghi']
    data = serialize_message(JointTorques(joint_names=names))
    view = MessageView(JointTorques)
    first = view.read(data).joint_names
    assert first == tuple(names)
    # The text 'a' with its end takes two bytes of four.
    filling = data.index(b'a\0') + 2
    other = data[:filling] + b'??' + data[filling + 2 :]
    assert view.read(other).joint_names is first
    changed = data.replace(b'bcd', b'bce')
    assert view.read(changed).joint_names == ('a', 'bce', 'efghi')
    assert view.read(data).joint_names is first


def test_only_what_is_wanted_is_there():
    message = MuscleAnalysis(lift_id='lift_001', muscle_names=['a'], activation=[0.5], force=[9.0])
    view = MessageView(MuscleAnalysis, ('activation', 'lift_id')).read(serialize_message(message))
    assert set(vars(view)) == {'lift_id', 'activation'}
    assert (view.lift_id, view.activation.tolist()) == ('lift_001', [0.5])


@pytest.mark.parametrize('message_type', TYPES)
def test_a_message_cut_off_anywhere_is_refused_with_its_field(message_type):
    """Also when the same, whole message was read before."""
    fields = message_type.get_fields_and_field_types()
    message = message_type(
        **{name: ['ab', 'c'] for name, kind in fields.items() if kind == 'sequence<string>'},
        **{name: [1.0, 2.0] for name, kind in fields.items() if kind == 'sequence<double>'},
    )
    data = serialize_message(message)
    view = MessageView(message_type)
    view.read(data)
    whole = len(data.rstrip(b'\0'))
    for size in range(4, whole):
        with pytest.raises(CdrError, match=rf'{message_type.__name__}\.|Header\.|Time\.|Report\.'):
            view.read(data[:size])


@pytest.mark.parametrize('data', [b'', b'\0\1', b'\0\0\0\0' + bytes(99)])
def test_what_is_no_little_endian_message_is_refused(data):
    with pytest.raises(CdrError, match=r'SpineLoad: .* no little-endian message'):
        VIEWS[SpineLoad].read(data)


def test_a_name_that_is_no_text_is_refused():
    data = serialize_message(JointTorques(joint_names=['knee']))
    with pytest.raises(CdrError, match=r'JointTorques\.joint_names.*utf-8'):
        VIEWS[JointTorques].read(data.replace(b'knee', b'\xff\xfe\xfd\xfc'))


def test_a_type_with_other_fields_cannot_be_viewed():
    with pytest.raises(TypeError, match=r'RiskAssessment\.multipliers'):
        MessageView(RiskAssessment)
    with pytest.raises(TypeError, match="has no \\['weight'\\]"):
        MessageView(SpineLoad, ('weight',))


def test_a_callback_gets_the_view():
    seen = []
    viewed(SpineLoad, seen.append, ('body_mass',))(serialize_message(SpineLoad(body_mass=61.0)))
    assert [view.body_mass for view in seen] == [61.0]
