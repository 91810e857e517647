# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Distance of a recorded box from the collision spheres (equation 3.10)."""

from __future__ import annotations

import numpy as np

from human_model.motion import BodyMotion
from human_model.typing import Array
from lift_predictor.core.models.contact import gaps
from lift_predictor.core.models.spatial.frame import StanceFrame
from lift_predictor.core.models.spatial.parameters import (
    ARM_POINTS,
    SIDES,
    SPHERE_BODIES,
    TRUNK,
    SpatialParameters,
)
from lift_predictor.core.models.spatial.person import SpatialPerson


def recorded_gaps(
    parameters: SpatialParameters, motion: BodyMotion, frame: StanceFrame, person: SpatialPerson
) -> Array:
    """Distance of the box from each sphere, (n, 32) [m]; infinite for an unused one.

    The box is where it was tracked, else at the hands.
    """
    skeleton = person.skeleton
    hands = np.stack([motion.point(f'hand_{side}') for side in SIDES], axis=1)
    line = hands[:, 1] - hands[:, 0]
    turn = np.arctan2(-line[:, 0], line[:, 1])
    x, y, z = parameters.box_from_hand
    offset = np.stack(
        (np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y,
         np.full(len(turn), z)), axis=1,
    )  # fmt: skip
    tracked = motion.box_position
    box = np.where(np.isfinite(tracked), tracked, hands.mean(axis=1) + offset)
    which = np.array([skeleton.parameters.index(name) for name in SPHERE_BODIES])
    offset = np.empty((len(motion), len(which), 3))
    for i, q in enumerate(motion.position):
        frames = skeleton.forward(q)[which]
        centre = np.einsum('sij,sj->si', frames[:, :3, :3], parameters.sphere[:, :3])
        apart = centre + frames[:, :3, 3] - box[i]
        c, s = np.cos(turn[i]), np.sin(turn[i])
        offset[i] = apart @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return gaps(offset, parameters.box_half, parameters.sphere[:, 3])


def recorded_arms(trunk: Array, motion: BodyMotion, person: SpatialPerson) -> Array:
    """Distance of elbows and wrists from the trunk's ellipsoids per semi-axes, (n, 2, 4)."""
    skeleton = person.skeleton
    segments = [skeleton.parameters.index(name) for name in TRUNK]
    points = [skeleton.parameters.index(name) for name in ARM_POINTS]
    found = np.empty((len(motion), len(segments), len(points)))
    for i, q in enumerate(motion.position):
        frames = skeleton.forward(q)
        for row, (segment, (x, z, *axes)) in enumerate(zip(segments, trunk, strict=True)):
            own = (frames[points, :3, 3] - frames[segment, :3, 3]) @ frames[segment, :3, :3]
            found[i, row] = np.linalg.norm((own - [x, 0.0, z]) / axes, axis=1)
    return found
