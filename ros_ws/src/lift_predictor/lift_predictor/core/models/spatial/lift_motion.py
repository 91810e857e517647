# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A motion of the spatial model as body motion in the laboratory, with all forces and torques."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.motion import BodyMotion
from human_model.skeleton import ExternalForce
from human_model.typing import Array
from lift_predictor.core.models.spatial.coordinates import skeleton_motion
from lift_predictor.core.models.spatial.evaluation import SpatialLoads
from lift_predictor.core.models.spatial.parameters import SIDES
from lift_predictor.core.models.spatial.task import SpatialTask

FREE: Final = 6
"""Coordinates of the free pelvis: no joints."""


def body_motion(
    task: SpatialTask,
    time: Array,
    splined: tuple[Array, Array, Array],
    loads: SpatialLoads,
    with_box: bool,
) -> BodyMotion:
    """Motion on the 3D skeleton with the forces on feet and hands.

    Parameters
    ----------
    task : SpatialTask
        Person, frame and box.
    time : array, shape (n,)
        On the recording's clock [s].
    splined : tuple of array, shape (n, 26)
        Splined coordinates and derivatives by time.
    loads : SpatialLoads
        At the same samples.
    with_box : bool
        Whether there is a box in the hands.
    """
    skeleton, frame = task.person.skeleton, task.frame
    motion = skeleton_motion(
        *splined, task.parameters, skeleton.coordinates, frame.heading, frame.origin
    )
    free = np.zeros((len(time), 2, 3))
    free[:, :, 2] = loads.free_moment
    box = np.full((len(time), 3), np.nan)
    if with_box:
        box = frame.to_world(_box(task, loads))
    pressure = frame.to_world(loads.pressure)
    pressure[loads.ground_force[:, :, 2] <= 0.0] = np.nan
    return skeleton.body_motion(
        time,
        *motion,
        ground_force=frame.turned(loads.ground_force),
        centre_of_pressure=pressure,
        free_moment=free,
        hand_force=frame.turned(loads.hand_force),
        box_position=box,
    )


def feet_moved(task: SpatialTask, motion: BodyMotion) -> float:
    """Largest distance of an ankle of the skeleton from where it stands [m].

    The closed form of the legs holds for a list of the pelvis of up to half a radian.
    """
    ankles = np.stack([motion.point(f'ankle_{side}') for side in SIDES], axis=1)
    off = np.linalg.norm(ankles - task.frame.to_world(task.frame.ankle), axis=2)
    return float(off.max())


def joint_torques(task: SpatialTask, motion: BodyMotion) -> tuple[Array, Array, Array]:
    """Torques of all joints (n, 34) by the skeleton's own inverse dynamics, and their limits.

    The force of the ground acts on the hindfoot; the torque at the ball of the foot is what the
    toes' own weight needs.
    """
    skeleton = task.person.skeleton
    torque = np.zeros((len(motion), len(motion.coordinates)))
    for i in range(len(motion)):
        external = []
        for k, side in enumerate(SIDES):
            if np.all(np.isfinite(motion.centre_of_pressure[i, k])):
                external.append(
                    ExternalForce(
                        f'foot_{side}', motion.ground_force[i, k], motion.centre_of_pressure[i, k],
                        motion.free_moment[i, k],
                    )
                )  # fmt: skip
            hand = motion.points[i, motion.point_names.index(f'hand_{side}')]
            external.append(ExternalForce(f'hand_{side}', motion.hand_force[i, k], hand))
        torque[i] = skeleton.inverse_dynamics(
            motion.position[i], motion.velocity[i], motion.acceleration[i], external
        )
    limits = task.person.strength.limit_arrays(
        motion.coordinates, motion.position, motion.velocity
    )
    return torque[:, FREE:], limits[0][:, FREE:], limits[1][:, FREE:]


def _box(task: SpatialTask, loads: SpatialLoads) -> Array:
    """Centre of the box in the stance frame (n, 3)."""
    line = loads.hand[:, 1] - loads.hand[:, 0]
    line = line[:, :2] / np.linalg.norm(line[:, :2], axis=1)[:, None]
    x, y, z = task.parameters.box_from_hand
    centre = loads.hand.mean(axis=1)
    centre[:, 0] += line[:, 1] * x + line[:, 0] * y
    centre[:, 1] += -line[:, 0] * x + line[:, 1] * y
    centre[:, 2] += z
    return np.asarray(centre)
