# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Points and frames of a skeleton in one sample of its motion, compiled."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.compiled import body_motion
from human_model.compiled_cache import njit
from human_model.tree import TreeArrays
from human_model.typing import Array, IntArray
from muscle_analyzer.core.multibody.kinematics import cross3


class SkeletonState(NamedTuple):
    """A skeleton at its coordinates; velocities and accelerations of its points.

    Attributes
    ----------
    point, velocity, acceleration : (n_p, 3) arrays
        m, m/s, m/s^2.
    rotation : (n_f, 3, 3) array
        World <- frame.
    omega, alpha : (n_f, 3) arrays
        Angular, rad/s and rad/s^2.
    """

    point: Array
    velocity: Array
    acceleration: Array
    rotation: Array
    omega: Array
    alpha: Array


class SkeletonMotion(NamedTuple):
    """Samples of a skeleton's motion; see `human_model.motion.BodyMotion`.

    Attributes
    ----------
    position, velocity, acceleration : (n, n_s) arrays
        Coordinates of the skeleton in rad or m, rates, accelerations.
    points : (n, n_all, 3) array
        REP-103 axes, m.
    frames : (n, n_frames, 4) array
        Quaternions xyzw.
    point_column, frame_column : (n_p,), (n_f,) int arrays
        Where the points and frames of the model are among them.
    """

    position: Array
    velocity: Array
    acceleration: Array
    points: Array
    frames: Array
    point_column: IntArray
    frame_column: IntArray


@njit
def set_frame(motion: SkeletonMotion, k: int, place: Array, frames: Array) -> None:
    """Write places (n_p, 3) and rotation matrices (n_f, 3, 3) of a sample of the motion."""
    for i in range(place.shape[0]):
        for j in range(3):
            place[i, j] = motion.points[k, motion.point_column[i], j]
    for f in range(frames.shape[0]):
        q = motion.frames[k, motion.frame_column[f]]
        size = np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        x, y, z, w = q[0] / size, q[1] / size, q[2] / size, q[3] / size
        m = frames[f]
        m[0, 0] = 1 - 2 * (y * y + z * z)
        m[0, 1] = 2 * (x * y - z * w)
        m[0, 2] = 2 * (x * z + y * w)
        m[1, 0] = 2 * (x * y + z * w)
        m[1, 1] = 1 - 2 * (x * x + z * z)
        m[1, 2] = 2 * (y * z - x * w)
        m[2, 0] = 2 * (x * z - y * w)
        m[2, 1] = 2 * (y * z + x * w)
        m[2, 2] = 1 - 2 * (x * x + y * y)


@njit
def skeleton_state(
    tree: TreeArrays,
    point_body: IntArray,
    local: Array,
    frame_body: IntArray,
    q: Array,
    qd: Array,
    qdd: Array,
) -> SkeletonState:
    """Return the state of points (n_p, 3) m and frames on bodies of a skeleton."""
    rotation, origin, _, omega, alpha, velocity, acceleration = body_motion(tree, q, qd, qdd)
    n_p, n_f = point_body.size, frame_body.size
    x = np.empty((n_p, 3))
    v = np.empty((n_p, 3))
    a = np.empty((n_p, 3))
    orientation = np.empty((n_f, 3, 3))
    w = np.empty((n_f, 3))
    al = np.empty((n_f, 3))
    for i in range(n_p):
        b = point_body[i]
        lx, ly, lz = local[i, 0], local[i, 1], local[i, 2]
        turn = rotation[b]
        ax = turn[0, 0] * lx + turn[0, 1] * ly + turn[0, 2] * lz
        ay = turn[1, 0] * lx + turn[1, 1] * ly + turn[1, 2] * lz
        az = turn[2, 0] * lx + turn[2, 1] * ly + turn[2, 2] * lz
        wx, wy, wz = omega[b, 0], omega[b, 1], omega[b, 2]
        sx, sy, sz = cross3(wx, wy, wz, ax, ay, az)
        tx, ty, tz = cross3(alpha[b, 0], alpha[b, 1], alpha[b, 2], ax, ay, az)
        cx, cy, cz = cross3(wx, wy, wz, sx, sy, sz)
        x[i, 0], x[i, 1], x[i, 2] = origin[b, 0] + ax, origin[b, 1] + ay, origin[b, 2] + az
        v[i, 0], v[i, 1], v[i, 2] = velocity[b, 0] + sx, velocity[b, 1] + sy, velocity[b, 2] + sz
        a[i, 0] = acceleration[b, 0] + tx + cx
        a[i, 1] = acceleration[b, 1] + ty + cy
        a[i, 2] = acceleration[b, 2] + tz + cz
    for i in range(n_f):
        b = frame_body[i]
        for j in range(3):
            w[i, j] = omega[b, j]
            al[i, j] = alpha[b, j]
            for k in range(3):
                orientation[i, j, k] = rotation[b, j, k]
    return SkeletonState(x, v, a, orientation, w, al)
