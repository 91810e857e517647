# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A motion of the sagittal model as body motion in the laboratory, with all forces on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from human_model.frames import matrix_from_quaternion, quaternion_from_matrix
from human_model.motion import POINTS, BodyMotion
from human_model.typing import Array
from lift_predictor.core.models.sagittal.evaluation import SagittalLoads
from lift_predictor.core.models.sagittal.kinematics import pelvis_motion
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.task import SagittalTask


def mtp_torque(task: SagittalTask, loads: SagittalLoads) -> Array:
    """Torque of both metatarsophalangeal joints (n,) [N m], dorsiflexion positive.

    The feet are flat: the ground's force acts on the hindfoot while the zero-moment point is
    behind the joint, and on the toes when it is before it. The weight of the toes themselves is
    carried by the ground.
    """
    neutral = task.person.neutral
    joint = task.parameters.ankle[0] + (neutral['mtp_r'] - neutral['ankle_r'])[0]
    height = float((neutral['mtp_r'] - neutral['toe_r'])[2])
    moment = (loads.zmp - joint) * loads.ground_force[:, 1] + height * loads.ground_force[:, 0]
    return np.where(loads.zmp > joint, -moment, 0.0)


def body_motion(
    task: SagittalTask, time: Array, q: Array, dq: Array, ddq: Array, loads: SagittalLoads
) -> BodyMotion:
    """Motion on the 2D skeleton with the forces on feet and hands.

    Both feet get half of the ground's force, both hands half of the box's.

    Parameters
    ----------
    task : SagittalTask
        Person, plane and box.
    time : array, shape (n,)
        On the recording's clock [s].
    q, dq, ddq : array, shape (n, 6)
        [rad], per s, per s^2.
    loads : SagittalLoads
        At the same samples.
    """
    skeleton, n = task.person.skeleton, len(time)
    coordinates = []
    pelvis = pelvis_motion(q, dq, ddq, task.parameters)
    for joints, root in zip((q, dq, ddq), pelvis, strict=True):
        full = np.zeros((n, len(skeleton.coordinates)))
        full[:, [skeleton.index(f'pelvis_{name}') for name in ('tx', 'ty', 'tilt')]] = root
        full[:, [skeleton.index(joint) for joint in JOINTS]] = joints
        coordinates.append(full)
    box = np.full((n, 3), np.nan)
    if task.parameters.box_mass > 0.0:
        box = _in_plane(loads.centres[:, -1] + task.parameters.box_from_hand)
    motion = skeleton.body_motion(
        time,
        *coordinates,
        ground_force=np.repeat(0.5 * _in_plane(loads.ground_force)[:, None], 2, axis=1),
        hand_force=np.repeat(0.5 * _in_plane(loads.hand_force)[:, None], 2, axis=1),
        box_position=box,
    )
    cop = motion.points[:, [POINTS.index(f'ankle_{side}') for side in 'rl']].copy()
    cop[..., 0] = loads.zmp[:, None]
    cop[..., 2] = task.parameters.ground_height
    return _into_laboratory(replace(motion, centre_of_pressure=cop), task)


def _in_plane(vectors: Array) -> Array:
    """Vectors (n, 2), forward and up, as (n, 3), forward, left and up."""
    return np.stack((vectors[:, 0], np.zeros(len(vectors)), vectors[:, 1]), axis=1)


def _into_laboratory(motion: BodyMotion, task: SagittalTask) -> BodyMotion:
    turn = task.plane.rotation()
    return replace(
        motion,
        points=task.plane.to_world(motion.points),
        frames=quaternion_from_matrix(turn @ matrix_from_quaternion(motion.frames)),
        ground_force=motion.ground_force @ turn.T,
        centre_of_pressure=task.plane.to_world(motion.centre_of_pressure),
        hand_force=motion.hand_force @ turn.T,
        box_position=task.plane.to_world(motion.box_position),
    )
