# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Gradient and Hessian of the marker fit (see `kernel`), and the curvature of what is seen."""

import numpy as np

from human_model.compiled import body_frames
from human_model.compiled_cache import njit
from human_model.tree import TreeArrays
from human_model.typing import Array, IntArray


@njit
def marker_positions(rotation: Array, origin: Array, body: IntArray, local: Array) -> Array:
    """Return the positions (n, 3) of markers at `local` (n, 3) on bodies [m]."""
    out = np.empty((body.shape[0], 3))
    for i in range(body.shape[0]):
        b = body[i]
        for r in range(3):
            out[i, r] = (
                origin[b, r]
                + rotation[b, r, 0] * local[i, 0]
                + rotation[b, r, 1] * local[i, 1]
                + rotation[b, r, 2] * local[i, 2]
            )
    return out


@njit
def add_normal_equations(
    tree: TreeArrays,
    origin: Array,
    axis: Array,
    position: Array,
    body: IntArray,
    target: Array,
    weight: Array,
    hessian: Array,
    gradient: Array,
) -> None:
    """Add half the gradient and half the Gauss-Newton Hessian of the marker terms."""
    n_q = gradient.shape[0]
    path = np.empty(n_q, dtype=np.int64)
    # Components of the columns of the Jacobian along the path, each in a row.
    cx, cy, cz = np.empty(n_q), np.empty(n_q), np.empty(n_q)
    for i in range(weight.shape[0]):
        w = weight[i]
        if w <= 0.0:
            continue
        count = 0
        j = body[i]
        while j >= 0:
            if tree.kind[j] == 1:
                cx[count], cy[count], cz[count] = axis[j, 0], axis[j, 1], axis[j, 2]
            else:
                x = position[i, 0] - origin[j, 0]
                y = position[i, 1] - origin[j, 1]
                z = position[i, 2] - origin[j, 2]
                cx[count] = axis[j, 1] * z - axis[j, 2] * y
                cy[count] = axis[j, 2] * x - axis[j, 0] * z
                cz[count] = axis[j, 0] * y - axis[j, 1] * x
            path[count] = j
            count += 1
            j = tree.parent[j]
        ex, ey, ez = (
            position[i, 0] - target[i, 0],
            position[i, 1] - target[i, 1],
            position[i, 2] - target[i, 2],
        )
        for a in range(count):
            x, y, z = cx[a], cy[a], cz[a]
            gradient[path[a]] += w * (x * ex + y * ey + z * ez)
            # Paths run from the marker to the root, so path[a] >= path[b]: lower triangle.
            row = hessian[path[a]]
            for b in range(a, count):
                row[path[b]] += w * (cx[b] * x + cy[b] * y + cz[b] * z)


@njit
def add_second_derivatives(
    tree: TreeArrays,
    origin: Array,
    axis: Array,
    position: Array,
    body: IntArray,
    target: Array,
    weight: Array,
    hessian: Array,
) -> None:
    """Add half of what the second derivatives of the marker positions give to the Hessian.

    For a joint b and a joint a nearer to the root, or the same, on the way to a marker,
    d2p / dq_a dq_b = axis_a x dp/dq_b if a turns, and zero if it slides.
    """
    for i in range(weight.shape[0]):
        w = weight[i]
        if w <= 0.0:
            continue
        ex, ey, ez = (
            position[i, 0] - target[i, 0],
            position[i, 1] - target[i, 1],
            position[i, 2] - target[i, 2],
        )
        b = body[i]
        while b >= 0:
            if tree.kind[b] == 1:
                cx, cy, cz = axis[b, 0], axis[b, 1], axis[b, 2]
            else:
                x = position[i, 0] - origin[b, 0]
                y = position[i, 1] - origin[b, 1]
                z = position[i, 2] - origin[b, 2]
                cx = axis[b, 1] * z - axis[b, 2] * y
                cy = axis[b, 2] * x - axis[b, 0] * z
                cz = axis[b, 0] * y - axis[b, 1] * x
            # e . (axis x c) = axis . (c x e)
            tx, ty, tz = cy * ez - cz * ey, cz * ex - cx * ez, cx * ey - cy * ex
            a = b
            while a >= 0:
                if tree.kind[a] != 1:
                    hessian[b, a] += w * (axis[a, 0] * tx + axis[a, 1] * ty + axis[a, 2] * tz)
                a = tree.parent[a]
            b = tree.parent[b]


@njit
def add_pairs(hessian: Array, pair: IntArray, share: Array, pair_weight: Array) -> None:
    """Add half the Hessian of the terms that tie two coordinates."""
    for k in range(pair.shape[0]):
        a, b, s = pair[k, 0], pair[k, 1], share[k]
        hessian[a, a] += pair_weight[k] * (1.0 - s) ** 2
        hessian[b, b] += pair_weight[k] * s**2
        hessian[max(a, b), min(a, b)] -= pair_weight[k] * s * (1.0 - s)


@njit
def observed_curvature(
    tree: TreeArrays,
    q: Array,
    body: IntArray,
    local: Array,
    weight: Array,
    pair: IntArray,
    share: Array,
    pair_weight: Array,
    floor: float,
) -> Array:
    """Curvature (n_q,) [m^2 or 1] of the fit about each coordinate, all others free to follow.

    The reciprocal diagonal of the inverse Hessian of the marker and pair terms, plus ``floor``
    on the diagonal: what is near the floor is not determined by the markers.
    """
    rotation, origin, axis = body_frames(tree, q)
    position = marker_positions(rotation, origin, body, local)
    n_q = q.shape[0]
    hessian = np.zeros((n_q, n_q))
    gradient = np.zeros(n_q)
    add_normal_equations(tree, origin, axis, position, body, position, weight, hessian, gradient)
    add_pairs(hessian, pair, share, pair_weight)
    for a in range(n_q):
        hessian[a, a] += floor
        for b in range(a):
            hessian[b, a] = hessian[a, b]
    return 1.0 / np.diag(np.linalg.inv(hessian))
