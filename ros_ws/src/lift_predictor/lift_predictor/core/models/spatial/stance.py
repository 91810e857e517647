# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Pelvis and legs above fixed flat feet, in closed form (feet-contacting position, section 3.3).

The root of the motion is not the pelvis but six numbers that keep both feet where they are:
both knee angles set the distances of the hips from the ankles, which gives the pelvis its height
and list; the hips' middle and the turn of the line of the hips are coordinates of their own. As
the knees are coordinates and no result, a straight knee is not singular.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import casadi as ca

from lift_predictor.core.models.spatial.parameters import MIRROR, SIDES, unpack

LIST_STEPS: Final = 3
"""Newton steps for the list of the pelvis: from a list of 30 deg the third leaves 1e-14."""


@dataclass(frozen=True)
class Stance:
    """Symbolic posture of pelvis and legs.

    Attributes
    ----------
    centre : SX, 3 x 1
        Middle of the hips in the stance frame [m].
    turn, list_, tilt : SX
        The pelvis turns about z by turn, about x by list_, about -y by tilt, in this order
        (other than the skeleton's tilt, list, rotation) [rad].
    leg : dict of SX
        `DEPENDENT` leg coordinates by name [rad].
    """

    centre: Any
    turn: Any
    list_: Any
    tilt: Any
    leg: dict[str, Any]


def stance(root: Any, p: Any) -> Stance:
    """Place pelvis and legs.

    Parameters
    ----------
    root : SX, 6 x 1
        `parameters.ROOT`.
    p : SX
        `SpatialParameters.pack`.
    """
    blocks = unpack(p)
    half = blocks['pelvis'][0][0]
    thigh, shank = blocks['leg'][0]
    right, left = (ca.vertcat(*row) for row in blocks['ankle'])
    middle, apart = 0.5 * (right + left), 0.5 * (left - right)
    ankle, hip, aside, turn, *knees = (root[i] for i in range(6))
    knee = 0.5 * (knees[0] + knees[1])
    forward = shank * ca.sin(ankle) + thigh * ca.sin(ankle - knee)
    tilt = knee - ankle - hip
    square = [thigh**2 + shank**2 + 2.0 * thigh * shank * ca.cos(k) for k in knees]
    height, sine = _list(forward, aside, turn, square, half, apart)
    list_ = ca.asin(sine)
    centre = middle + ca.vertcat(forward, aside, height)

    axes = _pelvis_axes(turn, list_, tilt)
    leg: dict[str, Any] = {}
    for index, side in enumerate(SIDES):
        outward = -MIRROR[side] * half * axes[1]
        foot = blocks['foot_turn'][0][index]
        leg |= _leg(
            centre + outward - (right, left)[index], foot, knees[index], axes, (thigh, shank), side
        )
    return Stance(centre, turn, list_, tilt, leg)


def _list(x: Any, y: Any, turn: Any, square: list[Any], half: Any, apart: Any) -> tuple[Any, Any]:
    """Height of the hips' middle over the ankles [m] and sine of the pelvis' list.

    With P from the ankles' to the hips' middle, e the line of the hips to the left, b its half
    length, D half the way from right to left ankle and v = b e - D, the distances are
    |P + v| = d_left, |P - v| = d_right, that is P v = (d_left^2 - d_right^2) / 4 and
    |P|^2 + |v|^2 = (d_left^2 + d_right^2) / 2. The second gives P_z for a list, the first is
    solved for the list by Newton's method.
    """
    c, s = ca.cos(turn), ca.sin(turn)
    across = half * (c * y - s * x)
    along = half * (c * apart[1] - s * apart[0])
    target = 0.25 * (square[1] - square[0]) + x * apart[0] + y * apart[1]
    rest = 0.5 * (square[0] + square[1]) - x**2 - y**2 - half**2 - ca.sumsqr(apart)

    def height(cosine: Any) -> Any:
        return ca.sqrt(rest + 2.0 * cosine * along)

    sine = (target - across) / (half * height(1.0))
    for _ in range(LIST_STEPS):
        cosine = ca.sqrt(1.0 - sine**2)
        z = height(cosine)
        slope = -sine / cosine
        value = half * z * sine + cosine * across - target
        sine = sine - value / (half * z + half * sine * along * slope / z + across * slope)
    return height(ca.sqrt(1.0 - sine**2)), sine


def _pelvis_axes(turn: Any, list_: Any, tilt: Any) -> tuple[Any, Any, Any]:
    ct, st, cl, sl = ca.cos(turn), ca.sin(turn), ca.cos(list_), ca.sin(list_)
    level = ca.vertcat(ct, st, 0.0)
    left = ca.vertcat(-st * cl, ct * cl, sl)
    up = ca.vertcat(st * sl, -ct * sl, cl)
    c, s = ca.cos(tilt), ca.sin(tilt)
    return c * level + s * up, left, c * up - s * level


def _leg(
    hip: Any, foot: Any, knee: Any, pelvis: tuple[Any, ...], lengths: tuple[Any, Any], side: str
) -> dict[str, Any]:
    """Angles of a leg whose hip is at a place from its ankle (world axes), feet flat."""
    thigh, shank = lengths
    c, s = ca.cos(foot), ca.sin(foot)
    x, y, z = c * hip[0] + s * hip[1], c * hip[1] - s * hip[0], hip[2]
    inside = MIRROR[side] * ca.atan2(y, z)
    reach = ca.sqrt(y**2 + z**2)
    ankle = ca.atan2(x, reach) + ca.atan2(thigh * ca.sin(knee), shank + thigh * ca.cos(knee))
    # Axes of the thigh: the foot's, turned by subtalar, ankle and knee angle.
    lean = ankle - knee
    cosine, sine = z / reach, y / reach
    along, across = ca.vertcat(c, s, 0.0), ca.vertcat(-s, c, 0.0)
    up = sine * across + cosine * ca.vertcat(0.0, 0.0, 1.0)
    aside = cosine * across - sine * ca.vertcat(0.0, 0.0, 1.0)
    forward = ca.cos(lean) * along - ca.sin(lean) * up
    axis = ca.sin(lean) * along + ca.cos(lean) * up
    tx, ty, tz = (ca.dot(own, axis) for own in pelvis)
    turned = ca.dot(pelvis[1], forward), ca.dot(pelvis[1], aside)
    return {
        f'hip_flexion_{side}': ca.atan2(-tx, tz),
        f'hip_adduction_{side}': -MIRROR[side] * ca.atan2(ty, ca.sqrt(tx**2 + tz**2)),
        f'hip_rotation_{side}': MIRROR[side] * ca.atan2(turned[0], turned[1]),
        f'ankle_angle_{side}': ankle,
        f'subtalar_angle_{side}': inside,
    }
