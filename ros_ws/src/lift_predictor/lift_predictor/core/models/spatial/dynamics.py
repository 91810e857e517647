# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Newton-Euler dynamics of person and box: joint torques, hands, and the ground under each foot.

Torques are those of equations 3.4 to 3.8 (the same generalised forces by another recursion).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import casadi as ca

from lift_predictor.core.models.spatial.body import BodyState
from lift_predictor.core.models.spatial.parameters import BODIES, SIDES, STRONG, unpack

_OUTWARD: Final = {
    **{f'{part}_{s}': f'{of}_{s}' for s in SIDES for part, of in (
        ('hand', 'forearm'), ('forearm', 'upper_arm'), ('foot', 'shank'), ('shank', 'thigh'),
    )},
    'upper_arm_r': 'thorax',
    'upper_arm_l': 'thorax',
    'thorax': 'lumbar',
}  # fmt: skip
"""Segment towards the pelvis of each one whose load is handed on, from the ends inward."""


@dataclass(frozen=True)
class Loads:
    """Symbolic loads of one instant, stance frame.

    Attributes
    ----------
    torque : SX, 26 x 1
        Of `parameters.STRONG` [N m].
    ground_force : tuple of SX, 3 x 1
        On right and left foot [N].
    free_moment : tuple of SX
        About the vertical, on right and left foot [N m].
    fraction : SX
        Where both centres of pressure are: part of the way from heel to tip of the toes.
    pressure : tuple of SX, 3 x 1
        Right and left centre of pressure [m].
    hand_force : tuple of SX, 3 x 1
        Of the box on right and left hand [N].
    """

    torque: Any
    ground_force: tuple[Any, Any]
    free_moment: tuple[Any, Any]
    fraction: Any
    pressure: tuple[Any, Any]
    hand_force: tuple[Any, Any]


def loads(state: BodyState, box_mass: Any, p: Any) -> Loads:
    """Compute the loads of one instant.

    Parameters
    ----------
    state : BodyState
        Motion.
    box_mass : SX
        [kg].
    p : SX
        `SpatialParameters.pack`.
    """
    blocks = unpack(p)
    gravity = blocks['gravity'][0][0]
    hands = _hand_forces(state, box_mass, gravity, blocks)
    force, moment, centre = {}, {}, ca.SX(3, 1)
    for name, row in zip(BODIES, blocks['body'], strict=True):
        segment = state.segment[name]
        arm = segment.turning.place(row[1:4])
        place = segment.place + arm
        push = segment.acceleration + segment.turning.acceleration(arm)
        force[name] = row[0] * (push + ca.vertcat(0.0, 0.0, gravity))
        moment[name] = ca.cross(place, force[name])
        if not name.startswith('foot'):
            moment[name] += segment.turning.spin_moment(row[4:])
        centre += row[0] * place
    for side, (place, _), hand in zip(SIDES, state.hand, hands, strict=True):
        force[f'hand_{side}'] -= hand
        moment[f'hand_{side}'] -= ca.cross(place, hand)

    total = sum(force.values(), ca.SX(3, 1)), sum(moment.values(), ca.SX(3, 1))
    height = centre[2] / sum(row[0] for row in blocks['body'])
    ground, free, fraction, pressure = _split(*total, height, blocks)
    for index, side in enumerate(SIDES):
        force[f'foot_{side}'] -= ground[index]
        moment[f'foot_{side}'] -= ca.cross(pressure[index], ground[index])
        moment[f'foot_{side}'] -= ca.vertcat(0.0, 0.0, free[index])
    for name, inner in _OUTWARD.items():
        force[inner] += force[name]
        moment[inner] += moment[name]
    torque = []
    for coordinate in STRONG:
        name, axis = state.hinge[coordinate]
        # The ankle, knee and hip are where their distal segment begins: the shank's origin in
        # `BodyState` is the knee, the thigh's the hip.
        at = state.segment[name].place
        torque.append(ca.dot(axis, moment[name] - ca.cross(at, force[name])))
    return Loads(ca.vertcat(*torque), ground, free, fraction, pressure, hands)


def _hand_forces(
    state: BodyState, mass: Any, gravity: Any, blocks: dict[str, Any]
) -> tuple[Any, Any]:
    """Force of the box on each hand.

    The box is a uniform cuboid that stays level. Each hand has half of its weight and inertia;
    its turning about the vertical is done by two opposite level forces across the line of the
    hands. (Two forces cannot turn it about that line: like in the sagittal model the box's centre
    is taken at the grip.)
    """
    (right, push_r), (left, push_l) = state.hand
    mean = 0.5 * (push_r + push_l) + ca.vertcat(0.0, 0.0, gravity)
    line = left - right
    across = ca.vertcat(-line[1], line[0], 0.0) / ca.sqrt(line[0] ** 2 + line[1] ** 2)
    turning = blocks['box_turning'][0][0] * ca.dot(across, push_l - push_r) * across
    return -mass * (0.5 * mean - turning), -mass * (0.5 * mean + turning)


def _split(
    force: Any, moment: Any, height: Any, blocks: dict[str, Any]
) -> tuple[tuple[Any, Any], tuple[Any, Any], Any, tuple[Any, Any]]:
    """Divide the ground's force and its moment about the origin between the feet.

    Both centres of pressure are at the same fraction of the way from heel to tip of the toes of
    their foot and their weighted mean is that of the whole, which determines the fraction and the
    load of each foot: the foot nearer to the zero-moment point carries the larger part. Horizontal
    force and free moment are shared like the load; each foot's force leans inwards
    (`inward_lean`), as it does when standing astride.
    """
    heel, along = [], []
    back, front = blocks['sole'][0]
    for ankle, turn in zip(blocks['ankle'], blocks['foot_turn'][0], strict=True):
        direction = ca.vertcat(ca.cos(turn), ca.sin(turn))
        heel.append(ca.vertcat(ankle[0], ankle[1]) + back * direction)
        along.append((front - back) * direction)
    zmp = ca.vertcat(-moment[1], moment[0]) / force[2]
    mean_heel, mean_along = 0.5 * (heel[0] + heel[1]), 0.5 * (along[0] + along[1])
    apart, spread = heel[0] - heel[1], along[0] - along[1]
    rest = zmp - mean_heel
    # Zero of the cross product of (rest - fraction mean_along) and (apart + fraction spread);
    # the root that stays for a spread of zero.
    c0 = _cross(rest, apart)
    c1 = _cross(rest, spread) - _cross(mean_along, apart)
    c2 = -_cross(mean_along, spread)
    fraction = -2.0 * c0 / (c1 + ca.sqrt(c1**2 - 4.0 * c0 * c2))
    between = apart + fraction * spread
    load = 0.5 + ca.dot(rest - fraction * mean_along, between) / ca.sumsqr(between)
    pressure = [ca.vertcat(h + fraction * a, 0.0) for h, a in zip(heel, along, strict=True)]
    part = (load, 1.0 - load)
    inward = blocks['inward_lean'][0][0] * force[2] * part[0] * part[1] / height
    lean = inward * (pressure[1] - pressure[0])
    ground = part[0] * force + lean, part[1] * force - lean
    free = moment[2] - sum(
        _cross(point[:2], f[:2]) for point, f in zip(pressure, ground, strict=True)
    )
    return ground, (part[0] * free, part[1] * free), fraction, (pressure[0], pressure[1])


def _cross(a: Any, b: Any) -> Any:
    return a[0] * b[1] - a[1] * b[0]
