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

import csv
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import PlanError
from lift_predictor.core.sagittal.kinematics import chain_positions
from lift_predictor.core.sagittal.parameters import LiftParameters
from lift_predictor.core.sagittal.person import Person

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
    table = files('lift_predictor') / 'data' / 'techniques.csv'
    rows = csv.DictReader(table.read_text(encoding='utf-8').splitlines())
    found = {}
    for row in rows:
        lower, upper = (
            float(row[key]) if row[key] else None for key in ('index_lower', 'index_upper')
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


def technique_range(wanted: Technique) -> tuple[float, float] | None:
    """Range of the index that the search for a posture aims at; None: any."""
    if wanted.lower is None or wanted.upper is None:
        return None
    inside = min(INDEX_INSIDE, 0.4 * (wanted.upper - wanted.lower))
    return wanted.lower + inside, wanted.upper - inside


def lowering(q: Array, person: Person, parameters: LiftParameters) -> tuple[Array, Array]:
    """How far hips and C7 are below their height in upright standing (n,) [m]."""
    state = chain_positions(q, parameters)
    neutral = person.neutral
    offset = (neutral['c7'] - neutral['l5_s1'])[[0, 2]]
    angle = state.angles['trunk']
    c7 = state.joints['lumbar'][:, 1] + np.sin(angle) * offset[0] + np.cos(angle) * offset[1]
    ankle = neutral['ankle_r'][2] - parameters.ankle[1]
    hips = neutral['hip_r'][2] - ankle - state.joints['hip'][:, 1]
    return hips, neutral['c7'][2] - ankle - c7


def stoop_squat_index(q: Array, person: Person, parameters: LiftParameters) -> Array:
    """Stoop-Squat-Index of postures q (n, 6); NaN where C7 is not lowered."""
    hips, c7 = lowering(q, person, parameters)
    lowered = c7 > 0.0
    return np.where(lowered, 100.0 * (1.0 - hips / np.where(lowered, c7, 1.0)), np.nan)
