# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Strict readers of OpenSim's TRC, MOT and STO files, and a writer of TRC.

Format as described in OpenSim's user guide, "Marker (.trc) Files"; MOT and STO are read by
`muscle_analyzer.core.opensim_bridge.storage`.
Nothing is repaired: a wrong count, an unsorted stamp or a word where a number belongs is an
error that names file, line and field.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from human_model.typing import Array
from lifting_recordings.exceptions import FileFormatError
from muscle_analyzer.core.exceptions import StorageError
from muscle_analyzer.core.opensim_bridge import storage
from muscle_analyzer.core.opensim_bridge.storage import Storage

_TRC_KEYS = ('DataRate', 'NumFrames', 'NumMarkers', 'Units')
_TRC_LEADING_COLUMNS = 2


@dataclass(frozen=True)
class MarkerTable:
    """Marker trajectories in the file's own units and axes.

    Attributes
    ----------
    names : tuple of str
        Marker names, unique.
    time : ndarray, shape (n,)
        Seconds, strictly increasing.
    positions : ndarray, shape (n, n_markers, 3)
        In `units`; NaN where a marker was not seen.
    units : str
        As stated in the file, e.g. 'mm'.
    rate : float
        Frames per second, as stated in the file.
    """

    names: tuple[str, ...]
    time: Array
    positions: Array
    units: str
    rate: float


def _lines(path: Path) -> list[str]:
    try:
        text = path.read_bytes().decode('utf-8-sig')
    except UnicodeDecodeError as error:
        raise FileFormatError(path, f'is not a text file ({error.reason})') from error
    if not text.strip():
        raise FileFormatError(path, 'is empty')
    return text.splitlines()


def _integer(path: Path, line: int, field: str, text: str) -> int:
    try:
        return int(text)
    except ValueError as error:
        raise FileFormatError(
            path, f'expected a whole number, found {text!r}', line=line, field=field
        ) from error


def _number(path: Path, line: int, field: str, text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise FileFormatError(
            path, f'expected a number, found {text!r}', line=line, field=field
        ) from error


def _unique(path: Path, line: int, names: tuple[str, ...]) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise FileFormatError(path, 'appears twice', line=line, field=name)
        seen.add(name)


def check_stamps(path: Path, time: Array, first_line: int) -> None:
    """Refuse NaN, unsorted or duplicated stamps.

    Raises
    ------
    FileFormatError
        Naming the first offending line.
    """
    bad = np.flatnonzero(~np.isfinite(time))
    if bad.size:
        raise FileFormatError(
            path, f'stamp is {time[bad[0]]}', line=first_line + int(bad[0]), field='time'
        )
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if back.size:
        i = int(back[0]) + 1
        kind = 'duplicated' if time[i] == time[i - 1] else 'unsorted'
        raise FileFormatError(
            path,
            f'{kind} stamp {time[i]:g} s after {time[i - 1]:g} s',
            line=first_line + i,
            field='time',
        )


def read_trc(path: str | Path) -> MarkerTable:
    """Read a TRC file.

    Parameters
    ----------
    path : str or Path
        The file; blank cells are missing markers (NaN).

    Raises
    ------
    FileFormatError
        Foreign, truncated or inconsistent file.
    """
    path = Path(path)
    lines = _lines(path)
    if not lines[0].startswith('PathFileType') or len(lines) < 5:
        raise FileFormatError(path, 'is not a TRC file (no PathFileType header)', line=1)
    keys, entries = lines[1].split(), lines[2].split()
    header = dict(zip(keys, entries, strict=False))
    for key in _TRC_KEYS:
        if key not in header:
            raise FileFormatError(path, 'is missing from the header', line=2, field=key)
    labels = lines[3].rstrip('\t\r\n ').split('\t')
    names = tuple(label.strip() for label in labels[_TRC_LEADING_COLUMNS:] if label.strip())
    _unique(path, 4, names)
    n_markers = _integer(path, 3, 'NumMarkers', header['NumMarkers'])
    if len(names) != n_markers:
        raise FileFormatError(
            path, f'header says {n_markers}, line 4 names {len(names)}', line=3, field='NumMarkers'
        )
    first = 5
    while first < len(lines) and not lines[first].strip():
        first += 1
    rows = [line for line in lines[first:] if line.strip()]
    n_frames = _integer(path, 3, 'NumFrames', header['NumFrames'])
    if len(rows) != n_frames:
        raise FileFormatError(
            path,
            f'header says {n_frames} frames, the file holds {len(rows)} (truncated?)',
            line=3,
            field='NumFrames',
        )
    data = np.full((n_frames, 3 * n_markers + 1), np.nan)
    for i, row in enumerate(rows):
        cells = row.rstrip('\r\n').split('\t')
        extra = cells[_TRC_LEADING_COLUMNS + 3 * n_markers :]
        if len(cells) < _TRC_LEADING_COLUMNS + 3 * n_markers or any(c.strip() for c in extra):
            raise FileFormatError(
                path,
                f'{len(cells)} cells where {_TRC_LEADING_COLUMNS + 3 * n_markers} belong',
                line=first + 1 + i,
            )
        _fill_trc_row(path, first + 1 + i, cells, names, data[i])
    check_stamps(path, data[:, 0], first + 1)
    return MarkerTable(
        names=names,
        time=data[:, 0].copy(),
        positions=data[:, 1:].reshape(n_frames, n_markers, 3).copy(),
        units=header['Units'],
        rate=_number(path, 3, 'DataRate', header['DataRate']),
    )


def _fill_trc_row(
    path: Path, line: int, cells: list[str], names: tuple[str, ...], row: Array
) -> None:
    for j in range(row.size):
        text = cells[j + 1].strip()
        if text:
            field = 'Time' if j == 0 else f'{names[(j - 1) // 3]}.{"XYZ"[(j - 1) % 3]}'
            row[j] = _number(path, line, field, text)


def write_trc(path: str | Path, table: MarkerTable) -> None:
    """Write a TRC file; missing markers become blank cells."""
    path = Path(path)
    n, m, _ = table.positions.shape
    labels = ''.join(f'\t{name}\t\t' for name in table.names)
    axes = ''.join(f'\tX{i}\tY{i}\tZ{i}' for i in range(1, m + 1))
    rate = f'{table.rate:g}'
    lines = [
        f'PathFileType\t4\t(X/Y/Z)\t{path.name}',
        'DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame'
        '\tOrigNumFrames',
        f'{rate}\t{rate}\t{n}\t{m}\t{table.units}\t{rate}\t1\t{n}',
        f'Frame#\tTime{labels}',
        f'\t{axes}',
        '',
    ]
    for i in range(n):
        values = table.positions[i].ravel()
        cells = ('' if np.isnan(v) else f'{v:.9g}' for v in values)
        lines.append(f'{i + 1}\t{table.time[i]:.9g}\t' + '\t'.join(cells))
    path.write_text('\n'.join(lines) + '\n', encoding='utf-8')


def read_storage(path: str | Path) -> Storage:
    """Read a MOT or STO file.

    Parameters
    ----------
    path : str or Path
        The file.

    Raises
    ------
    FileFormatError
        Foreign, truncated or inconsistent file.
    """
    try:
        return storage.read_storage(Path(path))
    except StorageError as error:
        raise FileFormatError(path, error.problem, line=error.line, field=error.column) from error
