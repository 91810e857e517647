# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Where a path of points leaves and meets the surfaces that it wraps over, compiled.

Which segment of the path wraps over an object, in which order objects are tried and how often, is
as in OpenSim's ``GeometryPath``; the single surfaces are in modules of their own.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core.ellipsoid_wrapping import wrap_ellipsoid
from muscle_analyzer.core.muscle_path_table import CYLINDER, ELLIPSOID, SPHERE, WrapTable
from muscle_analyzer.core.sphere_wrapping import wrap_sphere
from muscle_analyzer.core.torus_wrapping import wrap_torus
from muscle_analyzer.core.wrapping import INSIDE, MISSED, PIERCED, POSSIBLE, wrap_cylinder

Array = NDArray[np.float64]

#: Rounds over the wrap objects of one path until its length settles, as in OpenSim, but to a
#: tighter tolerance [m] so that the result does not depend on it.
WRAP_ROUNDS, WRAP_TOLERANCE = 8, 1e-9


@njit(cache=True, error_model='numpy')
def distance(a: Array, b: Array) -> float:
    """Give the distance of two points."""
    return math.sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 + (b[2] - a[2]) ** 2)


@njit(cache=True, error_model='numpy')
def into(rotation: Array, origin: Array, point: Array, out: Array) -> None:
    """Express a ground point in a frame."""
    for i in range(3):
        out[i] = 0.0
        for j in range(3):
            out[i] += rotation[j, i] * (point[j] - origin[j])


@njit(cache=True, error_model='numpy')
def out_of(rotation: Array, origin: Array, point: Array, out: Array) -> None:
    """Express a point of a frame in ground axes."""
    for i in range(3):
        out[i] = origin[i]
        for j in range(3):
            out[i] += rotation[i, j] * point[j]


@njit(cache=True, error_model='numpy')
def path_length(point: Array, owner: NDArray[np.int64], arc: Array, n: int) -> float:
    """Add up a path; two neighbours of one wrap object are joined by its arc."""
    length = 0.0
    for k in range(n - 1):
        if owner[k] < 0 and owner[k] == owner[k + 1]:
            length += arc[k]
        else:
            length += distance(point[k], point[k + 1])
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
    best: Array,
) -> tuple[int, int, float]:
    """
    Find the segment of a path that wraps over an object, and its tangent points.

    The first segment that pierces the object is taken; otherwise the one whose wrap lengthens
    the path least.  Returns the segment (-1 if none), the last contact and the arc length.
    """
    ends = np.empty((4, 3))
    found, contact, arc, least = -1, MISSED, 0.0, np.inf
    # Of the points that are there, the first and the last that the object counts for.
    start, end = n, -1
    for k in range(n):
        if wraps.first[use] <= owner[k] <= wraps.last[use]:
            start, end = min(start, k), k
    for k in range(start, end):
        if owner[k] < 0 and owner[k] == owner[k + 1]:
            continue
        into(rotation, origin, point[k], ends[0])
        into(rotation, origin, point[k + 1], ends[1])
        dimensions, axis = wraps.dimensions[use], wraps.axis[use]
        sign = wraps.sign[use]
        kind = wraps.kind[use]
        if kind == CYLINDER:
            contact, along = wrap_cylinder(
                ends[0], ends[1], dimensions, axis, sign, geodesic, ends[2], ends[3]
            )
        elif kind == ELLIPSOID:
            method = wraps.method[use]
            contact, along = wrap_ellipsoid(
                ends[0], ends[1], dimensions, axis, sign, method, ends[2], ends[3]
            )
        elif kind == SPHERE:
            contact, along = wrap_sphere(
                ends[0], ends[1], dimensions, axis, sign, ends[2], ends[3]
            )
        else:
            contact, along = wrap_torus(
                ends[0], ends[1], dimensions, axis, sign, geodesic, ends[2], ends[3]
            )
        if contact < POSSIBLE:
            continue
        longer = distance(ends[0], ends[2]) + along + distance(ends[3], ends[1])
        longer -= distance(ends[0], ends[1])
        if contact == PIERCED or longer < least:
            found, arc, least = k, along, longer
            out_of(rotation, origin, ends[2], best[0])
            out_of(rotation, origin, ends[3], best[1])
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
) -> tuple[int, float]:
    """
    Insert the wrap points of one muscle into its path.

    `owner` holds the number of a path point from 0, or ``-1 - use`` of a wrap point.
    Returns the number of points and the length.
    """
    begin, end = wraps.start[muscle], wraps.start[muscle + 1]
    n_wraps = end - begin
    order = np.arange(begin, end)
    contacts = np.zeros(n_wraps, np.int64)
    best = np.empty((2, 3))
    rotation, origin = np.empty((3, 3)), np.empty(3)
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
            out_of(
                body_rotation[body], body_position[body], wraps.translation[use], origin
            )
            segment, contact, along = _best_wrap(
                wraps, use, rotation, origin, point, owner, n, geodesic, best
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
