# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Velocities and accelerations of pelvis and legs above fixed feet, in closed form.

The chain rule on `stance`, written out: what a general differentiation makes of it is three times
as long, and it is evaluated most of all.
"""

from __future__ import annotations

from typing import Any

import casadi as ca

from lift_predictor.core.models.spatial.parameters import SIDES, unpack
from lift_predictor.core.models.spatial.rotations import Turning
from lift_predictor.core.models.spatial.stance import Stance

Triple = tuple[Any, Any, Any]
"""Value, rate and acceleration."""


def pelvis_motion(placed: Stance, q: Any, dq: Any, ddq: Any, p: Any) -> dict[str, Triple]:
    """Middle of the hips (3 x 1) as `centre`, and `turn`, `list`, `tilt`.

    Parameters
    ----------
    placed : Stance
        Posture at q.
    q, dq, ddq : SX, at least 6 x 1
        `parameters.ROOT` and derivatives by time.
    p : SX
        `SpatialParameters.pack`.
    """
    blocks = unpack(p)
    half = blocks['pelvis'][0][0]
    thigh, shank = blocks['leg'][0]
    right, left = (ca.vertcat(*row) for row in blocks['ankle'])
    ankle, hip, aside, turn, *knees = ((q[i], dq[i], ddq[i]) for i in range(6))
    knee = tuple(0.5 * (a + b) for a, b in zip(*knees, strict=True))
    forward = _forward(ankle, knee, thigh, shank)
    tilt = tuple(k - a - h for k, a, h in zip(knee, ankle, hip, strict=True))

    # Half squared distances of the hips from the ankles, differentiated.
    c_rate, c_change = [], []
    for angle, rate, change in knees:
        sine, cosine = ca.sin(angle), ca.cos(angle)
        c_rate.append(-thigh * shank * sine * rate)
        c_change.append(-thigh * shank * (sine * change + cosine * rate**2))

    c, s = ca.cos(turn[0]), ca.sin(turn[0])
    cl, sl = ca.cos(placed.list_), ca.sin(placed.list_)
    line = ca.vertcat(-s * cl, c * cl, sl)
    by_turn = ca.vertcat(-c * cl, -s * cl, 0.0)
    by_list = ca.vertcat(s * sl, -c * sl, cl)
    by_both = ca.vertcat(c * sl, s * sl, 0.0)
    place = placed.centre - 0.5 * (right + left)
    lever = half * line - 0.5 * (left - right)
    # (P + v)^2 and (P - v)^2 of `stance`, half the sum and half the difference, by z and list.
    matrix = (place[2], half * ca.dot(lever, by_list), lever[2], half * ca.dot(place, by_list))

    def solve(first: Any, second: Any) -> tuple[Any, Any]:
        a, b, d, e = matrix
        determinant = a * e - b * d
        return (first * e - b * second) / determinant, (a * second - first * d) / determinant

    known = half * turn[1] * by_turn
    level = ca.vertcat(forward[1], aside[1], 0.0)
    z_rate, list_rate = solve(
        0.5 * (c_rate[1] + c_rate[0]) - ca.dot(place, level) - ca.dot(lever, known),
        0.5 * (c_rate[1] - c_rate[0]) - ca.dot(lever, level) - ca.dot(place, known),
    )
    speed = ca.vertcat(forward[1], aside[1], z_rate)
    swing = known + half * list_rate * by_list
    known = half * (
        turn[2] * by_turn
        - turn[1] ** 2 * ca.vertcat(line[0], line[1], 0.0)
        + 2.0 * turn[1] * list_rate * by_both
        - list_rate**2 * line
    )
    level = ca.vertcat(forward[2], aside[2], 0.0)
    z_change, list_change = solve(
        0.5 * (c_change[1] + c_change[0])
        - ca.sumsqr(speed)
        - ca.sumsqr(swing)
        - ca.dot(place, level)
        - ca.dot(lever, known),
        0.5 * (c_change[1] - c_change[0])
        - 2.0 * ca.dot(speed, swing)
        - ca.dot(lever, level)
        - ca.dot(place, known),
    )
    return {
        'centre': (placed.centre, speed, ca.vertcat(forward[2], aside[2], z_change)),
        'turn': turn,
        'list': (placed.list_, list_rate, list_change),
        'tilt': (tilt[0], tilt[1], tilt[2]),
    }


def leg_motion(
    placed: Stance, hips: dict[str, Triple], q: Any, dq: Any, ddq: Any, p: Any
) -> dict[str, Triple]:
    """Ankle, subtalar and knee angles of both legs by name.

    `hips` is the motion of both hip joints (3 x 1), by side.
    """
    blocks = unpack(p)
    thigh, shank = blocks['leg'][0]
    result: dict[str, Triple] = {}
    for index, side in enumerate(SIDES):
        foot = Turning.fixed(blocks['foot_turn'][0][index])
        knee = (q[4 + index], dq[4 + index], ddq[4 + index])
        ankle = ca.vertcat(*blocks['ankle'][index])
        arm = [ca.vertcat(*(ca.dot(axis, part) for axis in foot.axes)) for part in (
            hips[side][0] - ankle, hips[side][1], hips[side][2]
        )]  # fmt: skip
        (x, y, z), (dx, dy, dz), (ddx, ddy, ddz) = ((a[0], a[1], a[2]) for a in arm)
        square = y**2 + z**2
        reach = ca.sqrt(square)
        inward = (z * dy - y * dz) / square
        d_reach = (y * dy + z * dz) / reach
        bent = (z * ddy - y * ddz) / square - 2.0 * inward * d_reach / reach
        dd_reach = (y * ddy + z * ddz) / reach + reach * inward**2
        whole = x**2 + square
        lean = (reach * dx - x * d_reach) / whole
        d_lean = (reach * ddx - x * dd_reach - 2.0 * lean * (x * dx + reach * d_reach)) / whole
        sine, cosine = ca.sin(knee[0]), ca.cos(knee[0])
        slope = thigh * (thigh + shank * cosine) / whole
        d_slope = thigh * shank * sine * (thigh**2 - shank**2) / whole**2
        sign = 1.0 if side == 'r' else -1.0
        result[f'subtalar_angle_{side}'] = (
            placed.leg[f'subtalar_angle_{side}'], sign * inward, sign * bent,
        )  # fmt: skip
        result[f'ankle_angle_{side}'] = (
            placed.leg[f'ankle_angle_{side}'],
            lean + slope * knee[1],
            d_lean + slope * knee[2] + d_slope * knee[1] ** 2,
        )
        result[f'knee_angle_{side}'] = knee
    return result


def hip_flexion_rate(pelvis: Turning, thigh: Turning) -> Any:
    """Rate of the hip's flexion, from how the thigh turns against the pelvis.

    The axes of flexion (-y of the pelvis), adduction and rotation (z of the thigh) are not
    orthogonal in general: the part along flexion is taken across both others.
    """
    turning = thigh.rate - pelvis.rate
    flexion, rotation = -pelvis.axes[1], thigh.axes[2]
    adduction = ca.cross(rotation, flexion)
    across = ca.cross(adduction, rotation)
    return ca.dot(turning, across) / ca.dot(flexion, across)


def _forward(ankle: Triple, knee: Any, thigh: Any, shank: Any) -> Triple:
    """Place of the hips' middle before the ankles' of `stance`."""
    upper = tuple(a - k for a, k in zip(ankle, knee, strict=True))
    value, rate, change = 0.0, 0.0, 0.0
    for length, (angle, speed, push) in ((shank, ankle), (thigh, upper)):
        sine, cosine = ca.sin(angle), ca.cos(angle)
        value += length * sine
        rate += length * cosine * speed
        change += length * (cosine * push - sine * speed**2)
    return value, rate, change
