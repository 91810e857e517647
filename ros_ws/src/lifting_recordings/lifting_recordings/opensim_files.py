# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Readers of OpenSim's TRC, MOT and STO files, and a writer of TRC.

Format as described in OpenSim's user guide, "Marker (.trc) Files"; MOT and STO are read by
`human_model.opensim_storage`.
A TRC file is read as OpenSim reads it; what is untidy and harmless is noted. An unsorted stamp, a
missing cell or a word where a number belongs is an error that names file, line and field.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from human_model import opensim_storage
from human_model.exceptions import StorageError
from human_model.opensim_storage import Storage
from human_model.typing import Array
from lifting_recordings.exceptions import FileFormatError
from lifting_recordings.raw_markers import select_labels

_TRC_LEADING_COLUMNS = 2
#: Line of the labels, after file type, keys and entries; the line of the axes follows.
_TRC_LABELS = 4
# Words that programs write for "not a number" or "infinite".
_NOT_A_NUMBER = re.compile(r'[-+]?(nan|inf(inity)?|1\.#[A-Z]+)(\(.*\))?0*', re.IGNORECASE)


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
    notes : tuple of str
        What the reader found worth saying.
    """

    names: tuple[str, ...]
    time: Array
    positions: Array
    units: str
    rate: float
    notes: tuple[str, ...] = ()


def _text(path: Path) -> str:
    """Return the text of a file in UTF-8, or else in Latin-1, as older programs write it."""
    data = path.read_bytes()
    if b'\0' in data:
        raise FileFormatError(path, 'is not a text file (it holds a zero byte)')
    try:
        text = data.decode('utf-8-sig')
    except UnicodeDecodeError:
        text = data.decode('latin-1')
    if not text.strip():
        raise FileFormatError(path, 'is empty')
    return text


def _number(path: Path, line: int, field: str, text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise FileFormatError(
            path, f'expected a number, found {text!r}', line=line, field=field
        ) from error


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def check_stamps(path: Path, time: Array, lines: Sequence[int]) -> None:
    """Refuse NaN, unsorted or duplicated stamps, which stand in these lines of the file.

    Raises
    ------
    FileFormatError
        Naming the first offending line.
    """
    bad = np.flatnonzero(~np.isfinite(time))
    if bad.size:
        raise FileFormatError(
            path, f'stamp is {time[bad[0]]}', line=lines[int(bad[0])], field='time'
        )
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if back.size:
        i = int(back[0]) + 1
        kind = 'duplicated' if time[i] == time[i - 1] else 'unsorted'
        raise FileFormatError(
            path,
            f'{kind} stamp {time[i]:g} s after {time[i - 1]:g} s',
            line=lines[i],
            field='time',
        )


def read_trc(path: str | Path, prefix: str | None = None) -> MarkerTable:
    """Read a TRC file as OpenSim does: the number of frames is that of the rows.

    Parameters
    ----------
    path : str or Path
        The file; a marker with a blank cell is not seen (NaN). Cells that were cut off with the
        blanks at the end of a line are blank.
    prefix : str, optional
        Prefix of the labels of the subject, where the file holds several.

    Raises
    ------
    FileFormatError
        Foreign, cut off or inconsistent file.
    """
    path = Path(path)
    text = _text(path)
    lines = text.splitlines()
    if not lines[0].lstrip().startswith('PathFileType') or len(lines) < _TRC_LABELS:
        raise FileFormatError(path, 'is not a TRC file (no PathFileType header)', line=1)
    header = _trc_header(path, lines)
    first = _TRC_LABELS
    while first < len(lines) and lines[first].strip()[:1] in ('', 'X', 'x'):
        first += 1
    rows = [(i, lines[i].split('\t')) for i in range(first, len(lines)) if lines[i].strip()]
    if not rows:
        raise FileFormatError(path, 'holds no frame', line=len(lines), field='Frame#')
    wide = max(_filled(cells) for _, cells in rows) - _TRC_LEADING_COLUMNS
    labels = _trc_labels(lines[_TRC_LABELS - 1], -(-wide // 3))
    complete = _TRC_LEADING_COLUMNS + 3 * len(labels)
    if not text.endswith(('\n', '\r')) and len(rows[-1][1]) < complete:
        raise FileFormatError(
            path,
            f'{len(rows[-1][1])} cells where {complete} belong: the file is cut off',
            line=rows[-1][0] + 1,
        )
    data = np.full((len(rows), 3 * len(labels) + 1), np.nan)
    for (i, cells), row in zip(rows, data, strict=True):
        _fill_trc_row(path, i + 1, cells, labels, row)
    check_stamps(path, data[:, 0], [i + 1 for i, _ in rows])
    chosen = select_labels(path, labels, prefix, field='labels', line=_TRC_LABELS)
    positions = data[:, 1:].reshape(len(rows), -1, 3)[:, chosen.columns]
    return MarkerTable(
        names=chosen.names,
        time=data[:, 0].copy(),
        positions=positions,
        units=header.get('Units', ''),
        rate=_trc_rate(header, data[:, 0]),
        notes=(*_trc_counts(path, header, len(rows), len(labels)), *chosen.notes),
    )


def _trc_header(path: Path, lines: list[str]) -> dict[str, str]:
    """Return the entries of lines 2 and 3 by key; blank cells between tabs are kept."""
    keys, entries = ([cell.strip() for cell in lines[i].split('\t')] for i in (1, 2))
    if len(keys) < len(lines[1].split()):
        keys, entries = lines[1].split(), lines[2].split()
    elif '' in keys:
        keys, entries = ([cell for cell in cells if cell] for cells in (keys, entries))
    if 'NumMarkers' not in keys:
        raise FileFormatError(path, 'is missing from the header', line=2, field='NumMarkers')
    return dict(zip(keys, entries, strict=False))


def _trc_rate(header: dict[str, str], time: Array) -> float:
    """Return the stated frames per second, or those of the stamps where it states no number."""
    stated = header.get('DataRate', '')
    if _is_number(stated) and float(stated) > 0.0:
        return float(stated)
    return 1.0 / float(np.median(np.diff(time))) if time.size > 1 else np.nan


def _trc_labels(line: str, columns: int) -> list[str]:
    """Return a label for each marker, of which the rows hold so many; '' where there is none.

    Labels stand above the first of three columns, or one after the other.
    """
    cells = [cell.strip() for cell in line.rstrip().split('\t')][_TRC_LEADING_COLUMNS:]
    aligned = all(not cell for i, cell in enumerate(cells) if i % 3)
    labels = cells[::3] if aligned else [cell for cell in cells if cell]
    return labels + [''] * (columns - len(labels))


def _trc_counts(
    path: Path, header: dict[str, str], n_frames: int, n_markers: int
) -> tuple[str, ...]:
    """Return notes of what the header counts otherwise."""
    found = {'NumFrames': n_frames, 'NumMarkers': n_markers}
    return tuple(
        f'{path.name}: {key} in the header is {header[key]}, the file holds {count} '
        '(trimmed or cut off?); what it holds is read.'
        for key, count in found.items()
        if key in header and header[key] != str(count)
    )


def _filled(cells: list[str]) -> int:
    """Return the number of cells up to the last that is not blank."""
    return max((i + 1 for i, cell in enumerate(cells) if cell.strip()), default=0)


def _fill_trc_row(path: Path, line: int, cells: list[str], names: list[str], row: Array) -> None:
    """Fill stamp and positions of a row; what is blank stays NaN."""
    missing = _TRC_LEADING_COLUMNS + 3 * len(names) - len(cells)
    if missing > 0 and missing % 3:
        raise FileFormatError(
            path, f'{len(cells)} cells where {len(cells) + missing} belong', line=line
        )
    for j, cell in enumerate(cells[1 : row.size + 1]):
        text = cell.strip()
        if text and not _NOT_A_NUMBER.fullmatch(text):
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
        return opensim_storage.read_storage(Path(path))
    except StorageError as error:
        raise FileFormatError(path, error.problem, line=error.line, field=error.column) from error
