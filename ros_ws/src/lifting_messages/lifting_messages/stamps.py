# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Message stamps and seconds."""

from __future__ import annotations

from lifting_messages.message_types import Message, make

NANOSECONDS = 1_000_000_000


def to_seconds(stamp: Message) -> float:
    """Return a stamp as seconds [s]; exact to 0.24 microseconds for stamps of this century."""
    return float(stamp.sec) + float(stamp.nanosec) / NANOSECONDS


def to_stamp(seconds: float) -> Message:
    """Return seconds [s] as a stamp, to the microsecond: a double holds no more of an epoch."""
    sec, nanosec = split(seconds)
    return make('builtin_interfaces/Time', sec=sec, nanosec=nanosec)


def split(seconds: float) -> tuple[int, int]:
    """Return whole seconds and nanoseconds of a stamp as `to_stamp` makes it."""
    microseconds = round(seconds * 1_000_000)
    return microseconds // 1_000_000, microseconds % 1_000_000 * 1000


def header(time: float, frame_id: str = '') -> Message:
    """Return the header of a message with a stamp [s] and the name of its frame."""
    return make('std_msgs/Header', stamp=to_stamp(time), frame_id=frame_id)
