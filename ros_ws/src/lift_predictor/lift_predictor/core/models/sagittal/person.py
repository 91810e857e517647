# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A subject as numbers of the sagittal model: segments, strength, joint limits, body thickness."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from human_model.anthropometry import SegmentParameters, body_dimensions
from human_model.constants import GRAVITY
from human_model.inertia import combine
from human_model.skeletons import Skeleton2D
from human_model.strength import JointStrength
from human_model.subject import Subject
from human_model.tables import read_table
from human_model.typing import Array
from lift_predictor.core.models.ranges import hip_range, ranges
from lift_predictor.core.models.sagittal.parameters import (
    BODIES,
    CIRCLE_BODIES,
    JOINTS,
    N_BODY,
)
from lift_predictor.core.models.strength_rows import strength_rows
from lift_predictor.core.options import COEFFICIENT_SET

_ENDS = {
    'shank': ('knee_r', 'ankle_r'),
    'thigh': ('hip_r', 'knee_r'),
    'pelvis': ('pelvis', 'l5_s1'),
    'trunk': ('l5_s1', 'shoulder_r'),
    'upper_arm': ('shoulder_r', 'elbow_r'),
    'forearm': ('elbow_r', 'hand_r'),
}
"""Origin and next joint of each segment, as points of the skeleton."""
_LINES = _ENDS | {'foot': ('ankle_r', 'toe_r')}
"""Lines on which the collision circles are."""


@dataclass(frozen=True, eq=False)
class Person:
    """One subject's part of the parameter vector, for both limbs of each pair together.

    Attributes
    ----------
    subject : Subject
        Who it is.
    skeleton : Skeleton2D
        Gives the motion of the result.
    neutral : dict of array, shape (3,)
        Shared points in upright standing [m].
    body : array, shape (7, 6)
        As `LiftParameters.body`.
    strength_lower, strength_upper : array, shape (6, 8)
        As in `LiftParameters`.
    mtp_limits : array, shape (2,)
        Fixed torque bounds of the metatarsophalangeal joints [N m] (no strength is published).
    circle, hip_range : array
        As in `LiftParameters`.
    angle_lower, angle_upper : array, shape (6,)
        Joint limits [rad]: those of the skeleton, and narrower ranges of people.
    gravity : float
        [m/s^2].
    """

    subject: Subject
    skeleton: Skeleton2D
    neutral: dict[str, Array]
    body: Array
    strength_lower: Array
    strength_upper: Array
    mtp_limits: Array
    circle: Array
    angle_lower: Array
    angle_upper: Array
    hip_range: Array
    gravity: float = GRAVITY

    @classmethod
    def of(
        cls,
        subject: Subject,
        coefficient_set: str = COEFFICIENT_SET,
        segments: SegmentParameters | None = None,
    ) -> Person:
        """Build from anthropometry.

        Parameters
        ----------
        subject : Subject
            Mass, stature, sex, measured lengths, strength.
        coefficient_set : str
            Published strength data to use, a name of `human_model.strength.coefficient_sets`.
        segments : SegmentParameters, optional
            Segments of the sagittal skeleton in place of those estimated from the subject.

        Raises
        ------
        TaskError
            Strength coefficients that can become negative: equations 2.16 and 2.19 would leave no
            torque at all.
        """
        skeleton = Skeleton2D.of(subject) if segments is None else Skeleton2D(segments)
        strength = JointStrength(skeleton.name, subject, coefficient_set)
        neutral = skeleton.points(skeleton.standing())
        limits = np.array([skeleton.limits[skeleton.index(joint)] for joint in JOINTS])
        for joint, (low, high) in ranges(skeleton.name).items():
            row = limits[JOINTS.index(joint)]
            row[:] = max(row[0], low), min(row[1], high)
        return cls(
            subject=subject,
            skeleton=skeleton,
            neutral=neutral,
            body=_bodies(skeleton, neutral),
            strength_lower=strength_rows(strength, JOINTS, 'lower'),
            strength_upper=strength_rows(strength, JOINTS, 'upper'),
            mtp_limits=np.array(strength.limits('mtp_angle', 0.0, 0.0)),
            circle=_circles(subject, neutral),
            angle_lower=limits[:, 0],
            angle_upper=limits[:, 1],
            hip_range=np.array(hip_range()),
        )

    @property
    def ankle_height(self) -> float:
        """Ankle over the sole [m]."""
        return float(self.neutral['ankle_r'][2] - self.neutral['toe_r'][2])


def _bodies(skeleton: Skeleton2D, neutral: dict[str, Array]) -> Array:
    parameters = skeleton.parameters
    body = np.zeros((len(BODIES), N_BODY))
    for row, name in enumerate(BODIES):
        parts = [(name, np.zeros(3))]
        if name == 'foot':
            parts.append(('toes', neutral['mtp_r'] - neutral['ankle_r']))
        indices = [(parameters.index(part), at) for part, at in parts]
        mass, com, inertia = combine(
            [
                (float(parameters.mass[i]), parameters.com[i] + at, parameters.inertia[i])
                for i, at in indices
            ]
        )
        offset = np.zeros(3)
        if name in _ENDS:
            origin, end = _ENDS[name]
            offset = neutral[end] - neutral[origin]
        body[row] = (mass, com[0], com[2], inertia[1, 1], offset[0], offset[2])
    return body


def _circles(subject: Subject, neutral: dict[str, Array]) -> Array:
    dimensions = body_dimensions(subject.sex, subject.stature, subject.mass)
    circles = []
    bodies: list[str] = []
    columns = 'body along dimension divisor'
    for line in read_table('lift_predictor', 'collision_circles.csv', columns):
        name, size = line['body'], line.choice('dimension', dimensions)
        origin, end = line.choice('body', _LINES)
        centre = line.number('along') * (neutral[end] - neutral[origin])
        circles.append((centre[0], centre[2], size / line.number('divisor')))
        bodies.append(name)
        if tuple(bodies) != CIRCLE_BODIES[: len(bodies)]:
            raise line.error('body', f'the circles are in the order {", ".join(CIRCLE_BODIES)}')
    return np.array(circles)
