# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of values that come from outside."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from injury_monitor.core.exceptions import InvalidInputError

FloatArray = npt.NDArray[np.float64]

#: So many values are summed by one thread; more may wait for several, longer than it takes.
_FEW = 1000


def finite(field: str, value: float) -> float:
    """Return ``value`` as a float; refuse NaN and infinity."""
    result = float(value)
    if not math.isfinite(result):
        raise InvalidInputError(field, value, 'must be finite')
    return result


def non_negative(field: str, value: float) -> float:
    """Return ``value`` as a float; refuse NaN, infinity and negative numbers."""
    result = finite(field, value)
    if result < 0.0:
        raise InvalidInputError(field, value, 'must not be negative')
    return result


def positive(field: str, value: float) -> float:
    """Return ``value`` as a float; refuse NaN, infinity, zero and negative numbers."""
    result = finite(field, value)
    if result <= 0.0:
        raise InvalidInputError(field, value, 'must be positive')
    return result


def array(field: str, value: Any, shape: tuple[int, ...]) -> FloatArray:
    """Return ``value`` as an array of the given shape.

    Raises
    ------
    InvalidInputError
        If the shape differs.
    """
    result = np.asarray(value, dtype=np.float64)
    if result.shape != shape:
        raise InvalidInputError(field, result.shape, f'must have the shape {shape}')
    return result


def all_finite(values: FloatArray) -> bool:
    """Return whether no value is NaN or infinite.

    A sum of squares is finite unless a value is not, or beyond 1e154: only then each is looked
    at, which takes four times as long for a live sample.
    """
    if values.size <= _FEW and math.isfinite(np.vdot(values, values)):
        return True
    return bool(np.all(np.isfinite(values)))
