# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""An exported folder is complete, refers to its own files only, and holds the same motion."""

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from human_model.exceptions import StorageError
from human_model.opensim_storage import read_storage, write_storage
from muscle_analyzer.core.exceptions import InputArrayError, TransferError
from muscle_analyzer.core.multibody.inverse_dynamics import add_force, inverse_dynamics
from muscle_analyzer.core.multibody.kinematics import forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.opensim_bridge import setup_files as files
from muscle_analyzer.core.opensim_bridge.export import (
    ExportOptions,
    export_motion,
    read_coordinates,
    rotational_coordinates,
)
from muscle_analyzer.core.opensim_bridge.motion_on_model import motion_on_model
from muscle_analyzer.core.osim.reader import read_osim
from muscle_analyzer.core.recruitment.reserves import read_reserves


@pytest.fixture(scope='module')
def folder(box_lift, tmp_path_factory):
    place = tmp_path_factory.mktemp('exported') / 'new' / 'folder'
    export_motion(place, box_lift.motion, ExportOptions(exponent=3.0))
    return place


def root(path):
    document = ElementTree.parse(path).getroot()
    assert document.tag == 'OpenSimDocument'
    return document[0]


def texts(element):
    """Return the words of all leaves by their tag."""
    return {leaf.tag: (leaf.text or '').strip() for leaf in element.iter() if not len(leaf)}


def test_the_motion_is_that_of_the_analysis(box_lift):
    """The torques of this motion are those of the analysis, sample by sample."""
    analysis = box_lift.analyzer.analyze(box_lift.body, 'lift', 'measured')
    motion, tree = box_lift.motion, box_lift.motion.model.tree
    names = list(motion.model.coordinate_names)
    about = [names.index(name) for name in analysis.coordinate_names]
    assert motion.time == pytest.approx(0.01 * np.arange(31), abs=1e-12)
    for k in range(motion.time.size):
        state = forward_kinematics(tree, motion.q[k], motion.qd[k], motion.qdd[k])
        force = inverse_dynamics(tree, state, motion.external(k)).force
        np.testing.assert_allclose(force[about], analysis.torque[k], atol=1e-6)


def test_splined_rates_belong_to_the_positions(box_lift):
    """Of a motion whose derivatives are known, away from the ends."""
    motion = box_lift.motion
    angle = 5.0 * motion.time[:, None] + np.arange(motion.q.shape[1])
    splined = replace(motion, q=np.sin(angle)).with_splined_rates()
    inner = slice(10, -10)
    np.testing.assert_allclose(splined.qd[inner], 5.0 * np.cos(angle)[inner], atol=1e-5)
    np.testing.assert_allclose(splined.qdd[inner], -25.0 * np.sin(angle)[inner], atol=1e-3)
    np.testing.assert_array_equal(splined.q, np.sin(angle))


def test_the_model_computes_the_same_torques(box_lift, folder):
    model = compile_model(read_osim(folder / files.MODEL))
    motion = box_lift.motion
    assert model.tree_coordinate_names == motion.model.tree_coordinate_names
    for k in (0, 17):
        results = []
        for tree in (model.tree, motion.model.tree):
            state = forward_kinematics(tree, motion.q[k], motion.qd[k], motion.qdd[k])
            results.append(inverse_dynamics(tree, state, motion.external(k)).tree_force)
        np.testing.assert_allclose(*results, atol=1e-9)


def test_coordinates_come_back_and_hold_the_coupled_ones(box_lift, folder):
    motion = box_lift.motion
    time, q = read_coordinates(folder / files.COORDINATES, motion.model)
    np.testing.assert_allclose(time, motion.time, atol=1e-12)
    np.testing.assert_array_equal(q, motion.q)
    table = read_storage(folder / files.COORDINATES)
    assert table.columns == motion.model.tree_coordinate_names
    for coupler in motion.model.source.couplers:
        driver = table.column(coupler.independent)
        want = [coupler.function.derivatives(x)[0] for x in driver]
        np.testing.assert_allclose(table.column(coupler.dependent), want, atol=1e-12)


def test_coordinates_in_degrees_are_read_as_opensim_writes_them(box_lift, folder, tmp_path):
    """Angles in degrees, lengths and the patella's coordinate as they are."""
    model = box_lift.motion.model
    angles = rotational_coordinates(model)
    assert 'knee_angle_r' in angles
    assert not {'pelvis_tx', 'knee_angle_r_beta'} & set(angles)
    table = read_storage(folder / files.COORDINATES)
    factor = [180.0 / np.pi if name in angles else 1.0 for name in table.columns]
    path = tmp_path / 'degrees.mot'
    write_storage(path, replace(table, values=table.values * factor, in_degrees=True))
    _, q = read_coordinates(path, model)
    np.testing.assert_allclose(q, box_lift.motion.q, atol=1e-14)


def test_a_file_without_a_coordinate_is_refused(box_lift, folder, tmp_path):
    table = read_storage(folder / files.COORDINATES)
    keep = [k for k, name in enumerate(table.columns) if name != 'hip_flexion_l']
    path = tmp_path / 'less.mot'
    columns = tuple(table.columns[k] for k in keep)
    write_storage(path, replace(table, columns=columns, values=table.values[:, keep]))
    with pytest.raises(StorageError, match=r"less.mot: .*coordinate 'hip_flexion_l'"):
        read_coordinates(path, box_lift.motion.model)


def test_external_loads_give_the_same_wrenches(box_lift, folder):
    """Rebuilt from the two files as OpenSim reads them: by names of bodies and columns."""
    motion = box_lift.motion
    table = read_storage(folder / files.LOADS_DATA)
    loads = root(folder / files.LOADS)
    assert texts(loads)['datafile'] == files.LOADS_DATA
    forces = [texts(element) for element in loads.iter('ExternalForce')]
    assert [force['applied_to_body'] for force in forces] == [
        'calcn_r', 'calcn_l', 'hand_r', 'hand_l',
    ]  # fmt: skip
    np.testing.assert_allclose(table.time, motion.time, atol=1e-12)
    for k in range(motion.time.size):
        wrenches = np.zeros((len(motion.model.body_names), 6))
        for force in forces:
            assert force['force_expressed_in_body'] == 'ground'
            assert force['point_expressed_in_body'] == 'ground'
            parts = [
                table.select([force[f'{what}_identifier'] + axis for axis in 'xyz'])[k]
                for what in ('force', 'point', 'torque')
            ]
            body = motion.model.body_index(force['applied_to_body'])
            add_force(wrenches, body, *parts)
        np.testing.assert_allclose(wrenches, motion.external(k), atol=1e-9)
    # OpenSim's y is up; the left foot is off the ground at the end, the box pulls down.
    assert (table.column('ground_force_right_vy') == 420.0).all()
    assert (table.column('ground_force_left_vy')[-3:] == 0.0).all()
    assert (table.column('hand_force_left_vy') == -58.0).all()


def test_every_coordinate_has_its_reserve(box_lift, folder):
    elements = list(root(folder / files.RESERVES).iter('CoordinateActuator'))
    found = {texts(e)['coordinate']: float(texts(e)['optimal_force']) for e in elements}
    names = box_lift.motion.model.coordinate_names
    assert found == {reserve.coordinate: reserve.torque for reserve in read_reserves(names)}
    assert {e.get('name') for e in elements} == {files.RESERVE_PREFIX + name for name in names}


@pytest.mark.parametrize(
    ('name', 'tag'),
    [
        (files.INVERSE_DYNAMICS, 'InverseDynamicsTool'),
        (files.STATIC_OPTIMIZATION, 'AnalyzeTool'),
        (files.JOINT_REACTION, 'AnalyzeTool'),
    ],
)
def test_set_ups_name_files_that_are_there(folder, name, tag):
    setup = root(folder / name)
    assert setup.tag == tag
    words = texts(setup)
    for key in ('model_file', 'external_loads_file', 'coordinates_file', 'force_set_files'):
        if key in words:
            assert (folder / words[key]).is_file(), key
    assert {'model_file', 'external_loads_file', 'coordinates_file'} <= words.keys()
    assert words['results_directory'] == files.RESULTS
    # Unfiltered, over the whole motion: what is filtered here must not be filtered again.
    assert float(words['lowpass_cutoff_frequency_for_coordinates']) < 0.0
    span = words.get('time_range') or f'{words["initial_time"]} {words["final_time"]}'
    assert [float(part) for part in span.split()] == pytest.approx([0.0, 0.3], abs=1e-12)


def test_options_reach_the_set_up_of_the_optimisation(box_lift, folder, tmp_path):
    words = texts(root(folder / files.STATIC_OPTIMIZATION))
    assert (float(words['activation_exponent']), words['use_muscle_physiology']) == (3.0, 'false')
    export_motion(tmp_path, box_lift.motion, ExportOptions(physiology=True))
    words = texts(root(tmp_path / files.STATIC_OPTIMIZATION))
    assert (float(words['activation_exponent']), words['use_muscle_physiology']) == (2.0, 'true')
    reaction = texts(root(folder / files.JOINT_REACTION))
    assert reaction['forces_file'] == f'{files.RESULTS}/{files.FORCES_RESULT}'
    assert (reaction['apply_on_bodies'], reaction['express_in_frame']) == ('child', 'ground')


def test_a_force_that_is_not_a_number_is_not_written(box_lift, tmp_path):
    motion = box_lift.motion
    pull = motion.forces[2].force.copy()
    pull[4, 1] = np.nan
    hand = replace(motion.forces[2], force=pull)
    broken = replace(motion, forces=(*motion.forces[:2], hand))
    with pytest.raises(StorageError, match=r"'hand_force_right_vy': nan at 0\.04 s is not"):
        export_motion(tmp_path, broken)


def test_instants_are_samples_and_must_be_in_the_lift(box_lift):
    motion = box_lift.motion
    assert motion.rows(np.array([0.101, 0.2, 0.0999])).tolist() == [10, 20]
    with pytest.raises(InputArrayError, match=r'instant 0\.5 s is outside the lift, 0 to 0\.3 s'):
        motion.rows(np.array([0.1, 0.5]))
    with pytest.raises(InputArrayError, match='no instants'):
        motion.rows(np.array([]))


def test_a_sample_that_cannot_be_taken_over_is_named(box_lift, monkeypatch):
    monkeypatch.setattr('muscle_analyzer.core.transfer.motion_transfer.MAX_ITERATIONS', 0)
    transfer = box_lift.analyzer.new_transfer(box_lift.body.skeleton)
    with pytest.raises(TransferError, match=r'sample at 0\.000 s: not converged in 0 iterations'):
        motion_on_model(transfer, box_lift.body, 1.7e9)
