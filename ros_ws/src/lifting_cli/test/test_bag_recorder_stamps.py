# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Where the recorder finds the stamp of a serialised message."""

import pytest
from rosbags.typesys import Stores, get_typestore

pytest.importorskip('rclpy', reason='recording needs rclpy')

from lifting_cli.transport.recorder import _stamp, _stamp_place
from lifting_messages import typestore

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
@pytest.mark.parametrize('make', [stamped_point, lambda: transforms(2)], ids=['header', 'list'])
def test_stamp_of_a_message_or_of_its_first_part(make, little):
    message = make()
    data = bytes(STORE.serialize_cdr(message, message.__msgtype__, little_endian=little))
    place = _stamp_place(typestore(), message.__msgtype__)
    assert _stamp(data, place) == EXPECTED


def test_empty_list_has_no_stamp():
    data = bytes(STORE.serialize_cdr(transforms(0), 'tf2_msgs/msg/TFMessage'))
    assert _stamp(data, _stamp_place(typestore(), 'tf2_msgs/msg/TFMessage')) == 0


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
    assert _stamp_place(typestore(), name) == 0


def test_markers_have_one():
    assert _stamp_place(typestore(), 'visualization_msgs/msg/MarkerArray') > 0
