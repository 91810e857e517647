# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Fields of a serialised message, without building the message.

A live muscle analysis is some 360 Python strings as a message object, which take longer to make
than what is done with them. A view has the same fields under the same names, so that what reads
messages reads views too. Arrays are those in the message's own bytes; names, which are the same
from sample to sample, are made once and then only compared.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Collection
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Final

import numpy as np

from lifting_node import cdr
from lifting_node.cdr import COUNT, HEAD, LITTLE_ENDIAN_HEAD, CdrError

#: Takes the bytes behind the head and a place in them; returns the value and the place behind it.
Take = Callable[[bytes, int], tuple[Any, int]]

#: Lists of names kept for one field: those of a few skeletons and muscle models.
_LISTS: Final = 8


def viewed(
    message_type: Any, callback: Callable[[Any], None], fields: Collection[str] | None = None
) -> Callable[[bytes], None]:
    """Return a callback for serialised messages that hands views of them to another one."""
    view = MessageView(message_type, fields)

    def callback_of_view(data: bytes) -> None:
        callback(view.read(data))

    return callback_of_view


class MessageView:
    """Reads serialised messages of one type.

    Parameters
    ----------
    message_type : type
        Of numbers, texts, sequences of them and messages of these.
    fields : collection of str, optional
        Those wanted; all if absent. What comes after the last of them is not looked at.

    Raises
    ------
    TypeError
        If the type has a field of another kind, or lacks one that is wanted.
    """

    def __init__(self, message_type: Any, fields: Collection[str] | None = None) -> None:
        self._name = message_type.__name__
        self._view = type(self._name, (SimpleNamespace,), {})
        known = cdr.fields(message_type)
        names = [name for name, _, _ in known]
        unknown = set(fields or ()) - set(names)
        if unknown:
            raise TypeError(f'{self._name} has no {sorted(unknown)}')
        last = len(names) if fields is None else 1 + max(names.index(name) for name in fields)
        self._steps = [
            (name, fields is None or name in fields, _take(several, content))
            for name, several, content in known[:last]
        ]

    def read(self, data: bytes) -> Any:
        """Return an object with the fields of a serialised message, and its type's name.

        Sequences of numbers are read-only arrays, sequences of texts are tuples.

        Raises
        ------
        CdrError
            If the data are no such little-endian message; names the field.
        """
        if len(data) < HEAD or data[1] != LITTLE_ENDIAN_HEAD[1]:
            raise CdrError(f'{self._name}: {len(data)} bytes are no little-endian message')
        # Without the head doubles lie where the processor wants them.
        return self.read_at(data[HEAD:], 0)[0]

    def read_at(self, octets: bytes, at: int) -> tuple[Any, int]:
        """Return the same of a message within another, and the place behind it."""
        values = {}
        for name, wanted, take in self._steps:
            try:
                value, at = take(octets, at)
            except (struct.error, ValueError) as error:
                raise CdrError(f'{self._name}.{name}: {error}') from error
            if wanted:
                values[name] = value
        return self._view(**values), at


def _take(several: bool, content: Any) -> Take:
    """Return what reads a field of such content."""
    if content is str:
        return _Names() if several else _text
    if not isinstance(content, str):
        return MessageView(content).read_at
    return _numbers(np.dtype('<' + content)) if several else _number(struct.Struct('<' + content))


def _number(kind: struct.Struct) -> Take:
    unpack, size = kind.unpack_from, kind.size

    def take(octets: bytes, at: int) -> tuple[Any, int]:
        at += -at % size
        return unpack(octets, at)[0], at + size

    return take


def _numbers(kind: np.dtype[Any]) -> Take:
    size = kind.itemsize
    nothing = np.empty(0, kind)
    nothing.setflags(write=False)

    def take(octets: bytes, at: int) -> tuple[Any, int]:
        count, at = _count(octets, at)
        if count == 0:
            return nothing, at
        at += -at % size
        return np.frombuffer(octets, kind, count, at), at + count * size

    return take


def _count(octets: bytes, at: int) -> tuple[int, int]:
    at += -at % 4
    return COUNT.unpack_from(octets, at)[0], at + 4


def _text(octets: bytes, at: int) -> tuple[str, int]:
    size, at = _count(octets, at)
    end = at + size
    if end > len(octets):
        raise ValueError(f'cut off after {len(octets)} bytes')
    return octets[at:end].rstrip(b'\0').decode(), end


@dataclass(frozen=True)
class _Known:
    """A sequence of texts that was read: its size in bytes, and these as one whole number.

    The mask blanks out the bytes that only fill up to the next place of four: they may hold
    anything.
    """

    names: tuple[str, ...]
    size: int
    mask: int
    content: int


class _Names:
    """Reads a sequence of texts, and remembers those that it has read."""

    def __init__(self) -> None:
        self._known: list[_Known] = []

    def __call__(self, octets: bytes, at: int) -> tuple[tuple[str, ...], int]:
        at += -at % 4
        for known in self._known:
            end = at + known.size
            # Whole numbers: arrays take three times as long to blank out and to compare.
            found = int.from_bytes(octets[at:end], 'little')
            if found & known.mask == known.content and end <= len(octets):
                return known.names, end
        known = _walk(octets, at)
        self._known = [known, *self._known[: _LISTS - 1]]
        return known.names, at + known.size


def _walk(octets: bytes, begin: int) -> _Known:
    """Read a sequence of texts one by one."""
    count, at = _count(octets, begin)
    names = []
    mask = bytearray(b'\xff' * 4)
    for _ in range(count):
        start = at + -at % 4
        text, end = _text(octets, start)
        names.append(text)
        mask += bytes(start - at) + b'\xff' * (end - start)
        at = end
    bits = int.from_bytes(mask, 'little')
    content = int.from_bytes(octets[begin:at], 'little') & bits
    return _Known(tuple(names), at - begin, bits, content)
