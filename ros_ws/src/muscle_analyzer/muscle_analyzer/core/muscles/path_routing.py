# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Paths that have to be found at each posture: those that wrap and those whose points come and go.

See `paths` for what is done with them, and `path_wrapping` for the surfaces.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array, IntArray
from muscle_analyzer.core.muscles.cylinder_wrapping import Vector
from muscle_analyzer.core.muscles.path_table import PathTable
from muscle_analyzer.core.muscles.path_wrapping import gap, path_length, wrap_path
from muscle_analyzer.core.osim.functions import evaluate


class Route(NamedTuple):
    """Room for one path at a time.

    Attributes
    ----------
    point, owner, arc, body : (n, 3), (n,), (n,), (n,)
        Points in ground axes [m], whose they are (see `wrap_path`), lengths on the surface
        [m] from them on, and bodies that they belong to.
    order, contact : (n_w,)
        See `wrap_path`.
    entry : (n_b,)
        Place of each body in `PathTable.body_index`.
    """

    point: Array
    owner: IntArray
    arc: Array
    body: IntArray
    order: IntArray
    contact: IntArray
    entry: IntArray


@njit(error_model='numpy', inline='always')
def allocate_route(longest: int, n_w: int, n_b: int) -> Route:
    """Return the arrays of a route: at most `longest` points, `n_w` wraps, `n_b` bodies."""
    return Route(
        np.empty((longest, 3)),
        np.empty(longest, np.int64),
        np.zeros(longest),
        np.empty(longest, np.int64),
        np.empty(n_w, np.int64),
        np.empty(n_w, np.int64),
        np.empty(n_b, np.int64),
    )


@njit(error_model='numpy', inline='always')
def add_span(point: Array, k: int, other: int, wrench: Array, entry: int, opposite: int) -> float:
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


@njit(error_model='numpy', inline='always')
def _add_motion(
    table: PathTable,
    motion: int,
    rotation: Array,
    body: int,
    pull: Vector,
    coordinate: Array,
    coordinate_gain: Array,
    arm: Array,
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
        for k in range(table.crossed_start[m], table.crossed_start[m + 1]):
            if table.crossed_index[k] == q:
                arm[k] += along * slope * coordinate_gain[x]


@kernel
def _pull(point: Array, n: int, k: int) -> Vector:
    """Return the force on point k of a path of n points per unit of tension."""
    x, y, z = 0.0, 0.0, 0.0
    for other in (k - 1, k + 1):
        if 0 <= other < n:
            span = gap(point, k, other)
            if span > 0.0:
                x += (point[other, 0] - point[k, 0]) / span
                y += (point[other, 1] - point[k, 1]) / span
                z += (point[other, 2] - point[k, 2]) / span
    return x, y, z


@kernel
def find_routes(
    table: PathTable,
    route: Route,
    place: Array,
    frame: Array,
    rotation: Array,
    coordinate: Array,
    coordinate_gain: Array,
    length: Array,
    wrench: Array,
    arm: Array,
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
    point, owner, arc, bodies, order, contacts, entry_of = route
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
                kind,
                size,
                axis,
                sign,
                surface,
                method,
                first_of,
                last_of,
                start[m],
                n_wraps,
                geodesic or n_wraps > 1,
                frame,
                order,
                contacts,
                point,
                owner,
                arc,
                n,
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
                add_span(point, k, k + 1, wrench, entry_of[bodies[k]], entry_of[bodies[k + 1]])
        if moving:
            for k in range(n):
                if owner[k] >= 0 and motion[first + owner[k]] >= 0:
                    number, pull = motion[first + owner[k]], _pull(point, n, k)
                    _add_motion(
                        table,
                        number,
                        rotation,
                        bodies[k],
                        pull,
                        coordinate,
                        coordinate_gain,
                        arm,
                        m,
                    )
