# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages from the values of their fields: as objects, or serialised at once.

A live muscle analysis as a message object is some 360 Python strings and a check of every field,
for the middleware to turn into bytes. Written at once, names become bytes when they are first
seen, and arrays are copied as they lie.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from lifting_node.cdr import COUNT, LITTLE_ENDIAN_HEAD, fields

#: Adds a value to the bytes behind the head.
Put = Callable[[bytearray, Any], None]

#: Bytes that fill up to the next place of two, four or eight.
_FILL: Final = tuple(bytes(size) for size in range(8))


class MessageWriter:
    """Makes messages of one type.

    Values are numbers, texts, sequences of numbers as arrays of any shape (row-major), sequences
    of texts as tuples, and mappings for messages within the message.

    Parameters
    ----------
    message_type : type
        Of numbers, texts, sequences of them and messages of these.

    Raises
    ------
    TypeError
        If the type has a field of another kind.
    """

    def __init__(self, message_type: Any) -> None:
        self._puts = [
            (name, _form(several, content)) for name, several, content in fields(message_type)
        ]

    def write(self, values: Mapping[str, Any]) -> bytes:
        """Return the serialised message (common data representation, little-endian).

        Raises
        ------
        KeyError
            If the value of a field is missing.
        """
        out = bytearray()
        self.put(out, values)
        return LITTLE_ENDIAN_HEAD + out

    def put(self, out: bytearray, values: Mapping[str, Any] | Any) -> None:
        """Add the message to the bytes of one that it is a part of; raises as `write`."""
        fields_ = values if isinstance(values, Mapping) else vars(values)
        for name, put in self._puts:
            put(out, fields_[name])


def _form(several: bool, content: Any) -> Put:
    """Return the function that writes a field of such content."""
    if content is str:
        return _Names() if several else _put_text
    if not isinstance(content, str):
        return MessageWriter(content).put
    if several:
        return _numbers(content)
    return _number(struct.Struct('<' + content))


def _number(kind: struct.Struct) -> Put:
    pack, size = kind.pack, kind.size

    def put(out: bytearray, value: Any) -> None:
        out += _FILL[-len(out) % size]
        out += pack(value)

    return put


def _numbers(code: str) -> Put:
    kind = np.dtype('<' + code)
    size = kind.itemsize

    def put(out: bytearray, value: Any) -> None:
        data = np.ascontiguousarray(value, kind)
        out += _FILL[-len(out) % 4]
        out += COUNT.pack(data.size)
        if data.size:
            out += _FILL[-len(out) % size]
            # Its own bytes, not a copy: those of a whole lift are half a megabyte.
            out += data.data

    return put


def _put_text(out: bytearray, value: str) -> None:
    data = value.encode()
    out += _FILL[-len(out) % 4]
    out += COUNT.pack(len(data) + 1)
    out += data
    out.append(0)


class _Names:
    """Writes a sequence of texts, and remembers the bytes of the last one."""

    def __init__(self) -> None:
        self._last: tuple[str, ...] = ()
        self._bytes = COUNT.pack(0)

    def __call__(self, out: bytearray, value: tuple[str, ...]) -> None:
        if value is not self._last and value != self._last:
            written = bytearray(COUNT.pack(len(value)))
            for text in value:
                _put_text(written, text)
            self._last, self._bytes = value, bytes(written)
        out += _FILL[-len(out) % 4]
        out += self._bytes
