# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Lengths, moment arms and forces on the bodies of all muscles at one posture, compiled.

A muscle pulls with unit force along its path; path points and points where it leaves a wrap
object push on their bodies.  The moment arm about a coordinate is the generalised force of these
pushes, which is minus the derivative of the length because the points lie where the length is
stationary (Sherman, Seth and Delp 2013, What is a moment arm?).  A coordinate that drives others
through couplers counts all of them.  A point that moves in its body with a coordinate does work
along its way as well.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core.functions import evaluate
from muscle_analyzer.core.kinematics import BodyState
from muscle_analyzer.core.muscle_path_table import PathTable, ProductTable, SpanTable
from muscle_analyzer.core.path_wrapping import gap, path_length, place_surfaces, wrap_path
from muscle_analyzer.core.wrapping import Vector

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


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


@njit(cache=True, error_model='numpy', inline='always')
def _place_points(
    table: PathTable, position: Array, rotation: Array, coordinate: Array
) -> Array:
    """Put all path points (n_p, 3) where they are in ground axes."""
    bodies, location, motion = table.point_body, table.point_location, table.point_motion
    place = np.empty(location.shape)
    for p in range(bodies.size):
        b = bodies[p]
        x, y, z = location[p, 0], location[p, 1], location[p, 2]
        for i in range(3):
            place[p, i] = position[b, i] + (
                rotation[b, i, 0] * x + rotation[b, i, 1] * y + rotation[b, i, 2] * z
            )
    if table.motion_coordinate.size > 0:
        for p in range(bodies.size):
            d = motion[p]
            if d >= 0:
                x, y = _moved(table, d, 0, coordinate), _moved(table, d, 1, coordinate)
                z = _moved(table, d, 2, coordinate)
                b = bodies[p]
                for i in range(3):
                    place[p, i] = position[b, i] + (
                        rotation[b, i, 0] * x + rotation[b, i, 1] * y + rotation[b, i, 2] * z
                    )
    return place


@njit(cache=True, error_model='numpy', inline='always')
def _moved(table: PathTable, motion: int, i: int, coordinate: Array) -> float:
    """Give one coordinate of a moving point in its body [m]."""
    x = coordinate[table.motion_coordinate[motion, i]]
    return float(evaluate(table.functions, table.motion_function[motion, i], x)[0])


@njit(cache=True, error_model='numpy', inline='always')
def _add_motion(
    table: PathTable,
    motion: int,
    rotation: Array,
    body: int,
    pull: Vector,
    coordinate: Array,
    coordinate_gain: Array,
    moment_arm: Array,
    m: int,
) -> None:
    """Add to moment arms of muscle m what it pulls a point along its way in its body."""
    for i in range(3):
        q = table.motion_independent[motion, i]
        if q < 0:
            continue
        x = table.motion_coordinate[motion, i]
        slope = evaluate(table.functions, table.motion_function[motion, i], coordinate[x])[1]
        along = pull[0] * rotation[body, 0, i] + pull[1] * rotation[body, 1, i]
        along += pull[2] * rotation[body, 2, i]
        moment_arm[m, q] += along * slope * coordinate_gain[x]


@njit(cache=True, error_model='numpy', inline='always')
def _add_span(point: Array, k: int, other: int, wrench: Array, entry: int, opposite: int) -> float:
    """Add what a straight span between two points does to both bodies; returns its length."""
    x, y, z = point[k, 0], point[k, 1], point[k, 2]
    ux, uy, uz = point[other, 0] - x, point[other, 1] - y, point[other, 2] - z
    span = math.sqrt(ux * ux + uy * uy + uz * uz)
    if span > 0.0:
        share = 1.0 / span
        ux, uy, uz = ux * share, uy * share, uz * share
        mx, my, mz = y * uz - z * uy, z * ux - x * uz, x * uy - y * ux
        # Both pushes lie on one line, so their moments about the origin are opposite too.
        wrench[entry, 0] += mx
        wrench[entry, 1] += my
        wrench[entry, 2] += mz
        wrench[entry, 3] += ux
        wrench[entry, 4] += uy
        wrench[entry, 5] += uz
        wrench[opposite, 0] -= mx
        wrench[opposite, 1] -= my
        wrench[opposite, 2] -= mz
        wrench[opposite, 3] -= ux
        wrench[opposite, 4] -= uy
        wrench[opposite, 5] -= uz
    return span


@njit(cache=True, error_model='numpy', inline='always')
def _straight(spans: SpanTable, place: Array, length: Array, wrench: Array) -> None:
    """Fill in the muscles that run straight from point to point."""
    start, ends, entry, fixed = spans.start, spans.point, spans.entry, spans.fixed_length
    for m in range(length.size):
        whole = fixed[m]
        for s in range(start[m], start[m + 1]):
            whole += _add_span(place, ends[s, 0], ends[s, 1], wrench, entry[s, 0], entry[s, 1])
        length[m] = whole


@njit(cache=True, error_model='numpy', inline='always')
def _routed(
    table: PathTable,
    place: Array,
    frame: Array,
    rotation: Array,
    coordinate: Array,
    coordinate_gain: Array,
    length: Array,
    wrench: Array,
    moment_arm: Array,
) -> None:
    """Fill in the muscles whose path has to be found."""
    routed, point_start, point_body = table.routed, table.point_start, table.point_body
    condition, watched = table.point_condition, table.condition_coordinate
    limits, motion = table.condition_range, table.point_motion
    body_start, body_index = table.body_start, table.body_index
    wraps = table.wraps
    kind, size, axis, sign = wraps.kind, wraps.dimensions, wraps.axis, wraps.sign
    start, surface, method = wraps.start, wraps.surface, wraps.method
    first_of, last_of, surface_body = wraps.first, wraps.last, wraps.body
    geodesic = wraps.geodesic[0]
    moving = table.motion_coordinate.size > 0
    longest = table.longest[0]
    point, owner, arc = np.empty((longest, 3)), np.empty(longest, np.int64), np.zeros(longest)
    bodies = np.empty(longest, np.int64)
    order, contacts = np.empty(surface.size, np.int64), np.empty(surface.size, np.int64)
    entry_of = np.empty(rotation.shape[0], np.int64)
    for r in range(routed.size):
        m = routed[r]
        first, n = point_start[m], 0
        for p in range(first, point_start[m + 1]):
            c = condition[p]
            if c >= 0 and not limits[c, 0] <= coordinate[watched[c]] <= limits[c, 1]:
                continue
            point[n, 0], point[n, 1], point[n, 2] = place[p, 0], place[p, 1], place[p, 2]
            owner[n] = p - first
            n += 1
        n_wraps = start[m + 1] - start[m]
        if n_wraps > 0:
            n, length[m] = wrap_path(
                kind, size, axis, sign, surface, method, first_of, last_of, start[m], n_wraps,
                geodesic or n_wraps > 1, frame, order, contacts, point, owner, arc, n,
            )
        else:
            length[m] = path_length(point, owner, arc, n)
        for k in range(body_start[m], body_start[m + 1]):
            entry_of[body_index[k]] = k
        for k in range(n):
            if owner[k] >= 0:
                bodies[k] = point_body[first + owner[k]]
            else:
                bodies[k] = surface_body[surface[-1 - owner[k]]]
        for k in range(n - 1):
            if bodies[k] != bodies[k + 1]:
                _add_span(point, k, k + 1, wrench, entry_of[bodies[k]], entry_of[bodies[k + 1]])
        if moving:
            for k in range(n):
                if owner[k] >= 0 and motion[first + owner[k]] >= 0:
                    number, pull = motion[first + owner[k]], _pull(point, n, k)
                    _add_motion(
                        table, number, rotation, bodies[k], pull, coordinate, coordinate_gain,
                        moment_arm, m,
                    )


@njit(cache=True, error_model='numpy')
def _pull(point: Array, n: int, k: int) -> Vector:
    """Give the force on point k of a path of n points per unit of tension."""
    x, y, z = 0.0, 0.0, 0.0
    for other in (k - 1, k + 1):
        if 0 <= other < n:
            span = gap(point, k, other)
            if span > 0.0:
                x += (point[other, 0] - point[k, 0]) / span
                y += (point[other, 1] - point[k, 1]) / span
                z += (point[other, 2] - point[k, 2]) / span
    return x, y, z


@njit(cache=True, error_model='numpy', inline='always')
def _add_moment_arms(
    products: ProductTable,
    crossed_start: IntArray,
    crossed: IntArray,
    wrench: Array,
    jacobian: Array,
    moment_arm: Array,
) -> None:
    """Add to the moment arms what the wrenches do per rate of the coordinates."""
    of, about = products.column_body, products.column_coordinate
    column = np.empty((of.size, 6))
    for c in range(of.size):
        for i in range(6):
            column[c, i] = jacobian[of[c], i, about[c]]
    start, entry, number = products.start, products.entry, products.column
    for m in range(moment_arm.shape[0]):
        for k in range(crossed_start[m], crossed_start[m + 1]):
            arm = 0.0
            for t in range(start[k], start[k + 1]):
                e, c = entry[t], number[t]
                arm += (
                    (wrench[e, 0] * column[c, 0] + wrench[e, 1] * column[c, 1])
                    + (wrench[e, 2] * column[c, 2] + wrench[e, 3] * column[c, 3])
                    + (wrench[e, 4] * column[c, 4] + wrench[e, 5] * column[c, 5])
                )
            moment_arm[m, crossed[k]] += arm


@njit(cache=True, error_model='numpy')
def _paths(
    table: PathTable,
    position: Array,
    rotation: Array,
    jacobian: Array,
    coordinate: Array,
    coordinate_gain: Array,
) -> MusclePaths:
    n_m = table.point_start.size - 1
    length = np.empty(n_m)
    moment_arm = np.zeros((n_m, jacobian.shape[2]))
    wrench = np.zeros((table.body_index.size, 6))
    place = _place_points(table, position, rotation, coordinate)
    _straight(table.spans, place, length, wrench)
    if table.routed.size > 0:
        frame = place_surfaces(table.wraps, position, rotation)
        _routed(
            table, place, frame, rotation, coordinate, coordinate_gain, length, wrench, moment_arm
        )
    _add_moment_arms(
        table.products, table.crossed_start, table.crossed_index, wrench, jacobian, moment_arm
    )
    return MusclePaths(length, moment_arm, wrench)


@njit(cache=True, error_model='numpy')
def muscle_paths(
    table: PathTable, body_position: Array, body_rotation: Array, jacobian: Array
) -> MusclePaths:
    """
    Compute all paths of a model whose path points are all fixed.

    Parameters
    ----------
    table
        Paths of the model.
    body_position, body_rotation
        Origins (n_b, 3) [m] and axes (n_b, 3, 3) of the bodies, ground from body.
    jacobian
        Spatial Jacobians (n_b, 6, n_q) about the ground's origin, (angular, linear).

    Raises
    ------
    ValueError
        If a path point is conditional or moving: where it is depends on the coordinates, which
        `posture_paths` knows.
    """
    if table.condition_coordinate.size > 0 or table.motion_coordinate.size > 0:
        raise ValueError('conditional or moving path points need the coordinates: posture_paths')
    none = np.zeros(0)
    return _paths(table, body_position, body_rotation, jacobian, none, none)


@njit(cache=True, error_model='numpy')
def posture_paths(table: PathTable, state: BodyState, jacobian: Array) -> MusclePaths:
    """
    Compute all paths.

    Parameters
    ----------
    table
        Paths of the model.
    state
        Motion of the bodies with the coordinates that it is for (`forward_kinematics`).
    jacobian
        Spatial Jacobians (n_b, 6, n_q) about the ground's origin, (angular, linear).
    """
    return _paths(
        table, state.position, state.rotation, jacobian, state.coordinate, state.coordinate_gain
    )


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
