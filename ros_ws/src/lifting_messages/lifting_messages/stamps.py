# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Message stamps and seconds."""

from __future__ import annotations

from functools import cache
from typing import Any, Final

from rosbags.interfaces import Nodetype

from lifting_messages.message_types import Message, decode, full_name, make, typestore

NANOSECONDS = 1_000_000_000

_TIME: Final = 'builtin_interfaces/msg/Time'
_HEADER: Final = 'std_msgs/msg/Header'
#: Bytes before the fields of a serialised message, of a count of elements, and of a stamp.
_HEAD, _COUNT, _STAMP = 4, 4, 8


def stamp_of(data: bytes, name: str) -> int:
    """Return the stamp [ns] of a serialised message, or of its first element; 0 without one.

    A message with a header begins with its stamp: nothing else of it is decoded.

    Parameters
    ----------
    data : bytes
        Serialised message.
    name : str
        Its type.
    """
    begin = _stamp_begin(full_name(name))
    if begin is None or len(data) < begin + _STAMP:
        return 0
    stamp = decode(data[:_HEAD] + data[begin : begin + _STAMP], _TIME)
    return int(stamp.sec) * NANOSECONDS + int(stamp.nanosec)


@cache
def _stamp_begin(name: str) -> int | None:
    """Return the place of the stamp in serialised messages of a type; None without one."""
    kind, content = _first_field(name)
    if kind == Nodetype.NAME and content in (_HEADER, _TIME):
        return _HEAD
    # A list of stamped messages, such as transforms.
    if kind == Nodetype.SEQUENCE and content[0][0] == Nodetype.NAME:
        stamped = _first_field(content[0][1]) == (Nodetype.NAME, _HEADER)
        return _HEAD + _COUNT if stamped else None
    return None


def _first_field(name: str) -> tuple[Any, Any]:
    fields = typestore().fielddefs[name][1]
    return fields[0][1] if fields else (None, None)


def to_seconds(stamp: Message) -> float:
    """Return a stamp as seconds [s]; exact to 0.24 microseconds for stamps of this century."""
    return float(stamp.sec) + float(stamp.nanosec) / NANOSECONDS


def to_stamp(seconds: float) -> Message:
    """Return seconds [s] as a stamp, to the microsecond: a double holds no more of an epoch."""
    sec, microseconds = divmod(round(seconds * 1_000_000), 1_000_000)
    return make('builtin_interfaces/Time', sec=sec, nanosec=1000 * microseconds)


def header(time: float, frame_id: str = '') -> Message:
    """Return the header of a message with a stamp [s] and the name of its frame."""
    return make('std_msgs/Header', stamp=to_stamp(time), frame_id=frame_id)
