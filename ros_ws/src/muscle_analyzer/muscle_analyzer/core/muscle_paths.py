# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Lengths, moment arms and forces on the bodies of all muscles at one posture, compiled.

A muscle pulls with unit force along its path; path points and points where it leaves a wrap
object push on their bodies.  The moment arm about a coordinate is the generalised force of these
pushes, which is minus the derivative of the length because the points lie where the length is
stationary (Sherman, Seth and Delp 2013, What is a moment arm?).  A coordinate that drives others
through couplers counts all of them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core.ellipsoid_wrapping import wrap_ellipsoid
from muscle_analyzer.core.muscle_path_table import CYLINDER, PathTable
from muscle_analyzer.core.wrapping import INSIDE, MISSED, PIERCED, POSSIBLE, wrap_cylinder

Array = NDArray[np.float64]

#: Rounds over the wrap objects of one path until its length settles, as in OpenSim, but to a
#: tighter tolerance [m] so that the result does not depend on it.
WRAP_ROUNDS, WRAP_TOLERANCE = 8, 1e-9


class MusclePaths(NamedTuple):
    """
    Paths of all muscles at one posture.

    Attributes
    ----------
    length : (n_m,)
        Path lengths [m].
    moment_arm : (n_m, n_q)
        Minus the derivative of the length with respect to each independent coordinate
        [m / rad or m / m].
    wrench : (n_e, 6)
        Moment about the ground's origin [m] and force [1] on a body per unit muscle force, ground
        axes; row k belongs to body ``table.body_index[k]`` of the muscle whose
        ``table.body_start`` range holds k.
    """

    length: Array
    moment_arm: Array
    wrench: Array


@njit(cache=True, error_model='numpy')
def _distance(a: Array, b: Array) -> float:
    return math.sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 + (b[2] - a[2]) ** 2)


@njit(cache=True, error_model='numpy')
def _into(rotation: Array, origin: Array, point: Array, out: Array) -> None:
    """Express a ground point in a frame."""
    for i in range(3):
        out[i] = 0.0
        for j in range(3):
            out[i] += rotation[j, i] * (point[j] - origin[j])


@njit(cache=True, error_model='numpy')
def _out_of(rotation: Array, origin: Array, point: Array, out: Array) -> None:
    """Express a point of a frame in ground axes."""
    for i in range(3):
        out[i] = origin[i]
        for j in range(3):
            out[i] += rotation[i, j] * point[j]


@njit(cache=True, error_model='numpy')
def _path_length(point: Array, owner: NDArray[np.int64], arc: Array, n: int) -> float:
    """Add up a path; two neighbours of one wrap object are joined by its arc."""
    length = 0.0
    for k in range(n - 1):
        if owner[k] < 0 and owner[k] == owner[k + 1]:
            length += arc[k]
        else:
            length += _distance(point[k], point[k + 1])
    return length


@njit(cache=True, error_model='numpy')
def _best_wrap(
    table: PathTable,
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
    for k in range(n - 1):
        start_late = owner[k] >= 0 and owner[k] < table.wrap_first[use]
        end_early = owner[k + 1] >= 0 and owner[k + 1] > table.wrap_last[use]
        if start_late or end_early or (owner[k] < 0 and owner[k] == owner[k + 1]):
            continue
        _into(rotation, origin, point[k], ends[0])
        _into(rotation, origin, point[k + 1], ends[1])
        dimensions, axis = table.wrap_dimensions[use], table.wrap_axis[use]
        sign = table.wrap_sign[use]
        if table.wrap_kind[use] == CYLINDER:
            contact, along = wrap_cylinder(
                ends[0], ends[1], dimensions, axis, sign, geodesic, ends[2], ends[3]
            )
        else:
            contact, along = wrap_ellipsoid(
                ends[0], ends[1], dimensions, axis, sign, ends[2], ends[3]
            )
        if contact < POSSIBLE:
            continue
        longer = _distance(ends[0], ends[2]) + along + _distance(ends[3], ends[1])
        longer -= _distance(ends[0], ends[1])
        if contact == PIERCED or longer < least:
            found, arc, least = k, along, longer
            _out_of(rotation, origin, ends[2], best[0])
            _out_of(rotation, origin, ends[3], best[1])
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
def _wrap_path(
    table: PathTable,
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
    begin, end = table.wrap_start[muscle], table.wrap_start[muscle + 1]
    n_wraps = end - begin
    order = np.arange(begin, end)
    contacts = np.zeros(n_wraps, np.int64)
    best = np.empty((2, 3))
    rotation, origin = np.empty((3, 3)), np.empty(3)
    length = np.inf
    geodesic = table.geodesic[0] or n_wraps > 1
    for attempt in range(WRAP_ROUNDS if n_wraps > 1 else 1):
        for place in range(n_wraps):
            use = order[place]
            for k in range(n - 1):
                if owner[k] == -1 - use:
                    for later in range(k + 2, n):
                        _move(point, owner, arc, later, later - 2)
                    n -= 2
                    break
            body = table.wrap_body[use]
            for i in range(3):
                for j in range(3):
                    rotation[i, j] = 0.0
                    for k in range(3):
                        rotation[i, j] += (
                            body_rotation[body, i, k] * table.wrap_rotation[use, k, j]
                        )
            _out_of(
                body_rotation[body], body_position[body], table.wrap_translation[use], origin
            )
            segment, contact, along = _best_wrap(
                table, use, rotation, origin, point, owner, n, geodesic, best
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
        length = _path_length(point, owner, arc, n)
        if abs(length - before) < WRAP_TOLERANCE:
            break
        # An object missed because the next one is in the way is tried after it.
        if attempt == 0 and n_wraps > 1 and contacts[0] == MISSED and contacts[1] == INSIDE:
            order[0], order[1] = order[1], order[0]
    return n, length


@njit(cache=True, error_model='numpy')
def muscle_paths(
    table: PathTable, body_position: Array, body_rotation: Array, jacobian: Array
) -> MusclePaths:
    """
    Compute all paths.

    Parameters
    ----------
    table
        Paths of the model.
    body_position, body_rotation
        Origins (n_b, 3) [m] and axes (n_b, 3, 3) of the bodies, ground from body.
    jacobian
        Spatial Jacobians (n_b, 6, n_q) about the ground's origin, (angular, linear).
    """
    n_m = table.point_start.size - 1
    size = table.longest[0]
    point, owner, arc = np.empty((size, 3)), np.empty(size, np.int64), np.zeros(size)
    entry_of = np.empty(body_position.shape[0], np.int64)
    length = np.empty(n_m)
    moment_arm = np.zeros((n_m, jacobian.shape[2]))
    wrench = np.zeros((table.body_index.size, 6))
    for m in range(n_m):
        n = table.point_start[m + 1] - table.point_start[m]
        for k in range(n):
            p = table.point_start[m] + k
            body = table.point_body[p]
            _out_of(
                body_rotation[body], body_position[body], table.point_location[p], point[k]
            )
            owner[k] = k
        if table.wrap_start[m + 1] > table.wrap_start[m]:
            n, length[m] = _wrap_path(
                table, m, body_rotation, body_position, point, owner, arc, n
            )
        else:
            length[m] = _path_length(point, owner, arc, n)

        for k in range(table.body_start[m], table.body_start[m + 1]):
            entry_of[table.body_index[k]] = k
        for k in range(n - 1):
            body_1, body_2 = _body(table, m, owner[k]), _body(table, m, owner[k + 1])
            if body_1 == body_2:
                continue
            span = _distance(point[k], point[k + 1])
            if span == 0.0:
                continue
            ux = (point[k + 1, 0] - point[k, 0]) / span
            uy = (point[k + 1, 1] - point[k, 1]) / span
            uz = (point[k + 1, 2] - point[k, 2]) / span
            mx = point[k, 1] * uz - point[k, 2] * uy
            my = point[k, 2] * ux - point[k, 0] * uz
            mz = point[k, 0] * uy - point[k, 1] * ux
            # Both pushes lie on one line, so their moments about the origin are opposite too.
            for entry, sense in ((entry_of[body_1], 1.0), (entry_of[body_2], -1.0)):
                wrench[entry, 0] += sense * mx
                wrench[entry, 1] += sense * my
                wrench[entry, 2] += sense * mz
                wrench[entry, 3] += sense * ux
                wrench[entry, 4] += sense * uy
                wrench[entry, 5] += sense * uz
        for c in range(table.crossed_start[m], table.crossed_start[m + 1]):
            q = table.crossed_index[c]
            arm = 0.0
            for k in range(table.body_start[m], table.body_start[m + 1]):
                body = table.body_index[k]
                for i in range(6):
                    arm += wrench[k, i] * jacobian[body, i, q]
            moment_arm[m, q] = arm
    return MusclePaths(length, moment_arm, wrench)


@njit(cache=True, error_model='numpy')
def _body(table: PathTable, muscle: int, owner: int) -> int:
    """Give the body that carries a point of a path."""
    if owner < 0:
        return int(table.wrap_body[-1 - owner])
    return int(table.point_body[table.point_start[muscle] + owner])


@njit(cache=True, error_model='numpy')
def body_wrenches(table: PathTable, wrench: Array, force: Array, n_bodies: int) -> Array:
    """
    Sum what muscles of given forces exert on the bodies.

    Parameters
    ----------
    wrench
        Of `MusclePaths` (n_e, 6).
    force
        Muscle forces (n_m,) [N].

    Returns
    -------
    (n_b, 6)
        Moment about the ground's origin [N m] and force [N] on each body, ground axes.
    """
    total = np.zeros((n_bodies, 6))
    for m in range(force.size):
        for k in range(table.body_start[m], table.body_start[m + 1]):
            for i in range(6):
                total[table.body_index[k], i] += force[m] * wrench[k, i]
    return total
