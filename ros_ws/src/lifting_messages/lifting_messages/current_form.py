# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of earlier definitions, and of other packages, in the form of today.

A recording carries the definitions it was made with.  Its messages are decoded with these and
brought into today's form here, so that nothing else meets an earlier one.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.typesys.store import Typestore

from lifting_messages.message_types import Message, full_name, make, typestore
from lifting_messages.names import join

MARKERS: Final = full_name('Markers')

#: Types of other packages that hold the same as one of ours.
SAME_CONTENT: Final = {'mocap4r2_msgs/msg/Markers': MARKERS}

#: Fields that had another name.
_RENAMED: Final = {
    'avoidable_compression': 'unnecessary_compression',
    'avoidable_shear': 'unnecessary_shear',
}


def current_type(name: str) -> str:
    """Return the type that messages of a type have in today's form."""
    return SAME_CONTENT.get(name, name)


def is_current(name: str, store: Typestore) -> bool:
    """Return whether a store defines a type as today, or the type is none of ours."""
    if name in SAME_CONTENT:
        return False
    if not name.startswith(full_name('')):
        return True
    today = typestore().fielddefs
    if name not in today:
        return True
    if name not in store.fielddefs or store.fielddefs[name][1] != today[name][1]:
        return False
    return all(is_current(part, store) for part in _parts(today[name][1]))


def _parts(fields: Any) -> Iterator[str]:
    """Yield the types of messages that are fields, or elements of fields."""
    for _, field in fields:
        node, content = field[1][0] if field[0] in (Nodetype.ARRAY, Nodetype.SEQUENCE) else field
        if node == Nodetype.NAME:
            yield content


def current_form(message: Message, name: str) -> Message:
    """Return a message of an earlier definition in today's form.

    A number that the earlier definition does not have is NaN, or 0 where it is whole; lists of
    names that are one text today are joined.

    Parameters
    ----------
    message : Message
        As decoded with the definition of its recording.
    name : str
        Its type there.

    Raises
    ------
    MessageTypeError
        If the type is none of ours.
    NameListError
        If a name of a list is empty or has a line break.
    """
    name = current_type(name)
    if name == MARKERS and hasattr(message, 'markers'):
        return _markers(message)
    return make(name, **{field: _field(message, field, kind) for field, kind in _fields(name)})


def _fields(name: str) -> list[tuple[str, Any]]:
    kinds = make(name)
    return [(field, getattr(kinds, field)) for field, _ in typestore().fielddefs[name][1]]


def _field(message: Message, field: str, empty: Any) -> Any:
    """Return the value for a field whose empty value is `empty`."""
    if not hasattr(message, field):
        field = _RENAMED.get(field, field)
    if not hasattr(message, field):
        return math.nan if isinstance(empty, float) else empty
    value = getattr(message, field)
    if isinstance(value, list) and isinstance(empty, str):
        return join(value)
    if hasattr(empty, '__msgtype__'):
        return current_form(value, empty.__msgtype__)
    return value


def _markers(message: Message) -> Message:
    """Return a frame of named markers, each a message of its own, as names and positions."""
    return make(
        MARKERS,
        header=current_form(message.header, 'std_msgs/msg/Header'),
        frame_number=message.frame_number,
        names=join(_marker_name(marker) for marker in message.markers),
        positions=np.array(
            [(m.translation.x, m.translation.y, m.translation.z) for m in message.markers]
        ),
    )


def _marker_name(marker: Message) -> str:
    """Return the name of a marker, or its number where it has none."""
    return str(marker.marker_name) or str(marker.marker_index)
