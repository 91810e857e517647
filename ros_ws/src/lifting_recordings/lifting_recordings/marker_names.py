# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Names of markers in their spellings, and the markers of a file under the names of a set.

Case, blanks and punctuation make no difference, the side may stand before or after the name, and
OpenCap's ending ``_study`` is left out: ``RHEE``, ``r hee``, ``R.Hee``, ``hee_right`` are one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cache

from human_model.tables import read_table

_SIDE = {'r': 'right', 'right': 'right', 'l': 'left', 'left': 'left'}
_BEFORE = re.compile(r'(right|left|r|l)(.+)')
# After the name a side counts only behind a separator or, as a capital, behind a small letter.
_AFTER = re.compile(r'(.+?)(?:[\W_]+(?i:(right|left|r|l))|(?<=[a-z])(R|L|Right|Left))')
_STUDY = re.compile(r'[\W_]*study$', re.IGNORECASE)


def _folded(text: str) -> str:
    return re.sub(r'[\W_]+', '', text.lower())


@cache
def _known(table: str, column: str) -> dict[tuple[str, bool], tuple[str, str]]:
    """Return meaning and side of each folded name of a table, and whether it needs a side."""
    return {
        (_folded(row['marker']), row['side'] == 'both'): (row[column], row['side'])
        for row in read_table('lifting_recordings', table, f'{column} side marker')
    }


def _readings(name: str) -> Iterator[tuple[str, str]]:
    """Yield the name without its side, folded, and the side; '' if it has none."""
    name = _STUDY.sub('', name)
    folded = _folded(name)
    yield folded, ''
    if before := _BEFORE.fullmatch(folded):
        yield before[2], _SIDE[before[1]]
    if folded.startswith(('right', 'left')):
        yield folded[1:], _SIDE[folded[0]]
    if after := _AFTER.fullmatch(name):
        yield _folded(after[1]), _SIDE[(after[2] or after[3]).lower()]


def named_in(table: str, column: str, name: str) -> tuple[str, str] | None:
    """Return what a table says of a marker, and its side; None if it does not have the name.

    Parameters
    ----------
    table : str
        Table of the package with the columns ``side`` (both or middle) and ``marker``.
    column : str
        Column to return.
    name : str
        Name of the marker in any spelling.
    """
    for base, side in _readings(name):
        found = _known(table, column).get((base, bool(side)))
        if found is not None:
            return found[0], side or found[1]
    return None


def names_of_set(names: Sequence[str], wanted: Sequence[str]) -> dict[str, str]:
    """Return the names of a marker set for markers of a file that have other names.

    A marker is renamed if its name is that of the set in other case or with OpenCap's ending, or
    if both name the same landmark of ``data/landmarks.csv``, and if no other marker of the file
    has or gets that name.

    Parameters
    ----------
    names : sequence of str
        Of the file.
    wanted : sequence of str
        Of the marker set.
    """
    by_spelling = {_spelled(name): name for name in wanted}
    by_landmark = {
        mark: name
        for name in wanted
        if (mark := named_in('landmarks.csv', 'landmark', name)) is not None
    }
    by_name = [{name: by_spelling.get(_spelled(name)) for name in names}]
    by_name.append(
        {
            name: by_landmark.get(mark)
            for name in names
            if (mark := named_in('landmarks.csv', 'landmark', name)) is not None
        }
    )
    renamed: dict[str, str] = {}
    taken = set(names)
    # The same name in another spelling goes before another name of the landmark.
    for found in by_name:
        for name, new in found.items():
            if new is not None and name not in wanted and name not in renamed and new not in taken:
                renamed[name] = new
                taken.add(new)
    return renamed


def _spelled(name: str) -> str:
    return _STUDY.sub('', name).lower()
