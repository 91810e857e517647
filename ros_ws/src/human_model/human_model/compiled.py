# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled kinematics and inverse dynamics of a `TreeArrays`, for code that runs at 100 Hz.

All functions are numba functions and can be called from other packages' numba code. World axes
are REP-103; bodies and segments are defined in `tree`. The algorithm is recursive Newton-Euler;
the tests compare it with the Lagrangian recursion of the thesis over the Denavit-Hartenberg rows.
The small functions add into their first argument, so the loops over bodies allocate nothing.
"""

import numpy as np

from human_model.compiled_cache import njit
from human_model.tree import TreeArrays
from human_model.typing import Array, IntArray

_PRISMATIC = 1


@njit
def _dot(a: Array, b: Array) -> float:
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@njit
def _add(out: Array, a: Array, factor: float) -> None:
    for i in range(3):
        out[i] += factor * a[i]


@njit
def _add_cross(out: Array, a: Array, b: Array, factor: float) -> None:
    out[0] += factor * (a[1] * b[2] - a[2] * b[1])
    out[1] += factor * (a[2] * b[0] - a[0] * b[2])
    out[2] += factor * (a[0] * b[1] - a[1] * b[0])


@njit
def _add_turned(out: Array, matrix: Array, vector: Array) -> None:
    for i in range(3):
        out[i] += matrix[i, 0] * vector[0] + matrix[i, 1] * vector[1] + matrix[i, 2] * vector[2]


@njit
def _add_turned_back(out: Array, matrix: Array, vector: Array) -> None:
    for i in range(3):
        out[i] += matrix[0, i] * vector[0] + matrix[1, i] * vector[1] + matrix[2, i] * vector[2]


@njit
def _turn_about(out: Array, base: Array, a: Array, angle: float) -> None:
    """Write ``base exp(a angle)`` into out (Rodrigues), column by column."""
    c, s = np.cos(angle), np.sin(angle)
    t = 1.0 - c
    for i in range(3):
        x, y, z = base[i, 0], base[i, 1], base[i, 2]
        along = t * (x * a[0] + y * a[1] + z * a[2])
        out[i, 0] = c * x + along * a[0] + s * (y * a[2] - z * a[1])
        out[i, 1] = c * y + along * a[1] + s * (z * a[0] - x * a[2])
        out[i, 2] = c * z + along * a[2] + s * (x * a[1] - y * a[0])


@njit
def body_frames(tree: TreeArrays, q: Array) -> tuple[Array, Array, Array]:
    """World rotation (n_q, 3, 3), origin (n_q, 3) [m] and joint axis (n_q, 3) of all bodies."""
    n = q.shape[0]
    rotation = np.empty((n, 3, 3))
    origin = np.zeros((n, 3))
    axis = np.zeros((n, 3))
    world = np.eye(3)
    for j in range(n):
        p = tree.parent[j]
        base = world if p < 0 else rotation[p]
        if p >= 0:
            _add(origin[j], origin[p], 1.0)
        _add_turned(origin[j], base, tree.offset[j])
        _add_turned(axis[j], base, tree.axis[j])
        if tree.kind[j] == _PRISMATIC:
            _add(origin[j], axis[j], q[j])
            _turn_about(rotation[j], base, tree.axis[j], 0.0)
        else:
            _turn_about(rotation[j], base, tree.axis[j], q[j])
    return rotation, origin, axis


@njit
def segment_frames(tree: TreeArrays, q: Array) -> tuple[Array, Array]:
    """World rotation (n_s, 3, 3) and origin (n_s, 3) [m] of all segments."""
    rotation, origin, _ = body_frames(tree, q)
    n = tree.segment_body.shape[0]
    segment_rotation = np.empty((n, 3, 3))
    segment_origin = np.empty((n, 3))
    for s in range(n):
        b = tree.segment_body[s]
        segment_rotation[s] = rotation[b]
        segment_origin[s] = origin[b]
        _add_turned(segment_origin[s], rotation[b], tree.segment_offset[s])
    return segment_rotation, segment_origin


@njit
def point_positions(tree: TreeArrays, q: Array, segment: IntArray, local: Array) -> Array:
    """World positions (n, 3) [m] of points fixed to segments (n,) at local positions (n, 3)."""
    rotation, origin = segment_frames(tree, q)
    position = np.empty((segment.shape[0], 3))
    for i in range(segment.shape[0]):
        position[i] = origin[segment[i]]
        _add_turned(position[i], rotation[segment[i]], local[i])
    return position


@njit
def points_and_jacobian(
    tree: TreeArrays, q: Array, segment: IntArray, local: Array
) -> tuple[Array, Array]:
    """World positions (n, 3) [m] of points and their Jacobian (n, 3, n_q) [m/rad or 1]."""
    rotation, origin, axis = body_frames(tree, q)
    n = segment.shape[0]
    position = np.empty((n, 3))
    jacobian = np.zeros((n, 3, q.shape[0]))
    for i in range(n):
        j = tree.segment_body[segment[i]]
        position[i] = origin[j]
        _add_turned(position[i], rotation[j], tree.segment_offset[segment[i]])
        _add_turned(position[i], rotation[j], local[i])
        while j >= 0:
            if tree.kind[j] == _PRISMATIC:
                jacobian[i, :, j] = axis[j]
            else:
                _add_cross(jacobian[i, :, j], axis[j], position[i], 1.0)
                _add_cross(jacobian[i, :, j], axis[j], origin[j], -1.0)
            j = tree.parent[j]
    return position, jacobian


@njit
def body_motion(
    tree: TreeArrays, q: Array, qd: Array, qdd: Array
) -> tuple[Array, Array, Array, Array, Array, Array, Array]:
    """Frames and their rates, all (n_q, ...) in world axes.

    Returns rotation, origin, axis, angular velocity, angular acceleration, and the origins'
    velocity and acceleration, gravity not included.
    """
    rotation, origin, axis = body_frames(tree, q)
    n = q.shape[0]
    omega, alpha = np.zeros((n, 3)), np.zeros((n, 3))
    velocity, acceleration = np.zeros((n, 3)), np.zeros((n, 3))
    arm, turning = np.empty(3), np.empty(3)
    for j in range(n):
        p = tree.parent[j]
        if p >= 0:
            for i in range(3):
                arm[i] = origin[j, i] - origin[p, i]
                turning[i] = 0.0
            _add_cross(turning, omega[p], arm, 1.0)
            _add(omega[j], omega[p], 1.0)
            _add(alpha[j], alpha[p], 1.0)
            _add(velocity[j], velocity[p], 1.0)
            _add(velocity[j], turning, 1.0)
            _add(acceleration[j], acceleration[p], 1.0)
            _add_cross(acceleration[j], alpha[p], arm, 1.0)
            _add_cross(acceleration[j], omega[p], turning, 1.0)
        if tree.kind[j] == _PRISMATIC:
            _add(velocity[j], axis[j], qd[j])
            _add(acceleration[j], axis[j], qdd[j])
            _add_cross(acceleration[j], omega[j], axis[j], 2.0 * qd[j])
        else:
            _add(alpha[j], axis[j], qdd[j])
            _add_cross(alpha[j], omega[j], axis[j], qd[j])
            _add(omega[j], axis[j], qd[j])
    return rotation, origin, axis, omega, alpha, velocity, acceleration


@njit
def newton_euler(
    tree: TreeArrays, q: Array, qd: Array, qdd: Array, wrench: Array, gravity: float
) -> Array:
    """Generalised forces (n_q,) [N m or N] by recursive Newton-Euler.

    ``wrench`` (n_s, 6): external force [N] and its moment about the *world origin* [N m] on each
    segment, world axes, gravity not included. ``gravity``: m/s^2, acts along -z.
    """
    rotation, origin, axis, omega, alpha, _, acceleration = body_motion(tree, q, qd, qdd)
    n = q.shape[0]
    force, moment = np.zeros((n, 3)), np.zeros((n, 3))
    arm, turning, inertial = np.empty(3), np.empty(3), np.empty(3)
    local, spin = np.empty(3), np.empty(3)
    for s in range(tree.segment_body.shape[0]):
        b = tree.segment_body[s]
        arm[:] = 0.0
        _add_turned(arm, rotation[b], tree.segment_offset[s])
        _add_turned(arm, rotation[b], tree.com[s])
        turning[:] = 0.0
        _add_cross(turning, omega[b], arm, 1.0)
        inertial[:] = acceleration[b]
        inertial[2] += gravity
        _add_cross(inertial, alpha[b], arm, 1.0)
        _add_cross(inertial, omega[b], turning, 1.0)
        _add(force[b], inertial, tree.mass[s])
        _add(force[b], wrench[s, :3], -1.0)
        _add_cross(moment[b], arm, inertial, tree.mass[s])
        _add(moment[b], wrench[s, 3:], -1.0)
        _add_cross(moment[b], origin[b], wrench[s, :3], 1.0)
        # Rotation: R J R^T alpha + omega x (R J R^T omega), J in the segment's axes.
        local[:] = 0.0
        _add_turned_back(local, rotation[b], alpha[b])
        spin[:] = 0.0
        _add_turned(spin, tree.inertia[s], local)
        _add_turned(moment[b], rotation[b], spin)
        local[:] = 0.0
        _add_turned_back(local, rotation[b], omega[b])
        spin[:] = 0.0
        _add_turned(spin, tree.inertia[s], local)
        local[:] = 0.0
        _add_turned(local, rotation[b], spin)
        _add_cross(moment[b], omega[b], local, 1.0)
    tau = np.empty(n)
    for j in range(n - 1, -1, -1):
        tau[j] = _dot(axis[j], force[j] if tree.kind[j] == _PRISMATIC else moment[j])
        p = tree.parent[j]
        if p >= 0:
            for i in range(3):
                arm[i] = origin[j, i] - origin[p, i]
            _add(force[p], force[j], 1.0)
            _add(moment[p], moment[j], 1.0)
            _add_cross(moment[p], arm, force[j], 1.0)
    return tau
