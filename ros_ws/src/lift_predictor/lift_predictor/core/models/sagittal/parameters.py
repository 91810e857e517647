# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Everything about a person and a task as one vector of the compiled functions."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.contact import semi_axes
from lift_predictor.core.parameter_vector import pack_blocks, unpack_blocks

JOINTS: Final = (
    'lumbar_extension',
    'arm_flex',
    'elbow_flex',
    'hip_flexion',
    'knee_angle',
    'ankle_angle',
)
"""Joint coordinates of the chain above the fixed feet, in the order of the 2D skeleton."""

BODIES: Final = ('foot', 'shank', 'thigh', 'pelvis', 'trunk', 'upper_arm', 'forearm')
"""Segments from the ground up; paired ones count both sides. The trunk carries the head, the
forearm the hand."""

CIRCLE_BODIES: Final = (
    *('foot',) * 4,
    *('shank',) * 6,
    *('thigh',) * 4,
    *('pelvis',) * 2,
    *('trunk',) * 2,
)
"""Segment of each collision circle, in the order of `collision_circles.csv`."""

N_JOINTS: Final = len(JOINTS)
HIP, KNEE = JOINTS.index('hip_flexion'), JOINTS.index('knee_angle')
N_BODY: Final = 6
N_STRENGTH: Final = 8
N_CIRCLE: Final = 3

SHAPES: Final[dict[str, tuple[int, int]]] = {
    'body': (len(BODIES), N_BODY),
    'strength_lower': (N_JOINTS, N_STRENGTH),
    'strength_upper': (N_JOINTS, N_STRENGTH),
    'circle': (len(CIRCLE_BODIES), N_CIRCLE),
    'semi_axes': (len(CIRCLE_BODIES), 2),
    'hip_range': (1, 2),
    'ankle': (1, 2),
    'support': (1, 2),
    'ground_height': (1, 1),
    'gravity': (1, 1),
    'duration': (1, 1),
    'box_acceleration': (1, 1),
    'box_from_hand': (1, 2),
    'lowest_grip': (1, 1),
    'objective': (1, 2),
}
N_SCALARS: Final = 1
"""Variables that hold for the whole lift: the box's mass [kg]."""
N_PARAMETERS: Final = sum(rows * columns for rows, columns in SHAPES.values())


@dataclass(frozen=True)
class LiftParameters:
    """Numbers of one person and one task; plane coordinates are (forward, up).

    Attributes
    ----------
    body : array, shape (7, 6)
        Per segment of `BODIES`: mass [kg], centre of mass (forward, up) [m], inertia about it [kg
        m^2], next joint (forward, up) [m]. Segment frames have their origin at the
        OpenSim-proximal joint (foot at the ankle, shank at the knee, thigh and pelvis at the hip,
        trunk at the lumbar joint, upper arm at the shoulder, forearm at the elbow) and are
        parallel to the world in upright standing. The next joint is the distal one of shank, thigh
        and arm, the lumbar joint for the pelvis, the shoulder for the trunk, the grip for the
        forearm; unused for the foot.
    strength_lower, strength_upper : array, shape (6, 8)
        Coefficients of equations 2.14 and 2.17 per joint in its own coordinate, [N m], z-score and
        both limbs included; the lower ones give a negative torque.
    circle : array, shape (18, 3)
        Circles on `CIRCLE_BODIES`: centre in the segment frame (forward, up) [m], radius [m]. A
        radius that is not positive switches the circle off.
    hip_range : array, shape (2,)
        Largest flexion of the hip with a straight knee [rad], and its rise per flexion of the
        knee.
    ankle : array, shape (2,)
        Ankle in the laboratory [m]; the feet are flat and do not move.
    support : array, shape (2,)
        Rear and front edge of the foot support region [m].
    ground_height, gravity, duration : float
        [m], [m/s^2], [s].
    box_mass : float
        Mass in the hands [kg]; a variable of the programme, and so no part of the vector.
    box_half : array, shape (2,)
        Half depth and half height of the box [m], in place of r2 of equation 4.5.
    box_acceleration : float
        Largest acceleration of the box [m/s^2].
    box_from_hand : array, shape (2,)
        Box centre minus grip [m]; the box stays level.
    lowest_grip : float
        Height below which the grip may not go [m]: the box stands on something where it is lower.
    objective : array, shape (2,)
        Factors a and b of the objective a effort - b log(W + 10) (equation 2.11 with weights and
        normalisation multiplied); the default is the effort alone.
    """

    body: Array
    strength_lower: Array
    strength_upper: Array
    circle: Array
    hip_range: Array
    ankle: Array
    support: Array
    ground_height: float
    gravity: float
    duration: float
    box_mass: float
    box_half: Array
    box_acceleration: float
    box_from_hand: Array
    lowest_grip: float
    objective: Array = field(default_factory=lambda: np.array([1.0, 0.0]))

    def pack(self) -> Array:
        """Return the parameter vector of the compiled functions, shape (N_PARAMETERS,).

        Raises
        ------
        TaskError
            A field of the wrong shape or a value that is not finite.
        """
        return pack_blocks(self, SHAPES)

    @property
    def semi_axes(self) -> Array:
        """Semi-axes of the box grown by each circle's radius, shape (18, 2) [m]."""
        return semi_axes(self.box_half, self.circle[:, 2])

    @property
    def total_mass(self) -> float:
        """Mass of body and box [kg]."""
        return float(self.body[:, 0].sum() + self.box_mass)


def unpack(vector: Any) -> dict[str, Any]:
    """Split a symbolic parameter vector into named blocks (matrices are row-major)."""
    return unpack_blocks(vector, SHAPES)
