# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The thesis' recursive kinematics (2.1 to 2.4) and recursive Lagrangian dynamics (2.5 to 2.9).

The reference for the compiled Newton-Euler method, by another principle. The recursion runs over
the rows of a Denavit-Hartenberg chain with branches: the parent replaces row i - 1 of the thesis,
the sum over the children replaces row i + 1. Any number of external forces and moments may act on
any row; the vector recursion F of one force becomes the matrix recursion of the sum of
``r_k f_k^T``, so that ``f^T dA/dq F`` becomes ``tr(dA/dq F)``.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from human_model.anthropometry import SegmentParameters
from human_model.constants import GRAVITY
from human_model.dh import Chain
from human_model.exceptions import ChainError
from human_model.tree import row_segments
from human_model.typing import Array


@dataclass(frozen=True, eq=False)
class RecursiveKinematics:
    """Position, velocity and acceleration matrices of all rows.

    Attributes
    ----------
    transform, first, second : ndarray (n_rows, 4, 4)
        T_i and its first and second derivative with respect to the row's coordinate.
    a, b, c : ndarray (n_rows, 4, 4)
        A_i, B_i = dA_i/dt, C_i = dB_i/dt (equations 2.1, 2.2, 2.3).
    """

    transform: Array
    first: Array
    second: Array
    a: Array
    b: Array
    c: Array

    def point(self, row: int, local: npt.ArrayLike) -> tuple[Array, Array, Array]:
        """Position, velocity, acceleration (3,) of a point of a row's frame (equation 2.4)."""
        augmented = np.append(np.asarray(local, dtype=np.float64), 1.0)
        return (
            (self.a[row] @ augmented)[:3],
            (self.b[row] @ augmented)[:3],
            (self.c[row] @ augmented)[:3],
        )


def forward_kinematics(
    chain: Chain, q: npt.ArrayLike, qd: npt.ArrayLike, qdd: npt.ArrayLike
) -> RecursiveKinematics:
    """Recursion from the world outward (equations 2.1 to 2.3); q, qd, qdd have shape (n_q,)."""
    values, rates, seconds = chain.expand(q), chain.expand(qd), chain.expand(qdd)
    n = len(chain.rows)
    transform, first, second = np.empty((3, n, 4, 4))
    a, b, c = np.empty((3, n, 4, 4))
    for i, row in enumerate(chain.rows):
        transform[i] = row.transform(float(values[i]))
        first[i], second[i] = row.derivatives(float(values[i]))
        if row.parent < 0:
            a_p, b_p, c_p = np.eye(4), np.zeros((4, 4)), np.zeros((4, 4))
        else:
            a_p, b_p, c_p = a[row.parent], b[row.parent], c[row.parent]
        a[i] = a_p @ transform[i]
        b[i] = b_p @ transform[i] + a_p @ first[i] * rates[i]
        c[i] = (
            c_p @ transform[i]
            + 2.0 * b_p @ first[i] * rates[i]
            + a_p @ second[i] * rates[i] ** 2
            + a_p @ first[i] * seconds[i]
        )
    return RecursiveKinematics(transform, first, second, a, b, c)


def augmented_inertia(chain: Chain, parameters: SegmentParameters) -> tuple[Array, Array, Array]:
    """Augmented inertia matrices I_i (n_rows, 4, 4), masses (n_rows,) and centres of mass.

    ``I_i`` is the integral of ``r r^T dm`` over the row's segment, r augmented by 1, in the row's
    frame: its upper left part is ``(tr(J)/2) E - J`` with J the inertia tensor about the frame's
    origin, its last column ``m r``. Centres of mass (n_rows, 3) are in the row's frame [m].
    """
    n = len(chain.rows)
    neutral = chain.frames(np.zeros(len(chain.coordinates)))
    rows, origins = row_segments(chain)
    inertia, mass, com = np.zeros((n, 4, 4)), np.zeros(n), np.zeros((n, 3))
    for s, name in enumerate(parameters.segments):
        if name not in rows:
            raise ChainError(f'{chain.name}: no row carries segment {name!r}')
        i = rows[name]
        turn = neutral[i, :3, :3].T
        com[i] = turn @ (origins[name] + parameters.com[s] - neutral[i, :3, 3])
        mass[i] = parameters.mass[s]
        tensor = turn @ parameters.inertia[s] @ turn.T
        inertia[i, :3, :3] = (
            np.trace(tensor) / 2.0 * np.eye(3) - tensor + mass[i] * np.outer(com[i], com[i])
        )
        inertia[i, :3, 3] = inertia[i, 3, :3] = mass[i] * com[i]
        inertia[i, 3, 3] = mass[i]
    return inertia, mass, com


def recursive_dynamics(
    chain: Chain,
    parameters: SegmentParameters,
    q: npt.ArrayLike,
    qd: npt.ArrayLike,
    qdd: npt.ArrayLike,
    *,
    wrench: Array | None = None,
    gravity: float = GRAVITY,
) -> Array:
    """Generalised forces (n_q,) [N m; N] by the recursion from the tips inward (2.5 to 2.9).

    Parameters
    ----------
    chain, parameters
        Tree of rows and the inertia of its segments.
    q, qd, qdd
        Coordinates and rates (n_q,).
    wrench
        External force [N] and its moment about the world's origin [N m] on each segment
        (n_s, 6), world axes, in the order of ``parameters.segments``.
    gravity
        m/s^2, along -z.
    """
    motion = forward_kinematics(chain, q, qd, qdd)
    inertia, mass, com = augmented_inertia(chain, parameters)
    n = len(chain.rows)
    d, f = np.zeros((2, n, 4, 4))
    e, g = np.zeros((2, n, 4))
    rows, _ = row_segments(chain)
    if wrench is not None:
        for s, name in enumerate(parameters.segments):
            i = rows[name]
            # The force is put into the world's origin, written in the row's own frame.
            point = np.linalg.solve(motion.a[i], np.array([0.0, 0.0, 0.0, 1.0]))
            f[i] = np.outer(point, np.append(wrench[s, :3], 0.0))
            g[i, :3] = wrench[s, 3:]
    down = np.array([0.0, 0.0, -gravity, 0.0])
    tau = np.zeros(n)
    for i in range(n - 1, -1, -1):
        row = chain.rows[i]
        d[i] += inertia[i] @ motion.c[i].T
        e[i] += mass[i] * np.append(com[i], 1.0)
        a_p = np.eye(4) if row.parent < 0 else motion.a[row.parent]
        slope = a_p @ motion.first[i]
        axis = a_p[:, 2] * row.sign if row.kind == 'revolute' else np.zeros(4)
        tau[i] = (
            np.trace(slope @ d[i]) - down @ slope @ e[i] - np.trace(slope @ f[i]) - g[i] @ axis
        )
        if row.parent >= 0:
            d[row.parent] += motion.transform[i] @ d[i]
            e[row.parent] += motion.transform[i] @ e[i]
            f[row.parent] += motion.transform[i] @ f[i]
            g[row.parent] += g[i]
    return tau[[i for i, row in enumerate(chain.rows) if row.coordinate]]
