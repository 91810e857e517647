# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""How far points and orientations of bodies are from where they shall be, compiled."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array, IntArray
from muscle_analyzer.core.multibody.kinematics import BodyState, cross3, set_jacobians
from muscle_analyzer.core.multibody.model import Tree


class Targets(NamedTuple):
    """What is fitted, ground axes.

    Attributes
    ----------
    point_body : (n_p,) int array
    point_local : (n_p, 3) array
        In the body's axes, m.
    point : (n_p, 3) array
        Where the points shall be, m.
    point_weight : (n_p,) array
        1 / m.
    frame_body : (n_f,) int array
    frame : (n_f, 3, 3) array
        Orientations that the bodies shall have, ground <- body.
    frame_weight : (n_f,) array
        1 / rad.
    reference : (n_q,) array
        Value that each coordinate is weakly pulled to, rad or m.
    reference_weight : (n_q,) array
        1 / rad or 1 / m; 0 for no pull.
    """

    point_body: IntArray
    point_local: Array
    point: Array
    point_weight: Array
    frame_body: IntArray
    frame: Array
    frame_weight: Array
    reference: Array
    reference_weight: Array


@kernel
def set_misfit(targets: Targets, state: BodyState, out: Array) -> None:
    """Write the weighted misfits (3 n_p + 3 n_f,): points first, then rotation vectors.

    These are the turns that take the wanted orientations to those of the bodies, ground axes.
    """
    rotation, position = state.rotation, state.position
    body, local = targets.point_body, targets.point_local
    wanted, weight = targets.point, targets.point_weight
    n_p = body.size
    for i in range(n_p):
        b = body[i]
        for j in range(3):
            place = position[b, j]
            for k in range(3):
                place += rotation[b, j, k] * local[i, k]
            out[3 * i + j] = weight[i] * (place - wanted[i, j])
    body, frame, weight = targets.frame_body, targets.frame, targets.frame_weight
    for f in range(body.size):
        b, at = body[f], 3 * (n_p + f)
        x, y, z, cosine = 0.0, 0.0, 0.0, -0.5
        for k in range(3):
            # Half the skew part of actual target^T, column by column, and half its trace.
            ax, ay, az = rotation[b, 0, k], rotation[b, 1, k], rotation[b, 2, k]
            tx, ty, tz = frame[f, 0, k], frame[f, 1, k], frame[f, 2, k]
            x += 0.5 * (az * ty - ay * tz)
            y += 0.5 * (ax * tz - az * tx)
            z += 0.5 * (ay * tx - ax * ty)
            cosine += 0.5 * (ax * tx)
            cosine += 0.5 * (ay * ty)
            cosine += 0.5 * (az * tz)
        sine = np.sqrt(x**2 + y**2 + z**2)
        factor = np.arctan2(sine, cosine) / sine if sine > 1e-9 else 1.0
        out[at] = x * factor * weight[f]
        out[at + 1] = y * factor * weight[f]
        out[at + 2] = z * factor * weight[f]


@njit
def misfit(targets: Targets, state: BodyState) -> Array:
    """Return the misfits of `set_misfit`."""
    out = np.empty(3 * (targets.point_body.size + targets.frame_body.size))
    set_misfit(targets, state, out)
    return out


@kernel
def set_misfit_jacobian(
    tree: Tree, targets: Targets, state: BodyState, spatial: Array, out: Array
) -> None:
    """Write the derivative (3 n_p + 3 n_f, n_q) of `misfit`, of rotations to first order.

    `spatial` is a workspace for the Jacobians (n_b, 6, n_q) of the bodies.
    """
    set_jacobians(tree, state, spatial)
    rotation, position = state.rotation, state.position
    body, local, weight = targets.point_body, targets.point_local, targets.point_weight
    n_p, n_q = body.size, out.shape[1]
    for i in range(n_p):
        b, w = body[i], weight[i]
        lx, ly, lz = local[i, 0], local[i, 1], local[i, 2]
        x = rotation[b, 0, 0] * lx + rotation[b, 0, 1] * ly + rotation[b, 0, 2] * lz
        y = rotation[b, 1, 0] * lx + rotation[b, 1, 1] * ly + rotation[b, 1, 2] * lz
        z = rotation[b, 2, 0] * lx + rotation[b, 2, 1] * ly + rotation[b, 2, 2] * lz
        x, y, z = x + position[b, 0], y + position[b, 1], z + position[b, 2]
        for k in range(n_q):
            wx, wy, wz = spatial[b, 0, k], spatial[b, 1, k], spatial[b, 2, k]
            out[3 * i, k] = w * (spatial[b, 3, k] + wy * z - wz * y)
            out[3 * i + 1, k] = w * (spatial[b, 4, k] + wz * x - wx * z)
            out[3 * i + 2, k] = w * (spatial[b, 5, k] + wx * y - wy * x)
    body, weight = targets.frame_body, targets.frame_weight
    for f in range(body.size):
        b, w = body[f], weight[f]
        for j in range(3):
            for k in range(n_q):
                out[3 * (n_p + f) + j, k] = w * spatial[b, j, k]


@njit
def misfit_jacobian(tree: Tree, targets: Targets, state: BodyState) -> Array:
    """Return the derivative of `set_misfit_jacobian`."""
    n_q = tree.n_independent[0]
    out = np.empty((3 * (targets.point_body.size + targets.frame_body.size), n_q))
    set_misfit_jacobian(tree, targets, state, np.empty((tree.parent.size, 6, n_q)), out)
    return out


@kernel
def set_left_acceleration(
    targets: Targets, state: BodyState, point: Array, frame: Array, out: Array
) -> None:
    """Write weighted accelerations (3 n_p + 3 n_f,) less those that the bodies have already.

    Parameters
    ----------
    targets : Targets
    state : BodyState
        With velocities and accelerations.
    point, frame : (n_p, 3), (n_f, 3) arrays
        Of the points and the frames, m/s^2 and rad/s^2.
    """
    rotation, omega = state.rotation, state.angular_velocity
    alpha, acceleration = state.angular_acceleration, state.acceleration
    body, local, weight = targets.point_body, targets.point_local, targets.point_weight
    n_p = body.size
    for i in range(n_p):
        b = body[i]
        lx, ly, lz = local[i, 0], local[i, 1], local[i, 2]
        x = rotation[b, 0, 0] * lx + rotation[b, 0, 1] * ly + rotation[b, 0, 2] * lz
        y = rotation[b, 1, 0] * lx + rotation[b, 1, 1] * ly + rotation[b, 1, 2] * lz
        z = rotation[b, 2, 0] * lx + rotation[b, 2, 1] * ly + rotation[b, 2, 2] * lz
        wx, wy, wz = omega[b, 0], omega[b, 1], omega[b, 2]
        sx, sy, sz = cross3(wx, wy, wz, x, y, z)
        sx, sy, sz = cross3(wx, wy, wz, sx, sy, sz)
        tx, ty, tz = cross3(alpha[b, 0], alpha[b, 1], alpha[b, 2], x, y, z)
        out[3 * i] = weight[i] * (point[i, 0] - (sx + (tx + acceleration[b, 0])))
        out[3 * i + 1] = weight[i] * (point[i, 1] - (sy + (ty + acceleration[b, 1])))
        out[3 * i + 2] = weight[i] * (point[i, 2] - (sz + (tz + acceleration[b, 2])))
    body, weight = targets.frame_body, targets.frame_weight
    for f in range(body.size):
        for j in range(3):
            out[3 * (n_p + f) + j] = weight[f] * (frame[f, j] - alpha[body[f], j])
