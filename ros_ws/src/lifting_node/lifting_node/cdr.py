# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A reader of serialised messages (common data representation of the OMG), for fast streams."""

from __future__ import annotations

import struct
from typing import Final

#: Bytes before the content; alignment is counted from behind them.
HEAD: Final = 4
_LITTLE_ENDIAN: Final = 1
_UNSIGNED: Final = struct.Struct('<I')
_TIME: Final = struct.Struct('<iI')


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
        return _UNSIGNED.unpack_from(self._data, begin)[0], range(begin, begin + 4)

    def stamp(self) -> float:
        """Return a time [s]."""
        seconds, nanoseconds = _TIME.unpack_from(self._data, self.skip(4, 8))
        return float(seconds) + nanoseconds / 1e9

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
