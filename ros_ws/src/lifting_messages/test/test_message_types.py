# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages from their definitions, and back from bytes."""

import numpy as np
import pytest

from lifting_messages import MessageError, MessageTypeError, decode, encode, make, message_type
from lifting_messages.message_types import interface_folder, typestore


def test_every_definition_becomes_a_type():
    """No file of the folder is left out, and each type has a message without values."""
    names = [path.stem for path in interface_folder().glob('*.msg')]
    assert names
    for name in names:
        data = encode(make(name))
        assert encode(decode(data, name)) == data, name


def test_a_message_survives_its_bytes():
    """Numbers, texts, arrays and messages within the message come back."""
    message = make('SpineLoad', lift_id='lift_001', compression=np.array([1.5, np.nan]))
    message.header.stamp.nanosec = 5
    message.report.message = 'all good'
    back = decode(encode(message), 'lifting_interfaces/SpineLoad')
    assert (back.lift_id, back.report.message, back.header.stamp.nanosec) == (
        'lift_001', 'all good', 5,
    )  # fmt: skip
    np.testing.assert_array_equal(back.compression, [1.5, np.nan])
    assert not back.compression.flags.writeable


def test_arrays_of_a_decoded_message_lie_on_the_boundary_of_their_numbers():
    """Compiled functions are not compiled a second time for unaligned arrays."""
    back = decode(encode(make('SpineLoad', compression=np.ones(3))), 'SpineLoad')
    assert back.compression.flags.aligned


def test_constants_are_attributes():
    assert message_type('SpineLoad').MEASURED == 2


def test_fixed_arrays_have_their_length():
    assert make('Task').box_size.tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize('cut', [0, 1, 3, 4, 40, -1])
def test_bytes_that_are_no_message_are_refused(cut):
    """The error names the type and the number of bytes."""
    data = encode(make('SpineLoad', status=np.zeros(9, np.uint16)))[:cut]
    with pytest.raises(MessageError, match='lifting_interfaces/msg/SpineLoad') as caught:
        decode(data, 'SpineLoad')
    assert caught.value.size == len(data)


def test_bytes_after_a_message_are_ignored():
    """As rclpy's serialize_message leaves them, and as ROS 2 ignores them."""
    data = encode(make('SpineLoad', compression=np.ones(2)))
    assert encode(decode(data + b'left over', 'SpineLoad')) == data


def test_an_unknown_type_is_refused_by_name():
    with pytest.raises(MessageTypeError, match='lifting_interfaces/msg/Nothing'):
        message_type('Nothing')


def test_the_store_holds_the_types_of_ros_too():
    assert 'geometry_msgs/msg/WrenchStamped' in typestore().types
