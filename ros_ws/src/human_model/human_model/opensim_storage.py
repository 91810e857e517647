# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Tables over time in OpenSim's `.mot` and `.sto` files.

Format: OpenSim's user guide, pages "Storage (.sto) Files" and "Motion (.mot) Files": header lines
up to `endheader`, a line of labels that begins with `time`, rows of numbers. A damaged file is an
error that names file, line and column; nothing is repaired.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from human_model.exceptions import StorageError
from human_model.typing import Array

_TIME = 'time'
_ROW_KEYS = ('nrows', 'datarows')
_COLUMN_KEYS = ('ncolumns', 'datacolumns')


@dataclass(frozen=True, eq=False)
class Storage:
    """A table over time.

    Attributes
    ----------
    name : str
        First line of the file.
    columns : tuple of str
        Labels without `time`.
    time : (n,) array
        s, increasing.
    values : (n, m) array
        In SI units; angles in degrees if `in_degrees`.
    in_degrees : bool
        The value in the header; False without one.
    """

    name: str
    columns: tuple[str, ...]
    time: Array
    values: Array
    in_degrees: bool = False

    def column(self, label: str) -> Array:
        """Return the column (n,) of that label, or raise StorageError."""
        if label not in self.columns:
            raise StorageError(self.name, f'there is no column {label!r}')
        return self.values[:, self.columns.index(label)]

    def select(self, labels: Sequence[str]) -> Array:
        """Return the columns (n, len(labels)) of these labels, or raise StorageError."""
        return np.stack([self.column(label) for label in labels], axis=1)

    def in_radians(self, angles: Sequence[str]) -> Storage:
        """Return the table with the columns named in `angles` in radians.

        Columns that the table does not have are passed over: files hold what they hold.
        """
        if not self.in_degrees:
            return self
        factor = [np.pi / 180.0 if label in angles else 1.0 for label in self.columns]
        return replace(self, values=self.values * factor, in_degrees=False)

    def at(self, times: Array) -> Array:
        """Return the values (k, m) at these times, by straight lines between the rows.

        Raises
        ------
        StorageError
            If a time is outside the table.
        """
        wanted = np.asarray(times, np.float64)
        slack = 1e-9
        outside = (wanted < self.time[0] - slack) | (wanted > self.time[-1] + slack)
        if np.any(outside):
            raise StorageError(
                self.name,
                f'{wanted[outside][0]:.6g} s is outside the table, {self.time[0]:.6g} to '
                f'{self.time[-1]:.6g} s',
            )
        return np.stack([np.interp(wanted, self.time, c) for c in self.values.T], axis=1)


def write_storage(path: Path, storage: Storage) -> None:
    """Write a table with full precision.

    Raises
    ------
    StorageError
        If the table is empty, times do not increase, shapes differ, or a value is not finite.
    """
    n, m = storage.time.size, len(storage.columns)
    if n == 0 or storage.time.shape != (n,) or storage.values.shape != (n, m):
        raise StorageError(
            path,
            f'{storage.time.shape} times and {m} columns do not fit values of shape '
            f'{storage.values.shape}',
        )
    if len(set(storage.columns)) != m or any(len(label.split()) != 1 for label in storage.columns):
        raise StorageError(path, f'column labels must be unique words: {storage.columns}')
    _check_times(path, storage.time, [None] * n)
    bad = np.argwhere(~np.isfinite(storage.values))
    if bad.size:
        row, column = bad[0]
        raise StorageError(
            path,
            f'{storage.values[row, column]} at {storage.time[row]:.6g} s is not finite',
            column=storage.columns[column],
        )
    lines = [
        storage.name,
        'version=1',
        f'nRows={n}',
        f'nColumns={m + 1}',
        f'inDegrees={"yes" if storage.in_degrees else "no"}',
        'endheader',
        '\t'.join((_TIME, *storage.columns)),
    ]
    lines += [
        '\t'.join(f'{value:.17g}' for value in (stamp, *row))
        for stamp, row in zip(storage.time, storage.values, strict=True)
    ]
    path.write_text('\n'.join(lines) + '\n', encoding='utf-8')


def read_storage(path: Path) -> Storage:
    """Read a table.

    Raises
    ------
    StorageError
        If the file cannot be read, has no header or labels, or its rows contradict them.
    """
    try:
        lines = path.read_text(encoding='utf-8-sig').splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise StorageError(path, f'cannot be read: {error}') from error
    header, first = _read_header(path, lines)
    numbered = [(i + 1, line) for i, line in enumerate(lines) if i >= first and line.strip()]
    if not numbered:
        raise StorageError(path, 'ends before the column labels')
    label_line, label_text = numbered[0]
    labels = tuple(label_text.split())
    if labels[0].lower() != _TIME:
        raise StorageError(path, f'first column is {labels[0]!r}, not time', line=label_line)
    if twice := [label for label in labels if labels.count(label) > 1]:
        raise StorageError(path, 'is there twice', line=label_line, column=twice[0])
    rows = numbered[1:]
    if not rows:
        raise StorageError(path, 'holds no rows')
    _check_count(path, header, _ROW_KEYS, len(rows), 'rows')
    _check_count(path, header, _COLUMN_KEYS, len(labels), 'columns')
    data = np.array([_read_row(path, number, text, labels) for number, text in rows])
    _check_times(path, data[:, 0], [number for number, _ in rows])
    return Storage(
        name=lines[0].strip(),
        columns=labels[1:],
        time=np.ascontiguousarray(data[:, 0]),
        values=np.ascontiguousarray(data[:, 1:]),
        in_degrees=_read_degrees(path, header),
    )


def _read_header(path: Path, lines: list[str]) -> tuple[dict[str, str], int]:
    """Return the header's entries in small letters and the index of the line after it."""
    header: dict[str, str] = {}
    for i, line in enumerate(lines):
        if line.strip().lower() == 'endheader':
            return header, i + 1
        key, equals, value = line.partition('=')
        if equals:
            header[key.strip().lower()] = value.strip()
    raise StorageError(path, 'no line endheader: this is no .mot or .sto file')


def _check_count(
    path: Path, header: dict[str, str], keys: tuple[str, ...], found: int, what: str
) -> None:
    for key in keys:
        if key in header and header[key] != str(found):
            raise StorageError(
                path,
                f'header says {key}={header[key]}, the file holds {found} {what} (truncated?)',
            )


def _read_degrees(path: Path, header: dict[str, str]) -> bool:
    text = header.get('indegrees', 'no').lower()
    if text not in ('yes', 'no'):
        raise StorageError(path, f'inDegrees={text!r} is neither yes nor no')
    return text == 'yes'


def _read_row(path: Path, number: int, text: str, labels: tuple[str, ...]) -> list[float]:
    cells = text.split()
    if len(cells) != len(labels):
        raise StorageError(path, f'{len(cells)} values where {len(labels)} belong', line=number)
    row = []
    for label, cell in zip(labels, cells, strict=True):
        try:
            row.append(float(cell))
        except ValueError:
            raise StorageError(
                path, f'{cell!r} is not a number', line=number, column=label
            ) from None
    return row


def _check_times(path: Path, time: Array, numbers: Sequence[int | None]) -> None:
    for i, stamp in enumerate(time):
        problem = ''
        if not np.isfinite(stamp):
            problem = f'{stamp} is not finite'
        elif i and stamp <= time[i - 1]:
            problem = f'{stamp:.9g} s after {time[i - 1]:.9g} s does not increase'
        if problem:
            raise StorageError(path, problem, line=numbers[i], column=_TIME)
