# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Ranges of motion of people, where they are narrower than the limits of the skeleton."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Final

import numpy as np

from human_model.tables import Row, read_table
from human_model.typing import Array

HAMSTRINGS: Final = ('hip_flexion_straight_knee', 'hip_flexion_per_knee_flexion')


@cache
def ranges(skeleton: str) -> Mapping[str, tuple[float, float]]:
    """Lower and upper end of the range of coordinates of a skeleton, by name [rad]."""
    return {row['coordinate']: _radians(row) for row in _rows() if row['skeleton'] == skeleton}


@cache
def hip_range() -> tuple[float, float]:
    """Largest hip flexion with the knee straight [rad], and its rise with the flexion of the knee.

    The hamstrings pass both joints, so that the hip flexes less the straighter the knee is.
    """
    value = {row['coordinate']: row.number('upper') for row in _rows()}
    straight, per_knee = (value[name] for name in HAMSTRINGS)
    return float(np.radians(straight)), per_knee


def hamstring_room(hip: Array, knee: Array, limit: Array) -> Array:
    """Hip flexion that is left before the hamstrings are at their full length [rad].

    Parameters
    ----------
    hip, knee : ndarray
        Flexion [rad].
    limit : ndarray, shape (2,)
        As of `hip_range`.
    """
    return np.asarray(limit[0] + limit[1] * knee - hip)


def _radians(row: Row) -> tuple[float, float]:
    low, high = np.radians(row.numbers('lower', 'upper'))
    return float(low), float(high)


def _rows() -> tuple[Row, ...]:
    return read_table('lift_predictor', 'ranges.csv', 'skeleton coordinate lower upper')
