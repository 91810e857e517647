# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscle strength by size, sex, age and percentile, against the published numbers behind it."""

import re

import numpy as np
import pytest

from human_model.subject import Subject
from human_model.tables import read_table
from muscle_analyzer.core.exceptions import OptionError, ScalingError
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import posture_paths
from muscle_analyzer.core.osim.reader import read_osim
from muscle_analyzer.core.subject.muscle_strength import (
    StrengthOptions,
    StrengthScaling,
    force_factors,
    reference_person,
)

POPULATION = StrengthOptions(StrengthScaling.POPULATION)
MAN = reference_person()
#: Woman of the reference's age and size: what is left is the difference of the sexes.
WOMAN = Subject('w', 'female', MAN.mass, MAN.stature, MAN.age)


def factor(model, muscle, subject, options=POPULATION):
    """Return the factor of one muscle."""
    names = [entry.name for entry in model.muscles]
    return force_factors(model, subject, options)[names.index(muscle)]


def test_the_person_the_model_stands_for_keeps_its_forces(lifting_model):
    np.testing.assert_allclose(force_factors(lifting_model, MAN, POPULATION), 1.0)


def test_forces_are_kept_without_the_option(lifting_model):
    np.testing.assert_array_equal(force_factors(lifting_model, WOMAN, StrengthOptions()), 1.0)


def test_geometric_strength_grows_with_mass_to_two_thirds(lifting_model):
    heavy = Subject('h', 'male', 2.0 * lifting_model.mass, 1.8, 30)
    options = StrengthOptions(StrengthScaling.GEOMETRIC)
    np.testing.assert_allclose(force_factors(lifting_model, heavy, options), 2.0 ** (2.0 / 3.0))


def test_women_have_the_published_share_of_mens_strength(lifting_model):
    # Stockdale 2011, trunk extension and rotation; Chaffin's static equations, shoulder. The
    # coefficients of the trunk have four digits.
    assert factor(lifting_model, 'MF_m1s_r', WOMAN) == pytest.approx(197.5 / 328.5, rel=1e-4)
    assert factor(lifting_model, 'EO1_l', WOMAN) == pytest.approx(43.0 / 71.0)
    assert factor(lifting_model, 'LD_L1_r', WOMAN) == pytest.approx(50.0 / 101.0)


def test_percentile_is_that_of_the_joint(lifting_model):
    # Coefficients of variation of men: Stockdale 2011, Anderson et al. 2007.
    weak = Subject('z', 'male', MAN.mass, MAN.stature, MAN.age, strength_z=-1.5)
    assert factor(lifting_model, 'MF_m1s_r', weak) == pytest.approx(1.0 - 1.5 * 0.16)
    assert factor(lifting_model, 'vaslat_l', weak) == pytest.approx(1.0 - 1.5 * 0.245)
    assert factor(lifting_model, 'soleus_r', weak) == pytest.approx(1.0 - 1.5 * 0.232)


def test_joint_strength_scales_as_published_with_the_arms_of_a_taller_body(lifting_model):
    # Legs are published per body mass, weight and stature; arms grow with stature.
    tall = Subject('t', 'male', 1.2 * MAN.mass, 1.1 * MAN.stature, MAN.age)
    assert factor(lifting_model, 'vaslat_r', tall) == pytest.approx(1.2)
    assert factor(lifting_model, 'MF_m1s_r', tall) == pytest.approx(1.0 / 1.1)


@pytest.mark.parametrize(('ageing', 'left'), [('doherty2003', 0.70), ('none', 1.0)])
def test_age_takes_from_the_trunk_what_the_option_says(lifting_model, ageing, left):
    options = StrengthOptions(StrengthScaling.POPULATION, ageing)
    share = {}
    for age in (20, 60, 90):
        person = Subject('a', 'male', MAN.mass, MAN.stature, age)
        share[age] = factor(lifting_model, 'LTpL_L5_r', person, options)
    assert share[60] / share[20] == pytest.approx(left)
    assert share[90] == share[60]


def test_age_of_the_legs_is_that_of_the_joint_strength_data(lifting_model):
    # Anderson et al. 2007, knee extension: one shape of all ages, times C1 of the groups 18 to 25
    # (0.163), 55 to 65 (0.156) and 66 to 80 (0.137), linear between the middles of the groups.
    old = Subject('o', 'male', MAN.mass, MAN.stature, 70)
    aged = np.interp(70.0, [60.0, 73.0], [0.156, 0.137])
    assert factor(lifting_model, 'vasint_r', old) == pytest.approx(aged / 0.163, rel=1e-4)


def test_what_a_muscle_follows_is_what_it_does(lifting_model):
    body = compile_model(lifting_model)
    zero = np.zeros(body.default.size)
    state = forward_kinematics(body.tree, body.default, zero, zero)
    arms = posture_paths(path_table(body), state, body_jacobians(body.tree, state)).moment_arm
    checked = 0
    for row in read_table('muscle_analyzer', 'strength_muscles.csv', 'pattern coordinate bound'):
        if 'moment arm' not in row['source'] or 'change sign' in row['source']:
            continue
        name = {'lumbar_extension': 'L5_S1_Flex_Ext'}.get(row['coordinate'], row['coordinate'])
        sign = 1.0 if row['bound'] == 'upper' else -1.0
        chosen = [
            k for k, muscle in enumerate(lifting_model.muscles)
            if re.search(row['pattern'], muscle.name) and muscle.name.endswith('_r')
        ]  # fmt: skip
        own = sign * arms[chosen, body.coordinate_names.index(name)]
        assert own.sum() > 0.0, row['pattern']
        assert 'sum' in row['source'] or np.all(own > 0.0), row['pattern']
        checked += len(chosen)
    assert checked > 100


def test_unknown_names_and_muscles_are_told(lifting_model, write_model):
    with pytest.raises(OptionError, match=r'nonsense.*doherty2003'):
        force_factors(lifting_model, MAN, StrengthOptions(StrengthScaling.POPULATION, 'nonsense'))
    with pytest.raises(OptionError, match='no coefficient set'):
        force_factors(
            lifting_model, MAN, StrengthOptions(StrengthScaling.POPULATION, 'none', 'nonsense')
        )
    model = read_osim(write_model())
    with pytest.raises(ScalingError, match=r'no row of strength_muscles\.csv'):
        force_factors(model, MAN, POPULATION)
