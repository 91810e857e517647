# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A person, a box and forces as shapes. Widths are for the eye only."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from human_model.typing import Array
from lifting_visualization.core.exceptions import PictureError
from lifting_visualization.core.shapes import Kind, Shape, nothing
from lifting_visualization.core.tables import Colour, bones, colours

BONE, JOINT, SHAFT = 0.035, 0.05, 0.025
#: Height of letters [m].
LETTER = 0.09


@dataclass(frozen=True)
class SpineScale:
    """How compression is drawn.

    Attributes
    ----------
    action, maximum : float
        Limits [N] at which the colour changes.
    length : float
        Of the arrow [m/N].
    """

    action: float
    maximum: float
    length: float

    def colour(self, compression: float) -> Colour:
        """Return the colour of a compression [N]; at a limit it is that of the limit."""
        if compression >= self.maximum:
            return colours()['above_maximum']
        return colours()['above_action' if compression >= self.action else 'below_limit']


@cache
def _ends(names: tuple[str, ...]) -> npt.NDArray[np.int64]:
    """Return the indices (2 n,) of the ends of n bones."""
    missing = sorted({name for pair in bones() for name in pair} - set(names))
    if missing:
        raise PictureError(f'body_motion.point_names: {missing[0]} is missing')
    return np.array([names.index(name) for pair in bones() for name in pair], np.int64)


def body(layer: str, names: tuple[str, ...], points: Array, colour: Colour) -> list[Shape]:
    """Return a stick figure of named points (n, 3) [m]: bones, joints, head."""
    ends = points[_ends(names)]
    head = np.array([points[names.index('c7')], points[names.index('head')]])
    size = float(np.linalg.norm(head[1] - head[0]))
    return [
        Shape(layer, 0, Kind.LINES, ends, (BONE, 0.0, 0.0), colour),
        Shape(layer, 1, Kind.BALLS, points, (JOINT, JOINT, JOINT), colour),
        # A ball that ends at the vertex and is as high as head and neck less a third: the neck.
        Shape(
            layer,
            2,
            Kind.BALLS,
            head[1:] - (head[1:] - head[:1]) / 3.0,
            (2.0 / 3.0 * size,) * 3,
            colour,
        ),
    ]


def box(layer: str, place: Array, size: Array, orientation: Array) -> Shape:
    """Return a box at its centre [m]; nothing where the centre or the size is not known."""
    depth, width, height = size.tolist()
    if not np.all(np.isfinite(place)) or min(depth, width, height) <= 0.0:
        return nothing(layer, 0)
    return Shape(
        layer,
        0,
        Kind.BOX,
        place[None],
        (depth, width, height),
        colours()['box'],
        orientation=orientation,
    )


def ground_forces(layer: str, force: Array, cop: Array, scale: float) -> list[Shape]:
    """Return the arrows of the ground's forces (2, 3) [N] at their places (2, 3) [m].

    `scale` is in m/N. A foot without centre of pressure has none.
    """
    shapes = []
    for side in range(2):
        if not np.all(np.isfinite(cop[side])) or not np.any(force[side]):
            shapes.append(nothing(layer, side))
            continue
        tip = cop[side] + scale * force[side]
        shapes.append(_arrow(layer, side, cop[side], tip, colours()['ground_force']))
    return shapes


def compression(
    layer: str, place: Array, direction: Array, value: float, scale: SpineScale
) -> list[Shape]:
    """Return arrow and number of the compression [N] of a disc at its place (3,) [m].

    `direction` (3,), of any length, points along the disc's normal towards the head. The arrow
    points into the disc from above: the load that the upper body puts on it. NaN gives nothing.
    """
    if not np.isfinite(value) or not np.any(direction):
        return [nothing(layer, 0), nothing(layer, 1)]
    colour = scale.colour(value)
    along = direction / np.linalg.norm(direction)
    tail = place + scale.length * abs(value) * along
    # A disc that is pulled apart has the arrow turned round.
    ends = (tail, place) if value >= 0.0 else (place, tail)
    text = Shape(
        layer,
        1,
        Kind.TEXT,
        (tail + LETTER * along)[None],
        (0.0, 0.0, LETTER),
        colour,
        f'{value:.0f} N',
    )
    return [_arrow(layer, 0, *ends, colour), text]


def label(layer: str, number: int, place: Array, text: str, colour: Colour) -> Shape:
    """Return a text above a place (3,) [m]."""
    above = place + np.array([0.0, 0.0, 2.0 * LETTER])
    return Shape(layer, number, Kind.TEXT, above[None], (0.0, 0.0, LETTER), colour, text)


def path(layer: str, number: int, places: Array, colour: Colour) -> Shape:
    """Return the line through places (n, 3) [m]; nothing with fewer than two."""
    known = places[np.all(np.isfinite(places), axis=1)]
    if len(known) < 2:
        return nothing(layer, number)
    pieces = np.repeat(known, 2, axis=0)[1:-1]
    return Shape(layer, number, Kind.LINES, pieces, (0.4 * BONE, 0.0, 0.0), colour)


def _arrow(layer: str, number: int, tail: Array, tip: Array, colour: Colour) -> Shape:
    length = float(np.linalg.norm(tip - tail))
    head = min(4.0 * SHAFT, 0.5 * length)
    return Shape(
        layer, number, Kind.ARROW, np.array([tail, tip]), (SHAFT, 2.0 * SHAFT, head), colour
    )
