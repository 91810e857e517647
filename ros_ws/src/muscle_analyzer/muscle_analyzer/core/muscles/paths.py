# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lengths, moment arms and forces on the bodies of all muscles at one posture, compiled.

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

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array, IntArray
from muscle_analyzer.core.multibody.kinematics import BodyState
from muscle_analyzer.core.muscles.path_routing import Route, add_span, allocate_route, find_routes
from muscle_analyzer.core.muscles.path_table import PathTable, ProductTable, SpanTable
from muscle_analyzer.core.muscles.path_wrapping import place_surfaces
from muscle_analyzer.core.osim.functions import evaluate


class MusclePaths(NamedTuple):
    """Paths of all muscles at one posture.

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


class CrossedPaths(NamedTuple):
    """The same with the moment arms of those coordinates alone that can change a muscle's length.

    Attributes
    ----------
    length, wrench
        See `MusclePaths`.
    arm : (n_k,)
        Moment arms in the order of ``table.crossed_index`` [m / rad or m / m].
    """

    length: Array
    arm: Array
    wrench: Array


class PathWorkspace(NamedTuple):
    """Intermediate results of `compute_muscle_paths`.

    Attributes
    ----------
    column : (n_j, 6)
        Columns of the Jacobians that are used; to be filled before.
    place : (n_p, 3)
        Path points in ground axes [m].
    frame : (n_o, 12)
        Of the wrap objects, see `place_surfaces`.
    route : Route
    """

    column: Array
    place: Array
    frame: Array
    route: Route


@njit
def allocate_paths(table: PathTable, n_b: int) -> tuple[PathWorkspace, CrossedPaths]:
    """Return workspace and result of `compute_muscle_paths`, for a model of n_b bodies."""
    n_m, wraps = table.point_start.size - 1, table.wraps
    workspace = PathWorkspace(
        np.empty((table.products.column_body.size, 6)),
        np.empty(table.point_location.shape),
        np.empty((wraps.body.size, 12)),
        allocate_route(table.longest[0], wraps.surface.size, n_b),
    )
    n_e, n_k = table.body_index.size, table.crossed_index.size
    return workspace, CrossedPaths(np.empty(n_m), np.empty(n_k), np.empty((n_e, 6)))


@kernel
def _place_points(
    table: PathTable, position: Array, rotation: Array, coordinate: Array, place: Array
) -> None:
    """Fill the places (n_p, 3) of all path points in ground axes."""
    bodies, location, motion = table.point_body, table.point_location, table.point_motion
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


@njit(error_model='numpy', inline='always')
def _moved(table: PathTable, motion: int, i: int, coordinate: Array) -> float:
    """Return one coordinate of a moving point in its body [m]."""
    x = coordinate[table.motion_coordinate[motion, i]]
    return float(evaluate(table.functions, table.motion_function[motion, i], x)[0])


@kernel
def _straight(spans: SpanTable, place: Array, length: Array, wrench: Array) -> None:
    """Fill in the muscles that run straight from point to point."""
    start, ends, entry, fixed = spans.start, spans.point, spans.entry, spans.fixed_length
    for m in range(length.size):
        whole = fixed[m]
        for s in range(start[m], start[m + 1]):
            whole += add_span(place, ends[s, 0], ends[s, 1], wrench, entry[s, 0], entry[s, 1])
        length[m] = whole


@kernel
def _columns_of_jacobians(products: ProductTable, jacobian: Array, column: Array) -> None:
    """Copy the columns (n_j, 6) of the Jacobians that are used close to each other."""
    of, about = products.column_body, products.column_coordinate
    for c in range(of.size):
        for i in range(6):
            column[c, i] = jacobian[of[c], i, about[c]]


@kernel
def _columns_of_motions(products: ProductTable, screw: Array, gain: Array, column: Array) -> None:
    """Make these columns of the elementary motions, without the Jacobians."""
    start, motion = products.motion_start, products.motion
    for c in range(column.shape[0]):
        for i in range(6):
            total = 0.0
            for k in range(start[c], start[c + 1]):
                total += screw[motion[k], i] * gain[motion[k]]
            column[c, i] = total


@kernel
def _add_moment_arms(products: ProductTable, column: Array, wrench: Array, arm: Array) -> None:
    """Add to the moment arms (n_k,) what the wrenches do per rate of the coordinates."""
    start, entry, number = products.start, products.entry, products.column
    for k in range(arm.size):
        along = 0.0
        for t in range(start[k], start[k + 1]):
            e, c = entry[t], number[t]
            along += (
                (wrench[e, 0] * column[c, 0] + wrench[e, 1] * column[c, 1])
                + (wrench[e, 2] * column[c, 2] + wrench[e, 3] * column[c, 3])
                + (wrench[e, 4] * column[c, 4] + wrench[e, 5] * column[c, 5])
            )
        arm[k] += along


@kernel
def _paths(
    table: PathTable,
    position: Array,
    rotation: Array,
    coordinate: Array,
    coordinate_gain: Array,
    workspace: PathWorkspace,
    out: CrossedPaths,
) -> None:
    """Find all paths; the columns are there."""
    length, arm, wrench = out
    arm.fill(0.0)
    wrench.fill(0.0)
    _place_points(table, position, rotation, coordinate, workspace.place)
    _straight(table.spans, workspace.place, length, wrench)
    if table.routed.size > 0:
        place_surfaces(table.wraps, position, rotation, workspace.frame)
        find_routes(
            table, workspace.route, workspace.place, workspace.frame, rotation, coordinate,
            coordinate_gain, length, wrench, arm,
        )  # fmt: skip
    _add_moment_arms(table.products, workspace.column, wrench, arm)


@njit(error_model='numpy')
def _with_all_arms(table: PathTable, found: CrossedPaths, n_q: int) -> MusclePaths:
    """Put the moment arms where they belong among those of all coordinates."""
    moment_arm = np.zeros((found.length.size, n_q))
    for m in range(found.length.size):
        for k in range(table.crossed_start[m], table.crossed_start[m + 1]):
            moment_arm[m, table.crossed_index[k]] = found.arm[k]
    return MusclePaths(found.length, moment_arm, found.wrench)


@njit(error_model='numpy')
def muscle_paths(
    table: PathTable, body_position: Array, body_rotation: Array, jacobian: Array
) -> MusclePaths:
    """Compute all paths of a model whose path points are all fixed.

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
    workspace, found = allocate_paths(table, jacobian.shape[0])
    _columns_of_jacobians(table.products, jacobian, workspace.column)
    _paths(table, body_position, body_rotation, none, none, workspace, found)
    return _with_all_arms(table, found, jacobian.shape[2])


@njit(error_model='numpy')
def posture_paths(table: PathTable, state: BodyState, jacobian: Array) -> MusclePaths:
    """Compute all paths.

    Parameters
    ----------
    table
        Paths of the model.
    state
        Motion of the bodies with the coordinates that it is for (`forward_kinematics`).
    jacobian
        Spatial Jacobians (n_b, 6, n_q) about the ground's origin, (angular, linear).
    """
    workspace, found = allocate_paths(table, jacobian.shape[0])
    _columns_of_jacobians(table.products, jacobian, workspace.column)
    _paths(
        table,
        state.position,
        state.rotation,
        state.coordinate,
        state.coordinate_gain,
        workspace,
        found,
    )
    return _with_all_arms(table, found, jacobian.shape[2])


@njit(error_model='numpy')
def crossed_paths(table: PathTable, state: BodyState) -> CrossedPaths:
    """Compute all paths as `posture_paths`, but without Jacobians and the zeros among the arms."""
    workspace, found = allocate_paths(table, state.position.shape[0])
    compute_muscle_paths(table, state, workspace, found)
    return found


@kernel
def compute_muscle_paths(
    table: PathTable, state: BodyState, workspace: PathWorkspace, out: CrossedPaths
) -> None:
    """Fill what `crossed_paths` gives; `workspace` and `out` are those of `allocate_paths`."""
    _columns_of_motions(table.products, state.screw, state.gain, workspace.column)
    _paths(
        table,
        state.position,
        state.rotation,
        state.coordinate,
        state.coordinate_gain,
        workspace,
        out,
    )


@njit(error_model='numpy')
def body_wrenches(table: PathTable, wrench: Array, force: Array, n_bodies: int) -> Array:
    """Return the sum of the wrenches of muscles of given forces on the bodies.

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
    total = np.empty((n_bodies, 6))
    apply_muscle_forces(table.body_start, table.body_index, wrench, force, total)
    return total


@kernel
def apply_muscle_forces(
    start: IntArray, body: IntArray, wrench: Array, force: Array, total: Array
) -> None:
    """Fill the sums (n_b, 6) of `body_wrenches`."""
    total.fill(0.0)
    for m in range(force.size):
        for k in range(start[m], start[m + 1]):
            for i in range(6):
                total[body[k], i] += force[m] * wrench[k, i]
