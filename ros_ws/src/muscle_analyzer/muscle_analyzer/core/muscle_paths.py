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

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core.functions import evaluate
from muscle_analyzer.core.kinematics import BodyState
from muscle_analyzer.core.muscle_path_table import PathTable
from muscle_analyzer.core.path_wrapping import (
    gap,
    new_scratch,
    out_of,
    path_length,
    wrap_path,
)

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


@njit(cache=True, error_model='numpy')
def _active_points(
    table: PathTable,
    muscle: int,
    body_position: Array,
    body_rotation: Array,
    coordinate: Array,
    point: Array,
    owner: NDArray[np.int64],
) -> int:
    """Put the points of a path that are there where they are; returns their number."""
    begin = table.point_start[muscle]
    moved = np.empty((1, 3))
    n = 0
    for p in range(begin, table.point_start[muscle + 1]):
        body = table.point_body[p]
        if table.point_condition[p] >= 0:
            c = table.point_condition[p]
            value = coordinate[table.condition_coordinate[c]]
            if not table.condition_range[c, 0] <= value <= table.condition_range[c, 1]:
                continue
        if table.point_motion[p] >= 0:
            d = table.point_motion[p]
            for i in range(3):
                value = coordinate[table.motion_coordinate[d, i]]
                moved[0, i] = evaluate(table.functions, table.motion_function[d, i], value)[0]
            out_of(body_rotation, body_position, body, moved, 0, point, n)
        else:
            out_of(body_rotation, body_position, body, table.point_location, p, point, n)
        owner[n] = p - begin
        n += 1
    return n


@njit(cache=True, error_model='numpy')
def _add_motion(
    table: PathTable,
    motion: int,
    rotation: Array,
    pull: Array,
    coordinate: Array,
    coordinate_gain: Array,
    moment_arm: Array,
) -> None:
    """Add to a muscle's moment arms (n_q,) what it pulls a point along its way in its body."""
    for i in range(3):
        q = table.motion_independent[motion, i]
        if q < 0:
            continue
        x = table.motion_coordinate[motion, i]
        slope = evaluate(table.functions, table.motion_function[motion, i], coordinate[x])[1]
        along = 0.0
        for j in range(3):
            along += pull[j] * rotation[j, i]
        moment_arm[q] += along * slope * coordinate_gain[x]


@njit(cache=True, error_model='numpy')
def _body(point_body: IntArray, wrap_body: IntArray, first: int, owner: int) -> int:
    """Give the body that carries a point of a path whose first point is number `first`."""
    if owner < 0:
        return int(wrap_body[-1 - owner])
    return int(point_body[first + owner])


@njit(cache=True, error_model='numpy')
def _paths(
    table: PathTable,
    body_position: Array,
    body_rotation: Array,
    jacobian: Array,
    coordinate: Array,
    coordinate_gain: Array,
) -> MusclePaths:
    n_m = table.point_start.size - 1
    size = table.longest[0]
    point, owner, arc = np.empty((size, 3)), np.empty(size, np.int64), np.zeros(size)
    entry_of = np.empty(body_position.shape[0], np.int64)
    length = np.empty(n_m)
    moment_arm = np.zeros((n_m, jacobian.shape[2]))
    wrench = np.zeros((table.body_index.size, 6))
    pull = np.empty(3)
    scratch = new_scratch(table.wraps.kind.size)
    special = table.condition_coordinate.size + table.motion_coordinate.size > 0
    for m in range(n_m):
        n = table.point_start[m + 1] - table.point_start[m]
        if special:
            n = _active_points(table, m, body_position, body_rotation, coordinate, point, owner)
        else:
            for k in range(n):
                p = table.point_start[m] + k
                body = table.point_body[p]
                out_of(body_rotation, body_position, body, table.point_location, p, point, k)
                owner[k] = k
        if table.wraps.start[m + 1] > table.wraps.start[m]:
            n, length[m] = wrap_path(
                table.wraps, m, body_rotation, body_position, point, owner, arc, n, scratch
            )
        else:
            length[m] = path_length(point, owner, arc, n)

        first = table.point_start[m]
        for k in range(table.body_start[m], table.body_start[m + 1]):
            entry_of[table.body_index[k]] = k
        for k in range(n - 1):
            body_1 = _body(table.point_body, table.wraps.body, first, owner[k])
            body_2 = _body(table.point_body, table.wraps.body, first, owner[k + 1])
            if body_1 == body_2:
                continue
            span = gap(point, k, k + 1)
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
        if table.motion_coordinate.size > 0:
            for k in range(n):
                p = table.point_start[m] + owner[k]
                if owner[k] < 0 or table.point_motion[p] < 0:
                    continue
                for i in range(3):
                    pull[i] = 0.0
                for other in (k - 1, k + 1):
                    if 0 <= other < n:
                        span = gap(point, k, other)
                        if span > 0.0:
                            for i in range(3):
                                pull[i] += (point[other, i] - point[k, i]) / span
                rotation = body_rotation[table.point_body[p]]
                motion = table.point_motion[p]
                _add_motion(
                    table, motion, rotation, pull, coordinate, coordinate_gain, moment_arm[m]
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
