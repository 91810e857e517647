# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Contact of a level box with round parts of the body (equations 3.10 and 4.5, true box size).

The centre of a circle or sphere must stay outside of the box grown by its radius: a box with
rounded edges. The constraint takes a smooth shape that contains it, sum (d / a)^8 = 1; the check
takes the exact distance.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import Any, Final

import numpy as np

from human_model.typing import Array

_ORDER: Final = 8
_DIRECTIONS: Final = np.linspace(0.0, 0.5 * np.pi, 13)


def semi_axes(half: Array, radius: Array) -> Array:
    """Semi-axes of the smooth shapes that contain a box grown by each radius.

    Parameters
    ----------
    half : ndarray, shape (k,)
        Half sizes of the box in 2 or 3 dimensions [m].
    radius : ndarray, shape (n,)
        Of the circles or spheres [m]; not positive: not used.

    Returns
    -------
    ndarray, shape (n, k)
        [m]; 0 for a radius that is not used.
    """
    circles = [np.array([np.cos(a), np.sin(a)]) for a in _DIRECTIONS]
    if len(half) == 2:
        directions = np.array(circles)
    else:
        directions = np.array(
            [np.append(flat * up[0], up[1]) for flat, up in product(circles, circles)]
        )
    axes = np.zeros((len(radius), len(half)))
    for row, r in enumerate(radius):
        if r > 0.0:
            part = (half + r * directions) / (half + r)
            scale = (part**_ORDER).sum(axis=1).max() ** (1.0 / _ORDER)
            axes[row] = max(scale, 1.0) * (half + r)
    return axes


def clearance(offset: Sequence[Any], axes: Sequence[Any], square_root: Any) -> Any:
    """Return the constraint of one circle or sphere: positive outside of the smooth shape.

    Parameters
    ----------
    offset : sequence of expressions
        From the centre of the box along its axes [m].
    axes : sequence of expressions
        Semi-axes [m].
    square_root : callable
        Of the expressions.
    """
    total = 0.0
    for part, axis in zip(offset, axes, strict=True):
        total = total + ((part / axis) ** 2) ** 4
    return square_root(square_root(total)) - 1.0


def gaps(offset: Array, half: Array, radius: Array) -> Array:
    """Exact distances of circles or spheres from the box; negative: how deep they are in it.

    Parameters
    ----------
    offset : ndarray, shape (..., n, k)
        Centres from the centre of the box, along its axes [m].
    half : ndarray, shape (k,)
        Half sizes of the box [m].
    radius : ndarray, shape (n,)
        [m].

    Returns
    -------
    ndarray, shape (..., n)
        [m]; infinite for a radius that is not positive.
    """
    beyond = np.abs(offset) - half
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=-1)
    inside = np.minimum(beyond.max(axis=-1), 0.0)
    return np.where(radius > 0.0, outside + inside - radius, np.inf)
