# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The stance frame in the laboratory, and a recorded motion in the programme's coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from human_model.frames import matrix_from_quaternion
from human_model.motion import BodyMotion
from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.spatial.parameters import SIDES, SPLINED
from lift_predictor.core.models.spatial.person import SpatialPerson

MIN_SAMPLES = 6
FULL_LEG = 1.0 - 1e-9
"""Part of the straight leg's length that a recorded leg has at most."""


@dataclass(frozen=True, eq=False)
class StanceFrame:
    """Where a person stands.

    Attributes
    ----------
    heading : float
        Mean direction of the feet in the laboratory [rad].
    origin : array, shape (3,)
        Point of the ground half way between the ankles [m].
    ankle : array, shape (2, 3)
        Right and left ankle in the stance frame [m].
    foot_turn : array, shape (2,)
        Direction of the feet in the stance frame [rad].
    """

    heading: float
    origin: Array
    ankle: Array
    foot_turn: Array

    @classmethod
    def of(cls, motion: BodyMotion, person: SpatialPerson) -> StanceFrame:
        """Mean feet of a motion, flat on the ground.

        Raises
        ------
        TaskError
            Heel and toe coincide, or a foot moves by its own length.
        """
        ankles, directions = [], []
        for side, name in zip(SIDES, ('right', 'left'), strict=True):
            heel, toe, ankle = (motion.point(f'{p}_{side}') for p in ('heel', 'toe', 'ankle'))
            direction = (toe - heel).mean(axis=0)[:2]
            length = float(np.linalg.norm(direction))
            if not length > 0.0:
                raise TaskError(
                    f'heel and toe of the {name} foot coincide at {heel.mean(axis=0).tolist()}: '
                    'it has no direction'
                )
            moved = float(np.ptp(heel[:, :2] @ direction) / length)
            if moved > length:
                raise TaskError(
                    f'the {name} foot moves {moved:.2f} m during the lift: the feet must stay '
                    '(equation 4.4)'
                )
            ankles.append(ankle.mean(axis=0))
            directions.append(direction / length)
        heading = float(np.arctan2(*np.sum(directions, axis=0)[::-1]))
        place = np.array(ankles)
        origin = place.mean(axis=0)
        origin[2] -= person.ankle_height
        frame = cls(heading, origin, np.zeros((2, 3)), np.zeros(2))
        ankle = frame.into(place)
        ankle[:, 2] = person.ankle_height
        own = np.array(directions) @ frame.rotation()[:2, :2]
        return cls(heading, origin, ankle, np.arctan2(own[:, 1], own[:, 0]))

    def rotation(self) -> Array:
        """Rotation (3, 3) from the stance frame to the laboratory."""
        c, s = np.cos(self.heading), np.sin(self.heading)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    def into(self, points: Array) -> Array:
        """Positions (..., 3) of the laboratory in the stance frame."""
        return np.asarray((points - self.origin) @ self.rotation())

    def to_world(self, points: Array) -> Array:
        """Positions (..., 3) of the stance frame in the laboratory."""
        return np.asarray(points @ self.rotation().T + self.origin)

    def turned(self, vectors: Array) -> Array:
        """Vectors (..., 3) of the stance frame in the laboratory's axes."""
        return np.asarray(vectors @ self.rotation().T)


def splined_motion(motion: BodyMotion, frame: StanceFrame, person: SpatialPerson) -> Array:
    """Programme's coordinates (n, 26) of a motion on the 3D skeleton.

    Spine and arms are taken over; pelvis and knees are those that bring the hips where they were
    over feet that do not move (a leg that would have to be longer than it is, is straight).

    Raises
    ------
    TaskError
        Another skeleton, or too few samples.
    """
    if motion.skeleton != '3d_40dof':
        raise TaskError(f'motion.skeleton: {motion.skeleton}, the spatial model needs 3d_40dof')
    if len(motion) < MIN_SAMPLES:
        raise TaskError(
            f'motion: {len(motion)} samples in the lift, at least {MIN_SAMPLES} are needed'
        )
    values = {name: motion.coordinate(name) for name in SPLINED if name in motion.coordinates}
    hips = np.stack([frame.into(motion.point(f'hip_{side}')) for side in SIDES], axis=1)
    pelvis = frame.rotation().T @ matrix_from_quaternion(motion.frame('pelvis'))
    return place_pelvis(values, hips, pelvis, frame.ankle, person)


def place_pelvis(
    values: dict[str, Array], hips: Array, pelvis: Array, ankle: Array, person: SpatialPerson
) -> Array:
    """Coordinates (n, 26) from joint angles by name and the pelvis in the stance frame.

    Parameters
    ----------
    values : dict of array, shape (n,)
        Spine and arm coordinates; others are replaced.
    hips : array, shape (n, 2, 3)
        Right and left hip [m].
    pelvis : array, shape (n, 3, 3)
        Rotation of the pelvis.
    ankle : array, shape (2, 3)
        Ankles [m].
    person : SpatialPerson
        Lengths.
    """
    thigh, shank = person.leg
    span = FULL_LEG * (thigh + shank)
    reach = np.minimum(np.linalg.norm(hips - ankle, axis=2), span)
    knees = np.arccos(np.clip((reach**2 - thigh**2 - shank**2) / (2.0 * thigh * shank), -1.0, 1.0))
    knee = knees.mean(axis=1)
    centre = hips.mean(axis=1)
    forward = centre[:, 0] - ankle[:, 0].mean()
    length = np.sqrt(thigh**2 + shank**2 + 2.0 * thigh * shank * np.cos(knee))
    bend = np.arctan2(thigh * np.sin(knee), shank + thigh * np.cos(knee))
    lean = np.arcsin(np.clip(forward / length, -1.0, 1.0)) + bend
    tilt = np.unwrap(np.arctan2(pelvis[:, 2, 0], pelvis[:, 2, 2]))
    own = {
        'ankle_mean': lean,
        'hip_mean': knee - lean - tilt,
        'pelvis_aside': centre[:, 1] - ankle[:, 1].mean(),
        'pelvis_turn': np.unwrap(np.arctan2(-pelvis[:, 0, 1], pelvis[:, 1, 1])),
        'knee_angle_r': knees[:, 0],
        'knee_angle_l': knees[:, 1],
    }
    return np.stack([(values | own)[name] for name in SPLINED], axis=1)
