# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lowering of hips and C7 in postures of the sagittal model, and their Stoop-Squat-Index."""

from __future__ import annotations

import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.sagittal.kinematics import chain_positions
from lift_predictor.core.models.sagittal.parameters import LiftParameters
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.planning.technique import squat_index


def lowering(q: Array, person: Person, parameters: LiftParameters) -> tuple[Array, Array]:
    """How far hips and C7 are below their height in upright standing (n,) [m]."""
    state = chain_positions(q, parameters)
    neutral = person.neutral
    offset = (neutral['c7'] - neutral['l5_s1'])[[0, 2]]
    angle = state.angles['trunk']
    c7 = state.joints['lumbar'][:, 1] + np.sin(angle) * offset[0] + np.cos(angle) * offset[1]
    ankle = neutral['ankle_r'][2] - parameters.ankle[1]
    hips = neutral['hip_r'][2] - ankle - state.joints['hip'][:, 1]
    return hips, neutral['c7'][2] - ankle - c7


def stoop_squat_index(q: Array, person: Person, parameters: LiftParameters) -> Array:
    """Stoop-Squat-Index of postures q (n, 6); NaN where C7 is not lowered."""
    return squat_index(*lowering(q, person, parameters))
