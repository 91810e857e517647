# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What serialised messages consist of (common data representation of the OMG), and a reader."""

from __future__ import annotations

import importlib
import struct
from typing import Any, Final

from rosidl_parser.definition import BasicType, NamespacedType, UnboundedSequence, UnboundedString

#: Before the content of a little-endian message; alignment is counted from behind it.
LITTLE_ENDIAN_HEAD: Final = b'\0\1\0\0'
HEAD: Final = len(LITTLE_ENDIAN_HEAD)
#: How many follow: texts, numbers, bytes of a text.
COUNT: Final = struct.Struct('<I')
_LITTLE_ENDIAN: Final = 1
_TIME: Final = struct.Struct('<iI')


#: Codes of `struct`, numpy and `array` for the numbers in messages of the graph.
_NUMBERS: Final = {'double': 'd', 'uint8': 'B', 'uint16': 'H', 'uint32': 'I', 'int32': 'i'}


class CdrError(ValueError):
    """The bytes are not what they should be; says where."""


class Reader:
    """Walks through a little-endian message.

    Parameters
    ----------
    data : bytes
        Head included.

    Raises
    ------
    CdrError
        If the head is not that of a little-endian message.
    """

    def __init__(self, data: bytes) -> None:
        if len(data) < HEAD or data[1] != _LITTLE_ENDIAN:
            raise CdrError(f'{len(data)} bytes are no little-endian message')
        self._data = data
        self._at = HEAD

    def skip(self, alignment: int, size: int) -> int:
        """Pass over so many bytes at an alignment; return the place of the first.

        Raises
        ------
        CdrError
            If the message ends before.
        """
        begin = self._at + (HEAD - self._at) % alignment
        if begin + size > len(self._data):
            raise CdrError(f'cut off after {len(self._data)} bytes')
        self._at = begin + size
        return begin

    def unsigned(self) -> tuple[int, range]:
        """Return an unsigned integer of 32 bits and the places of its bytes."""
        begin = self.skip(4, 4)
        return COUNT.unpack_from(self._data, begin)[0], range(begin, begin + 4)

    def stamp(self) -> float:
        """Return a time [s]."""
        seconds, nanoseconds = _TIME.unpack_from(self._data, self.skip(4, 8))
        return float(seconds + nanoseconds / 1e9)

    def string(self) -> tuple[str, list[int]]:
        """Return a text and the places of its length's and its own bytes.

        Raises
        ------
        CdrError
            If it is not in UTF-8.
        """
        size, places = self.unsigned()
        begin = self.skip(1, size)
        try:
            text = self._data[begin : begin + size].rstrip(b'\0').decode()
        except UnicodeDecodeError as error:
            raise CdrError(f'a text at byte {begin} is not in UTF-8') from error
        return text, [*places, *range(begin, begin + size)]


def fields(message_type: Any) -> list[tuple[str, bool, Any]]:
    """Return name, whether it is a sequence, and content of each field of a type of messages.

    The content is a code of `struct` for a number, the class `str` for a text, or the type of a
    message within the message.

    Raises
    ------
    TypeError
        If a field is none of these; names it.
    """
    owner = message_type.__name__
    names = message_type.get_fields_and_field_types()
    return [
        (name, isinstance(kind, UnboundedSequence), _content(f'{owner}.{name}', kind))
        for name, kind in zip(names, message_type.SLOT_TYPES, strict=True)
    ]


def _content(field: str, kind: Any) -> Any:
    one = kind.value_type if isinstance(kind, UnboundedSequence) else kind
    if isinstance(one, BasicType) and one.typename in _NUMBERS:
        return _NUMBERS[one.typename]
    if isinstance(one, UnboundedString):
        return str
    if isinstance(one, NamespacedType) and one is kind:
        return getattr(importlib.import_module('.'.join(one.namespaces)), one.name)
    raise TypeError(f'{field}: a {kind} can neither be viewed nor written')
