# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Message types without ROS: rosbags' dataclasses of the Jazzy types and of lifting_interfaces.

In Python a message of the graph is such a dataclass, with NumPy arrays; rosbags' generated code
is the one codec between it and the bytes of a topic or a recording.
"""

from __future__ import annotations

import struct
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from lifting_messages.exceptions import MessageError, MessageTypeError

#: A message of any type; rosbags makes its class when the program runs.
Message: TypeAlias = Any

_PACKAGE = 'lifting_interfaces'

#: Bytes before the fields of a serialised message; the first two are the order of bytes.
_HEAD = 4
_BIG_ENDIAN, _LITTLE_ENDIAN = b'\0\0', b'\0\1'


def interface_folder() -> Path:
    """Return the folder of lifting_interfaces' .msg files.

    They lie in this package where it was installed as a wheel, beside it in the source tree, or
    in the share folder of a built lifting_interfaces.

    Raises
    ------
    MessageTypeError
        Found in none of these places.
    """
    here = Path(__file__).resolve().parent
    places = [here / 'msg', here.parents[1] / _PACKAGE / 'msg']
    for place in places:
        if place.is_dir():
            return place
    try:
        from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
    except ModuleNotFoundError as error:
        raise MessageTypeError(f'{_PACKAGE}: not at {places[-1]}, no ament index') from error
    try:
        return Path(get_package_share_directory(_PACKAGE)) / 'msg'
    except PackageNotFoundError as error:
        raise MessageTypeError(f'{_PACKAGE} is not installed and not at {places[-1]}') from error


@cache
def typestore() -> Typestore:
    """Return a store with the Jazzy types and those of lifting_interfaces."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types = {}
    folder = interface_folder()
    files = sorted(folder.glob('*.msg'))
    if not files:
        raise MessageTypeError(f'{folder} holds no .msg files')
    for file in files:
        text = file.read_text(encoding='utf-8')
        types.update(get_types_from_msg(text, f'{_PACKAGE}/msg/{file.stem}'))
    store.register(types)
    return store


@cache
def full_name(name: str) -> str:
    """Return 'package/msg/Name' of 'package/Name', or of a name of lifting_interfaces."""
    if '/' not in name:
        return f'{_PACKAGE}/msg/{name}'
    return name if '/msg/' in name else name.replace('/', '/msg/')


@cache
def message_type(name: str) -> Any:
    """Return the class of a message; its constants are attributes.

    Parameters
    ----------
    name : str
        'package/msg/Name', 'package/Name', or 'Name' of lifting_interfaces.

    Raises
    ------
    MessageTypeError
        If there is no such type.
    """
    kind = typestore().types.get(full_name(name))
    if kind is None:
        raise MessageTypeError(f'there is no message type {full_name(name)}')
    return kind


def make(name: str, /, **fields: Any) -> Message:
    """Return a message of a type.

    Parameters
    ----------
    name : str
        As `message_type` takes it.
    **fields
        Values; those that are not given are zero or empty. Arrays of numbers may have any shape
        (they are written row-major) and type.
    """
    for field, kind, content in _contents(full_name(name)):
        if field not in fields:
            fields[field] = _zero(*content)
        elif kind is not None:
            fields[field] = np.ascontiguousarray(fields[field], kind).reshape(-1)
    return message_type(name)(**fields)


@cache
def _contents(name: str) -> tuple[tuple[str, np.dtype[Any] | None, Any], ...]:
    """Return name, type of the numbers if it is an array of them, and content of each field."""
    contents = []
    for field, (node, content) in typestore().fielddefs[name][1]:
        numbers = node in (Nodetype.ARRAY, Nodetype.SEQUENCE)
        numbers = numbers and content[0][0] == Nodetype.BASE and content[0][1][0] != 'string'
        kind = np.dtype(content[0][1][0]) if numbers else None
        contents.append((field, kind, (node, content)))
    return tuple(contents)


def _zero(node: Nodetype, content: Any) -> Any:
    if node == Nodetype.BASE:
        kind = content[0]
        return '' if kind == 'string' else kind == 'never' if kind == 'bool' else _number(kind)
    if node == Nodetype.NAME:
        return make(content)
    (inner, element), length = content
    size = length if node == Nodetype.ARRAY else 0
    if inner == Nodetype.BASE and element[0] != 'string':
        return np.zeros(size, np.dtype(element[0]))
    return [_zero(inner, element) for _ in range(size)]


def _number(kind: str) -> float | int:
    return 0.0 if kind.startswith('float') else 0


def encode(message: Message) -> bytes:
    """Return a message serialised (CDR, little-endian), as DDS and recordings have it."""
    return bytes(typestore().serialize_cdr(message, message.__msgtype__))


def decode(data: bytes, name: str) -> Message:
    """Return the message of serialised data.

    Parameters
    ----------
    data : bytes
        Its arrays of numbers stay in here: they are read-only.
    name : str
        Type, as `message_type` takes it.

    Raises
    ------
    MessageError
        If the data are no message of this type.
    """
    name = full_name(name)
    if len(data) < _HEAD or data[:2] not in (_BIG_ENDIAN, _LITTLE_ENDIAN):
        raise MessageError(name, len(data), 'they do not begin as plain CDR')
    store = typestore()
    definition = store.get_msgdef(name)
    little = data[:2] == _LITTLE_ENDIAN
    take = definition.deserialize_cdr_le if little else definition.deserialize_cdr_be
    try:
        # Not `deserialize_cdr`: it refuses bytes after the message, as rclpy's serialize_message
        # leaves them; ROS 2 ignores them.
        message, end = take(data[_HEAD:], 0, definition.cls, store)
    except (SerdeError, struct.error, IndexError, ValueError) as error:
        raise MessageError(name, len(data), str(error)) from error
    if end + _HEAD > len(data):
        raise MessageError(name, len(data), 'the message is cut off')
    return message
