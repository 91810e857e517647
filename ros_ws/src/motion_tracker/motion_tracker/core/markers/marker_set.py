# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker sets as data: which marker sits where on which segment, and how much it counts.

A set is a CSV file in ``data/marker_sets``. Positions are in metres in the segment's anatomical
frame (REP-103 axes in the neutral posture, origin in the proximal joint) for the reference
subject below; for another person each axis is scaled with the length or the three lengths (x y z)
that ``scale_with`` names. Rows without a position get theirs from a static trial only. ``weight``
is the weight of the squared distance in the fit: bony landmarks count twice as much as markers
over muscle, on the moving shoulder, or where the skin of the back slides. ``tracking`` is ``no``
for markers that are only known by name or used in the static trial only.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from human_model.anthropometry import segment_lengths
from human_model.subject import Subject
from human_model.tables import Row, read_file, read_table
from human_model.typing import Array
from motion_tracker.core.exceptions import MarkerSetError

#: Person the positions of the marker sets belong to.
REFERENCE_SUBJECT = Subject('reference', 'male', 75.0, 1.75, 30.0)

DATA = Path(__file__).resolve().parents[2] / 'data'

COLUMNS = 'marker segment x y z scale_with weight tracking'


@dataclass(frozen=True)
class Marker:
    """One row of a marker set.

    Attributes
    ----------
    name, segment : str
    position : tuple of 3 float or None
        For the reference subject [m]; None when only a static trial gives it.
    scale_with : tuple of 3 str
        Lengths the axes scale with; empty strings without a position.
    weight : float
    tracking : bool
    """

    name: str
    segment: str
    position: tuple[float, float, float] | None
    scale_with: tuple[str, str, str]
    weight: float
    tracking: bool


@dataclass(frozen=True)
class MarkerSet:
    """A named set of markers.

    Attributes
    ----------
    name : str
    markers : tuple of Marker
    path : Path or None
        File of a set of one's own; None for a set of the package.
    """

    name: str
    markers: tuple[Marker, ...]
    path: Path | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all markers."""
        return tuple(marker.name for marker in self.markers)

    def marker(self, name: str) -> Marker:
        """Marker by name."""
        for marker in self.markers:
            if marker.name == name:
                return marker
        raise MarkerSetError(f'marker set {self.name}: no marker named {name!r}')

    def positions(self, lengths: Mapping[str, float]) -> dict[str, Array]:
        """Positions (3,) [m] in the segments' frames, scaled to a person's segment lengths.

        Markers without a position in the set are left out.
        """
        reference = _reference_lengths()
        scaled = {}
        for marker in self.markers:
            if marker.position is None:
                continue
            ratio = [lengths[key] / reference[key] for key in marker.scale_with]
            scaled[marker.name] = np.array(marker.position) * ratio
        return scaled


def mirror_name(name: str, names: Sequence[str]) -> str | None:
    """Name of the marker on the other side of the body, if there is one among ``names``.

    The side is a leading L or R, in either case, as in ``LKNE``, ``r_knee`` or ``L.ASIS``.
    """
    other = {'L': 'R', 'R': 'L'}.get(name[:1].upper())
    if other is None:
        return None
    for candidate in (other + name[1:], other.lower() + name[1:]):
        if candidate in names:
            return candidate
    return None


def available() -> tuple[str, ...]:
    """Names of the marker sets that come with the package."""
    return tuple(sorted(path.stem for path in (DATA / 'marker_sets').glob('*.csv')))


def load_marker_set(name: str | Path) -> MarkerSet:
    """Read a marker set by its name, or from a CSV file of one's own.

    Raises
    ------
    MarkerSetError
        If there is no set of that name, or a marker occurs twice.
    TableError
        If the file cannot be read, a column is missing or a value is not valid.
    """
    if str(name).endswith('.csv'):
        rows = read_file(Path(name), COLUMNS)
    elif name in available():
        rows = read_table('motion_tracker', f'marker_sets/{name}.csv', COLUMNS)
    else:
        raise MarkerSetError(f'marker set {name!r}: there are {", ".join(available())}')
    markers = tuple(_parse(row) for row in rows)
    names = [marker.name for marker in markers]
    for marker in names:
        if names.count(marker) > 1:
            raise MarkerSetError(f'{name}: marker {marker!r} occurs {names.count(marker)} times')
    own = str(name).endswith('.csv')
    return MarkerSet(Path(name).stem, markers, Path(name) if own else None)


def _parse(row: Row) -> Marker:
    weight = row.number('weight')
    if weight <= 0.0:
        raise row.error('weight', 'a number above 0 is needed')
    known = any(row[axis] for axis in 'xyz')
    scale = row['scale_with'].split()
    if known and len(scale) not in (1, 3):
        raise row.error('scale_with', 'one or three segment lengths are needed')
    for length in scale:
        if length not in _reference_lengths():
            raise row.error('scale_with', f'{length!r} is no segment length')
    names = (scale * 3)[:3] if scale else ['', '', '']
    return Marker(
        row['marker'],
        row['segment'],
        (row.number('x'), row.number('y'), row.number('z')) if known else None,
        (names[0], names[1], names[2]),
        weight,
        row.flag('tracking'),
    )


@cache
def _reference_lengths() -> dict[str, float]:
    return segment_lengths(REFERENCE_SUBJECT)[0]
