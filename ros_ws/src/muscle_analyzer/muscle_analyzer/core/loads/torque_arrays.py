# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint torques and dynamic strength (equations 2.14 to 2.19) of a block, compiled."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array, BoolArray, IntArray
from muscle_analyzer.core.boxed_tuple import Boxed


class TorqueTable(NamedTuple):
    """What is compared with what, of n_j joints; strength is [lower, upper].

    Attributes
    ----------
    of_net_moment : (n_j,) bool
        Whether a torque is the net L5-S1 moment about an axis of the pelvis.
    source : (n_j,) int
        Number of that axis, or of the balanced coordinate.
    sign : (n_j,)
        From that torque to the coordinate's positive direction.
    column : (n_j,) int
        Coordinate of the skeleton whose angle and speed count, or -1: held at zero.
    coefficients : (2, n_j, 8)
        c1 to c8.
    magnitude, angle_factor, speed_factor : (2, n_j)
        See `human_model.strength.StrengthBound`.
    """

    of_net_moment: BoolArray
    source: IntArray
    sign: Array
    column: IntArray
    coefficients: Array
    magnitude: Array
    angle_factor: Array
    speed_factor: Array


@njit(error_model='numpy')
def _peak(x: float, centre: float, width: float) -> float:
    u = (x - centre) / width
    return 4.0 / (2.0 + float(np.exp(u)) + float(np.exp(-u)))


@njit(error_model='numpy')
def _strength(table: TorqueTable, side: int, j: int, angle: float, speed: float) -> float:
    """Return the strength of a joint [N m]; `human_model.strength.surface` in numbers."""
    c = table.coefficients[side, j]
    of_angle = _peak(table.angle_factor[side, j] * angle, c[2], c[3])
    of_speed = _peak(table.speed_factor[side, j] * speed, c[5], c[6])
    sum_ = c[0] + c[1] * of_angle + c[4] * of_speed + c[7] * of_angle * of_speed
    return float(table.magnitude[side, j] * sum_)


@njit(error_model='numpy')
def _axis(quaternion: Array, number: int) -> tuple[float, float, float]:
    """Return an axis of a frame, in the world, from the frame's quaternion xyzw."""
    q = quaternion
    size = np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    x, y, z, w = q[0] / size, q[1] / size, q[2] / size, q[3] / size
    if number == 0:
        return 1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)
    if number == 1:
        return 2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)
    return 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)


@njit(error_model='numpy')
def torques_and_limits(
    boxed: Boxed[TorqueTable],
    position: Array,
    velocity: Array,
    frames: Array,
    pelvis: int,
    net_moment: Array,
    torque: Array,
) -> tuple[Array, Array, Array]:
    """Return torque, lower and upper strength (n, n_j) [N m] of a block.

    Parameters
    ----------
    boxed : Boxed of TorqueTable
    position, velocity : (n, n_s)
        Of the motion's skeleton [rad or m, per s].
    frames : (n, n_f, 4)
        Quaternions xyzw of the motion's frames, world <- frame.
    pelvis : int
        Which of them is the pelvis'.
    net_moment : (n, 3)
        At L5-S1, world frame [N m].
    torque : (n, n_c)
        Of the balanced coordinates [N m].
    """
    table = boxed.content
    n, n_j = len(position), len(table.sign)
    out, lower, upper = np.empty((n, n_j)), np.empty((n, n_j)), np.empty((n, n_j))
    for k in range(n):
        for j in range(n_j):
            if table.of_net_moment[j]:
                x, y, z = _axis(frames[k, pelvis], table.source[j])
                value = x * net_moment[k, 0] + y * net_moment[k, 1] + z * net_moment[k, 2]
            else:
                value = torque[k, table.source[j]]
            out[k, j] = table.sign[j] * value
            angle, speed = 0.0, 0.0
            if table.column[j] >= 0:
                angle = position[k, table.column[j]]
                speed = velocity[k, table.column[j]]
            # A fitted surface may cross zero where the joint has no strength left.
            lower[k, j] = min(_strength(table, 0, j, angle, speed), 0.0)
            upper[k, j] = max(_strength(table, 1, j, angle, speed), 0.0)
    return out, lower, upper
