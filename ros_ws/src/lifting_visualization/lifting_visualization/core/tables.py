# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of the package: which points are joined, and colours."""

from __future__ import annotations

from functools import cache

from human_model.motion import POINTS
from human_model.tables import read_table

Colour = tuple[float, float, float, float]


@cache
def bones() -> tuple[tuple[str, str], ...]:
    """Return the pairs of points that are joined by a line."""
    points = {name: name for name in POINTS}
    return tuple(
        (row.choice('from', points), row.choice('to', points))
        for row in read_table('lifting_visualization', 'bones.csv', 'from to')
    )


@cache
def colours() -> dict[str, Colour]:
    """Return red, green, blue and opacity, each 0 to 1, by what is drawn."""
    found = {}
    for row in read_table('lifting_visualization', 'colours.csv', 'role red green blue opacity'):
        red, green, blue = (row.within(name, 0.0, 255.0) for name in ('red', 'green', 'blue'))
        opacity = row.within('opacity', 0.0, 1.0)
        found[row['role']] = (red / 255.0, green / 255.0, blue / 255.0, opacity)
    return found
