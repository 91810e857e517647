# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The real OpenSim on exported folders. Skipped where there is none (`make opensim`).

A pendulum of two links takes OpenSim no time; one sample of the lifting full-body model takes it
seconds, so that comparison is among the long tests.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import OpenSimError
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.multibody.inverse_dynamics import inverse_dynamics
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import muscle_paths
from muscle_analyzer.core.opensim_bridge import setup_files as files
from muscle_analyzer.core.opensim_bridge.compare import compare
from muscle_analyzer.core.opensim_bridge.export import ExportOptions, export_motion
from muscle_analyzer.core.opensim_bridge.motion_on_model import MotionOnModel
from muscle_analyzer.core.opensim_bridge.own_results import OwnSide
from muscle_analyzer.core.opensim_bridge.process import find_opensim, run_opensim
from muscle_analyzer.core.opensim_bridge.results import read_opensim
from muscle_analyzer.core.osim.reader import read_osim
from muscle_analyzer.core.recruitment.reserves import Reserve


@pytest.fixture(scope='module')
def opensim():
    try:
        return find_opensim()
    except OpenSimError as error:
        pytest.skip(str(error))


@pytest.fixture
def swing(write_model, tmp_path, opensim, monkeypatch):
    """Return a swinging pendulum with a push on its lower link, and OpenSim's answer."""
    model = compile_model(read_osim(write_model()))
    monkeypatch.setattr(
        'muscle_analyzer.core.opensim_bridge.export.read_reserves',
        lambda names: tuple(Reserve(name, name, 10.0, False) for name in names),
    )
    time = 0.01 * np.arange(41)
    q = np.stack([0.5 * np.sin(3.0 * time), 0.3 + 0.4 * np.cos(4.0 * time)], axis=1)
    force = np.tile([3.0, -2.0, 1.0], (time.size, 1)) * np.cos(time)[:, None]
    point = np.tile([0.1, -0.5, 0.02], (time.size, 1)) + 0.05 * time[:, None]
    push = files.PointForce('push', 'lower', force, point, 0.3 * force)
    motion = MotionOnModel(model, time, q, 0.0 * q, 0.0 * q, (push,)).with_splined_rates()
    folder = tmp_path / 'swing'
    export_motion(folder, motion)
    rows = motion.rows(np.array([0.11, 0.2, 0.3]))
    run_opensim(opensim, folder, motion.time[rows], print)
    run = read_opensim(folder, motion, ('flexor',), model.coordinate_names, rows)
    return SimpleNamespace(motion=motion, rows=rows, run=run, folder=folder)


def test_torques_of_a_pendulum_under_a_push(swing):
    motion = swing.motion
    for k in range(motion.time.size):
        state = forward_kinematics(motion.model.tree, motion.q[k], motion.qd[k], motion.qdd[k])
        ours = inverse_dynamics(motion.model.tree, state, motion.external(k)).tree_force
        np.testing.assert_allclose(swing.run.answer.torque[k], ours, atol=1e-5)


def test_path_and_moment_arms_of_a_pendulum(swing):
    tree = swing.motion.model.tree
    for i, k in enumerate(swing.rows):
        q = swing.motion.q[k]
        state = forward_kinematics(tree, q, 0.0 * q, 0.0 * q)
        paths = muscle_paths(
            path_table(swing.motion.model), state.position, state.rotation,
            body_jacobians(tree, state),
        )  # fmt: skip
        np.testing.assert_allclose(swing.run.answer.length[i], paths.length, atol=1e-9)
        np.testing.assert_allclose(swing.run.answer.moment_arm[i], paths.moment_arm, atol=1e-9)


def test_muscle_and_reserves_balance_the_torques_of_a_pendulum(swing):
    """The optimisation saw the same torques: what it found adds up to them."""
    answer, motion = swing.run.answer, swing.motion
    strength = motion.model.source.muscles[0].max_isometric_force
    for i, k in enumerate(swing.rows):
        torque = answer.moment_arm[i].T @ answer.force[i] + answer.reserve[i]
        np.testing.assert_allclose(torque, answer.torque[k], atol=2e-3)
        np.testing.assert_allclose(answer.force[i], strength * answer.activation[i], rtol=1e-6)


def test_all_instants_in_one_run_of_each_tool_as_well(swing, opensim, tmp_path):
    """The set-ups lead to every tenth sample; the answer is the same as of runs apart."""
    motion = swing.motion
    names, coordinates = ('flexor',), motion.model.coordinate_names
    rows = np.array([10, 20, 30])
    answers = []
    for together in (False, True):
        folder = tmp_path / f'together_{together}'
        export_motion(folder, motion, ExportOptions(samples_per_solution=10))
        run_opensim(opensim, folder, motion.time[rows], print, together)
        answers.append(read_opensim(folder, motion, names, coordinates, rows).answer)
    for field in ('force', 'reserve', 'reaction', 'moment_arm'):
        apart, one = (getattr(answer, field) for answer in answers)
        np.testing.assert_allclose(one, apart, atol=1e-3)


def test_a_folder_without_its_model_fails_with_opensims_words(swing, opensim):
    (swing.folder / files.MODEL).unlink()
    with pytest.raises(OpenSimError, match=r'exit code 1(?s:.*)model\.osim'):
        run_opensim(opensim, swing.folder, swing.motion.time[swing.rows[:1]], print)


@pytest.mark.long
def test_a_lift_with_the_full_body_model(box_lift, opensim, tmp_path):
    """One instant; the limits are the agreed ones, what was measured is in docs/opensim.md."""
    options = MuscleAnalyzerOptions()
    motion = box_lift.motion.with_splined_rates()
    rows = motion.rows(np.array([0.15]))
    export_motion(tmp_path, box_lift.motion)
    run_opensim(opensim, tmp_path, motion.time[rows], print)
    own = OwnSide(motion, options)
    run = read_opensim(tmp_path, motion, own.muscle_names, own.coordinate_names, rows)
    result = compare(box_lift.motion, motion, rows, run, options)
    assert run.version.startswith('4.6')
    assert result.difference('joint torque').percent_of_peak < 0.1
    arm = result.difference('moment arm')
    assert arm.median < 0.1
    assert arm.largest < 1.0
    for instant in result.instants:
        ours, theirs = instant.cost_equal_torques
        assert ours <= theirs
        assert instant.compression[0] == pytest.approx(instant.compression[1], rel=0.02)
    assert result.difference('force on L5-S1, equal muscle forces').largest < 0.1
