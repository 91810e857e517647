# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of shapes and links."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from human_model.typing import Array
from lifting_messages.conversions import LABORATORY
from lifting_messages.message_types import Message, make, message_type
from lifting_messages.stamps import to_seconds
from lifting_visualization.core.exceptions import PictureError
from lifting_visualization.core.link_frames import LinkFrames
from lifting_visualization.core.shapes import Kind, Shape
from lifting_visualization.core.spine_loads import SpineLoads

_MARKERS = 'visualization_msgs/MarkerArray'
_MARKER = message_type('visualization_msgs/Marker')
_POINT = message_type('geometry_msgs/Point')
_VECTOR = message_type('geometry_msgs/Vector3')
_QUATERNION = message_type('geometry_msgs/Quaternion')
_TRANSFORM = message_type('geometry_msgs/Transform')
_STAMPED = message_type('geometry_msgs/TransformStamped')
_HEADER = message_type('std_msgs/Header')

_TYPES = {
    Kind.LINES: _MARKER.LINE_LIST,
    Kind.BALLS: _MARKER.SPHERE_LIST,
    Kind.ARROW: _MARKER.ARROW,
    Kind.BOX: _MARKER.CUBE,
    Kind.TEXT: _MARKER.TEXT_VIEW_FACING,
}


def markers_to_msg(shapes: Sequence[Shape], stamp: Message) -> Message:
    """Return the markers of shapes, all in the laboratory frame."""
    head = _HEADER(stamp, LABORATORY)
    return make(_MARKERS, markers=[_marker(shape, head) for shape in shapes])


def clear_msg(stamp: Message) -> Message:
    """Return the message that removes everything that was drawn."""
    marker = make(
        'visualization_msgs/Marker', header=_HEADER(stamp, LABORATORY), action=_MARKER.DELETEALL
    )
    return make(_MARKERS, markers=[marker])


def _marker(shape: Shape, head: Message) -> Message:
    marker = make(
        'visualization_msgs/Marker',
        header=head,
        ns=shape.layer,
        id=shape.number,
        text=shape.text,
    )
    if shape.kind is Kind.NOTHING:
        marker.action = _MARKER.DELETE
        return marker
    marker.type = _TYPES[shape.kind]
    marker.scale = _VECTOR(*shape.size)
    red, green, blue, opacity = shape.colour
    marker.color = make('std_msgs/ColorRGBA', r=red, g=green, b=blue, a=opacity)
    if shape.kind in (Kind.BOX, Kind.TEXT):
        marker.pose.position = _POINT(*shape.points[0].tolist())
        marker.pose.orientation = _QUATERNION(*shape.orientation.tolist())
    else:
        marker.pose.orientation = _QUATERNION(0.0, 0.0, 0.0, 1.0)
        marker.points = [_POINT(*point) for point in shape.points.tolist()]
    return marker


def transforms_to_msg(
    parents: Sequence[str], children: Sequence[str], stamp: Message, places: Array
) -> Message:
    """Return the message of /tf with moving frames.

    Parameters
    ----------
    parents, children : sequence of str, n
        Names of the frames.
    stamp : Message
        Time of all of them.
    places : ndarray, shape (n, 7)
        Translation [m] and quaternion x, y, z, w of each child in its parent.
    """
    return make(
        'tf2_msgs/TFMessage',
        transforms=[
            _STAMPED(
                _HEADER(stamp, parent),
                child,
                _TRANSFORM(_VECTOR(x, y, z), _QUATERNION(*turn)),
            )
            for parent, child, (x, y, z, *turn) in zip(
                parents, children, places.tolist(), strict=True
            )
        ],
    )


def fixed_to_msg(links: LinkFrames, stamp: Message) -> Message:
    """Return the message of the links that have no joint."""
    parents, children, origins = zip(*links.fixed, strict=True)
    places = np.array([[*origin, 0.0, 0.0, 0.0, 1.0] for origin in origins])
    return transforms_to_msg(parents, children, stamp, places)


def loads_from_msg(message: Message) -> SpineLoads:
    """Return the loads of a message; what is not good data is NaN.

    Raises
    ------
    PictureError
        If the frame has no name, or the arrays do not fit to each other or are empty.
    """
    time = to_seconds(message.header.stamp) + np.asarray(message.time_from_start, np.float64)
    values = np.asarray(message.compression, np.float64)
    status = np.asarray(message.status, np.int64)
    place = np.asarray(message.disc_position, np.float64)
    turn = np.asarray(message.disc_orientation, np.float64)
    n = time.size
    if not n or (values.size, status.size, place.size, turn.size) != (n, n, 3 * n, 4 * n):
        raise PictureError(
            f'spine_load: {n} times, {values.size} compressions, {status.size} '
            f'statuses, {place.size} numbers of disc_position, {turn.size} of '
            'disc_orientation'
        )
    if not message.header.frame_id:
        raise PictureError('spine_load.header.frame_id: empty')
    return SpineLoads(
        time, np.where(status == 0, values, np.nan), place.reshape(n, 3), turn.reshape(n, 4)
    )
