# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Positions, velocities and accelerations of all bodies, and their Jacobians; compiled.

Forward recursion over the tree in ground axes (the thesis' equations 2.1 to 2.4 with the joints of
`.osim` files in place of Denavit-Hartenberg links). Jacobians are with respect to the
*independent* coordinates: a coupled coordinate's motion counts for the coordinate that drives it.

Spatial quantities are (angular, linear) and refer to the ground's origin: the Jacobian of a body
gives its angular velocity and the velocity of the body-fixed point that is at the ground's origin,
so that the velocity of a point at p is `v + w x p`, and the wrench of a force F at p is `(p x F,
F)`. With one reference point for all bodies, wrenches of different bodies add up without being
shifted.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array
from muscle_analyzer.core.multibody.model import Tree
from muscle_analyzer.core.osim.functions import evaluated


class CoordinateState(NamedTuple):
    """All tree coordinates x (n_x,) with time derivatives, and dx/dq of their own driver."""

    value: Array
    rate: Array
    acceleration: Array
    gain: Array


class BodyState(NamedTuple):
    """Motion of every body, ground axes.

    Attributes
    ----------
    position : (n_b, 3) array
        Origins of the bodies, m.
    rotation : (n_b, 3, 3) array
        Ground <- body.
    angular_velocity, velocity : (n_b, 3) arrays
        rad/s, and m/s of the origins.
    angular_acceleration, acceleration : (n_b, 3) arrays
        rad/s^2, and m/s^2 of the origins.
    joint_position : (n_b, 3) array
        Where the joint that carries the body is (its moved frame's origin), m.
    screw : (n_e, 6) array
        Spatial axis of each elementary motion about the ground's origin.
    tree_gain, gain : (n_e,) arrays
        Rate of each elementary motion per rate of its tree coordinate and of its independent one.
    coordinate, coordinate_gain : (n_x,) arrays
        All tree coordinates, rad or m, and their rates per rate of the independent one.
    """

    position: Array
    rotation: Array
    angular_velocity: Array
    velocity: Array
    angular_acceleration: Array
    acceleration: Array
    joint_position: Array
    screw: Array
    tree_gain: Array
    gain: Array
    coordinate: Array
    coordinate_gain: Array


class KinematicsWorkspace(NamedTuple):
    """Intermediate results of `compute_kinematics`.

    Attributes
    ----------
    coordinates : CoordinateState
        Its values and gains are those of the `BodyState` as well.
    move : (n_e, 3) array
        Angle or distance of each elementary motion with its time derivatives.
    frame : (3, 3) array
        Ground <- the frame that a joint has moved so far.
    shift : (3, 3) array
        Of that frame's origin from the parent's, with its time derivatives as rows.
    """

    coordinates: CoordinateState
    move: Array
    frame: Array
    shift: Array


@njit
def allocate_kinematics(tree: Tree) -> tuple[KinematicsWorkspace, BodyState]:
    """Return workspace and result of `compute_kinematics`, full of zeros."""
    n_b, n_e, n = tree.parent.size, tree.motion_turns.size, tree.independent.size
    x = CoordinateState(np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n))
    workspace = KinematicsWorkspace(x, np.zeros((n_e, 3)), np.zeros((3, 3)), np.zeros((3, 3)))
    state = BodyState(
        np.zeros((n_b, 3)), np.zeros((n_b, 3, 3)), np.zeros((n_b, 3)), np.zeros((n_b, 3)),
        np.zeros((n_b, 3)), np.zeros((n_b, 3)), np.zeros((n_b, 3)), np.zeros((n_e, 6)),
        np.zeros(n_e), np.zeros(n_e), x.value, x.gain,
    )  # fmt: skip
    return workspace, state


@njit(error_model='numpy')
def coordinate_state(tree: Tree, q: Array, qd: Array, qdd: Array) -> CoordinateState:
    """Return all tree coordinates and their derivatives from the independent ones.

    Parameters
    ----------
    tree : Tree
    q, qd, qdd : (n_q,) arrays
        Independent coordinates in rad or m, their rates and accelerations.
    """
    n = tree.independent.size
    x = CoordinateState(np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n))
    _move_coordinates(tree, q, qd, qdd, x)
    return x


@kernel
def _move_coordinates(tree: Tree, q: Array, qd: Array, qdd: Array, out: CoordinateState) -> None:
    """Fill a `coordinate_state`, zeros before."""
    value, rate, acceleration, gain = out
    # Plain arrays: passing a tuple of them to a function takes longer than the function.
    first, lower, anchor, coefficient = tree.functions
    independent, number = tree.independent, tree.coupling_function
    for i in range(independent.size):
        k = independent[i]
        x = q[k] if k >= 0 else 0.0
        f, f1, f2 = evaluated(first, lower, anchor, coefficient, number[i], x)
        value[i] = f
        if k >= 0:
            gain[i] = f1
            rate[i] = f1 * qd[k]
            acceleration[i] = f1 * qdd[k] + f2 * qd[k] * qd[k]


@njit(inline='always')
def cross3(
    ax: float, ay: float, az: float, bx: float, by: float, bz: float
) -> tuple[float, float, float]:
    """Return the cross product of two vectors, in scalars."""
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@kernel
def _turn_about(rotation: Array, x: float, y: float, z: float, angle: float) -> None:
    """Multiply a rotation matrix from the right by a turn about an axis of its own frame."""
    s = np.sin(angle)
    c = np.cos(angle)
    for i in range(3):
        a, b, d = rotation[i, 0], rotation[i, 1], rotation[i, 2]
        along = (a * x + b * y + d * z) * (1.0 - c)
        rotation[i, 0] = c * a + along * x + s * (b * z - d * y)
        rotation[i, 1] = c * b + along * y + s * (d * x - a * z)
        rotation[i, 2] = c * d + along * z + s * (a * y - b * x)


@kernel
def _moves(tree: Tree, x: CoordinateState, move: Array, tree_gain: Array, gain: Array) -> None:
    """Fill angle or distance of each motion with its time derivatives, and gains; zeros before."""
    first, lower, anchor, coefficient = tree.functions
    coordinate, number = tree.motion_coordinate, tree.motion_function
    value, rate, acceleration, x_gain = x
    for e in range(coordinate.size):
        k = coordinate[e]
        at = value[k] if k >= 0 else 0.0
        f, f1, f2 = evaluated(first, lower, anchor, coefficient, number[e], at)
        move[e, 0] = f
        if k >= 0:
            move[e, 1] = f1 * rate[k]
            move[e, 2] = f1 * acceleration[k] + f2 * rate[k] * rate[k]
            tree_gain[e] = f1
            gain[e] = f1 * x_gain[k]


@njit(error_model='numpy')
def forward_kinematics(tree: Tree, q: Array, qd: Array, qdd: Array) -> BodyState:
    """Return the motion of every body.

    Parameters
    ----------
    tree : Tree
    q, qd, qdd : (n_q,) arrays
        Independent coordinates in rad or m, their rates and accelerations.
    """
    workspace, state = allocate_kinematics(tree)
    compute_kinematics(tree, q, qd, qdd, workspace, state)
    return state


@kernel
def compute_kinematics(
    tree: Tree, q: Array, qd: Array, qdd: Array, workspace: KinematicsWorkspace, state: BodyState
) -> None:
    """Fill the motion of every body as `forward_kinematics` gives it.

    `workspace` and `state` are those of `allocate_kinematics`, or of an earlier state of the
    same tree.
    """
    parent, first_motion = tree.parent, tree.first_motion
    turns, axis = tree.motion_turns, tree.motion_axis
    parent_rotation, parent_translation = tree.parent_rotation, tree.parent_translation
    child_rotation, child_translation = tree.child_rotation, tree.child_translation
    p, rot, w, v, al, a, pivot, screw, tree_gain, gain = state[:10]
    move, frame = workspace.move, workspace.frame
    r, r1, r2 = workspace.shift[0], workspace.shift[1], workspace.shift[2]
    _move_coordinates(tree, q, qd, qdd, workspace.coordinates)
    _moves(tree, workspace.coordinates, move, tree_gain, gain)
    for i in range(3):
        rot[0, i, i] = 1.0
    for b in range(1, parent.size):
        m = parent[b]
        begin, end = first_motion[b], first_motion[b + 1]
        for i in range(3):
            c0, c1, c2 = rot[m, i, 0], rot[m, i, 1], rot[m, i, 2]
            for j in range(3):
                frame[i, j] = (
                    c0 * parent_rotation[b, 0, j]
                    + c1 * parent_rotation[b, 1, j]
                    + c2 * parent_rotation[b, 2, j]
                )
            r[i] = (
                c0 * parent_translation[b, 0]
                + c1 * parent_translation[b, 1]
                + c2 * parent_translation[b, 2]
            )
            r1[i] = 0.0
            r2[i] = 0.0
        for e in range(begin, end):
            if not turns[e]:
                for i in range(3):
                    s = frame[i, 0] * axis[e, 0]
                    s += frame[i, 1] * axis[e, 1] + frame[i, 2] * axis[e, 2]
                    screw[e, 3 + i] = s
                    r[i] += s * move[e, 0]
                    r1[i] += s * move[e, 1]
                    r2[i] += s * move[e, 2]
        wx, wy, wz = w[m, 0], w[m, 1], w[m, 2]
        lx, ly, lz = al[m, 0], al[m, 1], al[m, 2]
        cx, cy, cz = cross3(wx, wy, wz, r[0], r[1], r[2])
        dx, dy, dz = cross3(wx, wy, wz, cx + 2.0 * r1[0], cy + 2.0 * r1[1], cz + 2.0 * r1[2])
        ex, ey, ez = cross3(lx, ly, lz, r[0], r[1], r[2])
        vx, vy, vz = v[m, 0] + cx + r1[0], v[m, 1] + cy + r1[1], v[m, 2] + cz + r1[2]
        ax = a[m, 0] + ex + dx + r2[0]
        ay = a[m, 1] + ey + dy + r2[1]
        az = a[m, 2] + ez + dz + r2[2]
        for i in range(3):
            pivot[b, i] = p[m, i] + r[i]
        for e in range(begin, end):
            if turns[e]:
                ux, uy, uz = axis[e, 0], axis[e, 1], axis[e, 2]
                sx = frame[0, 0] * ux + frame[0, 1] * uy + frame[0, 2] * uz
                sy = frame[1, 0] * ux + frame[1, 1] * uy + frame[1, 2] * uz
                sz = frame[2, 0] * ux + frame[2, 1] * uy + frame[2, 2] * uz
                mx, my, mz = cross3(pivot[b, 0], pivot[b, 1], pivot[b, 2], sx, sy, sz)
                screw[e, 0], screw[e, 1], screw[e, 2] = sx, sy, sz
                screw[e, 3], screw[e, 4], screw[e, 5] = mx, my, mz
                rate = move[e, 1]
                cx, cy, cz = cross3(wx, wy, wz, sx, sy, sz)
                lx += sx * move[e, 2] + cx * rate
                ly += sy * move[e, 2] + cy * rate
                lz += sz * move[e, 2] + cz * rate
                wx += sx * rate
                wy += sy * rate
                wz += sz * rate
                _turn_about(frame, ux, uy, uz, move[e, 0])
        tx, ty, tz = child_translation[b, 0], child_translation[b, 1], child_translation[b, 2]
        for i in range(3):
            for j in range(3):
                rot[b, i, j] = (
                    frame[i, 0] * child_rotation[b, 0, j]
                    + frame[i, 1] * child_rotation[b, 1, j]
                    + frame[i, 2] * child_rotation[b, 2, j]
                )
            r[i] = -(rot[b, i, 0] * tx + rot[b, i, 1] * ty + rot[b, i, 2] * tz)
            p[b, i] = pivot[b, i] + r[i]
        cx, cy, cz = cross3(wx, wy, wz, r[0], r[1], r[2])
        dx, dy, dz = cross3(wx, wy, wz, cx, cy, cz)
        ex, ey, ez = cross3(lx, ly, lz, r[0], r[1], r[2])
        w[b, 0], w[b, 1], w[b, 2] = wx, wy, wz
        al[b, 0], al[b, 1], al[b, 2] = lx, ly, lz
        v[b, 0], v[b, 1], v[b, 2] = vx + cx, vy + cy, vz + cz
        a[b, 0], a[b, 1], a[b, 2] = ax + ex + dx, ay + ey + dy, az + ez + dz


@kernel
def set_jacobians(tree: Tree, state: BodyState, out: Array) -> None:
    """Write the spatial Jacobians (n_b, 6, n_q) of all bodies about the ground's origin."""
    parent, first, independent = tree.parent, tree.first_motion, tree.independent
    coordinate, screw, gain = tree.motion_coordinate, state.screw, state.gain
    n_q = out.shape[2]
    for i in range(6):
        for k in range(n_q):
            out[0, i, k] = 0.0
    for b in range(1, parent.size):
        m = parent[b]
        for i in range(6):
            for k in range(n_q):
                out[b, i, k] = out[m, i, k]
        for e in range(first[b], first[b + 1]):
            q = independent[coordinate[e]] if coordinate[e] >= 0 else -1
            if q >= 0:
                for i in range(6):
                    out[b, i, q] += screw[e, i] * gain[e]


@njit
def body_jacobians(tree: Tree, state: BodyState) -> Array:
    """Return the Jacobians of `set_jacobians`."""
    jacobian = np.empty((tree.parent.size, 6, tree.n_independent[0]))
    set_jacobians(tree, state, jacobian)
    return jacobian


@njit
def point_jacobian(jacobian: Array, point: Array) -> Array:
    """Return the Jacobian (3, n_q) of a body's point at `point` (3,), ground axes, m.

    Parameters
    ----------
    jacobian : (6, n_q) array
        The body's spatial Jacobian.
    """
    n_q = jacobian.shape[1]
    out = np.empty((3, n_q))
    x, y, z = point
    for k in range(n_q):
        wx, wy, wz = jacobian[0, k], jacobian[1, k], jacobian[2, k]
        out[0, k] = jacobian[3, k] + wy * z - wz * y
        out[1, k] = jacobian[4, k] + wz * x - wx * z
        out[2, k] = jacobian[5, k] + wx * y - wy * x
    return out
