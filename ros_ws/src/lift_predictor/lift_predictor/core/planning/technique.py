# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Squat, semi-squat and stoop as ranges of a Stoop-Squat-Index after Schmid (2022).

Schmid's index is the proportion of the trunk's forward lean to the flexion of the legs, from 0
(full squat) to 100 (full stoop); its mean was below 30 in squat and above 90 in stoop lifting of
a 15 kg box by 30 adults (Arch Physiother 12:8, doi 10.1186/s40945-022-00135-4; arXiv 2108.05795).
Only the abstract could be read here. The formula is ours, made to have that meaning and those
ends: how far the hips are lowered from upright standing, by how far the seventh cervical vertebra
is, 100 (1 - hips / C7). It is 0 where only the legs bend, 100 where only the trunk leans.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np

from human_model.tables import read_table
from human_model.typing import Array
from lift_predictor.core.exceptions import PlanError

FREE: Final = 'free'

INDEX_INSIDE: Final = 5.0
"""Distance to the ends of a technique's index range that the search for a posture aims at, if they
are so far apart; a numerical margin, as the optimiser may move the posture afterwards."""


@dataclass(frozen=True)
class Technique:
    """Range of the Stoop-Squat-Index that has a name; None: any."""

    name: str
    lower: float | None
    upper: float | None
    source: str

    def holds(self, index: float) -> bool:
        """Tell whether an index is of this technique."""
        return self.lower is None or self.upper is None or bool(self.lower <= index <= self.upper)


@cache
def techniques() -> dict[str, Technique]:
    """All techniques of `data/techniques.csv` by name."""
    columns = 'technique index_lower index_upper'
    found = {}
    for row in read_table('lift_predictor', 'techniques.csv', columns):
        lower, upper = (
            row.number(key) if row[key] else None for key in ('index_lower', 'index_upper')
        )
        found[row['technique']] = Technique(row['technique'], lower, upper, row['source'])
    return found


def technique(name: str) -> Technique:
    """Return one technique.

    Raises
    ------
    PlanError
        An unknown name.
    """
    known = techniques()
    if name not in known:
        raise PlanError(f'task.technique: {name!r} is not one of {", ".join(known)}')
    return known[name]


def technique_range(wanted: Technique | None) -> tuple[float, float] | None:
    """Range of the index that the search for a posture aims at; None: any."""
    if wanted is None or wanted.lower is None or wanted.upper is None:
        return None
    inside = min(INDEX_INSIDE, 0.4 * (wanted.upper - wanted.lower))
    return wanted.lower + inside, wanted.upper - inside


def off_technique(hips: Array, c7: Array, index: tuple[float, float]) -> Array:
    """Distance of the hips from the range of an index (n,) [m], by the lowering of hips and C7."""
    low, high = ((1.0 - limit / 100.0) * c7 for limit in index)
    return np.maximum(np.maximum(hips - low, high - hips), 0.0)


def squat_index(hips: Array, c7: Array) -> Array:
    """Stoop-Squat-Index (n,) of a lowering of hips and C7 [m]; NaN where C7 is not lowered."""
    lowered = c7 > 0.0
    return np.where(lowered, 100.0 * (1.0 - hips / np.where(lowered, c7, 1.0)), np.nan)
