# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The 3D skeleton of 40 degrees of freedom (thesis table 3.1)."""

from human_model.anthropometry import SegmentParameters, segment_parameters
from human_model.skeleton import Skeleton
from human_model.subject import Subject


class Skeleton3D(Skeleton):
    """Whole body: pelvis, two spine joints, arms with hands, legs with toes."""

    def __init__(self, parameters: SegmentParameters) -> None:
        super().__init__('3d_40dof', parameters)

    @classmethod
    def of(cls, subject: Subject) -> 'Skeleton3D':
        """Skeleton of a subject, from mass, stature, sex and measured lengths."""
        return cls(segment_parameters(subject))
