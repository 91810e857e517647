# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled kinematics of a block of instants: one call for a live sample or for a whole lift."""

import numpy as np

from human_model.compiled import body_motion, segment_frames
from human_model.compiled_cache import njit
from human_model.tree import TreeArrays
from human_model.typing import Array, IntArray


@njit
def quaternions(rotation: Array) -> Array:
    """Quaternions (n, 4) xyzw with w >= 0 of rotation matrices (n, 3, 3).

    As `frames.quaternion_from_matrix` (Shepperd 1978), without its checks.
    """
    out = np.empty((rotation.shape[0], 4))
    squared = np.empty(4)
    for n in range(rotation.shape[0]):
        r = rotation[n]
        q = out[n]
        trace = r[0, 0] + r[1, 1] + r[2, 2]
        for i in range(3):
            squared[i] = 1.0 + 2.0 * r[i, i] - trace
        squared[3] = 1.0 + trace
        best = np.argmax(squared)
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            difference = r[k, j] - r[j, k]
            if best == 3:
                q[i] = difference
            elif best == i:
                q[i] = squared[i]
                q[3] = difference
            else:
                q[i] = r[best, i] + r[i, best]
        if best == 3:
            q[3] = squared[3]
        size = np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
        q /= -size if q[3] < 0.0 else size
    return out


@njit
def points_and_frames(
    tree: TreeArrays, q: Array, segment: IntArray, local: Array, frame_segment: IntArray
) -> tuple[Array, Array]:
    """Positions of points and orientations of segments at coordinates q (n, n_q).

    Parameters are the points' segments (n_p,) and local positions (n_p, 3) [m], and the segments
    (n_f,) of the frames. Returns positions (n, n_p, 3) [m] and quaternions (n, n_f, 4) xyzw.
    """
    n = q.shape[0]
    points = np.empty((n, segment.shape[0], 3))
    frames = np.empty((n, frame_segment.shape[0], 4))
    for k in range(n):
        rotation, origin = segment_frames(tree, q[k])
        for i in range(segment.shape[0]):
            s = segment[i]
            for r in range(3):
                points[k, i, r] = origin[s, r] + (
                    rotation[s, r, 0] * local[i, 0]
                    + rotation[s, r, 1] * local[i, 1]
                    + rotation[s, r, 2] * local[i, 2]
                )
        frames[k] = quaternions(rotation[frame_segment])
    return points, frames


@njit
def outer_force(tree: TreeArrays, q: Array, qd: Array, qdd: Array, gravity: float) -> Array:
    """Sum of the outer forces (n, 3) [N] that make a motion (n, n_q), world axes.

    The mass of each segment times the acceleration of its centre of mass less gravity, which
    acts along -z [m/s^2].
    """
    force = np.zeros((q.shape[0], 3))
    arm, spun = np.empty(3), np.empty(3)
    for k in range(q.shape[0]):
        rotation, _, _, omega, alpha, _, acceleration = body_motion(tree, q[k], qd[k], qdd[k])
        for s in range(tree.segment_body.shape[0]):
            b = tree.segment_body[s]
            for i in range(3):
                arm[i] = 0.0
                for j in range(3):
                    arm[i] += rotation[b, i, j] * (tree.segment_offset[s, j] + tree.com[s, j])
            for i in range(3):
                j, m = (i + 1) % 3, (i + 2) % 3
                spun[i] = omega[b, j] * arm[m] - omega[b, m] * arm[j]
            for i in range(3):
                j, m = (i + 1) % 3, (i + 2) % 3
                force[k, i] += tree.mass[s] * (
                    acceleration[b, i]
                    + (alpha[b, j] * arm[m] - alpha[b, m] * arm[j])
                    + (omega[b, j] * spun[m] - omega[b, m] * spun[j])
                )
        force[k, 2] += gravity * tree.mass.sum()
    return force
