# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Where a path of points leaves and meets the surfaces that it wraps over, compiled.

Which segment of the path wraps over an object, in which order objects are tried and how often, is
as in OpenSim's ``GeometryPath``; the single surfaces are in modules of their own.

Arrays are given one by one and whole, with the numbers of rows: rows that are cut out as arrays of
their own, and tuples of arrays, cost more to hand over than the arithmetic.
"""

from __future__ import annotations

import math

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array, IntArray
from muscle_analyzer.core.muscles.cylinder_wrapping import (
    INSIDE,
    MISSED,
    PIERCED,
    POSSIBLE,
    Vector,
    wrap_cylinder,
)
from muscle_analyzer.core.muscles.ellipsoid_wrapping import wrap_ellipsoid
from muscle_analyzer.core.muscles.sphere_wrapping import wrap_sphere
from muscle_analyzer.core.muscles.torus_wrapping import wrap_torus
from muscle_analyzer.core.muscles.wrap_table import CYLINDER, ELLIPSOID, SPHERE, WrapTable

#: Rounds over the wrap objects of one path until its length settles, as in OpenSim, but to a
#: tighter tolerance [m] so that the result does not depend on it.
WRAP_ROUNDS, WRAP_TOLERANCE = 8, 1e-9


@kernel
def place_surfaces(wraps: WrapTable, position: Array, rotation: Array, frame: Array) -> None:
    """Fill origin and axes (n_o, 12), ground from surface, of all wrap objects.

    `position` (n_b, 3) and `rotation` (n_b, 3, 3) are those of the bodies.
    """
    bodies, turn, shift = wraps.body, wraps.rotation, wraps.translation
    for k in range(bodies.size):
        body = bodies[k]
        for i in range(3):
            rx, ry, rz = rotation[body, i, 0], rotation[body, i, 1], rotation[body, i, 2]
            frame[k, i] = (
                position[body, i] + rx * shift[k, 0] + ry * shift[k, 1] + rz * shift[k, 2]
            )
            for j in range(3):
                frame[k, 3 + 3 * i + j] = (
                    rx * turn[k, 0, j] + ry * turn[k, 1, j] + rz * turn[k, 2, j]
                )


@njit(error_model='numpy')
def into(frame: Array, k: int, point: Array, p: int) -> Vector:
    """Express ground point p of (n, 3) in frame k of (n_o, 12)."""
    x, y, z = point[p, 0] - frame[k, 0], point[p, 1] - frame[k, 1], point[p, 2] - frame[k, 2]
    return (
        frame[k, 3] * x + frame[k, 6] * y + frame[k, 9] * z,
        frame[k, 4] * x + frame[k, 7] * y + frame[k, 10] * z,
        frame[k, 5] * x + frame[k, 8] * y + frame[k, 11] * z,
    )


@njit(error_model='numpy')
def out_of(frame: Array, k: int, local: Vector) -> Vector:
    """Express a point given in frame k of (n_o, 12) in ground axes."""
    x, y, z = local
    return (
        frame[k, 0] + (frame[k, 3] * x + frame[k, 4] * y + frame[k, 5] * z),
        frame[k, 1] + (frame[k, 6] * x + frame[k, 7] * y + frame[k, 8] * z),
        frame[k, 2] + (frame[k, 9] * x + frame[k, 10] * y + frame[k, 11] * z),
    )


@njit(error_model='numpy')
def distance(a: Vector, b: Vector) -> float:
    """Return the distance of two points."""
    dx, dy, dz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@njit(error_model='numpy')
def gap(point: Array, k: int, other: int) -> float:
    """Return the distance of two rows of (n, 3)."""
    dx, dy, dz = (
        point[other, 0] - point[k, 0],
        point[other, 1] - point[k, 1],
        point[other, 2] - point[k, 2],
    )
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@njit(error_model='numpy')
def path_length(point: Array, owner: IntArray, arc: Array, n: int) -> float:
    """Add up a path; two neighbours of one wrap object are joined by its arc."""
    length = 0.0
    for k in range(n - 1):
        if owner[k] < 0 and owner[k] == owner[k + 1]:
            length += arc[k]
        else:
            length += gap(point, k, k + 1)
    return length


@njit(error_model='numpy')
def _wrap_segment(
    kind: int,
    first: Vector,
    second: Vector,
    dimensions: Vector,
    axis: int,
    sign: int,
    method: int,
    geodesic: bool,
) -> tuple[int, float, Vector, Vector]:
    """Wrap one segment over a surface of any kind; results as of `wrap_cylinder`."""
    if kind == CYLINDER:
        return wrap_cylinder(first, second, dimensions, axis, sign, geodesic)
    if kind == ELLIPSOID:
        return wrap_ellipsoid(first, second, dimensions, axis, sign, method)
    if kind == SPHERE:
        return wrap_sphere(first, second, dimensions, axis, sign)
    return wrap_torus(first, second, dimensions, axis, sign, geodesic)


@njit(error_model='numpy')
def _move(point: Array, owner: IntArray, arc: Array, old: int, new: int) -> None:
    """Copy one entry of a path to another place."""
    owner[new], arc[new] = owner[old], arc[old]
    for i in range(3):
        point[new, i] = point[old, i]


@njit(error_model='numpy', inline='always')
def wrap_path(
    kind: IntArray,
    dimensions: Array,
    axis: IntArray,
    sign: IntArray,
    surface: IntArray,
    method: IntArray,
    first: IntArray,
    last: IntArray,
    begin: int,
    n_wraps: int,
    geodesic: bool,
    frame: Array,
    order: IntArray,
    contacts: IntArray,
    point: Array,
    owner: IntArray,
    arc: Array,
    n: int,
) -> tuple[int, float]:
    """Insert the wrap points of one muscle into its path.

    The first eight arguments are of `WrapTable`; `begin` and `n_wraps` are the muscle's uses,
    `frame` is of `place_surfaces`.  `owner` holds the number of a path point from 0, or
    ``-1 - use`` of a wrap point.  Returns the number of points and the length.
    """
    for place in range(n_wraps):
        order[place] = begin + place
        contacts[place] = MISSED
    length = math.inf
    for attempt in range(WRAP_ROUNDS if n_wraps > 1 else 1):
        for place in range(n_wraps):
            use = order[place]
            if attempt > 0:
                for k in range(n - 1):
                    if owner[k] == -1 - use:
                        for later in range(k + 2, n):
                            _move(point, owner, arc, later, later - 2)
                        n -= 2
                        break
            # Of the points that are there, the first and the last that the object counts for.
            start, end = n, -1
            for k in range(n):
                if first[use] <= owner[k] <= last[use]:
                    start, end = min(start, k), k
            # The first segment that pierces the object is taken; otherwise the one whose wrap
            # lengthens the path least.
            of = surface[use]
            size = dimensions[of, 0], dimensions[of, 1], dimensions[of, 2]
            segment, contact, along, least = -1, MISSED, 0.0, math.inf
            leave = meet = size
            for k in range(start, end):
                if owner[k] < 0 and owner[k] == owner[k + 1]:
                    continue
                a, b = into(frame, of, point, k), into(frame, of, point, k + 1)
                contact, around, one, two = _wrap_segment(
                    kind[of], a, b, size, axis[of], sign[of], method[use], geodesic
                )
                if contact < POSSIBLE:
                    continue
                longer = distance(a, one) + around + distance(two, b) - distance(a, b)
                if contact == PIERCED or longer < least:
                    segment, along, least, leave, meet = k, around, longer, one, two
                if contact == PIERCED:
                    break
            contacts[place] = contact
            if segment >= 0:
                k = segment + 1
                for later in range(n - 1, segment, -1):
                    _move(point, owner, arc, later, later + 2)
                point[k, 0], point[k, 1], point[k, 2] = out_of(frame, of, leave)
                point[k + 1, 0], point[k + 1, 1], point[k + 1, 2] = out_of(frame, of, meet)
                owner[k] = owner[k + 1] = -1 - use
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
