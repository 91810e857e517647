# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The skeletons in the sagittal plane (thesis table 2.1) and in space (thesis table 3.1)."""

from human_model.anthropometry import SegmentParameters, sagittal_parameters, segment_parameters
from human_model.skeleton import Skeleton
from human_model.subject import Subject


class Skeleton2D(Skeleton):
    """Symmetric body in the sagittal plane, 10 degrees of freedom.

    Paired limbs are one link of double mass.

    The shared points are put at the subject's half widths of hips and shoulders to the right and
    to the left of the plane, so that the result can be taken over to a model with two sides.
    """

    # Predicted motions are evaluated as a whole, and numba loads for longer than that takes.
    uses_compiled = False

    def __init__(self, parameters: SegmentParameters) -> None:
        super().__init__('2d_10dof', parameters)

    @classmethod
    def of(cls, subject: Subject) -> 'Skeleton2D':
        """Skeleton of a subject, from mass, stature, sex and measured lengths."""
        return cls(sagittal_parameters(segment_parameters(subject)))


class Skeleton3D(Skeleton):
    """Whole body with 40 degrees of freedom: two spine joints, arms with hands, legs with toes."""

    def __init__(self, parameters: SegmentParameters) -> None:
        super().__init__('3d_40dof', parameters)

    @classmethod
    def of(cls, subject: Subject) -> 'Skeleton3D':
        """Skeleton of a subject, from mass, stature, sex and measured lengths."""
        return cls(segment_parameters(subject))
