# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The pipeline: live and recorded blocks, both skeletons, options, and what goes wrong."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from human_model.frames import matrix_from_quaternion, quaternion_from_matrix
from human_model.motion import POINTS
from human_model.report import SolveStatus
from human_model.skeletons import Skeleton2D, Skeleton3D
from human_model.subject import Subject
from muscle_analyzer.core.exceptions import (
    InputArrayError,
    OptionError,
    TransferError,
)
from muscle_analyzer.core.loads import load_solver
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer, MuscleAnalyzerOptions
from muscle_analyzer.core.recruitment.reserves import read_reserves
from muscle_analyzer.core.subject.muscle_strength import StrengthScaling

SUBJECT = Subject('p01', 'male', 63.5, 1.69, 25)
WEIGHT = 63.5 * 9.81
POSE_3D = {
    'hip_flexion_r': 0.9, 'hip_flexion_l': 0.9, 'knee_angle_r': 0.8, 'knee_angle_l': 0.8,
    'ankle_angle_r': 0.2, 'ankle_angle_l': 0.2, 'lumbar_extension': -0.4,
    'arm_flex_r': 0.6, 'arm_flex_l': 0.6,
}  # fmt: skip
POSE_2D = {
    'hip_flexion': 0.9, 'knee_angle': 0.8, 'ankle_angle': 0.2, 'lumbar_extension': -0.4,
    'arm_flex': 0.6,
}  # fmt: skip


def held_posture(skeleton, pose, box_weight=100.0, n=1, **changes):
    """Stand still in a posture, feet under the centre of mass, a box in the hands."""
    bent = np.linspace(1.0, 1.1, n)
    q = np.array([skeleton.vector({k: s * v for k, v in pose.items()}, skeleton.standing())
                  for s in bent])  # fmt: skip
    points = skeleton.point_array(q)
    box = points[:, [POINTS.index('hand_r'), POINTS.index('hand_l')]].mean(axis=1)
    body = np.array([skeleton.centre_of_mass(row) for row in q])
    centre = (WEIGHT * body + box_weight * box) / (WEIGHT + box_weight)
    cop = points[:, [POINTS.index('mtp_r'), POINTS.index('mtp_l')]].copy()
    cop[:, :, 0] = centre[:, None, 0]
    forces = {
        'ground_force': np.zeros((n, 2, 3)),
        'hand_force': np.zeros((n, 2, 3)),
        'centre_of_pressure': cop,
    }
    forces['ground_force'][:, :, 2] = 0.5 * (WEIGHT + box_weight)
    forces['hand_force'][:, :, 2] = -0.5 * box_weight
    still = np.zeros_like(q)
    time = 0.01 * np.arange(n)
    return skeleton.body_motion(time, q, still, still, **(forces | changes))


@pytest.fixture(scope='module')
def analyzer():
    return MuscleAnalyzer(SUBJECT)


@pytest.fixture(scope='module')
def skeleton():
    return Skeleton3D.of(SUBJECT)


def test_stooped_lift_loads_the_spine(analyzer, skeleton):
    result = analyzer.analyze(held_posture(skeleton, POSE_3D), 'lift_1', 'measured')
    assert result.report.ok
    assert (result.lift_id, result.source, result.pseudonym) == ('lift_1', 'measured', 'p01')
    assert result.disc_frame == 'bruno2015'
    # Symmetric: compression, hardly any lateral shear, a moment about the axis to the left.
    assert 1000.0 < result.compression[0] < 4000.0
    assert abs(result.lateral_shear[0]) < 0.02 * result.compression[0]
    assert result.net_moment_top_down[0, 1] < -40.0
    assert np.abs(result.net_moment_top_down[0, [0, 2]]).max() < 1.0
    # More than half a body and the box weigh on the disc, the muscles add the most.
    heavier = analyzer.analyze(held_posture(skeleton, POSE_3D, 200.0), 'lift_2', 'measured')
    assert heavier.compression[0] > result.compression[0] + 100.0
    assert result.hand_distance.max() < 0.005
    assert result.foot_distance.max() < 0.005
    assert np.degrees(result.trunk_angle.max()) < 1.0


def test_residual_is_the_difference_of_the_net_moments(analyzer, skeleton):
    """Push the body sideways without support: the pelvis and the net moment must tell."""
    still = held_posture(skeleton, POSE_3D)
    pushed = still.hand_force.copy()
    pushed[:, 0, 1] += 20.0
    other = held_posture(skeleton, POSE_3D, hand_force=pushed)
    before, after = (analyzer.analyze(motion, source='measured') for motion in (still, other))
    assert after.pelvis_residual[0, :3] - before.pelvis_residual[0, :3] == pytest.approx(
        [0.0, -20.0, 0.0], abs=1e-6
    )
    hand = still.point('hand_r')[0]
    change = after.net_moment_difference[0] - before.net_moment_difference[0]
    from_above = after.net_moment_top_down[0] - before.net_moment_top_down[0]
    assert change == pytest.approx(from_above, abs=1e-6)
    # The moment of the push about L5-S1, which lies within centimetres of the shared point.
    arm = hand - still.point('l5_s1')[0]
    assert from_above == pytest.approx(-np.cross(arm, [0.0, 20.0, 0.0]), abs=20.0 * 0.05)


def test_live_samples_equal_the_recorded_block(analyzer, skeleton):
    motion = held_posture(skeleton, POSE_3D, n=5)
    block = analyzer.analyze(motion, 'lift_1', 'measured')
    live = [analyzer.analyze(sample) for sample in motion]
    assert len(block) == 5
    for k, sample in enumerate(live):
        assert len(sample) == 1
        assert sample.activation[0] == pytest.approx(block.activation[k], abs=1e-4)
        assert sample.compression[0] == pytest.approx(block.compression[k], rel=1e-4)
        assert sample.time[0] == block.time[k]
    assert np.all(block.status == SolveStatus.OK)


def test_torques_are_balanced_by_muscles_and_reserves(analyzer, skeleton):
    result = analyzer.analyze(held_posture(skeleton, POSE_3D), source='measured')
    assert result.report.primal_residual < 1e-7
    knee = result.coordinate_names.index('knee_angle_r')
    assert abs(result.reserve[0, knee]) < 0.05 * abs(result.torque[0, knee])
    assert not any(name.startswith('pelvis') for name in result.coordinate_names)
    wrist = result.coordinate_names.index('wrist_flex_r')
    assert result.reserve[0, wrist] == pytest.approx(result.torque[0, wrist])


def test_predicted_lift_of_the_sagittal_skeleton(analyzer):
    motion = held_posture(Skeleton2D.of(SUBJECT), POSE_2D)
    result = analyzer.analyze(motion, 'lift_1', 'predicted')
    assert result.report.ok
    assert result.hand_distance.max() < 0.005
    assert result.foot_distance.max() < 0.005
    names = list(result.muscle_names)
    right, left = (result.force[0, names.index(f'vasint_{side}')] for side in 'rl')
    assert right == pytest.approx(left, rel=0.05)
    assert result.compression[0] > 1000.0


def test_predicted_lift_may_face_anywhere(analyzer):
    """Coordinates in the own plane, everything Cartesian turned by 20 degrees and shifted."""
    plane = Skeleton2D.of(SUBJECT)
    values = held_posture(plane, POSE_2D, n=3)
    rates = values.position - plane.standing()
    straight = replace(values, velocity=rates, acceleration=-5.0 * rates)
    turn = Rotation.from_euler('z', 20.0, degrees=True).as_matrix()
    place = np.array([0.4, -0.7, 0.0])
    turned = replace(
        straight,
        points=straight.points @ turn.T + place,
        frames=quaternion_from_matrix(turn @ matrix_from_quaternion(straight.frames)),
        ground_force=straight.ground_force @ turn.T,
        centre_of_pressure=straight.centre_of_pressure @ turn.T + place,
        hand_force=straight.hand_force @ turn.T,
    )
    first, second = (analyzer.analyze(motion, 'l', 'predicted') for motion in (straight, turned))
    assert second.report.ok
    # Accelerated: the load would differ by more than this if only places were turned.
    still = analyzer.analyze(values, 'l', 'predicted')
    assert np.abs(still.compression - first.compression).max() > 20.0
    assert second.l5_s1_force == pytest.approx(first.l5_s1_force, abs=1.0)
    assert second.net_moment_top_down @ turn == pytest.approx(first.net_moment_top_down, abs=0.1)
    torques = [
        analyzer.joint_torques(result, motion).torque
        for result, motion in ((first, straight), (second, turned))
    ]
    assert torques[1] == pytest.approx(torques[0], abs=0.2)


def test_sagittal_motion_of_another_person_is_refused(analyzer):
    taller = Skeleton2D.of(Subject('p02', 'male', 90.0, 1.9, 25))
    with pytest.raises(TransferError, match='away from the skeleton of the subject'):
        analyzer.analyze(held_posture(taller, POSE_2D))


def test_weak_hip_leaves_the_spine_load_good(analyzer, skeleton):
    """Push the hips sideways: the muscles of the hips cannot, those of the trunk need not."""
    motion = held_posture(skeleton, POSE_3D)
    force = motion.ground_force.copy()
    force[0, :, 1] = (-400.0, 400.0)
    result = analyzer.analyze(replace(motion, ground_force=force), source='measured')
    assert result.status[0] == SolveStatus.MUSCLE_TOO_WEAK
    assert 'reserves help hip_rotation' in result.report.message
    assert result.spine_status[0] == SolveStatus.OK
    assert result.torque_status[0] == SolveStatus.OK
    assert result.good_spine_samples == 1
    assert result.peak_compression == result.compression[0]
    weak = analyzer.analyze(held_posture(skeleton, POSE_3D, 4000.0), source='measured')
    assert weak.spine_status[0] == SolveStatus.MUSCLE_TOO_WEAK
    assert 'L5_S1_Flex_Ext' in weak.spine_report.message
    assert weak.torque_status[0] == SolveStatus.OK


def test_spine_load_does_not_hang_on_how_weak_hips_are_helped(analyzer, skeleton, monkeypatch):
    """Hip reserves a hundred times as cheap take over from the muscles: same force on L5."""

    def generous(names, levels):
        return tuple(
            replace(reserve, torque=100.0) if reserve.coordinate.startswith('hip') else reserve
            for reserve in read_reserves(names, levels=levels)
        )

    motion = held_posture(skeleton, POSE_3D)
    force = motion.ground_force.copy()
    force[0, :, 1] = (-400.0, 400.0)
    motion = replace(motion, ground_force=force)
    weak = analyzer.analyze(motion, source='measured')
    monkeypatch.setattr(load_solver, 'read_reserves', generous)
    other = analyzer.for_subject(SUBJECT)
    helped = other.analyze(motion, source='measured')
    assert np.abs(helped.reserve - weak.reserve).max() > 5.0
    assert helped.l5_s1_force[0] == pytest.approx(weak.l5_s1_force[0], rel=0.01, abs=10.0)


def test_tracker_status_is_never_forgotten(analyzer, skeleton):
    motion = held_posture(skeleton, POSE_3D, n=3)
    tracker = [0, SolveStatus.TRACKER_NO_GROUND_FORCE, SolveStatus.TRACKER_NOT_CONVERGED]
    result = analyzer.analyze(motion, 'l', 'measured', tracker)
    expected = [0, SolveStatus.MUSCLE_NO_GROUND_FORCE, SolveStatus.MUSCLE_BAD_INPUT]
    for status in (result.status, result.spine_status, result.torque_status):
        assert status.tolist() == expected
    assert np.isnan(result.l5_s1_force[1:]).all() and np.isnan(result.torque[1:]).all()
    assert 'TRACKER_NO_GROUND_FORCE' in result.report.message
    with pytest.raises(InputArrayError, match='tracker status'):
        analyzer.analyze(motion, 'l', 'measured', [0, 0])


def test_analyzer_of_another_subject_has_the_same_options_and_model(analyzer):
    heavier = analyzer.for_subject(replace(SUBJECT, mass=80.0))
    assert heavier.options is analyzer.options
    assert heavier.generic_model is analyzer.generic_model
    assert (heavier.subject.mass, analyzer.subject.mass) == (80.0, SUBJECT.mass)


def test_muscles_too_weak_name_coordinate_and_muscles(analyzer, skeleton):
    result = analyzer.analyze(held_posture(skeleton, POSE_3D, 4000.0), source='measured')
    assert result.report.status == SolveStatus.MUSCLE_TOO_WEAK
    assert 'L5_S1_Flex_Ext' in result.report.message
    assert 'at full activation' in result.report.message
    assert np.isfinite(result.compression[0])


def test_no_ground_force_gives_no_numbers(analyzer, skeleton):
    lost = np.full((1, 2, 3), np.nan)
    motion = held_posture(
        skeleton, POSE_3D, centre_of_pressure=lost, ground_force=np.zeros((1, 2, 3))
    )
    result = analyzer.analyze(motion, source='measured')
    assert result.report.status == SolveStatus.MUSCLE_NO_GROUND_FORCE
    assert np.isnan(result.compression[0]) and np.isnan(result.activation).all()


def test_loaded_foot_without_centre_of_pressure_is_named(analyzer, skeleton):
    motion = held_posture(skeleton, POSE_3D)
    cop = motion.centre_of_pressure.copy()
    cop[:, 1] = np.nan
    result = analyzer.analyze(
        held_posture(skeleton, POSE_3D, centre_of_pressure=cop), source='measured'
    )
    assert result.report.status == SolveStatus.MUSCLE_BAD_INPUT
    assert 'left foot: ground force of 361 N' in result.report.message
    assert np.isnan(result.l5_s1_force).all()


def test_worst_sample_is_reported(analyzer, skeleton):
    motion = held_posture(skeleton, POSE_3D, n=3)
    cop = motion.centre_of_pressure.copy()
    cop[1] = np.nan
    result = analyzer.analyze(
        held_posture(skeleton, POSE_3D, n=3, centre_of_pressure=cop), source='measured'
    )
    assert result.status.tolist() == [0, int(SolveStatus.MUSCLE_NO_GROUND_FORCE), 0]
    assert result.report.status == SolveStatus.MUSCLE_NO_GROUND_FORCE
    assert np.isfinite(result.compression[[0, 2]]).all()


def test_disc_frame_turns_the_same_force(analyzer, skeleton):
    motion = held_posture(skeleton, POSE_3D)
    turned = analyzer.analyze(motion, source='measured')
    other = MuscleAnalyzer(SUBJECT, MuscleAnalyzerOptions(disc_frame='vertebral'))
    plain = other.analyze(motion, source='measured')
    size = np.linalg.norm(plain.l5_s1_force[0])
    assert np.linalg.norm(turned.l5_s1_force[0]) == pytest.approx(size)
    angles = [np.arctan2(r.anterior_shear[0], r.compression[0]) for r in (turned, plain)]
    assert np.degrees(angles[0] - angles[1]) == pytest.approx(21.0, abs=0.01)
    # The stated sensitivity is the derivative along that turn.
    assert turned.anterior_shear_per_degree[0] == pytest.approx(np.radians(turned.compression[0]))


def test_force_length_velocity_weakens_muscles(analyzer, skeleton):
    motion = held_posture(skeleton, POSE_3D)
    strong = analyzer.analyze(motion, source='measured')
    hill = MuscleAnalyzer(SUBJECT, MuscleAnalyzerOptions(force_length_velocity=True))
    weak = hill.analyze(motion, source='measured')
    assert weak.torque == pytest.approx(strong.torque, abs=1e-9)
    assert weak.report.primal_residual < 1e-7
    assert weak.report.objective > strong.report.objective
    maximum = strong.force[0] / strong.activation[0]
    assert np.all(weak.force[0] <= maximum * 1.001)


def test_weaker_people_use_more_of_their_muscles(analyzer, skeleton):
    motion = held_posture(skeleton, POSE_3D)
    usual = analyzer.analyze(motion, source='measured')
    options = MuscleAnalyzerOptions(strength=StrengthScaling.POPULATION)
    weak = MuscleAnalyzer(replace(SUBJECT, strength_z=-1.0), options)
    more = weak.analyze(motion, source='measured')
    trunk = [k for k, name in enumerate(usual.muscle_names) if name.startswith(('LTp', 'MF_'))]
    assert more.activation[0, trunk].sum() > 1.1 * usual.activation[0, trunk].sum()
    # The torques are the same and so, nearly, are the forces that balance them.
    assert more.torque == pytest.approx(usual.torque, abs=1e-9)
    assert more.compression == pytest.approx(usual.compression, rel=0.05)


def test_wrong_use_is_refused(analyzer, skeleton):
    motion = held_posture(skeleton, POSE_3D)
    with pytest.raises(InputArrayError, match="source 'guessed'"):
        analyzer.analyze(motion, source='guessed')
    with pytest.raises(OptionError, match="disc frame 'round'"):
        MuscleAnalyzer(SUBJECT, MuscleAnalyzerOptions(disc_frame='round'))
    taller = Skeleton3D.of(Subject('p02', 'male', 90.0, 1.9, 25))
    with pytest.raises(TransferError, match='away from the skeleton of the subject'):
        analyzer.analyze(held_posture(taller, POSE_3D))
