# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of the package: which points are joined, and colours."""

from __future__ import annotations

import csv
from functools import cache
from importlib.resources import files

from human_model.motion import POINTS
from lifting_visualization.core.exceptions import DataFileError

Colour = tuple[float, float, float, float]


def _rows(name: str) -> list[dict[str, str]]:
    text = files('lifting_visualization').joinpath('data', name).read_text(encoding='utf-8')
    return list(csv.DictReader(text.splitlines()))


@cache
def bones() -> tuple[tuple[str, str], ...]:
    """Return the pairs of points that are joined by a line."""
    pairs = tuple((row['from'], row['to']) for row in _rows('bones.csv'))
    for name in (name for pair in pairs for name in pair):
        if name not in POINTS:
            raise DataFileError(f'bones.csv: {name!r} is no point of the body')
    return pairs


@cache
def colours() -> dict[str, Colour]:
    """Return red, green, blue and opacity, each 0 to 1, by what is drawn."""
    found = {}
    for row in _rows('colours.csv'):
        red, green, blue = (float(row[name]) / 255.0 for name in ('red', 'green', 'blue'))
        found[row['role']] = (red, green, blue, float(row['opacity']))
        if not all(0.0 <= value <= 1.0 for value in found[row['role']]):
            raise DataFileError(f'colours.csv: {row["role"]}: {found[row["role"]]}')
    return found
