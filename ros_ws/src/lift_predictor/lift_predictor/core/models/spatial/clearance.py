# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Distance of a recorded box from the collision spheres (equation 3.10)."""

from __future__ import annotations

import numpy as np

from human_model.motion import BodyMotion
from human_model.typing import Array
from lift_predictor.core.models.spatial.frame import StanceFrame
from lift_predictor.core.models.spatial.parameters import SIDES, SPHERE_BODIES, SpatialParameters
from lift_predictor.core.models.spatial.person import SpatialPerson


def recorded_gaps(
    parameters: SpatialParameters, motion: BodyMotion, frame: StanceFrame, person: SpatialPerson
) -> Array:
    """Distance of the box's centre from each sphere's centre less both radii, (n, 12) [m].

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
    gaps = np.full((len(motion), len(which)), np.inf)
    for i, q in enumerate(motion.position):
        frames = skeleton.forward(q)[which]
        centre = np.einsum('sij,sj->si', frames[:, :3, :3], parameters.sphere[:, :3])
        apart = np.linalg.norm(box[i] - centre - frames[:, :3, 3], axis=1)
        gaps[i] = apart - parameters.sphere[:, 3] - parameters.box_radius
    gaps[:, parameters.sphere[:, 3] <= 0.0] = np.inf
    return gaps
