# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of values that come from outside."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from human_model.typing import Array
from injury_monitor.core.exceptions import InvalidInputError


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


def array(field: str, value: Any, shape: tuple[int, ...]) -> Array:
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
