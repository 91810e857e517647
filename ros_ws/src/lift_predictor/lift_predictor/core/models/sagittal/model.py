# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Sagittal dynamics of body and box with the feet as the root of the chain.

The feet are flat and fixed (equation 4.4), so the chain is built from the ankle up and equation
4.4 holds exactly: the six joints above are the only coordinates, the pelvis follows. Angles are
measured counter-clockwise in the (forward, up) plane, which is OpenSim's positive rotation about
the axis to the right.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca

from lift_predictor.core.models.contact import clearance
from lift_predictor.core.models.passive import passive_hip_moment
from lift_predictor.core.models.sagittal.parameters import (
    BODIES,
    CIRCLE_BODIES,
    HIP,
    KNEE,
    unpack,
)


@dataclass(frozen=True)
class ChainState:
    """Symbolic kinematics and loads of one instant; vectors are 2 x 1 (forward, up)."""

    position: dict[str, Any]
    acceleration: dict[str, Any]
    angle: dict[str, Any]
    torque: Any
    ground_force: Any
    ground_moment: Any
    hand_force: Any
    clearance: Any


def chain_state(q: Any, dq: Any, ddq: Any, s: Any, p: Any) -> ChainState:
    """Kinematics from the ankle to the grip and Newton-Euler dynamics back down.

    Parameters
    ----------
    q, dq, ddq : SX, 6 x 1
        Joint coordinates of `parameters.JOINTS` [rad], [rad/s], [rad/s^2].
    s : SX, 1 x 1
        Mass in the hands [kg].
    p : SX
        Vector of `LiftParameters.pack`.

    Returns
    -------
    ChainState
        `torque` (6): generalised forces of the joints, both limbs together [N m]. `ground_force`
        (2): force of the ground [N]; `ground_moment`: its moment about the point of the ground
        below the laboratory's origin, so that the zero-moment point is moment / vertical force.
        `hand_force` (2): force of the box on both hands [N]. `clearance`: `contact.clearance` of
        each collision circle (4.5); positive means clear, 1 for an unused circle.
    """
    blocks = unpack(p)
    body = {name: blocks['body'][i] for i, name in enumerate(BODIES)}
    gravity = blocks['gravity'][0][0]
    lumbar, arm, elbow, hip, knee, ankle = ((q[i], dq[i], ddq[i]) for i in range(6))
    shank = _add((0.0, 0.0, 0.0), ankle, -1.0)
    thigh = _add(shank, knee, 1.0)
    pelvis = _add(thigh, hip, -1.0)
    trunk = _add(pelvis, lumbar, 1.0)
    upper_arm = _add(trunk, arm, 1.0)
    forearm = _add(upper_arm, elbow, 1.0)
    angle = {
        'foot': (0.0, 0.0, 0.0),
        'shank': shank,
        'thigh': thigh,
        'pelvis': pelvis,
        'trunk': trunk,
        'upper_arm': upper_arm,
        'forearm': forearm,
    }

    zero = ca.SX.zeros(2)
    position = {'ankle': ca.vertcat(*blocks['ankle'][0])}
    acceleration = {'ankle': zero}

    def step(joint: str, new: str, segment: str, sign: float) -> None:
        arm_vector, arm_acceleration = _rotating(body[segment][4:6], angle[segment])
        position[new] = position[joint] + sign * arm_vector
        acceleration[new] = acceleration[joint] + sign * arm_acceleration

    step('ankle', 'knee', 'shank', -1.0)
    step('knee', 'hip', 'thigh', -1.0)
    step('hip', 'lumbar', 'pelvis', 1.0)
    step('lumbar', 'shoulder', 'trunk', 1.0)
    step('shoulder', 'elbow', 'upper_arm', 1.0)
    step('elbow', 'hand', 'forearm', 1.0)

    origin = {
        'foot': 'ankle',
        'shank': 'knee',
        'thigh': 'hip',
        'pelvis': 'hip',
        'trunk': 'lumbar',
        'upper_arm': 'shoulder',
        'forearm': 'elbow',
    }
    up = ca.vertcat(0.0, 1.0)
    # The box is a point mass at the grip: it is carried level, and its weight and inertia act at
    # the hands during the whole lift.
    hand_force = -s[0] * (acceleration['hand'] + gravity * up)
    force = -hand_force
    moment = _cross(position['hand'], force)
    load = {}
    for segment in reversed(BODIES):
        start = origin[segment]
        lever, relative = _rotating(body[segment][1:3], angle[segment])
        centre = position[start] + lever
        inertial = body[segment][0] * (acceleration[start] + relative + gravity * up)
        force = force + inertial
        moment = moment + _cross(centre, inertial) + body[segment][3] * angle[segment][2]
        load[segment] = (force, moment)

    def at_joint(segment: str, joint: str) -> Any:
        """Moment that everything from the grip down to the segment needs at its lower joint."""
        total, about_origin = load[segment]
        return about_origin - _cross(position[joint], total)

    # A coordinate's generalised force is the torque on the OpenSim child: the upper body of
    # lumbar and arm joints, the lower one of hip and ankle; the knee's flexion turns the shank
    # backwards, which flips the sign again.
    torque = ca.vertcat(
        at_joint('trunk', 'lumbar'),
        at_joint('upper_arm', 'shoulder'),
        at_joint('forearm', 'elbow'),
        -at_joint('pelvis', 'hip'),
        at_joint('thigh', 'knee'),
        -at_joint('shank', 'ankle'),
    )
    ground = ca.vertcat(0.0, blocks['ground_height'][0][0])
    return ChainState(
        position=position,
        acceleration=acceleration,
        angle=angle,
        torque=torque,
        ground_force=force,
        ground_moment=moment - _cross(ground, force),
        hand_force=hand_force,
        clearance=_clearance(blocks, position, angle, origin),
    )


def strength(q: Any, v: Any, coefficients: list[Any]) -> Any:
    """Dynamic joint strength of equations 2.14 and 2.17 in a form that cannot overflow.

    Parameters
    ----------
    q, v : SX
        Joint angle [rad] and angular velocity [rad/s].
    coefficients : list of 8 SX
        c1 to c8; c3, c4 [rad], c6, c7 [rad/s], the others [N m].

    Notes
    -----
    4 exp(-u) / (1 + exp(-u))^2 = 1 - tanh(u/2)^2.
    """
    c1, c2, c3, c4, c5, c6, c7, c8 = coefficients
    in_angle = 1.0 - ca.tanh((q - c3) / (2.0 * c4)) ** 2
    in_speed = 1.0 - ca.tanh((v - c6) / (2.0 * c7)) ** 2
    return c1 + c2 * in_angle + c5 * in_speed + c8 * in_angle * in_speed


def torque_limits(q: Any, dq: Any, p: Any) -> tuple[Any, Any]:
    """Lower and upper limits of the net torques [N m], 6 x 1 each.

    The dynamic limits of equations 2.18 and 2.15, and the passive moment of both hips.
    """
    blocks = unpack(p)
    lower = [strength(q[i], dq[i], row) for i, row in enumerate(blocks['strength_lower'])]
    upper = [strength(q[i], dq[i], row) for i, row in enumerate(blocks['strength_upper'])]
    passive = 2.0 * passive_hip_moment(q[HIP], q[KNEE], ca.exp)
    lower[HIP] += passive
    upper[HIP] += passive
    return ca.vertcat(*lower), ca.vertcat(*upper)


def _add(base: tuple[Any, ...], joint: tuple[Any, ...], sign: float) -> tuple[Any, ...]:
    return tuple(b + sign * j for b, j in zip(base, joint, strict=True))


def _rotating(offset: list[Any], angle: tuple[Any, ...]) -> tuple[Any, Any]:
    """Offset turned into the world and its acceleration relative to the segment's origin."""
    cosine, sine = ca.cos(angle[0]), ca.sin(angle[0])
    x = cosine * offset[0] - sine * offset[1]
    y = sine * offset[0] + cosine * offset[1]
    rate2 = angle[1] * angle[1]
    return (ca.vertcat(x, y), ca.vertcat(-angle[2] * y - rate2 * x, angle[2] * x - rate2 * y))


def _cross(a: Any, b: Any) -> Any:
    return a[0] * b[1] - a[1] * b[0]


def _clearance(
    blocks: dict[str, Any], position: dict[str, Any], angle: dict[str, Any], origin: dict[str, str]
) -> Any:
    box = position['hand'] + ca.vertcat(*blocks['box_from_hand'][0])
    rows = []
    table = zip(CIRCLE_BODIES, blocks['circle'], blocks['semi_axes'], strict=True)
    for segment, (x, y, radius), axes in table:
        offset, _ = _rotating([x, y], angle[segment])
        gap = position[origin[segment]] + offset - box
        used = radius > 0.0
        lengths = [ca.if_else(used, axis, 1.0) for axis in axes]
        # An unused circle reads "clear" whatever the posture.
        clear = clearance([gap[0], gap[1]], lengths, ca.sqrt)
        rows.append(ca.if_else(used, clear, 1.0))
    return ca.vertcat(*rows)
