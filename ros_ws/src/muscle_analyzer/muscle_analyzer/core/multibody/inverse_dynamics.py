# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Inverse dynamics of the whole tree by the recursive Newton-Euler method; compiled.

The thesis' equations 2.5 to 2.9 in wrench form. All wrenches are (moment, force) about the
ground's origin in ground axes, so the backward recursion is a plain sum over the subtree.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array
from muscle_analyzer.core.multibody.kinematics import BodyState, cross3
from muscle_analyzer.core.multibody.model import Tree


class InverseDynamics(NamedTuple):
    """Wrenches and generalised forces at the joints, from motion and external loads.

    Attributes
    ----------
    joint_wrench : (n_b, 6) array
        Wrench that must act on each body from its parent, by joint and muscles together. Of the
        root body it is the residual: the part that the external loads do not balance.
    tree_force : (n_x,) array
        Generalised force of every coordinate of the tree, as if none were coupled, N m or N.
    force : (n_q,) array
        Generalised force of the independent coordinates, coupled ones included, N m or N.
    """

    joint_wrench: Array
    tree_force: Array
    force: Array


@njit
def add_force(wrenches: Array, body: int, force: Array, point: Array, moment: Array) -> None:
    """Add a force (3,) N at a ground point (3,) m and a free moment (3,) N m to a body's wrench.

    Parameters
    ----------
    wrenches : (n_b, 6) array
        Changed in place.
    """
    px, py, pz = point
    fx, fy, fz = force
    wrenches[body, 0] += py * fz - pz * fy + moment[0]
    wrenches[body, 1] += pz * fx - px * fz + moment[1]
    wrenches[body, 2] += px * fy - py * fx + moment[2]
    wrenches[body, 3] += fx
    wrenches[body, 4] += fy
    wrenches[body, 5] += fz


@njit(inline='always')
def _times(m: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a matrix (3, 3) times a vector, in scalars."""
    return (
        m[0, 0] * x + m[0, 1] * y + m[0, 2] * z,
        m[1, 0] * x + m[1, 1] * y + m[1, 2] * z,
        m[2, 0] * x + m[2, 1] * y + m[2, 2] * z,
    )


@njit(inline='always')
def _into_body(m: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a transposed matrix (3, 3) times a vector, in scalars."""
    return (
        m[0, 0] * x + m[1, 0] * y + m[2, 0] * z,
        m[0, 1] * x + m[1, 1] * y + m[2, 1] * z,
        m[0, 2] * x + m[1, 2] * y + m[2, 2] * z,
    )


@kernel
def _inertial_wrenches(tree: Tree, state: BodyState, out: Array) -> None:
    """Fill the wrenches (n_b, 6) that give every body its acceleration, weight taken off."""
    for b in range(1, tree.parent.size):
        rot = state.rotation[b]
        c, tensor, mass = tree.mass_center[b], tree.inertia[b], tree.mass[b]
        wx, wy, wz = state.angular_velocity[b]
        lx, ly, lz = state.angular_acceleration[b]
        rx = rot[0, 0] * c[0] + rot[0, 1] * c[1] + rot[0, 2] * c[2]
        ry = rot[1, 0] * c[0] + rot[1, 1] * c[1] + rot[1, 2] * c[2]
        rz = rot[2, 0] * c[0] + rot[2, 1] * c[1] + rot[2, 2] * c[2]
        sx, sy, sz = cross3(wx, wy, wz, rx, ry, rz)
        sx, sy, sz = cross3(wx, wy, wz, sx, sy, sz)
        tx, ty, tz = cross3(lx, ly, lz, rx, ry, rz)
        fx = mass * (state.acceleration[b, 0] + sx + tx - tree.gravity[0])
        fy = mass * (state.acceleration[b, 1] + sy + ty - tree.gravity[1])
        fz = mass * (state.acceleration[b, 2] + sz + tz - tree.gravity[2])
        # Angular momentum and its rate in body axes, where the inertia is constant.
        ux, uy, uz = _into_body(rot, wx, wy, wz)
        vx, vy, vz = _into_body(rot, lx, ly, lz)
        hx, hy, hz = _times(tensor, ux, uy, uz)
        mx, my, mz = cross3(ux, uy, uz, hx, hy, hz)
        hx, hy, hz = _times(tensor, vx, vy, vz)
        mx, my, mz = _times(rot, mx + hx, my + hy, mz + hz)
        px, py, pz = cross3(
            state.position[b, 0] + rx, state.position[b, 1] + ry, state.position[b, 2] + rz,
            fx, fy, fz,
        )  # fmt: skip
        out[b, 0], out[b, 1], out[b, 2] = mx + px, my + py, mz + pz
        out[b, 3], out[b, 4], out[b, 5] = fx, fy, fz


@kernel
def accumulate_subtrees(parent: NDArray[np.int64], wrenches: Array) -> None:
    """Add to the wrenches (n_b, 6) on each body those on all that it carries, in place."""
    for b in range(parent.size - 1, 0, -1):
        for i in range(6):
            wrenches[parent[b], i] += wrenches[b, i]


@njit
def inverse_dynamics(tree: Tree, state: BodyState, external: Array) -> InverseDynamics:
    """Return the joint wrenches and generalised forces of a motion under external loads.

    Parameters
    ----------
    tree : Tree
    state : BodyState
        Of the same tree.
    external : (n_b, 6) array
        Wrenches on the bodies from outside (ground, box), without weight; see `add_force`.
    """
    found = allocate_dynamics(tree)
    compute_inverse_dynamics(tree, state, external, found)
    return found


@njit
def allocate_dynamics(tree: Tree) -> InverseDynamics:
    """Return workspace for `compute_inverse_dynamics`."""
    return InverseDynamics(
        np.zeros((tree.parent.size, 6)),
        np.zeros(tree.independent.size),
        np.zeros(tree.n_independent[0]),
    )


@kernel
def compute_inverse_dynamics(
    tree: Tree, state: BodyState, external: Array, out: InverseDynamics
) -> None:
    """Fill joint wrenches and generalised forces as `inverse_dynamics` gives them."""
    joint_wrench, tree_force, force = out
    for i in range(6):
        joint_wrench[0, i] = 0.0
    _inertial_wrenches(tree, state, joint_wrench)
    for b in range(tree.parent.size):
        for i in range(6):
            joint_wrench[b, i] -= external[b, i]
    accumulate_subtrees(tree.parent, joint_wrench)
    tree_force.fill(0.0)
    force.fill(0.0)
    for b in range(1, tree.parent.size):
        for e in range(tree.first_motion[b], tree.first_motion[b + 1]):
            x = tree.motion_coordinate[e]
            if x < 0:
                continue
            along = 0.0
            for i in range(6):
                along += state.screw[e, i] * joint_wrench[b, i]
            tree_force[x] += along * state.tree_gain[e]
            if tree.independent[x] >= 0:
                force[tree.independent[x]] += along * state.gain[e]


@njit
def wrench_at(wrench: Array, point: Array) -> Array:
    """Return a wrench (6,) about the ground's origin as one about another point (3,), m."""
    out = np.empty(6)
    refer_wrench(wrench, point, out)
    return out


@kernel
def refer_wrench(wrench: Array, point: Array, out: Array) -> None:
    """Fill the wrench (6,) that `wrench_at` gives."""
    x, y, z = cross3(point[0], point[1], point[2], wrench[3], wrench[4], wrench[5])
    out[0], out[1], out[2] = wrench[0] - x, wrench[1] - y, wrench[2] - z
    out[3], out[4], out[5] = wrench[3], wrench[4], wrench[5]
