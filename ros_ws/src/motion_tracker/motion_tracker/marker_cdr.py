# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker frames straight from their serialised messages.

A frame of 58 markers is 175 Python objects as a message, which take longer to make than its
inverse kinematics. From frame to frame only the numbers change: the places of names and numbers
are found once and then only compared.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from human_model.typing import Array
from lifting_node.cdr import HEAD, CdrError, Reader
from motion_tracker.core.exceptions import TrackerError


@dataclass(frozen=True, eq=False)
class _Layout:
    """Where things are in messages of one length.

    Attributes
    ----------
    names : tuple of str
    mask : int
        The message as one whole number, with all bits of the bytes of counts, lengths and names.
    content : int
        The message as one whole number, the other bytes zero.
    numbers : (n, 3) array of int
        Places of the coordinates, counted in doubles from the end of the head.
    """

    names: tuple[str, ...]
    mask: int
    content: int
    numbers: npt.NDArray[np.int64]


class MarkerReader:
    """Reads `Markers` messages of one topic."""

    def __init__(self) -> None:
        self._layouts: dict[int, _Layout] = {}

    def read(self, data: bytes) -> tuple[float, tuple[str, ...], Array]:
        """Return stamp [s], names and positions (n, 3) [m] of a serialised marker frame.

        Raises
        ------
        TrackerError
            If the data are no little-endian `Markers`.
        """
        layout = self._layouts.get(len(data))
        # Whole numbers are compared faster than arrays are gathered.
        if layout is None or int.from_bytes(data, 'little') & layout.mask != layout.content:
            layout = self._layouts[len(data)] = _layout(data)
        try:
            stamp = Reader(data).stamp()
        except CdrError as error:
            raise TrackerError(f'markers: {error}') from error
        doubles = np.frombuffer(data, '<f8', (len(data) - HEAD) // 8, HEAD)
        return stamp, layout.names, doubles[layout.numbers]


def _layout(data: bytes) -> _Layout:
    """Walk through a message once."""
    fixed: list[int] = []
    try:
        reader = Reader(data)
        reader.stamp()
        fixed += reader.string()[1]
        reader.skip(4, 4)
        count, places = reader.unsigned()
        fixed += places
        names, numbers = [], []
        for _ in range(count):
            reader.skip(1, 1)
            reader.skip(4, 4)
            name, octets_of_name = reader.string()
            names.append(name)
            fixed += octets_of_name
            begin = reader.skip(8, 24)
            numbers.append([(begin - HEAD) // 8 + axis for axis in range(3)])
    except CdrError as error:
        raise TrackerError(f'markers: {error}') from error
    octets = np.zeros(len(data), np.uint8)
    octets[fixed] = 0xFF
    mask = int.from_bytes(octets.tobytes(), 'little')
    return _Layout(
        tuple(names),
        mask,
        int.from_bytes(data, 'little') & mask,
        np.array(numbers, np.int64).reshape(-1, 3),
    )
