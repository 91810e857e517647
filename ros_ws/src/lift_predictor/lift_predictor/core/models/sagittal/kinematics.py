# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Positions of the sagittal chain in NumPy, and inverse kinematics of single postures."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from human_model.typing import Array
from lift_predictor.core.least_squares import minimise
from lift_predictor.core.models.contact import gaps
from lift_predictor.core.models.ranges import hamstring_room
from lift_predictor.core.models.sagittal.parameters import (
    BODIES,
    CIRCLE_BODIES,
    HIP,
    KNEE,
    LiftParameters,
)
from lift_predictor.core.planning.postures import POSTURE_WEIGHT, REACHED


@dataclass(frozen=True)
class ChainPositions:
    """Positions of n postures, (forward, up) [m].

    Attributes
    ----------
    joints : dict of array, shape (n, 2)
        Ankle, knee, hip, lumbar, shoulder, elbow, hand.
    angles : dict of array, shape (n,)
        Segment angles [rad], counter-clockwise from upright standing.
    box : array, shape (n, 2)
        Box centre.
    gaps : array, shape (n, 18)
        Distance of the box from each collision circle (equation 4.5) [m]; infinite for an unused
        circle.
    hamstrings : array, shape (n,)
        Flexion of the hip that is left [rad].
    centre_of_mass : array, shape (n,)
        Of body and box, forward.
    """

    joints: dict[str, Array]
    angles: dict[str, Array]
    box: Array
    gaps: Array
    hamstrings: Array
    centre_of_mass: Array


def chain_positions(
    q: Array, parameters: LiftParameters, grip: Array | None = None
) -> ChainPositions:
    """Positions of postures q (n, 6) [rad]; the box is at the model's or a given grip [m]."""
    q = np.atleast_2d(q)
    body = dict(zip(BODIES, parameters.body, strict=True))
    shank = -q[:, 5]
    thigh = shank + q[:, 4]
    pelvis = thigh - q[:, 3]
    trunk = pelvis + q[:, 0]
    upper_arm = trunk + q[:, 1]
    forearm = upper_arm + q[:, 2]
    angles = {
        'foot': np.zeros(len(q)), 'shank': shank, 'thigh': thigh, 'pelvis': pelvis,
        'trunk': trunk, 'upper_arm': upper_arm, 'forearm': forearm,
    }  # fmt: skip

    def turned(name: str, offset: Array) -> Array:
        c, s = np.cos(angles[name]), np.sin(angles[name])
        return np.stack((c * offset[0] - s * offset[1], s * offset[0] + c * offset[1]), axis=1)

    ankle = np.tile(np.asarray(parameters.ankle, dtype=float), (len(q), 1))
    knee = ankle - turned('shank', body['shank'][4:])
    hip = knee - turned('thigh', body['thigh'][4:])
    lumbar = hip + turned('pelvis', body['pelvis'][4:])
    shoulder = lumbar + turned('trunk', body['trunk'][4:])
    elbow = shoulder + turned('upper_arm', body['upper_arm'][4:])
    hand = elbow + turned('forearm', body['forearm'][4:])
    joints = {
        'ankle': ankle, 'knee': knee, 'hip': hip, 'lumbar': lumbar, 'shoulder': shoulder,
        'elbow': elbow, 'hand': hand,
    }  # fmt: skip
    origin = {
        'foot': ankle, 'shank': knee, 'thigh': hip, 'pelvis': hip, 'trunk': lumbar,
        'upper_arm': shoulder, 'forearm': elbow,
    }  # fmt: skip
    box = (hand if grip is None else grip) + parameters.box_from_hand
    centres = [
        origin[name] + turned(name, row[:2])
        for name, row in zip(CIRCLE_BODIES, parameters.circle, strict=True)
    ]
    offset = np.stack(centres, axis=1) - box[:, None]
    free = gaps(offset, parameters.box_half, parameters.circle[:, 2])
    moment = parameters.box_mass * hand[:, 0]
    for name in BODIES:
        centre = origin[name] + turned(name, body[name][1:3])
        moment = moment + body[name][0] * centre[:, 0]
    room = hamstring_room(q[:, HIP], q[:, KNEE], parameters.hip_range)
    return ChainPositions(joints, angles, box, free, room, moment / parameters.total_mass)


def reach(
    grip: Array, reference: Array, lower: Array, upper: Array, parameters: LiftParameters
) -> tuple[Array, float]:
    """Find the posture that brings the grip nearest to a point.

    If it can be reached so, the posture is clear of the box, balanced, and near a reference.

    Parameters
    ----------
    grip : array, shape (2,)
        Where the hands should be [m].
    reference : array, shape (6,)
        Posture to stay near [rad].
    lower, upper : array, shape (6,)
        Bounds of the posture [rad].
    parameters : LiftParameters
        Person and task.

    Returns
    -------
    posture : array, shape (6,)
        [rad].
    distance : float
        Remaining distance of the grip [m].
    """
    rear, front = parameters.support

    def residual(q: Array, secondary: float) -> Array:
        state = chain_positions(q, parameters)
        forward = state.centre_of_mass
        unbalanced = np.maximum(np.maximum(rear - forward, forward - front), 0.0)
        beyond = np.minimum(state.hamstrings, 0.0)
        wishes = np.column_stack((np.minimum(state.gaps, 0.0), unbalanced, beyond))
        apart = state.joints['hand'] - grip
        return np.hstack((apart, secondary * wishes, POSTURE_WEIGHT * (q - reference)))

    posture = minimise(partial(residual, secondary=1.0), reference, lower, upper)
    rest = residual(posture[None], 1.0)[0, : -len(posture)]
    if np.abs(rest).max() <= REACHED:
        return posture, float(np.linalg.norm(rest[:2]))
    if not np.isfinite(reference).all():  # a place so far away that its arithmetic overflows
        return np.clip(np.nan_to_num(reference), lower, upper), np.inf
    # Loads for long, and most postures do not need it.
    from scipy.optimize import least_squares

    posture, distance = np.clip(reference, lower, upper), np.inf
    for secondary in (1.0, 0.0):

        def one(q: Array, secondary: float = secondary) -> Array:
            return np.asarray(residual(q[None], secondary)[0])

        solution = least_squares(one, posture, bounds=(lower - 1e-9, upper + 1e-9), xtol=1e-10)
        posture = np.clip(solution.x, lower, upper)
        hand = chain_positions(posture, parameters).joints['hand'][0]
        distance = float(np.linalg.norm(hand - grip))
        if distance <= REACHED:
            break
    return posture, distance


def pelvis_motion(
    q: Array, dq: Array, ddq: Array, parameters: LiftParameters
) -> tuple[Array, Array, Array]:
    """Pelvis coordinates (tx, ty, tilt) that follow from fixed feet, with two derivatives.

    Parameters
    ----------
    q, dq, ddq : array, shape (n, 6)
        [rad], [rad/s], [rad/s^2].
    parameters : LiftParameters
        Person and task.

    Returns
    -------
    tuple of array, shape (n, 3)
        Position [m, m, rad], velocity, acceleration.
    """
    body = dict(zip(BODIES, parameters.body, strict=True))
    to_shank = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0])
    to_thigh = np.array([0.0, 0.0, 0.0, 0.0, 1.0, -1.0])
    to_pelvis = np.array([0.0, 0.0, 0.0, -1.0, 1.0, -1.0])
    position = np.zeros((len(q), 3))
    velocity, acceleration = np.zeros_like(position), np.zeros_like(position)
    position[:, :2] = parameters.ankle
    for name, row in (('shank', to_shank), ('thigh', to_thigh)):
        angle, rate, change = q @ row, (dq @ row)[:, None], (ddq @ row)[:, None]
        x, y = -body[name][4:]
        c, s = np.cos(angle), np.sin(angle)
        arm = np.stack((c * x - s * y, s * x + c * y), axis=1)
        across = np.stack((-arm[:, 1], arm[:, 0]), axis=1)
        position[:, :2] += arm
        velocity[:, :2] += rate * across
        acceleration[:, :2] += change * across - rate**2 * arm
    for target, source in ((position, q), (velocity, dq), (acceleration, ddq)):
        target[:, 2] = source @ to_pelvis
    return position, velocity, acceleration
