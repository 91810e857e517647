# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Shapes: lines, balls, an arrow, a box, a text; positions in the laboratory frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from human_model.typing import Array
from lifting_visualization.core.tables import Colour


class Kind(Enum):
    """Kinds of shapes."""

    LINES = 'lines'
    BALLS = 'balls'
    ARROW = 'arrow'
    BOX = 'box'
    TEXT = 'text'
    NOTHING = 'nothing'


@dataclass(frozen=True, eq=False)
class Shape:
    """One thing in the picture; another one of the same layer and number takes its place.

    Attributes
    ----------
    layer : str
        Group that a viewer can switch off.
    number : int
        In its layer.
    kind : Kind
        NOTHING takes away what was there.
    points : ndarray (n, 3)
        LINES: two for each line; BALLS: centres; ARROW: tail and head; BOX and TEXT: one [m].
    size : tuple of 3 floats
        LINES: width, -, -; BALLS: diameters; ARROW: diameter of shaft and head, length of the
        head; BOX: depth, width, height; TEXT: -, -, height of a letter [m].
    colour : Colour
        Red, green, blue, opacity.
    text : str
    orientation : ndarray (4,)
        Of a BOX: quaternion xyzw, world <- box.
    """

    layer: str
    number: int
    kind: Kind
    points: Array = field(default_factory=lambda: np.zeros((1, 3)))
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)
    colour: Colour = (0.0, 0.0, 0.0, 0.0)
    text: str = ''
    orientation: Array = field(default_factory=lambda: np.array([0.0, 0.0, 0.0, 1.0]))


def nothing(layer: str, number: int) -> Shape:
    """Return what takes a shape away."""
    return Shape(layer, number, Kind.NOTHING)
