# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Motion of all segments of the person in the stance frame, feet fixed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca

from lift_predictor.core.models.spatial.parameters import MIRROR, SIDES, SPLINED, unpack
from lift_predictor.core.models.spatial.rotations import Turning
from lift_predictor.core.models.spatial.stance import stance
from lift_predictor.core.models.spatial.stance_motion import (
    hip_flexion_rate,
    leg_motion,
    pelvis_motion,
)

_X, _Y, _Z = range(3)


@dataclass(frozen=True)
class Segment:
    """A moving segment: its frame, and place and acceleration of its origin (3 x 1)."""

    turning: Turning
    place: Any
    acceleration: Any


@dataclass(frozen=True)
class BodyState:
    """Symbolic motion of one instant.

    Attributes
    ----------
    segment : dict of Segment
        All of `parameters.BODIES`.
    hinge : dict of (segment, axis)
        World axis (3 x 1) of each coordinate with published strength, and the segment whose
        origin it passes through and which it moves, by name.
    angle, rate : dict of SX
        Of those coordinates, and angles of the dependent ones [rad], [rad/s].
    hand : tuple of (SX, SX)
        Place and acceleration of right and left grip.
    """

    segment: dict[str, Segment]
    hinge: dict[str, tuple[str, Any]]
    angle: dict[str, Any]
    rate: dict[str, Any]
    hand: tuple[tuple[Any, Any], tuple[Any, Any]]


def body_state(q: Any, dq: Any, ddq: Any, p: Any) -> BodyState:
    """Frames, accelerations and joint axes of one instant.

    Parameters
    ----------
    q, dq, ddq : SX, 26 x 1
        `parameters.SPLINED` and derivatives by time.
    p : SX
        `SpatialParameters.pack`.
    """
    placed = stance(q, p)
    root = pelvis_motion(placed, q, dq, ddq, p)
    own = {name: (q[i], dq[i], ddq[i]) for i, name in enumerate(SPLINED)}
    blocks = unpack(p)
    pelvis = Turning.fixed().joint(_Z, 1.0, *root['turn'])
    pelvis = pelvis.joint(_X, 1.0, *root['list']).joint(_Y, -1.0, *root['tilt'])
    centre, speed, push = root['centre']
    hips = {}
    for side in SIDES:
        arm = pelvis.place([0.0, -MIRROR[side] * blocks['pelvis'][0][0], 0.0])
        hips[side] = (
            centre + arm,
            speed + ca.cross(pelvis.rate, arm),
            push + pelvis.acceleration(arm),
        )
    own |= leg_motion(placed, hips, q, dq, ddq, p)
    builder = _Builder(own)
    builder.segment['pelvis'] = Segment(pelvis, centre, push)
    builder.trunk(blocks)
    hands = tuple(builder.arm(side, blocks) for side in SIDES)
    for index, side in enumerate(SIDES):
        builder.leg(side, index, blocks)
    rate = {name: value[1] for name, value in own.items()}
    for side in SIDES:
        thigh = builder.segment[f'thigh_{side}'].turning
        rate[f'hip_flexion_{side}'] = hip_flexion_rate(pelvis, thigh)
    angle = {name: value[0] for name, value in own.items()} | placed.leg
    return BodyState(builder.segment, builder.hinge, angle, rate, (hands[0], hands[1]))


class _Builder:
    """Adds segments outward from the pelvis and upward from the feet."""

    def __init__(self, own: dict[str, tuple[Any, Any, Any]]) -> None:
        self.own = own
        self.segment: dict[str, Segment] = {}
        self.hinge: dict[str, tuple[str, Any]] = {}

    def _attach(
        self, name: str, parent: str, place: list[Any], joints: list[tuple[str, int, float]]
    ) -> None:
        base = self.segment[parent]
        turning = base.turning
        for coordinate, axis, sign in joints:
            self.hinge[coordinate] = (name, sign * turning.axes[axis])
            turning = turning.joint(axis, sign, *self.own[coordinate])
        arm = base.turning.place(place)
        self.segment[name] = Segment(
            turning, base.place + arm, base.acceleration + base.turning.acceleration(arm)
        )

    def trunk(self, blocks: dict[str, list[list[Any]]]) -> None:
        _, forward, up = blocks['pelvis'][0]
        places = {'lumbar': [forward, 0.0, up], 'thorax': None}
        places['thorax'] = [blocks['spine'][0][0], 0.0, blocks['spine'][0][1]]
        for name, parent in (('lumbar', 'pelvis'), ('thorax', 'lumbar')):
            joints = [
                (f'{name}_extension', _Y, -1.0),
                (f'{name}_bending', _X, 1.0),
                (f'{name}_rotation', _Z, 1.0),
            ]
            place = places[name]
            assert place is not None
            self._attach(name, parent, place, joints)

    def arm(self, side: str, blocks: dict[str, list[list[Any]]]) -> tuple[Any, Any]:
        sign = MIRROR[side]
        half, upper, fore, grip = blocks['arm'][0]
        _, _, forward, up = blocks['spine'][0]
        self._attach(
            f'upper_arm_{side}', 'thorax', [forward, -sign * half, up],
            [(f'arm_flex_{side}', _Y, -1.0), (f'arm_add_{side}', _X, sign),
             (f'arm_rot_{side}', _Z, sign)],
        )  # fmt: skip
        self._attach(
            f'forearm_{side}', f'upper_arm_{side}', [0.0, 0.0, -upper],
            [(f'elbow_flex_{side}', _Y, -1.0), (f'pro_sup_{side}', _Z, sign)],
        )  # fmt: skip
        self._attach(
            f'hand_{side}', f'forearm_{side}', [0.0, 0.0, -fore],
            [(f'wrist_flex_{side}', _X, sign), (f'wrist_dev_{side}', _Y, 1.0)],
        )  # fmt: skip
        hand = self.segment[f'hand_{side}']
        arm = hand.turning.place([0.0, 0.0, -grip])
        return hand.place + arm, hand.acceleration + hand.turning.acceleration(arm)

    def leg(self, side: str, index: int, blocks: dict[str, list[list[Any]]]) -> None:
        """Shank and thigh from the fixed foot up, so that no error of the chain can move it."""
        sign = MIRROR[side]
        thigh, shank = blocks['leg'][0]
        foot = Turning.fixed(blocks['foot_turn'][0][index])
        ankle = ca.vertcat(*blocks['ankle'][index])
        self.segment[f'foot_{side}'] = Segment(foot, ankle, ca.SX(3, 1))
        between = foot.joint(_X, -sign, *self.own[f'subtalar_angle_{side}'])
        lower = between.joint(_Y, 1.0, *self.own[f'ankle_angle_{side}'])
        upper = lower.joint(_Y, -1.0, *self.own[f'knee_angle_{side}'])
        up = lower.place([0.0, 0.0, shank])
        knee = Segment(lower, ankle + up, lower.acceleration(up))
        self.segment[f'shank_{side}'] = knee
        along = upper.place([0.0, 0.0, thigh])
        self.segment[f'thigh_{side}'] = Segment(
            upper, knee.place + along, knee.acceleration + upper.acceleration(along)
        )
        self.hinge[f'ankle_angle_{side}'] = (f'foot_{side}', -between.axes[_Y])
        self.hinge[f'knee_angle_{side}'] = (f'shank_{side}', upper.axes[_Y])
        pelvis = self.segment['pelvis'].turning
        self.hinge[f'hip_flexion_{side}'] = (f'thigh_{side}', -pelvis.axes[_Y])
