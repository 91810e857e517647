# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the CSV tables of the package; every row names its source."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from importlib import resources

from injury_monitor.core.exceptions import DataFileError

Row = dict[str, str]


def read_table(name: str, columns: Sequence[str]) -> list[Row]:
    """Read one table of the package's ``data`` folder.

    Parameters
    ----------
    name : str
        File name, for example ``limits.csv``.
    columns : sequence of str
        Columns that must be there; ``source`` is always required and never empty.

    Returns
    -------
    list of dict
        One dictionary a row, values as text.

    Raises
    ------
    DataFileError
        If a column is missing, a row is empty or has no source.
    """
    text = resources.files('injury_monitor').joinpath('data', name).read_text(encoding='utf-8')
    return parse_table(name, text, columns)


def parse_table(name: str, text: str, columns: Sequence[str]) -> list[Row]:
    """Parse CSV text with ``#`` comment lines; see :func:`read_table`."""
    lines = [line for line in text.splitlines() if line and not line.startswith('#')]
    reader = csv.DictReader(lines, strict=True)
    required = [*columns, 'source']
    missing = [column for column in required if column not in (reader.fieldnames or [])]
    if missing:
        raise DataFileError(name, 'header', reader.fieldnames, f'columns missing: {missing}')
    rows = list(reader)
    if not rows:
        raise DataFileError(name, 'rows', 0, 'the table is empty')
    for number, row in enumerate(rows, start=1):
        if None in row or None in row.values():
            raise DataFileError(name, f'row {number}', row, 'wrong number of columns')
        if not row['source'].strip():
            raise DataFileError(name, f'row {number}, source', row['source'], 'must not be empty')
    return rows


def number(name: str, row: Row, column: str, default: float | None = None) -> float:
    """Return one cell as a number; an empty cell gives ``default`` if there is one.

    Raises
    ------
    DataFileError
        If the cell is not a number, or empty without a default.
    """
    cell = row[column].strip()
    if not cell and default is not None:
        return default
    try:
        return float(cell)
    except ValueError as error:
        raise DataFileError(name, f'{column} of {row}', cell, 'must be a number') from error
