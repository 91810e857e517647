# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker frames as they come, in the order of the marker model."""

from collections import Counter
from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from human_model.compiled_cache import njit
from human_model.typing import Array
from motion_tracker.core.exceptions import TrackerError

IntArray = npt.NDArray[np.intp]

#: A coordinate beyond this is no position in metres in a laboratory [m].
LARGEST_POSITION = 50.0


class MarkerFrames:
    """Order of the markers in a frame; each unknown name is reported once.

    Parameters
    ----------
    names
        Of the marker model, in its order.
    known
        Further names that need no notice: markers of the set that are not tracked.
    counts
        Where refused markers are counted.
    """

    def __init__(self, names: Sequence[str], known: Iterable[str], counts: Counter[str]) -> None:
        self._row = {name: i for i, name in enumerate(names)}
        self._noticed = set(known)
        self._counts = counts
        self._names: tuple[str, ...] = ()
        self._twice = 0
        self._rows = self._places = np.zeros(0, dtype=np.intp)

    def arrange(
        self, stamp: float, names: Sequence[str], positions: npt.ArrayLike
    ) -> tuple[Array, list[str]]:
        """Positions (n_markers, 3) [m] in the model's order, and names not seen before.

        A marker that is not there is NaN; so is one whose name occurs twice, and one at exactly
        0, 0, 0, with which many programs fill gaps.

        Raises
        ------
        TrackerError
            If names and positions do not belong together, or the positions are not in metres.
        """
        array = np.ascontiguousarray(positions, dtype=np.float64).reshape(-1, 3)
        if len(array) != len(names):
            raise TrackerError(
                f'markers at {stamp:.3f} s: {len(names)} names, {len(array)} positions'
            )
        largest = _largest(array)
        if largest > LARGEST_POSITION:
            raise TrackerError(
                f'markers at {stamp:.3f} s: a coordinate is {largest:.0f} m; are '
                'the markers in millimetres?'
            )
        unknown: list[str] = []
        if tuple(names) != self._names:
            unknown = self._plan(tuple(names))
        if self._twice:
            self._counts['markers: name twice in a frame'] += self._twice
        target, zeros = _scattered(array, self._rows, self._places, len(self._row))
        if zeros:
            self._counts['markers: at 0, 0, 0, taken as not seen'] += zeros
        return target, unknown

    def _plan(self, names: tuple[str, ...]) -> list[str]:
        """Find out which position goes where; return names not seen before."""
        known = [name for name in names if name in self._row]
        once = [name for name, number in Counter(known).items() if number == 1]
        self._names = names
        self._twice = len(known) - len(set(known))
        self._rows = np.array([self._row[name] for name in once], dtype=np.intp)
        self._places = np.array([names.index(name) for name in once], dtype=np.intp)
        unknown = [
            name
            for name in dict.fromkeys(names)
            if name not in self._row and name not in self._noticed
        ]
        self._noticed.update(unknown)
        return unknown


@njit
def _largest(positions: Array) -> float:
    """Largest finite size of a coordinate."""
    largest = 0.0
    for i in range(positions.shape[0]):
        for axis in range(3):
            size = abs(positions[i, axis])
            if size > largest and size < np.inf:
                largest = size
    return largest


@njit
def _scattered(positions: Array, rows: IntArray, places: IntArray, n: int) -> tuple[Array, int]:
    """Positions (n, 3) whose ``rows`` are those at ``places``, the others NaN; count of zeros."""
    target = np.full((n, 3), np.nan)
    zeros = 0
    for i in range(rows.shape[0]):
        place = positions[places[i]]
        if place[0] == 0.0 and place[1] == 0.0 and place[2] == 0.0:
            zeros += 1
        else:
            target[rows[i]] = place
    return target, zeros
