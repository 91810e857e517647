# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The reader of CSV tables, and of the length sums written in them.

Lines that begin with ``#`` and empty lines are skipped.  The next line is the header.  Each row of
a table of data has a source.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import TypeVar

from human_model.exceptions import HumanModelError, TableError

T = TypeVar('T')
_TERM = re.compile(r'([+-]?)\s*([A-Za-z0-9_.]+)')
_FLAGS = {'yes': True, 'no': False}


class Row(Mapping[str, str]):
    """One row of a table: its cells by column, as text or as checked values.

    Parameters
    ----------
    file : str
        The file, for messages.
    line : int
        Line of the file, from 1.
    cells : mapping of str to str

    Raises
    ------
    TableError
        As do all methods, if a cell has a wrong value.
    """

    def __init__(self, file: str, line: int, cells: Mapping[str, str]) -> None:
        self.file, self.line = file, line
        self._cells = cells

    def __getitem__(self, column: str) -> str:
        return self._cells[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._cells)

    def __len__(self) -> int:
        return len(self._cells)

    def error(self, column: str, problem: str) -> TableError:
        """Return an error about one cell."""
        return TableError(self.file, self.line, column, self[column], problem)

    def number(self, column: str, *default: float) -> float:
        """Return a cell as a finite number; an empty cell gives the default if there is one."""
        if not self[column] and default:
            return default[0]
        try:
            value = float(self[column])
        except ValueError:
            raise self.error(column, 'a number is needed') from None
        if not math.isfinite(value):
            raise self.error(column, 'a finite number is needed')
        return value

    def numbers(self, *columns: str) -> tuple[float, ...]:
        """Return several cells as finite numbers."""
        return tuple(self.number(column) for column in columns)

    def within(self, column: str, low: float, high: float) -> float:
        """Return a cell as a number between two limits."""
        value = self.number(column)
        if not low <= value <= high:
            raise self.error(column, f'a number from {low:g} to {high:g} is needed')
        return value

    def whole(self, column: str) -> int:
        """Return a cell as a whole number."""
        try:
            return int(self[column])
        except ValueError:
            raise self.error(column, 'a whole number is needed') from None

    def choice(self, column: str, choices: Mapping[str, T]) -> T:
        """Return the value of the name in a cell."""
        if self[column] not in choices:
            raise self.error(column, f'one of {", ".join(choices)} is needed')
        return choices[self[column]]

    def flag(self, column: str) -> bool:
        """Return whether a cell is yes, not no."""
        return self.choice(column, _FLAGS)


@cache
def read_table(package: str, name: str, columns: str) -> tuple[Row, ...]:
    """Read a table of data of a package.

    Parameters
    ----------
    package : str
    name : str
        Path of the file in the folder ``data`` of the package.
    columns : str
        Columns that the header must have beside ``source``, separated by spaces.

    Raises
    ------
    TableError
        If the file cannot be read, a column is missing, a row has another number of cells than
        the header or no source, or there is no row.
    """
    return read_file(files(package) / 'data' / name, columns, sourced=True)


def read_file(path: Traversable, columns: str, sourced: bool = False) -> tuple[Row, ...]:
    """Read a table of a user, which needs no source; `sourced`: as `read_table`."""
    try:
        text = path.read_text(encoding='utf-8-sig')
    except (OSError, UnicodeDecodeError) as error:
        raise TableError(str(path), 0, '', None, f'cannot be read: {error}') from error
    return parse_table(str(path), text, columns, sourced=sourced)


def parse_table(file: str, text: str, columns: str, sourced: bool = False) -> tuple[Row, ...]:
    """Return the rows of the text of a table; see `read_table`."""
    lines = [
        (number, _cells(file, number, line))
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.startswith('#')
    ]
    if len(lines) < 2:
        raise TableError(file, 0, '', None, 'the table is empty')
    (first, header), *body = lines
    for column in f'{columns} source'.split() if sourced else columns.split():
        if column not in header:
            raise TableError(file, first, column, None, 'the column is missing')
    if len(set(header)) != len(header):
        raise TableError(file, first, '', header, 'a column occurs twice')
    rows = []
    for number, cells in body:
        if len(cells) != len(header):
            raise TableError(file, number, '', cells, f'{len(header)} cells are needed')
        row = Row(file, number, dict(zip(header, cells, strict=True)))
        if sourced and not row['source']:
            raise row.error('source', 'the source of the row is needed')
        rows.append(row)
    return tuple(rows)


def _cells(file: str, number: int, line: str) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], strict=True))]
    except csv.Error as error:
        raise TableError(file, number, '', line, str(error)) from error


def length_sum(expression: str, lengths: Mapping[str, float]) -> float:
    """Value [m] of a sum such as ``ankle_height - mtp_drop``; numbers are allowed as terms.

    Raises
    ------
    HumanModelError
        If a name in it is unknown or the expression is not a sum.
    """
    total, position = 0.0, 0
    text = expression.strip()
    while position < len(text):
        match = _TERM.match(text, position)
        if match is None:
            raise HumanModelError(f'{expression!r} is not a sum of lengths')
        sign, term = match.groups()
        if re.fullmatch(r'[0-9.]+', term):
            value = float(term)
        elif term in lengths:
            value = lengths[term]
        else:
            raise HumanModelError(f'{expression!r}: unknown length {term!r}')
        total += -value if sign == '-' else value
        position = match.end()
        while position < len(text) and text[position] == ' ':
            position += 1
    return total
