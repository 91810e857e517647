# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of shapes and links, field by field; the type of /tf is that of ROS 2."""

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('tf2_msgs.msg', reason='tf2_msgs is neither built nor installed')

from rclpy.serialization import deserialize_message
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

from lifting_messages import encode, make
from lifting_messages.stamps import to_stamp
from lifting_visualization import conversions
from lifting_visualization.core.exceptions import PictureError
from lifting_visualization.core.link_frames import LinkFrames
from lifting_visualization.core.shapes import Kind, Shape, nothing

STAMP = to_stamp(12.5)
COLOUR = (0.25, 0.5, 0.75, 1.0)


def test_markers():
    points = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    turn = np.array([0.0, 0.0, 0.6, 0.8])
    shapes = [
        Shape('a', 0, Kind.LINES, points, (0.1, 0.0, 0.0), COLOUR),
        Shape('a', 1, Kind.ARROW, points, (0.1, 0.2, 0.3), COLOUR),
        Shape('b', 0, Kind.BOX, points[:1], (0.1, 0.2, 0.3), COLOUR, orientation=turn),
        Shape('b', 1, Kind.TEXT, points[:1], (0.0, 0.0, 0.1), COLOUR, '3400 N'),
        Shape('c', 0, Kind.BALLS, points, (0.1, 0.1, 0.1), COLOUR),
        nothing('d', 5),
    ]
    markers = conversions.markers_to_msg(shapes, STAMP).markers
    assert [m.type for m in markers[:5]] == [
        Marker.LINE_LIST,
        Marker.ARROW,
        Marker.CUBE,
        Marker.TEXT_VIEW_FACING,
        Marker.SPHERE_LIST,
    ]
    assert [m.action for m in markers] == [Marker.ADD] * 5 + [Marker.DELETE]
    assert [(m.ns, m.id) for m in markers] == [
        ('a', 0),
        ('a', 1),
        ('b', 0),
        ('b', 1),
        ('c', 0),
        ('d', 5),
    ]
    assert {(m.header.frame_id, m.header.stamp.sec, m.header.stamp.nanosec) for m in markers} == {
        ('world', 12, 500_000_000)
    }
    for marker in (markers[0], markers[1], markers[4]):
        assert [(p.x, p.y, p.z) for p in marker.points] == [(1, 2, 3), (4, 5, 6)]
        # The points are given in the marker's own frame: it must not be turned or moved.
        assert (marker.pose.position.x, marker.pose.orientation.w) == (0.0, 1.0)
    place, orientation = markers[2].pose.position, markers[2].pose.orientation
    assert (place.x, place.y, place.z) == (1.0, 2.0, 3.0)
    assert (orientation.z, orientation.w) == (0.6, 0.8)
    assert markers[3].text == '3400 N'
    assert (markers[3].color.r, markers[3].color.a, markers[3].scale.z) == (0.25, 1.0, 0.1)
    assert conversions.clear_msg(STAMP).markers[0].action == Marker.DELETEALL


@pytest.mark.parametrize('station', ['', 'a/', 'cell_3/', 'line_12_cell_3/'])
def test_transforms(skeleton, station):
    links = LinkFrames(skeleton, station)
    values = links.transforms(skeleton.coordinates, np.random.default_rng(7).normal(size=40))
    made = conversions.transforms_to_msg(links.parents, links.children, STAMP, values)
    message = deserialize_message(encode(made), TFMessage)
    assert [t.child_frame_id for t in message.transforms] == list(links.children)
    assert message.transforms[0].header.frame_id == 'world'
    for entry, row in zip(message.transforms, values, strict=True):
        place, turn = entry.transform.translation, entry.transform.rotation
        assert (entry.header.stamp.sec, entry.header.stamp.nanosec) == (12, 500_000_000)
        assert [place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w] == row.tolist()
    (head,) = conversions.fixed_to_msg(links, STAMP).transforms
    assert (head.header.frame_id, head.child_frame_id) == (f'{station}thorax', f'{station}head')
    assert head.transform.translation.z == pytest.approx(skeleton.parameters.lengths['c7_height'])


def load_message():
    """Return a message of two samples, the second not solved."""
    message = make(
        'SpineLoad',
        time_from_start=[0.0, 0.01],
        compression=[1.0, 2.0],
        status=[0, 301],
        disc_position=[0.1, 0.2, 0.9, 0.4, 0.5, 0.6],
        disc_orientation=[0.0, 0.6, 0.0, 0.8, 0.0, 0.0, 0.0, 1.0],
    )
    message.header.stamp = STAMP
    message.header.frame_id = 'cell_3/l5_s1'
    return message


def test_loads_of_a_message():
    loads = conversions.loads_from_msg(load_message())
    np.testing.assert_allclose(loads.time, [12.5, 12.51])
    np.testing.assert_array_equal(loads.compression, [1.0, np.nan])
    np.testing.assert_array_equal(loads.position, [[0.1, 0.2, 0.9], [0.4, 0.5, 0.6]])
    np.testing.assert_array_equal(loads.orientation[:, 1], [0.6, 0.0])
    # Half the angle about the axis to the left has the sine 0.6: its whole has 0.96.
    np.testing.assert_allclose(loads.normal, [[0.96, 0.0, 0.28], [0.0, 0.0, 1.0]], atol=1e-15)


@pytest.mark.parametrize(
    ('field', 'value', 'says'),
    [
        ('status', [0], '2 times, 2 compressions, 1 statuses'),
        ('compression', [1.0], '2 times, 1 compressions'),
        ('time_from_start', [], '0 times'),
        ('disc_position', [0.0] * 3, '3 numbers of disc_position, 8 of disc_orientation'),
        ('disc_orientation', [], '6 numbers of disc_position, 0 of disc_orientation'),
    ],
)
def test_loads_that_do_not_fit_are_named(field, value, says):
    message = load_message()
    setattr(message, field, np.array(value))
    with pytest.raises(PictureError, match=says):
        conversions.loads_from_msg(message)


def test_loads_need_the_name_of_their_frame():
    message = load_message()
    message.header.frame_id = ''
    with pytest.raises(PictureError, match='frame_id: empty'):
        conversions.loads_from_msg(message)


def test_type_of_tf_is_that_of_ros():
    """Nodes of a full ROS 2 take the message only if the hash of its description is theirs."""
    typesys = pytest.importorskip('rosbags.typesys', reason='rosbags is not installed')
    from ament_index_python.packages import get_package_share_directory

    store = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
    path = Path(get_package_share_directory('tf2_msgs')) / 'msg' / 'TFMessage.json'
    built = {
        entry['type_name']: entry['hash_string']
        for entry in json.loads(path.read_text(encoding='utf-8'))['type_hashes']
    }
    name = 'tf2_msgs/msg/TFMessage'
    assert built[name] == store.hash_rihs01(name)
