# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Kinematics of a `TreeArrays` at many instants at once, in NumPy: nothing to compile or to load.

The same numbers as those of `compiled`, which is made for single instants at 100 Hz. Importing
numba takes longer than predicting a lift, and the sagittal skeleton does without it.
"""

import numpy as np

from human_model.tree import PRISMATIC, TreeArrays
from human_model.typing import Array, IntArray


def segment_frames(tree: TreeArrays, q: Array) -> tuple[Array, Array]:
    """World rotations (n, n_s, 3, 3), origins (n, n_s, 3) [m] of all segments for q (n, n_q)."""
    n, n_q = q.shape
    rotation = np.empty((n_q, n, 3, 3))
    origin = np.zeros((n_q, n, 3))
    for j in range(n_q):
        p = int(tree.parent[j])
        base = np.broadcast_to(np.eye(3), (n, 3, 3)) if p < 0 else rotation[p]
        at = np.zeros((n, 3)) if p < 0 else origin[p]
        if tree.kind[j] == PRISMATIC:
            rotation[j] = base
            origin[j] = (
                at + (base @ (tree.offset[j] + tree.axis[j] * q[:, j, None])[..., None])[..., 0]
            )
        else:
            rotation[j] = base @ _rotations(tree.axis[j], q[:, j])
            origin[j] = at + base @ tree.offset[j]
    turned = rotation[tree.segment_body]
    place = origin[tree.segment_body] + np.einsum('snij,sj->sni', turned, tree.segment_offset)
    return np.moveaxis(turned, 0, 1), np.moveaxis(place, 0, 1)


def point_positions(tree: TreeArrays, q: Array, segment: IntArray, local: Array) -> Array:
    """World positions (n, n_p, 3) [m] of points fixed to segments (n_p,) at local (n_p, 3)."""
    rotation, origin = segment_frames(tree, q)
    return np.asarray(origin[:, segment] + np.einsum('npij,pj->npi', rotation[:, segment], local))


def _rotations(axis: Array, angle: Array) -> Array:
    """Rotations (n, 3, 3) about a unit axis (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    c, s = np.cos(angle)[:, None, None], np.sin(angle)[:, None, None]
    return np.asarray(c * np.eye(3) + s * cross + (1.0 - c) * np.outer(axis, axis))
