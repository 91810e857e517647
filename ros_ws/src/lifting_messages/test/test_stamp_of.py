# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The stamp of a serialised message is read without the rest of it."""

import pytest
from rosbags.typesys import Stores, get_typestore

from lifting_messages import encode, make
from lifting_messages.stamps import stamp_of

STORE = get_typestore(Stores.ROS2_JAZZY)
TYPES = STORE.types
SECONDS, NANOSECONDS = 1_700_000_001, 250_000_000
EXPECTED = SECONDS * 10**9 + NANOSECONDS


def header():
    stamp = TYPES['builtin_interfaces/msg/Time'](SECONDS, NANOSECONDS)
    return TYPES['std_msgs/msg/Header'](stamp, 'world')


def stamped_point():
    point = TYPES['geometry_msgs/msg/Point'](1.0, 2.0, 3.0)
    return TYPES['geometry_msgs/msg/PointStamped'](header(), point)


def transforms(count):
    place = TYPES['geometry_msgs/msg/Vector3'](0.0, 0.0, 1.0)
    turn = TYPES['geometry_msgs/msg/Quaternion'](0.0, 0.0, 0.0, 1.0)
    transform = TYPES['geometry_msgs/msg/Transform'](place, turn)
    entry = TYPES['geometry_msgs/msg/TransformStamped'](header(), 'station_1/pelvis', transform)
    return TYPES['tf2_msgs/msg/TFMessage']([entry] * count)


@pytest.mark.parametrize('little', [True, False])
@pytest.mark.parametrize(
    'make', [stamped_point, header, lambda: transforms(2)], ids=['header', 'itself', 'list']
)
def test_stamp_of_a_message_or_of_its_first_part(make, little):
    message = make()
    data = bytes(STORE.serialize_cdr(message, message.__msgtype__, little_endian=little))
    assert stamp_of(data, message.__msgtype__) == EXPECTED


def test_empty_list_has_no_stamp():
    data = bytes(STORE.serialize_cdr(transforms(0), 'tf2_msgs/msg/TFMessage'))
    assert stamp_of(data, 'tf2_msgs/msg/TFMessage') == 0


@pytest.mark.parametrize(
    'name',
    [
        'std_msgs/msg/String',
        'std_msgs/msg/Empty',
        'std_msgs/msg/Float64MultiArray',
        'geometry_msgs/msg/Polygon',
    ],
)
def test_messages_without_stamp(name):
    assert stamp_of(encode(make(name)), name) == 0


@pytest.mark.parametrize('keep', [0, 3, 4, 11])
def test_cut_off_message_has_none(keep):
    message = stamped_point()
    data = bytes(STORE.serialize_cdr(message, message.__msgtype__))
    assert stamp_of(data[:keep], message.__msgtype__) == 0
