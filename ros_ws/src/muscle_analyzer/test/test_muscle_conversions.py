# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Results of the analyzer as messages: shapes, signs, statuses, and what readers make of them."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from lifting_interfaces.msg import SpineLoad

from human_model.report import SolveReport, SolveStatus
from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from lifting_messages.stamps import to_seconds
from muscle_analyzer import conversions
from muscle_analyzer.core.loads.analysis import MuscleAnalysis
from muscle_analyzer.core.loads.torque_limits import JointTorques

N, N_M, N_C = 2, 3, 4
WEAK = SolveReport(SolveStatus.MUSCLE_TOO_WEAK, 'weak hip', 7, 1.5, 1e-9, 2e-9, 0.001, 0.002)


def numbers(*shape):
    """Return distinct numbers, so that a swapped axis shows."""
    return np.arange(np.prod(shape), dtype=float).reshape(shape) + 1.0


@pytest.fixture
def analysis():
    return MuscleAnalysis(
        lift_id='lift_003',
        source='measured',
        pseudonym='p01',
        body_mass=63.5,
        time=np.array([1000.25, 1000.26]),
        muscle_names=('a', 'b', 'c'),
        activation=numbers(N, N_M) / 10.0,
        force=numbers(N, N_M),
        coordinate_names=('k', 'l', 'm', 'n'),
        torque=numbers(N, N_C),
        reserve=-numbers(N, N_C),
        disc_frame='bruno2015',
        disc_position=0.1 * numbers(N, 3),
        disc_orientation=np.array([[0.0, 0.6, 0.0, 0.8], [0.0, 0.0, 0.0, 1.0]]),
        l5_s1_force=np.array([[-300.0, 20.0, 3000.0], [-400.0, -10.0, 3500.0]]),
        l5_s1_moment=numbers(N, 3),
        joint_names=('l5_s1', 'hip_r'),
        joint_force=numbers(N, 2, 3),
        joint_moment=-numbers(N, 2, 3),
        joint_net_force=numbers(N, 2, 3),
        joint_net_moment=numbers(N, 2, 3),
        abdomen_moment=numbers(N, 3),
        lumbar_balance='coupled',
        abdomen='sacrum',
        compression_per_degree=np.array([1.0, 2.0]),
        anterior_shear_per_degree=np.array([3.0, 4.0]),
        net_moment_top_down=np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 5.0]]),
        net_moment_bottom_up=np.zeros((N, 3)),
        pelvis_residual=numbers(N, 6),
        hand_distance=np.array([[0.001, 0.002], [0.003, 0.001]]),
        foot_distance=np.array([[0.001, 0.004], [0.001, 0.001]]),
        trunk_angle=np.array([0.01, 0.02]),
        hand_angle=np.full((N, 2), 0.5),
        foot_angle=np.array([[0.03, 0.0], [0.0, 0.01]]),
        torque_status=np.array([0, 305]),
        spine_reports=(SolveReport(), replace(WEAK, message='weak back')),
        reports=(WEAK, WEAK),
    )


def check_block(message):
    assert (message.lift_id, message.source) == ('lift_003', SpineLoad.MEASURED)
    assert to_seconds(message.header.stamp) == pytest.approx(1000.25, abs=1e-6)
    np.testing.assert_allclose(message.time_from_start, [0.0, 0.01], atol=1e-9)


def test_muscle_analysis(analysis):
    message = conversions.analysis_to_msg(analysis)
    check_block(message)
    assert message.muscle_names == 'a\nb\nc'
    np.testing.assert_array_equal(np.reshape(message.force, (N, N_M)), analysis.force)
    np.testing.assert_array_equal(np.reshape(message.activation, (N, N_M)), analysis.activation)
    np.testing.assert_array_equal(np.reshape(message.torque, (N, N_C)), analysis.torque)
    np.testing.assert_array_equal(np.reshape(message.reserve, (N, N_C)), analysis.reserve)
    np.testing.assert_array_equal(message.pelvis_residual, numbers(N * 6))
    # Hands and feet, trunk and feet: the angle of the hands is not one of them.
    np.testing.assert_allclose(message.transfer_position_error, [0.004, 0.003])
    np.testing.assert_allclose(message.transfer_angle_error, [0.03, 0.02])
    assert list(message.status) == [302, 302]
    assert list(message.primal_residual) == [1e-9, 1e-9]
    assert list(message.dual_residual) == [2e-9, 2e-9]
    assert (message.report.status, message.report.iterations) == (302, 7)
    assert '2 of 2 samples' in message.report.message


def test_spine_load_has_its_own_status_and_signs(analysis):
    message = conversions.spine_load_to_msg(analysis, 12.0, 'cell_3/l5_s1')
    check_block(message)
    assert list(message.compression) == [3000.0, 3500.0]
    assert list(message.anterior_shear) == [300.0, 400.0]
    assert list(message.lateral_shear) == [20.0, -10.0]
    assert list(message.moment_difference) == [5.0, 5.0]
    assert list(message.net_moment) == [3.0, 4.0, 0.0, 0.0, 0.0, 5.0]
    assert list(message.status) == [0, 302]
    assert 'weak back' in message.report.message
    assert (message.subject, message.body_mass, message.box_mass) == ('p01', 63.5, 12.0)
    assert (message.header.frame_id, message.disc_frame) == ('cell_3/l5_s1', 'bruno2015')
    np.testing.assert_array_equal(message.disc_position, 0.1 * numbers(N * 3))
    assert list(message.disc_orientation) == [0.0, 0.6, 0.0, 0.8, 0.0, 0.0, 0.0, 1.0]
    assert list(message.compression_per_degree) == [1.0, 2.0]
    assert list(message.anterior_shear_per_degree) == [3.0, 4.0]


@pytest.mark.parametrize(
    ('station', 'name'),
    [
        ('/', 'l5_s1'),
        ('', 'l5_s1'),
        ('/cell_3', 'cell_3/l5_s1'),
        ('station_1', 'station_1/l5_s1'),
        ('/hall/cell_3', 'hall/cell_3/l5_s1'),
    ],
)
def test_frame_of_the_disc_has_the_name_of_the_station(station, name):
    assert conversions.disc_frame_id(station) == name


def test_reaction_only_of_good_samples(analysis):
    (message,) = conversions.reactions_to_msg(analysis, 'cell_3/l5_s1')
    force, torque = message.wrench.force, message.wrench.torque
    assert (force.x, force.y, force.z) == (-300.0, 20.0, 3000.0)
    assert (torque.x, torque.y, torque.z) == (1.0, 2.0, 3.0)
    assert message.header.frame_id == 'cell_3/l5_s1'
    assert to_seconds(message.header.stamp) == pytest.approx(1000.25, abs=1e-6)


def test_joint_reactions(analysis):
    message = conversions.joint_reactions_to_msg(analysis)
    check_block(message)
    assert message.joint_names == 'l5_s1\nhip_r'
    np.testing.assert_array_equal(message.force, analysis.joint_force.ravel())
    np.testing.assert_array_equal(message.moment, analysis.joint_moment.ravel())
    assert (message.subject, message.body_mass) == ('p01', 63.5)
    assert list(message.status) == [int(WEAK.status)] * N
    assert list(message.lumbar_status) == [0, int(WEAK.status)]


def test_joint_torques(analysis):
    torques = JointTorques(
        'lift_003',
        'predicted',
        analysis.time,
        ('hip', 'knee'),
        numbers(N, 2),
        -numbers(N, 2),
        2.0 * numbers(N, 2),
        np.array([0, 305]),
    )
    message = conversions.torques_to_msg(torques)
    assert message.source == SpineLoad.PREDICTED
    assert list(message.torque) == [1.0, 2.0, 3.0, 4.0]
    assert list(message.torque_lower) == [-1.0, -2.0, -3.0, -4.0]
    assert list(message.torque_upper) == [2.0, 4.0, 6.0, 8.0]
    assert (message.joint_names, list(message.status)) == ('hip\nknee', [0, 305])


def test_live_samples_say_so(analysis):
    live = replace(analysis, source='live', lift_id='')
    for message in (conversions.analysis_to_msg(live), conversions.spine_load_to_msg(live, 0.0)):
        assert (message.source, message.lift_id) == (SpineLoad.LIVE, '')


def test_mass_is_in_the_hands_while_the_box_pushes_them():
    skeleton = Skeleton3D.of(Subject('p01', 'male', 63.5, 1.69, 25))
    q = skeleton.standing()
    motion = skeleton.body_motion([0.0], q, 0.0 * q, 0.0 * q)
    assert conversions.mass_in_hands(motion, 12.0) == 0.0
    loaded = replace(motion, hand_force=np.full((1, 2, 3), -1.0))
    assert conversions.mass_in_hands(loaded, 12.0) == 12.0


def test_peaks_leave_out_samples_that_are_not_good(analysis):
    assert analysis.peak_compression == 3000.0
    assert analysis.good_spine_samples == 1
    bad = replace(analysis, spine_reports=(WEAK, WEAK))
    assert np.isnan(bad.peak_compression)
