# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Coordinates of the spatial programme, and everything about person and task as one vector.

All Cartesian numbers are in the stance frame: origin on the ground half way between the ankles, x
along the mean direction of the feet, y to the left, z up.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.contact import semi_axes
from lift_predictor.core.parameter_vector import pack_blocks, unpack_blocks

SIDES: Final = ('r', 'l')
MIRROR: Final = {'r': 1.0, 'l': -1.0}
"""Sign of the rotations about the forward and upward axes (skeleton table, left side mirrored)."""

ROOT: Final = (
    'ankle_mean',
    'hip_mean',
    'pelvis_aside',
    'pelvis_turn',
    'knee_angle_r',
    'knee_angle_l',
)
"""What places the pelvis above the fixed feet. In a symmetric posture on parallel feet below the
hips, ankle_mean is the ankle's, hip_mean the hips' flexion; in general they place the pelvis
forward and tilt it by the same formulas. pelvis_aside is the middle of the hips to the left [m],
pelvis_turn the turn of the line of the hips about the vertical."""

SPINE: Final = tuple(
    f'{joint}_{name}'
    for joint in ('lumbar', 'thorax')
    for name in ('extension', 'bending', 'rotation')
)
ARM: Final = ('arm_flex', 'arm_add', 'arm_rot', 'elbow_flex', 'pro_sup', 'wrist_flex', 'wrist_dev')
SPLINED: Final = (*ROOT, *SPINE, *(f'{name}_{side}' for side in SIDES for name in ARM))
"""Coordinates that are splines in time: the optimisation variables."""

LEG: Final = ('hip_flexion', 'hip_adduction', 'hip_rotation', 'ankle_angle', 'subtalar_angle')
DEPENDENT: Final = tuple(f'{name}_{side}' for side in SIDES for name in LEG)
"""Leg coordinates that follow from the others in closed form, as the feet are flat and fixed."""

LEG_STRENGTH: Final = ('hip_flexion', 'knee_angle', 'ankle_angle')
STRONG: Final = (
    *SPINE,
    *(f'{name}_{side}' for side in SIDES for name in ARM),
    *(f'{name}_{side}' for side in SIDES for name in LEG_STRENGTH),
)
"""Coordinates whose strength is published: they have torque limits and take part in the effort."""

CONSTANT_STRENGTH: Final = frozenset(
    (
        *(f'{joint}_{name}' for joint in ('lumbar', 'thorax') for name in ('bending', 'rotation')),
        *(f'{n}_{s}' for s in SIDES for n in ('arm_add', 'arm_rot', 'pro_sup', 'wrist_dev')),
    )
)
"""Coordinates whose published strength does not depend on angle and speed (strength_surfaces)."""

MOVING: Final = (
    'pelvis',
    'lumbar',
    'thorax',
    *(f'{name}_{side}' for side in SIDES for name in ('upper_arm', 'forearm', 'hand')),
    *(f'{name}_{side}' for side in SIDES for name in ('shank', 'thigh')),
)
"""Segments that move; the thorax carries the head."""
BODIES: Final = (*MOVING, 'foot_r', 'foot_l')
"""The feet carry their toes; they do not move."""

_LEG_SPHERES: Final = {
    'foot': ('toes', 'ball of the foot', 'instep', 'ankle'),
    'shank': ('lowest shank', 'lower shank', 'shank', 'upper shank', 'highest shank', 'knee'),
    'thigh': ('lowest thigh', 'lower thigh', 'thigh', 'upper thigh', 'hip'),
}
SPHERE_BODIES: Final = (
    *(f'{body}_{side}' for side in SIDES for body, n in _LEG_SPHERES.items() for _ in n),
    'lumbar',
    'thorax',
)
"""Segments of the collision spheres (equation 3.10)."""
SPHERE_NAMES: Final = (
    *(f'{name}_{side}' for side in SIDES for n in _LEG_SPHERES.values() for name in n),
    'lower spine',
    'upper spine',
)
TRUNK: Final = ('lumbar', 'thorax')
"""Segments that the arms stay out of."""
ARM_POINTS: Final = tuple(f'{name}_{side}' for side in SIDES for name in ('forearm', 'hand'))
"""Segments whose origins, elbows and wrists, stay out of the trunk."""

N_SPLINED: Final = len(SPLINED)
SCALARS: Final = ('box_mass', 'duration')
"""Variables that hold for the whole lift [kg], [s]."""
N_SCALARS: Final = len(SCALARS)

SHAPES: Final[dict[str, tuple[int, int]]] = {
    'body': (len(BODIES), 10),
    'pelvis': (1, 3),
    'spine': (1, 4),
    'arm': (1, 4),
    'leg': (1, 2),
    'strength_lower': (len(STRONG), 8),
    'strength_upper': (len(STRONG), 8),
    'sphere': (len(SPHERE_BODIES), 4),
    'semi_axes': (len(SPHERE_BODIES), 3),
    'trunk': (len(TRUNK), 5),
    'hip_range': (1, 2),
    'ankle': (2, 3),
    'foot_turn': (1, 2),
    'sole': (1, 2),
    'inward_lean': (1, 1),
    'gravity': (1, 1),
    'box_acceleration': (1, 1),
    'box_width': (1, 1),
    'box_turning': (1, 1),
    'box_from_hand': (1, 3),
    'way': (3, 4),
    'objective': (1, 2),
    'standing': (1, 4),
    'technique': (1, 2),
}
N_PARAMETERS: Final = sum(rows * columns for rows, columns in SHAPES.values())


@dataclass(frozen=True, eq=False)
class SpatialParameters:
    """Numbers of one person and one task.

    Attributes
    ----------
    body : array, shape (15, 10)
        Per segment of `BODIES`: mass [kg], centre of mass (3) [m], inertia about it (xx, yy, zz,
        xy, xz, yz) [kg m^2], in the segment's frame.
    pelvis : array, shape (3,)
        Half width of the hips; L5-S1 forward and up from their middle [m].
    spine : array, shape (4,)
        T12-L1 forward and up from L5-S1; shoulders forward and up from T12-L1 [m].
    arm : array, shape (4,)
        Half width of the shoulders, upper arm, forearm, wrist to grip [m].
    leg : array, shape (2,)
        Thigh and shank [m].
    strength_lower, strength_upper : array, shape (26, 8)
        Coefficients of equations 2.14 and 2.17 for `STRONG` in the coordinate itself [N m]; the
        lower ones give a negative torque.
    sphere : array, shape (32, 4)
        Collision spheres: centre in the segment's frame, radius [m]; a radius that is not
        positive switches it off.
    trunk : array, shape (2, 5)
        Ellipsoids of `TRUNK`: centre forward and up in the segment's frame, semi-axes forward, to
        the side and up [m].
    hip_range : array, shape (2,)
        Largest flexion of the hip with a straight knee [rad], and its rise per flexion of the
        knee.
    ankle : array, shape (2, 3)
        Right and left ankle [m].
    foot_turn : array, shape (2,)
        Direction of right and left foot about the vertical [rad].
    sole : array, shape (2,)
        Heel and tip of the toes along the foot from below the ankle [m].
    inward_lean : float
        Part of the angle from each foot to the centre of mass by which its force leans inwards.
    gravity : float
        [m/s^2].
    box_half : array, shape (3,)
        Half sizes of the box forward, to the side and up [m].
    box_acceleration : float
        Largest acceleration of the box [m/s^2].
    box_width : float
        Distance of the hands [m].
    box_turning : float
        Moment of inertia of the box about the vertical, per mass and squared width.
    box_from_hand : array, shape (3,)
        Box centre from the middle of the hands, in the box's axes [m].
    way : array, shape (3, 4)
        Half-spaces n x + d >= 0 in which the box's centre stays: left and right of the edges of
        the sector, seen from between the ankles, in which it is carried, and above the lower of
        its places. Without the first two the least effort is to swing the box past the hips, where
        equation 3.10 lets it pass; without the third a heavy box may
        sink into the floor.
    objective : array, shape (2,)
        Factors a and b of the objective a effort - b log(W + 10), W in N (equation 3.9 with
        weights and normalisation multiplied).
    standing : array, shape (4,)
        C7 forward and up from T12-L1; heights of hips and C7 in upright standing [m].
    technique : array, shape (2,)
        Least and largest part of C7's lowering that the hips are lowered by at the start, where
        a technique is asked for.
    """

    body: Array
    pelvis: Array
    spine: Array
    arm: Array
    leg: Array
    strength_lower: Array
    strength_upper: Array
    sphere: Array
    trunk: Array
    hip_range: Array
    ankle: Array
    foot_turn: Array
    sole: Array
    inward_lean: float
    gravity: float
    box_half: Array
    box_acceleration: float
    box_width: float
    box_turning: float
    box_from_hand: Array
    way: Array
    standing: Array
    objective: Array = field(default_factory=lambda: np.array([1.0, 0.0]))
    technique: Array = field(default_factory=lambda: np.array([0.0, 1.0]))

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
        """Semi-axes of the box grown by each sphere's radius, shape (32, 3) [m]."""
        return semi_axes(self.box_half, self.sphere[:, 3])

    @property
    def body_mass(self) -> float:
        """Mass of the person [kg]."""
        return float(self.body[:, 0].sum())


def unpack(vector: Any) -> dict[str, list[list[Any]]]:
    """Split a symbolic parameter vector into named blocks (matrices are row-major)."""
    return unpack_blocks(vector, SHAPES)
