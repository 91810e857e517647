# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Reading of the package's data tables, and of the length sums written in them."""

import csv
import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from human_model.exceptions import HumanModelError

_TERM = re.compile(r'([+-]?)\s*([A-Za-z0-9_.]+)')


@cache
def read_table(name: str) -> tuple[Mapping[str, str], ...]:
    """Rows of ``data/<name>.csv`` by column.

    Raises
    ------
    HumanModelError
        If there is no such table or a row has another number of fields than the heading.
    """
    path = files('human_model') / 'data' / f'{name}.csv'
    if not path.is_file():
        raise HumanModelError(f'no data table named {name!r} in human_model/data')
    rows = list(csv.DictReader(path.read_text(encoding='utf-8').splitlines()))
    for line, row in enumerate(rows, start=2):
        if None in row or any(value is None for value in row.values()):
            raise HumanModelError(f'{name}.csv, line {line}: wrong number of fields')
    return tuple(rows)


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
