# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The model alone: paths and recruitment at a posture, by name."""

from __future__ import annotations

import pytest

from human_model.subject import Subject
from muscle_analyzer import MuscleAnalyzerOptions, MuscleModel
from muscle_analyzer.core.exceptions import UnknownNameError


@pytest.fixture(scope='module')
def model(lifting_multibody):
    return MuscleModel()


def test_moment_arm_is_minus_the_derivative_of_the_length(model):
    step = 1e-5
    ahead, behind = (
        model.posture(hip_flexion_r=0.5 + sign * step).length['psoas_r'] for sign in (1.0, -1.0)
    )
    arm = model.posture(hip_flexion_r=0.5).moment_arm('psoas_r', 'hip_flexion_r')
    assert arm == pytest.approx(-(ahead - behind) / (2.0 * step), rel=1e-3)
    assert arm > 0.0


def test_recruited_muscles_and_reserves_balance_the_torque(model):
    posture = model.posture(hip_flexion_r=0.5)
    balance = posture.recruit(hip_flexion_r=60.0)
    activation = dict(zip(model.muscle_names, balance.activation.tolist(), strict=True))
    assert activation['psoas_r'] > activation['psoas_l']
    balanced = posture.solver.sample_model.balanced
    torque = (posture.moment_arms.T @ (balance.activation * posture.active))[balanced]
    names = posture.solver.coordinate_names
    expected = [60.0 if name == 'hip_flexion_r' else 0.0 for name in names]
    assert torque + balance.reserve == pytest.approx(expected, abs=1e-6)


def test_a_taller_subject_has_longer_muscles(model):
    taller = MuscleModel(Subject('p01', 'male', 90.0, 1.95, 25))
    assert taller.posture().length['recfem_r'] > model.posture().length['recfem_r']


def test_muscles_far_from_their_optimal_length_are_weaker(model):
    hill = MuscleModel(options=MuscleAnalyzerOptions(force_length_velocity=True))
    ratio = hill.posture().active / model.posture().active
    assert ratio.min() < 0.5
    # The curve of De Groote and Fregly exceeds 1 a little near the optimal length.
    assert ratio.max() < 1.02


@pytest.mark.parametrize(
    'use',
    [
        lambda model: model.posture(tail_flexion=0.1),
        lambda model: model.posture().moment_arm('tail_r', 'hip_flexion_r'),
        lambda model: model.posture().recruit(pelvis_tilt=1.0),
    ],
)
def test_an_unknown_name_is_refused(model, use):
    with pytest.raises(UnknownNameError, match='there is no'):
        use(model)
