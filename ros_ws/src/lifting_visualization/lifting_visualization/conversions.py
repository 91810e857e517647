# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of shapes and links."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, Quaternion, TransformStamped, Vector3
from lifting_interfaces.msg import SpineLoad
from rclpy.serialization import serialize_message
from std_msgs.msg import ColorRGBA
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from human_model.typing import Array
from lifting_messages.conversions import LABORATORY
from lifting_messages.stamps import to_seconds
from lifting_visualization.core.exceptions import PictureError
from lifting_visualization.core.link_frames import LinkFrames
from lifting_visualization.core.shapes import Kind, Shape
from lifting_visualization.core.spine_loads import SpineLoads

#: Bytes before the body of a serialised message.
_HEAD = 4
#: Begins the stamps that mark their own places; far from all lengths and characters.
_MARK = 900_000_001

_TYPES = {
    Kind.LINES: Marker.LINE_LIST,
    Kind.BALLS: Marker.SPHERE_LIST,
    Kind.ARROW: Marker.ARROW,
    Kind.BOX: Marker.CUBE,
    Kind.TEXT: Marker.TEXT_VIEW_FACING,
}


def markers_to_msg(shapes: Sequence[Shape], stamp: Time) -> MarkerArray:
    """Return the markers of shapes, all in the laboratory frame."""
    return MarkerArray(markers=[_marker(shape, stamp) for shape in shapes])


def clear_msg(stamp: Time) -> MarkerArray:
    """Return what takes away all that was drawn."""
    marker = Marker(action=Marker.DELETEALL)
    marker.header.stamp = stamp
    marker.header.frame_id = LABORATORY
    return MarkerArray(markers=[marker])


def _marker(shape: Shape, stamp: Time) -> Marker:
    marker = Marker(ns=shape.layer, id=shape.number, text=shape.text)
    marker.header.stamp = stamp
    marker.header.frame_id = LABORATORY
    if shape.kind is Kind.NOTHING:
        marker.action = Marker.DELETE
        return marker
    marker.type = _TYPES[shape.kind]
    marker.scale = Vector3(x=shape.size[0], y=shape.size[1], z=shape.size[2])
    red, green, blue, opacity = shape.colour
    marker.color = ColorRGBA(r=red, g=green, b=blue, a=opacity)
    if shape.kind in (Kind.BOX, Kind.TEXT):
        marker.pose.position = _point(shape.points[0].tolist())
        marker.pose.orientation = _quaternion(shape.orientation.tolist())
    else:
        marker.points = [_point(point) for point in shape.points.tolist()]
    return marker


def _point(values: Sequence[float]) -> Point:
    return Point(x=values[0], y=values[1], z=values[2])


def _quaternion(values: Sequence[float]) -> Quaternion:
    return Quaternion(x=values[0], y=values[1], z=values[2], w=values[3])


class TransformWriter:
    """The serialised message of moving frames, of which only the numbers change.

    Setting and serialising 40 transforms field by field takes half of the node's processor time:
    the message is serialised once, and numbers and stamps are written where they are in it.

    Parameters
    ----------
    parents, children : sequence of str, n
        Names of the frames.
    """

    def __init__(self, parents: Sequence[str], children: Sequence[str]) -> None:
        message = TFMessage(
            transforms=[
                _named(parent, child) for parent, child in zip(parents, children, strict=True)
            ]
        )
        # Numbers that occur nowhere else mark the places.
        marks = 0.5 + np.arange(7.0 * len(children)).reshape(-1, 7)
        for k, (entry, values) in enumerate(zip(message.transforms, marks.tolist(), strict=True)):
            entry.header.stamp = Time(sec=_MARK + k, nanosec=_MARK + k)
            place, turn = entry.transform.translation, entry.transform.rotation
            place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w = values
        self._data = np.frombuffer(bytearray(serialize_message(message)), np.uint8)
        # CDR aligns numbers to their size, counted from after the four bytes of its head.
        body = self._data[_HEAD:]
        self._numbers = body[: body.size // 8 * 8].view(np.float64)
        self._words = body[: body.size // 4 * 4].view(np.int32)
        self._at = np.array([np.flatnonzero(self._numbers == mark) for mark in marks.ravel()])
        stamps = _MARK + np.arange(len(marks))
        self._stamps = np.array([np.flatnonzero(self._words == mark) for mark in stamps])
        if self._at.shape != (marks.size, 1) or self._stamps.shape != (len(marks), 2):
            raise PictureError('tf2_msgs/TFMessage: the places of its numbers were not found')

    def message(self, stamp: Time, transforms: Array) -> bytes:
        """Return the serialised message of translations and quaternions (n, 7)."""
        self._numbers[self._at[:, 0]] = transforms.ravel()
        self._words[self._stamps] = stamp.sec, stamp.nanosec
        return self._data.tobytes()


def fixed_to_msg(links: LinkFrames, stamp: Time) -> TFMessage:
    """Return the message of the links that have no joint."""
    message = TFMessage()
    for parent, child, place in links.fixed:
        entry = _named(parent, child)
        entry.header.stamp = stamp
        at = entry.transform.translation
        at.x, at.y, at.z = place.tolist()
        message.transforms.append(entry)
    return message


def _named(parent: str, child: str) -> TransformStamped:
    entry = TransformStamped(child_frame_id=child)
    entry.header.frame_id = parent
    return entry


def loads_from_msg(message: SpineLoad) -> SpineLoads:
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
