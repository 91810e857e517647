# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A subject as numbers of the spatial model: segments, strength, joint limits, body thickness."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from human_model.anthropometry import SegmentParameters, body_dimensions
from human_model.constants import GRAVITY
from human_model.inertia import combine
from human_model.skeletons import Skeleton3D
from human_model.strength import JointStrength
from human_model.subject import Subject
from human_model.tables import read_table
from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.ranges import hip_range, ranges
from lift_predictor.core.models.spatial.parameters import (
    BODIES,
    CONSTANT_STRENGTH,
    SPHERE_BODIES,
    SPHERE_NAMES,
    STRONG,
)
from lift_predictor.core.models.strength_rows import strength_rows
from lift_predictor.core.options import COEFFICIENT_SET

INWARD_LEAN: Final = 0.6
"""Fits the public recording keenon/nimblephysics data/grf/Subject4 squats1 at rest: 36 N lateral
in each foot at 590 N, feet 0.38 m apart."""

_CARRIED: Final = {'thorax': 'head', 'foot_r': 'toes_r', 'foot_l': 'toes_l'}
"""Segments that move with another one."""


@dataclass(frozen=True, eq=False)
class SpatialPerson:
    """One subject's part of the parameter vector.

    Attributes
    ----------
    subject : Subject
        Who it is.
    skeleton : Skeleton3D
        Gives the motion of the result.
    strength : JointStrength
        Torque limits.
    body, pelvis, spine, arm, leg, strength_lower, strength_upper, sphere, trunk, hip_range, sole
        As in `SpatialParameters`.
    ranges : mapping
        Lower and upper end of the range of each coordinate of the skeleton [rad].
    standing : array, shape (4,)
        As in `SpatialParameters`.
    ankle_height : float
        Ankle over the sole [m].
    gravity : float
        [m/s^2].
    """

    subject: Subject
    skeleton: Skeleton3D
    strength: JointStrength
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
    sole: Array
    standing: Array
    ankle_height: float
    ranges: Mapping[str, tuple[float, float]]
    gravity: float = GRAVITY

    @classmethod
    def of(
        cls,
        subject: Subject,
        coefficient_set: str = COEFFICIENT_SET,
        segments: SegmentParameters | None = None,
    ) -> SpatialPerson:
        """Build from anthropometry.

        Parameters
        ----------
        subject : Subject
            Mass, stature, sex, measured lengths, strength.
        coefficient_set : str
            Published strength data to use, a name of `human_model.strength.coefficient_sets`.
        segments : SegmentParameters, optional
            Segments in place of those estimated from the subject.

        Raises
        ------
        TaskError
            Strength coefficients that can become negative, or that vary where the compiled model
            takes them as constant.
        """
        skeleton = Skeleton3D.of(subject) if segments is None else Skeleton3D(segments)
        length = skeleton.parameters.lengths
        strength = JointStrength(skeleton.name, subject, coefficient_set)

        def pick(*names: str) -> Array:
            return np.array([length[name] for name in names])

        return cls(
            subject=subject,
            skeleton=skeleton,
            strength=strength,
            body=_bodies(skeleton),
            pelvis=pick('hip_half_width', 'l5s1_forward', 'l5s1_height'),
            spine=pick('t12l1_forward', 't12l1_height', 'shoulder_forward', 'shoulder_height'),
            arm=pick('shoulder_half_width', 'upper_arm', 'forearm', 'hand_grip'),
            leg=pick('thigh', 'shank'),
            strength_lower=strength_rows(strength, STRONG, 'lower', CONSTANT_STRENGTH),
            strength_upper=strength_rows(strength, STRONG, 'upper', CONSTANT_STRENGTH),
            sphere=_spheres(subject, skeleton),
            trunk=_trunk(subject, length),
            hip_range=np.array(hip_range()),
            ranges=_ranges(skeleton),
            sole=np.array([-length['heel_length'], length['ankle_mtp'] + length['toes']]),
            standing=_standing(skeleton),
            ankle_height=float(length['ankle_height']),
        )

    def limits(self, names: tuple[str, ...]) -> tuple[Array, Array]:
        """Lower and upper joint limits of coordinates by name; the pelvis' own are infinite."""
        rows = np.array([self.ranges.get(name, (-np.inf, np.inf)) for name in names])
        return rows[:, 0], rows[:, 1]

    def fields(self) -> dict[str, Any]:
        """Return the person's fields of `SpatialParameters`."""
        names = ('body', 'pelvis', 'spine', 'arm', 'leg', 'strength_lower', 'strength_upper',
                 'sphere', 'trunk', 'hip_range', 'sole', 'standing', 'gravity')  # fmt: skip
        return {name: getattr(self, name) for name in names} | {'inward_lean': INWARD_LEAN}


def _standing(skeleton: Skeleton3D) -> Array:
    upright = skeleton.standing()
    points = skeleton.points(upright)
    thorax = skeleton.forward(upright)[skeleton.parameters.index('thorax'), :3, 3]
    ground = points['ankle_r'][2] - float(skeleton.parameters.lengths['ankle_height'])
    forward, _, up = points['c7'] - thorax
    hips = 0.5 * (points['hip_r'] + points['hip_l'])
    return np.array([forward, up, hips[2] - ground, points['c7'][2] - ground])


def _bodies(skeleton: Skeleton3D) -> Array:
    parameters, neutral = skeleton.parameters, skeleton.forward(skeleton.standing())
    table = np.zeros((len(BODIES), 10))
    for row, name in enumerate(BODIES):
        parts = []
        for part in (name, _CARRIED.get(name)):
            if part is not None:
                i = parameters.index(part)
                at = neutral[i, :3, 3] - neutral[parameters.index(name), :3, 3]
                parts.append((float(parameters.mass[i]), parameters.com[i] + at,
                              parameters.inertia[i]))  # fmt: skip
        mass, com, inertia = combine(parts)
        table[row] = (mass, *com, *inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]])
    return table


def _ranges(skeleton: Skeleton3D) -> dict[str, tuple[float, float]]:
    narrower = ranges(skeleton.name)
    found = {}
    for name, (low, high) in zip(skeleton.coordinates, skeleton.limits, strict=True):
        least, most = narrower.get(name, (-np.inf, np.inf))
        found[name] = (max(float(low), least), min(float(high), most))
    return found


def _trunk(subject: Subject, length: Mapping[str, float]) -> Array:
    dimensions = body_dimensions(subject.sex, subject.stature, subject.mass)
    rows = []
    for part, upper in (('waist', 't12l1'), ('chest', 'shoulder')):
        forward, up = 0.5 * length[f'{upper}_forward'], 0.5 * length[f'{upper}_height']
        depth, breadth = dimensions[f'{part}depth'], dimensions[f'{part}breadth']
        rows.append((forward, up, 0.5 * depth, 0.5 * breadth, up))
    return np.array(rows)


def _spheres(subject: Subject, skeleton: Skeleton3D) -> Array:
    dimensions = body_dimensions(subject.sex, subject.stature, subject.mass)
    length = skeleton.parameters.lengths
    along = {
        'foot': np.array([length['ankle_mtp'] + length['toes'], 0.0, -length['ankle_height']]),
        'shank': np.array([0.0, 0.0, -length['shank']]),
        'thigh': np.array([0.0, 0.0, -length['thigh']]),
        'lumbar': np.array([length['t12l1_forward'], 0.0, length['t12l1_height']]),
        'thorax': np.array([length['shoulder_forward'], 0.0, length['shoulder_height']]),
    }
    columns = 'sphere body along dimension divisor'
    rows: dict[str, tuple[str, Array]] = {}
    for line in read_table('lift_predictor', 'collision_spheres.csv', columns):
        centre = line.number('along') * line.choice('body', along)
        radius = line.choice('dimension', dimensions) / line.number('divisor')
        rows[line['sphere']] = (line['body'], np.append(centre, radius))
    spheres = np.zeros((len(SPHERE_NAMES), 4))
    for i, (name, body) in enumerate(zip(SPHERE_NAMES, SPHERE_BODIES, strict=True)):
        plain = name if name in rows else name.removesuffix('_r').removesuffix('_l')
        if plain not in rows or body.removesuffix('_r').removesuffix('_l') != rows[plain][0]:
            raise TaskError(f'collision_spheres.csv: no row for the {name} on the {body}')
        spheres[i] = rows[plain][1]
    return spheres
