# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Balance of the lumbar levels beside that of the coupled coordinate, and the parts of moments."""

from dataclasses import replace

import numpy as np
import pytest

from human_model.report import SolveStatus
from muscle_analyzer.core.exceptions import OptionError
from muscle_analyzer.core.loads.load_solver import LoadSolver
from muscle_analyzer.core.loads.lumbar_balance import (
    AbdomenSupport,
    LumbarBalance,
    balanced_model,
)
from muscle_analyzer.core.loads.lumbar_moments import lumbar_moments
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import posture_paths

FORMS = {
    'opensim': (LumbarBalance.COUPLED, AbdomenSupport.RHYTHM),
    'sacrum': (LumbarBalance.COUPLED, AbdomenSupport.SACRUM),
    'levels': (LumbarBalance.LEVELS, AbdomenSupport.SACRUM),
}
LEVELS = ('L5_S1', 'L4_L5', 'L3_L4', 'L2_L3', 'L1_L2', 'L1_T12')
AXES = ('Flex_Ext', 'Lat_Bending', 'axial_rotation')


@pytest.fixture(scope='module')
def forms(lifting_multibody):
    return {name: balanced_model(lifting_multibody, *form) for name, form in FORMS.items()}


@pytest.fixture(scope='module')
def bent(lifting_multibody):
    """Return a bent and twisted posture (n_q,) of the coupled model."""
    q = lifting_multibody.default.copy()
    for name, value in zip(AXES, (-0.11, 0.02, 0.03), strict=True):
        q[lifting_multibody.coordinate_index(f'L5_S1_{name}')] = value
    return q


def arms_of(form, q):
    """Return moment arms (n_m, n_x) of a form at a posture of the coupled model."""
    model = form.model
    x = q[form.source] * form.gain + form.offset
    state = forward_kinematics(model.tree, x, 0.0 * x, 0.0 * x)
    paths = posture_paths(path_table(model), state, body_jacobians(model.tree, state))
    return paths.moment_arm


def test_opensims_form_is_the_model_itself(forms, lifting_multibody):
    assert forms['opensim'].model is lifting_multibody
    assert forms['opensim'].lumbar == tuple(f'L5_S1_{axis}' for axis in AXES)
    assert len(forms['levels'].lumbar) == 18


@pytest.mark.parametrize('axis', AXES)
def test_arms_of_levels_and_abdomen_add_up_to_the_coupled_arm(forms, bent, axis):
    """By virtual work, with the coefficients of the couplers."""
    opensim, levels = forms['opensim'], forms['levels']
    coupled = arms_of(opensim, bent)[:, opensim.model.coordinate_index(f'L5_S1_{axis}')]
    arms = arms_of(levels, bent)
    follows = levels.source == opensim.model.coordinate_index(f'L5_S1_{axis}')
    assert follows.sum() == 7
    assert arms[:, follows] @ levels.gain[follows] == pytest.approx(coupled, abs=1e-12)


def test_upper_obliques_are_back_extensors_only_in_opensims_form(forms, bent):
    """An extensor has a positive arm about the flexion-extension coordinate."""
    obliques = [
        i
        for i, muscle in enumerate(forms['opensim'].model.source.muscles)
        if muscle.name in ('EO2_r', 'EO3_r', 'EO4_r')
    ]
    arm = {
        name: arms_of(form, bent)[obliques, form.model.coordinate_index('L5_S1_Flex_Ext')]
        for name, form in forms.items()
    }
    assert (arm['opensim'] > 0.05).all()
    assert (arm['sacrum'] < -0.05).all()
    assert (arm['levels'] < 0.0).all()


def test_a_coupler_that_is_not_linear_is_not_released(lifting_multibody):
    source = lifting_multibody.source
    curve = next(
        axis.function
        for joint in source.joints
        for axis in joint.rotations + joint.translations
        if not axis.function.is_line() and not axis.function.is_constant()
    )
    couplers = tuple(
        replace(c, function=curve) if c.dependent == 'L4_L5_Flex_Ext' else c
        for c in source.couplers
    )
    model = compile_model(replace(source, couplers=couplers))
    with pytest.raises(OptionError, match='L4_L5_Flex_Ext_con: only a linear one'):
        balanced_model(model, *FORMS['levels'])


@pytest.mark.parametrize('option', ['lumbar_balance', 'abdomen'])
def test_an_unknown_option_is_refused(lifting_multibody, option):
    with pytest.raises(OptionError, match=f"{option} 'stiff' is not known"):
        LoadSolver(lifting_multibody, MuscleAnalyzerOptions(**{option: 'stiff'}))


@pytest.fixture(scope='module')
def analyses(box_lift):
    """Return the analysis of a lift in each form."""
    return {
        name: type(box_lift.analyzer)(
            box_lift.analyzer.subject,
            MuscleAnalyzerOptions(lumbar_balance=balance, abdomen=abdomen),
            box_lift.analyzer.generic_model,
        ).analyze(box_lift.body, 'lift', 'measured')
        for name, (balance, abdomen) in FORMS.items()
    }


def test_torques_of_the_levels_do_the_work_of_the_coupled_torque(analyses, forms):
    levels, opensim = analyses['levels'], analyses['opensim']
    for axis in AXES:
        wanted = opensim.torque[:, opensim.coordinate_names.index(f'L5_S1_{axis}')]
        form = forms['levels']
        names = [f'{level}_{axis}' for level in LEVELS]
        own = levels.torque[:, [levels.coordinate_names.index(name) for name in names]]
        gain = form.gain[[form.model.coordinate_index(name) for name in names]]
        # The rest is the weight of the abdominal body, 1 g.
        assert own @ gain == pytest.approx(wanted, abs=0.01)


def test_levels_leave_the_reserves_alone_in_the_joints(analyses):
    analysis = analyses['levels']
    parts = lumbar_moments(analysis)
    assert parts.levels == ('l5_s1', 'l4_l5', 'l3_l4', 'l2_l3', 'l1_l2', 't12_l1')
    for j, level in enumerate(LEVELS):
        flexion = analysis.reserve[:, analysis.coordinate_names.index(f'{level}_Flex_Ext')]
        # The flexion axis of a level is the lateral axis of its lower segment; the upper one, in
        # whose frame the moment is given, is turned about that axis but for small angles.
        assert -parts.reserve[:, j, 1] == pytest.approx(flexion, abs=0.2)
    np.testing.assert_allclose(parts.muscles + parts.reserve, parts.net, atol=1e-9)
    assert not parts.abdomen.any()
    assert parts.unassigned == pytest.approx(0.0, abs=1e-12)


def test_opensims_form_leaves_the_pull_on_the_abdomen_in_the_levels(analyses, forms):
    """The weighted sum of what the joints keep is the abdominal body's moment, 7.14 times."""
    analysis = analyses['opensim']
    parts = lumbar_moments(analysis)
    form = forms['levels']
    gain = form.gain[[form.model.coordinate_index(f'{level}_Flex_Ext') for level in LEVELS]]
    work = parts.rhythm[:, :, 1] @ gain
    whole = (parts.rhythm + parts.abdomen)[:, :, 1] @ gain
    assert np.abs(whole).max() > 20.0
    assert np.abs(work).max() < 0.03 * np.abs(whole).max()
    assert parts.unassigned.max() > 0.1


def test_with_the_sacrum_as_support_the_levels_keep_no_work(analyses, forms):
    parts = lumbar_moments(analyses['sacrum'])
    form = forms['levels']
    gain = form.gain[[form.model.coordinate_index(f'{level}_Flex_Ext') for level in LEVELS]]
    assert np.abs(parts.rhythm[:, :, 1] @ gain).max() < 0.5
    assert not parts.abdomen.any()


def test_the_net_moment_does_not_depend_on_the_balance(analyses):
    for name in ('sacrum', 'levels'):
        np.testing.assert_allclose(
            analyses[name].joint_net_moment, analyses['opensim'].joint_net_moment, atol=1e-9
        )
    # About L5-S1 it is the net moment of the analysis, in another frame.
    analysis = analyses['levels']
    np.testing.assert_allclose(
        np.linalg.norm(analysis.joint_net_moment[:, 0], axis=1),
        np.linalg.norm(analysis.net_moment_top_down, axis=1),
        rtol=1e-12,
    )


def test_a_reserve_above_its_limit_is_reported(box_lift):
    """A back of 5 % of its strength leaves the levels to the reserves, and the report says so."""
    generic = box_lift.analyzer.generic_model
    weak = replace(
        generic,
        muscles=tuple(
            replace(muscle, max_isometric_force=0.05 * muscle.max_isometric_force)
            for muscle in generic.muscles
        ),
    )
    options = MuscleAnalyzerOptions(lumbar_balance='levels')
    analyzer = type(box_lift.analyzer)(box_lift.analyzer.subject, options, weak)
    analysis = analyzer.analyze(box_lift.body, 'lift', 'measured')
    assert (analysis.spine_status == SolveStatus.MUSCLE_TOO_WEAK).any()
    assert 'L5-S1 not balanced at' in analysis.spine_report.message
