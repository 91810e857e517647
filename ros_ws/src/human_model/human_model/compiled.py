# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled kinematics and inverse dynamics of a `TreeArrays`, for code that runs at 100 Hz.

All functions are numba functions and can be called from other packages' numba code. World axes
are REP-103; bodies and segments are defined in `tree`. The algorithm is recursive Newton-Euler;
`recursive` holds the thesis' Lagrangian recursion over the Denavit-Hartenberg rows, and the tests
hold both to the same numbers.
"""

import numba
import numpy as np
import numpy.typing as npt

from human_model.tree import TreeArrays

Array = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Standard gravity [m/s^2] (CGPM 1901).
GRAVITY = 9.80665


@numba.njit(cache=True)
def _cross(a: Array, b: Array) -> Array:
    out = np.empty(3)
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
    return out


@numba.njit(cache=True)
def _turn(matrix: Array, vector: Array) -> Array:
    out = np.empty(3)
    for i in range(3):
        out[i] = (matrix[i, 0] * vector[0] + matrix[i, 1] * vector[1]
                  + matrix[i, 2] * vector[2])
    return out


@numba.njit(cache=True)
def body_frames(tree: TreeArrays, q: Array) -> tuple[Array, Array, Array]:
    """World rotation (n_q, 3, 3), origin (n_q, 3) [m] and joint axis (n_q, 3) of all bodies."""
    n = q.shape[0]
    rotation = np.empty((n, 3, 3))
    origin = np.empty((n, 3))
    axis = np.empty((n, 3))
    for j in range(n):
        p = tree.parent[j]
        local = tree.offset[j].copy()
        if tree.kind[j] == 1:
            local += tree.axis[j] * q[j]
        if p < 0:
            base = np.eye(3)
            origin[j] = local
        else:
            base = rotation[p]
            origin[j] = origin[p] + _turn(base, local)
        axis[j] = _turn(base, tree.axis[j])
        if tree.kind[j] == 1:
            rotation[j] = base
            continue
        a = tree.axis[j]
        c, s = np.cos(q[j]), np.sin(q[j])
        own = np.empty((3, 3))
        for r in range(3):
            for k in range(3):
                own[r, k] = (1.0 - c) * a[r] * a[k]
            own[r, r] += c
        own[0, 1] -= s * a[2]
        own[0, 2] += s * a[1]
        own[1, 0] += s * a[2]
        own[1, 2] -= s * a[0]
        own[2, 0] -= s * a[1]
        own[2, 1] += s * a[0]
        for r in range(3):
            for k in range(3):
                rotation[j, r, k] = (base[r, 0] * own[0, k] + base[r, 1] * own[1, k]
                                     + base[r, 2] * own[2, k])
    return rotation, origin, axis


@numba.njit(cache=True)
def segment_frames(tree: TreeArrays, q: Array) -> tuple[Array, Array]:
    """World rotation (n_s, 3, 3) and origin (n_s, 3) [m] of all segments."""
    rotation, origin, _ = body_frames(tree, q)
    n = tree.segment_body.shape[0]
    segment_rotation = np.empty((n, 3, 3))
    segment_origin = np.empty((n, 3))
    for s in range(n):
        b = tree.segment_body[s]
        segment_rotation[s] = rotation[b]
        segment_origin[s] = origin[b] + _turn(rotation[b], tree.segment_offset[s])
    return segment_rotation, segment_origin


@numba.njit(cache=True)
def point_positions(tree: TreeArrays, q: Array, segment: IntArray, local: Array) -> Array:
    """World positions (n, 3) [m] of points fixed to segments (n,) at local positions (n, 3)."""
    rotation, origin = segment_frames(tree, q)
    out = np.empty((segment.shape[0], 3))
    for i in range(segment.shape[0]):
        s = segment[i]
        out[i] = origin[s] + _turn(rotation[s], local[i])
    return out


@numba.njit(cache=True)
def points_and_jacobian(tree: TreeArrays, q: Array, segment: IntArray, local: Array,
                        ) -> tuple[Array, Array]:
    """World positions (n, 3) [m] of points and their Jacobian (n, 3, n_q) [m/rad or 1]."""
    rotation, origin, axis = body_frames(tree, q)
    n, n_q = segment.shape[0], q.shape[0]
    position = np.empty((n, 3))
    jacobian = np.zeros((n, 3, n_q))
    for i in range(n):
        b = tree.segment_body[segment[i]]
        position[i] = origin[b] + _turn(rotation[b], tree.segment_offset[segment[i]] + local[i])
        j = b
        while j >= 0:
            if tree.kind[j] == 1:
                jacobian[i, :, j] = axis[j]
            else:
                jacobian[i, :, j] = _cross(axis[j], position[i] - origin[j])
            j = tree.parent[j]
    return position, jacobian


@numba.njit(cache=True)
def body_motion(tree: TreeArrays, q: Array, qd: Array, qdd: Array,
                ) -> tuple[Array, Array, Array, Array, Array, Array, Array]:
    """Frames and their rates, all (n_q, ...) in world axes.

    Returns rotation, origin, axis, angular velocity, angular acceleration, and the origins'
    velocity and acceleration, gravity not included.
    """
    rotation, origin, axis = body_frames(tree, q)
    n = q.shape[0]
    omega, alpha = np.zeros((n, 3)), np.zeros((n, 3))
    velocity, acceleration = np.zeros((n, 3)), np.zeros((n, 3))
    for j in range(n):
        p = tree.parent[j]
        if p >= 0:
            arm = origin[j] - origin[p]
            turning = _cross(omega[p], arm)
            omega[j] = omega[p]
            alpha[j] = alpha[p]
            velocity[j] = velocity[p] + turning
            acceleration[j] = acceleration[p] + _cross(alpha[p], arm) + _cross(omega[p], turning)
        if tree.kind[j] == 1:
            velocity[j] += axis[j] * qd[j]
            acceleration[j] += axis[j] * qdd[j] + 2.0 * _cross(omega[j], axis[j]) * qd[j]
        else:
            alpha[j] += axis[j] * qdd[j] + _cross(omega[j], axis[j]) * qd[j]
            omega[j] += axis[j] * qd[j]
    return rotation, origin, axis, omega, alpha, velocity, acceleration


@numba.njit(cache=True)
def newton_euler(
        tree: TreeArrays, q: Array, qd: Array, qdd: Array, wrench: Array, gravity: float,
) -> Array:
    """Generalised forces (n_q,) [N m or N] by recursive Newton-Euler.

    ``wrench`` (n_s, 6): external force [N] and its moment about the *world origin* [N m] on each
    segment, world axes, gravity not included. ``gravity``: m/s^2, acts along -z.
    """
    rotation, origin, axis, omega, alpha, _, acceleration = body_motion(tree, q, qd, qdd)
    n = q.shape[0]
    force, moment = np.zeros((n, 3)), np.zeros((n, 3))
    for s in range(tree.segment_body.shape[0]):
        b = tree.segment_body[s]
        arm = _turn(rotation[b], tree.segment_offset[s] + tree.com[s])
        a = (acceleration[b] + _cross(alpha[b], arm)
             + _cross(omega[b], _cross(omega[b], arm)))
        a[2] += gravity
        inertia = rotation[b] @ tree.inertia[s] @ rotation[b].T
        external = wrench[s, :3]
        f = tree.mass[s] * a - external
        force[b] += f
        moment[b] += (_turn(inertia, alpha[b]) + _cross(omega[b], _turn(inertia, omega[b]))
                      + _cross(arm, tree.mass[s] * a)
                      - (wrench[s, 3:] - _cross(origin[b], external)))
    tau = np.empty(n)
    for j in range(n - 1, -1, -1):
        if tree.kind[j] == 1:
            tau[j] = axis[j, 0] * force[j, 0] + axis[j, 1] * force[j, 1] + axis[j, 2] * force[j, 2]
        else:
            tau[j] = (axis[j, 0] * moment[j, 0] + axis[j, 1] * moment[j, 1]
                      + axis[j, 2] * moment[j, 2])
        p = tree.parent[j]
        if p >= 0:
            force[p] += force[j]
            moment[p] += moment[j] + _cross(origin[j] - origin[p], force[j])
    return tau
