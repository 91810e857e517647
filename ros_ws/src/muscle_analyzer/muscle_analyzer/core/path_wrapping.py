# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Where a path of points leaves and meets the surfaces that it wraps over, compiled.

Which segment of the path wraps over an object, in which order objects are tried and how often, is
as in OpenSim's ``GeometryPath``; the single surfaces are in modules of their own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core.ellipsoid_wrapping import wrap_ellipsoid
from muscle_analyzer.core.muscle_path_table import CYLINDER, ELLIPSOID, SPHERE, WrapTable
from muscle_analyzer.core.sphere_wrapping import wrap_sphere
from muscle_analyzer.core.torus_wrapping import wrap_torus
from muscle_analyzer.core.wrapping import INSIDE, MISSED, PIERCED, POSSIBLE, wrap_cylinder

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Rounds over the wrap objects of one path until its length settles, as in OpenSim, but to a
#: tighter tolerance [m] so that the result does not depend on it.
WRAP_ROUNDS, WRAP_TOLERANCE = 8, 1e-9


class Scratch(NamedTuple):
    """Working space of `wrap_path`, made once for all muscles: allocating costs time."""

    order: IntArray
    contacts: IntArray
    first: Array
    second: Array
    tangent_first: Array
    tangent_second: Array
    best: Array
    rotation: Array
    origin: Array


@njit(cache=True, error_model='numpy')
def new_scratch(most_wraps: int) -> Scratch:
    """Make the working space for paths with so many wrap objects at most."""
    return Scratch(
        np.empty(most_wraps, np.int64),
        np.empty(most_wraps, np.int64),
        np.empty(3),
        np.empty(3),
        np.empty(3),
        np.empty(3),
        np.empty((2, 3)),
        np.empty((3, 3)),
        np.empty(3),
    )


@njit(cache=True, error_model='numpy')
def distance(a: Array, b: Array) -> float:
    """Give the distance of two points."""
    return math.sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 + (b[2] - a[2]) ** 2)


@njit(cache=True, error_model='numpy', inline='always')
def into(rotation: Array, origin: Array, point: Array, k: int, out: Array) -> None:
    """
    Express ground point k of (n, 3) in a frame.

    Rows are given by array and number, here and below: numba counts references of every row that
    is cut out as an array of its own, which costs more than the arithmetic.
    """
    x, y, z = point[k, 0] - origin[0], point[k, 1] - origin[1], point[k, 2] - origin[2]
    for i in range(3):
        out[i] = rotation[0, i] * x + rotation[1, i] * y + rotation[2, i] * z


@njit(cache=True, error_model='numpy', inline='always')
def out_of(
    rotation: Array, origin: Array, body: int, local: Array, p: int, out: Array, k: int
) -> None:
    """Put point p of (n, 3), in the axes of one of many bodies, into row k in ground axes."""
    x, y, z = local[p, 0], local[p, 1], local[p, 2]
    for i in range(3):
        out[k, i] = origin[body, i] + (
            rotation[body, i, 0] * x + rotation[body, i, 1] * y + rotation[body, i, 2] * z
        )


@njit(cache=True, error_model='numpy', inline='always')
def gap(point: Array, k: int, other: int) -> float:
    """Give the distance of two rows of (n, 3)."""
    return math.sqrt(
        (point[other, 0] - point[k, 0]) ** 2
        + (point[other, 1] - point[k, 1]) ** 2
        + (point[other, 2] - point[k, 2]) ** 2
    )


@njit(cache=True, error_model='numpy')
def path_length(point: Array, owner: NDArray[np.int64], arc: Array, n: int) -> float:
    """Add up a path; two neighbours of one wrap object are joined by its arc."""
    length = 0.0
    for k in range(n - 1):
        if owner[k] < 0 and owner[k] == owner[k + 1]:
            length += arc[k]
        else:
            length += gap(point, k, k + 1)
    return length


@njit(cache=True, error_model='numpy')
def _best_wrap(
    wraps: WrapTable,
    use: int,
    rotation: Array,
    origin: Array,
    point: Array,
    owner: NDArray[np.int64],
    n: int,
    geodesic: bool,
    scratch: Scratch,
) -> tuple[int, int, float]:
    """
    Find the segment of a path that wraps over an object, and its tangent points.

    The first segment that pierces the object is taken; otherwise the one whose wrap lengthens
    the path least.  Returns the segment (-1 if none), the last contact and the arc length.
    """
    a, b = scratch.first, scratch.second
    leave, meet = scratch.tangent_first, scratch.tangent_second
    found, contact, arc, least = -1, MISSED, 0.0, np.inf
    # Of the points that are there, the first and the last that the object counts for.
    start, end = n, -1
    for k in range(n):
        if wraps.first[use] <= owner[k] <= wraps.last[use]:
            start, end = min(start, k), k
    for k in range(start, end):
        if owner[k] < 0 and owner[k] == owner[k + 1]:
            continue
        into(rotation, origin, point, k, a)
        into(rotation, origin, point, k + 1, b)
        dimensions, axis = wraps.dimensions[use], wraps.axis[use]
        sign = wraps.sign[use]
        kind = wraps.kind[use]
        if kind == CYLINDER:
            contact, along = wrap_cylinder(
                a, b, dimensions, axis, sign, geodesic, leave, meet
            )
        elif kind == ELLIPSOID:
            method = wraps.method[use]
            contact, along = wrap_ellipsoid(
                a, b, dimensions, axis, sign, method, leave, meet
            )
        elif kind == SPHERE:
            contact, along = wrap_sphere(
                a, b, dimensions, axis, sign, leave, meet
            )
        else:
            contact, along = wrap_torus(
                a, b, dimensions, axis, sign, geodesic, leave, meet
            )
        if contact < POSSIBLE:
            continue
        longer = distance(a, leave) + along + distance(meet, b) - distance(a, b)
        if contact == PIERCED or longer < least:
            found, arc, least = k, along, longer
            for i in range(3):
                scratch.best[0, i] = scratch.best[1, i] = origin[i]
                for j in range(3):
                    scratch.best[0, i] += rotation[i, j] * leave[j]
                    scratch.best[1, i] += rotation[i, j] * meet[j]
        if contact == PIERCED:
            break
    return found, contact, arc


@njit(cache=True, error_model='numpy')
def _move(point: Array, owner: NDArray[np.int64], arc: Array, old: int, new: int) -> None:
    """Copy one entry of a path to another place."""
    owner[new], arc[new] = owner[old], arc[old]
    for i in range(3):
        point[new, i] = point[old, i]


@njit(cache=True, error_model='numpy')
def wrap_path(
    wraps: WrapTable,
    muscle: int,
    body_rotation: Array,
    body_position: Array,
    point: Array,
    owner: NDArray[np.int64],
    arc: Array,
    n: int,
    scratch: Scratch,
) -> tuple[int, float]:
    """
    Insert the wrap points of one muscle into its path.

    `owner` holds the number of a path point from 0, or ``-1 - use`` of a wrap point.
    Returns the number of points and the length.
    """
    begin, end = wraps.start[muscle], wraps.start[muscle + 1]
    n_wraps = end - begin
    order, contacts, best = scratch.order, scratch.contacts, scratch.best
    rotation, origin = scratch.rotation, scratch.origin
    for place in range(n_wraps):
        order[place] = begin + place
        contacts[place] = MISSED
    length = np.inf
    geodesic = wraps.geodesic[0] or n_wraps > 1
    for attempt in range(WRAP_ROUNDS if n_wraps > 1 else 1):
        for place in range(n_wraps):
            use = order[place]
            for k in range(n - 1):
                if owner[k] == -1 - use:
                    for later in range(k + 2, n):
                        _move(point, owner, arc, later, later - 2)
                    n -= 2
                    break
            body = wraps.body[use]
            for i in range(3):
                for j in range(3):
                    rotation[i, j] = 0.0
                    for k in range(3):
                        rotation[i, j] += (
                            body_rotation[body, i, k] * wraps.rotation[use, k, j]
                        )
                origin[i] = body_position[body, i]
                for k in range(3):
                    origin[i] += body_rotation[body, i, k] * wraps.translation[use, k]
            segment, contact, along = _best_wrap(
                wraps, use, rotation, origin, point, owner, n, geodesic, scratch
            )
            contacts[place] = contact
            if segment >= 0:
                k = segment + 1
                for later in range(n - 1, k - 1, -1):
                    _move(point, owner, arc, later, later + 2)
                for end_number in range(2):
                    for i in range(3):
                        point[k + end_number, i] = best[end_number, i]
                    owner[k + end_number] = -1 - use
                arc[k] = along
                n += 2
        before = length
        length = path_length(point, owner, arc, n)
        if abs(length - before) < WRAP_TOLERANCE:
            break
        # An object missed because the next one is in the way is tried after it.
        if attempt == 0 and n_wraps > 1 and contacts[0] == MISSED and contacts[1] == INSIDE:
            order[0], order[1] = order[1], order[0]
    return n, length
