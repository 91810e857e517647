# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The comparison without OpenSim: its files written here from this project's numbers.

Unchanged numbers give no difference; a number that was changed is found at its place, and in the
steps that hang on it only.
"""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from human_model.exceptions import StorageError
from human_model.opensim_storage import Storage, write_storage
from muscle_analyzer.core.exceptions import OpenSimError
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.opensim_bridge import setup_files as files
from muscle_analyzer.core.opensim_bridge.compare import DIFFERENT_PROBLEM, compare, difference
from muscle_analyzer.core.opensim_bridge.own_results import OwnSide
from muscle_analyzer.core.opensim_bridge.results import read_opensim
from muscle_analyzer.core.recruitment.reserves import read_reserves
from muscle_analyzer.core.recruitment.static_optimization import StaticOptimizationOptions

OPTIONS = MuscleAnalyzerOptions()
#: The forces that OpenSim calls so are those of coordinates that are no plain rotation.
FORCES = ('_tx', '_ty', '_tz', '_beta', 'Abs_t1', 'Abs_t2')


@pytest.fixture(scope='module')
def own(box_lift):
    """Return this project's side, with the answer for two instants."""
    motion = box_lift.motion.with_splined_rates()
    side = OwnSide(motion, OPTIONS)
    rows = motion.rows(np.array([0.1, 0.15]))
    return SimpleNamespace(side=side, motion=motion, rows=rows, answer=side.answer(rows))


def write_results(folder, own, **changes):
    """Write what OpenSim's tools and the script would, in another order of columns."""
    results = folder / files.RESULTS
    results.mkdir()
    motion, side = own.motion, own.side
    parts = vars(own.answer) | changes
    time = motion.time[own.rows]
    suffix = ['_force' if name.endswith(FORCES) else '_moment'
              for name in motion.model.tree_coordinate_names]  # fmt: skip
    labels = [n + s for n, s in zip(motion.model.tree_coordinate_names, suffix, strict=True)]

    def write(name, columns, stamps, values):
        turned = Storage(name, tuple(columns[::-1]), stamps, values[:, ::-1])
        write_storage(results / name, turned)

    write(files.TORQUES_RESULT, labels, motion.time, parts['torque'])
    reserves = [files.RESERVE_PREFIX + name for name in side.coordinate_names]
    forces = np.hstack([parts['force'], parts['reserve']])
    write(files.FORCES_RESULT, [*side.muscle_names, *reserves], time, forces)
    write(files.ACTIVATIONS_RESULT, list(side.muscle_names), time, parts['activation'])
    joints = zip(motion.model.joint_names[1:], motion.model.body_names[1:], strict=True)
    columns = [
        f'{joint}_on_{body}_in_ground_{kind}{axis}'
        for joint, body in joints for kind in 'mf' for axis in 'xyz'
    ]  # fmt: skip
    write(files.REACTIONS_RESULT, columns, time, parts['reaction'][:, 1:].reshape(2, -1))
    stored = {
        'opensim': '4.6-test',
        'times': parts.get('times', time.tolist()),
        'seconds': {'static_optimization': [3.0, 3.5]},
        'muscles': list(side.muscle_names[::-1]),
        'coordinates': list(side.coordinate_names[::-1]),
        'length': parts['length'][:, ::-1].tolist(),
        'moment_arm': parts['moment_arm'][:, ::-1, ::-1].tolist(),
    }
    (results / files.SCRIPT_RESULT).write_text(json.dumps(stored), encoding='utf-8')
    return folder


def read(folder, own):
    side = own.side
    return read_opensim(folder, own.motion, side.muscle_names, side.coordinate_names, own.rows)


def compared(box_lift, own, folder, options=OPTIONS):
    return compare(box_lift.motion, own.motion, own.rows, read(folder, own), options)


def test_files_come_back_in_this_projects_order(own, tmp_path):
    run = read(write_results(tmp_path, own), own)
    for name, value in vars(own.answer).items():
        # The ground hangs on no joint.
        part = np.s_[:, 1:] if name == 'reaction' else np.s_[:]
        found = getattr(run.answer, name)[part]
        np.testing.assert_allclose(found, value[part], rtol=1e-12, atol=1e-12, err_msg=name)
    assert run.version == '4.6-test'
    assert run.seconds == {'static_optimization': [3.0, 3.5]}


def test_equal_answers_have_no_difference(box_lift, own, tmp_path):
    result = compared(box_lift, own, write_results(tmp_path, own))
    for row in result.differences:
        if row.quantity != 'joint torque, rates of the analysis':
            assert row.percent_of_peak < 1e-6, row
    rates = result.difference('joint torque, rates of the analysis')
    assert 1e-3 < rates.percent_of_peak < 10.0
    for instant in result.instants:
        assert instant.compression[0] == pytest.approx(instant.compression[1])
        assert instant.compression[0] > 1000.0
    assert json.loads(json.dumps(result.as_dict()))['version'] == '4.6-test'


def test_the_disc_frame_is_that_of_the_analysis(box_lift, own, tmp_path):
    """The loads by instant are those that the analysis reports, up to the rates."""
    result = compared(box_lift, own, write_results(tmp_path, own))
    analysis = box_lift.analyzer.analyze(box_lift.body, 'lift', 'measured')
    for instant, k in zip(result.instants, own.rows, strict=True):
        assert instant.compression[0] == pytest.approx(analysis.compression[k], rel=0.01)
        assert instant.anterior_shear[0] == pytest.approx(analysis.anterior_shear[k], rel=0.02)
        assert instant.lateral_shear[0] == pytest.approx(analysis.l5_s1_force[k, 1], abs=2.0)


def test_a_torque_that_differs_is_found_at_its_place(box_lift, own, tmp_path):
    torque = own.answer.torque.copy()
    k = own.motion.model.tree_coordinate_names.index('hip_flexion_l')
    torque[7, k] += 5.0
    result = compared(box_lift, own, write_results(tmp_path, own, torque=torque))
    row = result.difference('joint torque')
    assert row.where == 'hip_flexion_l, 0.070 s'
    assert row.largest == pytest.approx(5.0)
    assert row.opensim - row.ours == pytest.approx(5.0)
    assert row.percent_of_peak == pytest.approx(500.0 / np.abs(torque[:, 6:]).max(), rel=0.5)
    assert result.difference('pelvis residual force').largest < 1e-8


def test_a_moment_arm_that_differs_is_found_at_its_place(box_lift, own, tmp_path):
    arm = own.answer.moment_arm.copy()
    names = own.side.muscle_names, own.side.coordinate_names
    i, j = names[0].index('glmax1_r'), names[1].index('hip_flexion_r')
    arm[1, i, j] += 0.002
    result = compared(box_lift, own, write_results(tmp_path, own, moment_arm=arm))
    row = result.difference('moment arm')
    assert row.where == 'glmax1_r about hip_flexion_r, 0.150 s'
    assert row.largest == pytest.approx(2.0)
    assert row.median == 0.0


def test_forces_that_cost_more_are_told_apart_from_the_steps_after(box_lift, own, tmp_path):
    """Pull more than needed with four muscles, and say so in the reactions.

    The cost at equal torques is above this project's; the reaction at equal muscle forces agrees.
    """
    force = own.answer.force.copy()
    for name in ('IL_L1_r', 'IL_L1_l', 'rect_abd_r', 'rect_abd_l'):
        force[:, own.side.muscle_names.index(name)] += 60.0
    strength = np.array([m.max_isometric_force for m in own.motion.model.source.muscles])
    reaction = np.array(
        [own.side.reactions(int(k), row) for k, row in zip(own.rows, force, strict=True)]
    )
    result = compared(
        box_lift,
        own,
        write_results(tmp_path, own, force=force, activation=force / strength, reaction=reaction),
    )
    for instant in result.instants:
        assert instant.cost_equal_torques[0] < instant.cost_equal_torques[1]
        assert instant.compression[1] > instant.compression[0] + 100.0
    assert result.difference('muscle force').largest == pytest.approx(60.0)
    assert result.difference('muscle strength').largest < 1e-6
    assert result.difference('muscle force, equal torques').largest > 10.0
    assert result.difference('force on L5-S1').largest > 100.0
    assert result.difference('force on L5-S1, equal muscle forces').largest < 1e-6
    assert result.difference('force on any joint, equal muscle forces').largest < 1e-6


def test_min_max_is_compared_only_where_opensims_squares_allow(box_lift, own, tmp_path):
    criterion = StaticOptimizationOptions(criterion='min_max')
    options = MuscleAnalyzerOptions(static_optimization=criterion)
    result = compared(box_lift, own, write_results(tmp_path, own), options)
    assert result.criterion == 'min_max'
    assert result.not_compared == DIFFERENT_PROBLEM
    assert not {row.quantity for row in result.differences} & set(DIFFERENT_PROBLEM)
    # What takes OpenSim's activations, forces or torques has no difference all the same.
    for row in result.differences:
        if 'rates of the analysis' not in row.quantity:
            assert row.percent_of_peak < 1e-6, row
    assert result.difference('force on L5-S1, equal activations').ours > 1000.0
    # The loads by instant are those of the two criteria, and differ.
    assert any(abs(i.compression[0] - i.compression[1]) > 1.0 for i in result.instants)


def test_optimum_balances_the_torques_of_the_forces_that_it_is_given(own):
    """Forces and reserves of the smallest cost give the same torques; optimal ones stay."""
    side, answer = own.side, own.answer
    k, activation = int(own.rows[0]), answer.activation[0]
    smallest, given, forces = side.optimum(k, answer.force[0], activation, answer.reserve[0])
    assert smallest == pytest.approx(given, rel=1e-9)
    np.testing.assert_allclose(forces, answer.force[0], atol=1e-6)
    rng = np.random.default_rng(2)
    more = rng.uniform(1.0, 1.3, activation.size)
    other = more * answer.force[0]
    smallest, given, forces = side.optimum(k, other, more * activation, answer.reserve[0])
    assert smallest < given
    arm = answer.moment_arm[0]
    muscles = [k for k, r in enumerate(read_reserves(side.coordinate_names)) if r.muscle_driven]
    unit = np.array([r.torque for r in read_reserves(side.coordinate_names)])
    # What the muscles do not balance the reserves do, and that is part of the smallest cost.
    left = (arm.T @ other + answer.reserve[0] - arm.T @ forces) / unit
    strength = np.array([m.max_isometric_force for m in own.motion.model.source.muscles])
    cost = np.sum((forces / strength) ** 2) + np.sum(left**2)
    assert cost == pytest.approx(smallest, rel=1e-6)
    assert np.abs(left[muscles]).max() < 1.0


def test_results_of_other_instants_are_refused(own, tmp_path):
    write_results(tmp_path, own, times=[0.1, 0.2])
    with pytest.raises(OpenSimError, match=r'opensim\.json: at \[0\.1 0\.2\] s, not at'):
        read(tmp_path, own)


def test_results_that_are_missing_are_named(own, tmp_path):
    with pytest.raises(OpenSimError, match=r'opensim\.json: cannot be read'):
        read(tmp_path, own)
    write_results(tmp_path, own)
    (tmp_path / files.RESULTS / files.REACTIONS_RESULT).unlink()
    with pytest.raises(StorageError, match=f'{files.REACTIONS_RESULT}: cannot be read'):
        read(tmp_path, own)


def test_difference_takes_the_largest_and_opensims_peak():
    row = difference(
        'torque', 'N m', np.array([[1.0, 2.0], [3.0, -4.5]]), np.array([[1.0, 2.5], [3.0, -5.5]]),
        lambda index: f'{index}',
    )  # fmt: skip
    assert (row.where, row.ours, row.opensim, row.largest) == ('(1, 1)', -4.5, -5.5, 1.0)
    assert row.percent_of_peak == pytest.approx(100.0 / 5.5)
    assert row.rms == pytest.approx(np.sqrt((0.25 + 1.0) / 4.0))
    assert (row.median, row.count) == (0.25, 4)
