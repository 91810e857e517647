# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The musculoskeletal model of one subject: the generic model read, scaled and compiled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import MultibodyModel, compile_model
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import posture_paths
from muscle_analyzer.core.osim.model import OsimModel
from muscle_analyzer.core.subject.body_points import BodyPoints, attach_points, scale_factors
from muscle_analyzer.core.subject.coordinate_ranges import with_published_ranges
from muscle_analyzer.core.subject.scaling import scale_model
from muscle_analyzer.core.subject.segment_masses import SegmentMass, with_segment_masses


@dataclass(frozen=True, eq=False)
class SubjectModel:
    """A subject's model.

    Attributes
    ----------
    multibody : MultibodyModel
    points : BodyPoints
        The shared points and frames on its bodies.
    factors : mapping of str to (3,) array
        Scale factors of the bodies along their axes.
    """

    multibody: MultibodyModel
    points: BodyPoints
    factors: Mapping[str, Array]


def default_path_lengths(model: OsimModel) -> Array:
    """Return the path lengths (n_muscles,) of a model in its default posture, m."""
    multibody = compile_model(model)
    zero = np.zeros(multibody.default.size)
    state = forward_kinematics(multibody.tree, multibody.default, zero, zero)
    jacobians = body_jacobians(multibody.tree, state)
    table = path_table(multibody)
    length: Array = posture_paths(table, state, jacobians).length
    return length


def subject_model(
    generic: OsimModel,
    points: Mapping[str, Array],
    lengths: Mapping[str, float],
    mass: float,
    force_factors: Array | None = None,
    segments: Mapping[str, SegmentMass] | None = None,
) -> SubjectModel:
    """Scale a model to a subject and compile it.

    Parameters
    ----------
    generic : OsimModel
    points : mapping of str to (3,) array
        The subject's shared points in upright standing with hanging arms (`human_model` skeleton
        at zero coordinates), REP-103 axes, m.
    lengths : mapping of str to float
        The subject's segment lengths, m (`human_model.anthropometry`).
    mass : float
        kg.
    force_factors : array (n_muscles,), optional
        Factors of the muscles' maximum isometric forces (`muscle_strength`).
    segments : mapping of str to SegmentMass, optional
        Masses of the subject's segments in the same posture; without them the body mass is
        distributed as in the generic model.

    Raises
    ------
    ScalingError
        If points or segments are missing or factors are not positive.
    """
    factors = scale_factors(compile_model(generic), points, lengths)
    model = with_published_ranges(
        scale_model(generic, factors, mass, default_path_lengths, force_factors)
    )
    if segments is not None:
        model = with_segment_masses(model, segments, points)
    scaled = compile_model(model)
    return SubjectModel(scaled, attach_points(scaled, points), factors)
