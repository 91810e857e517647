# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint torques beside dynamic strength: which torque, which strength, which sign."""

from dataclasses import replace

import numpy as np
import pytest

from human_model.exceptions import TableError
from human_model.frames import quaternion_from_matrix
from human_model.report import SolveStatus
from human_model.skeletons import Skeleton2D, Skeleton3D
from human_model.strength import JointStrength
from human_model.subject import Subject
from human_model.tables import parse_table
from muscle_analyzer.core.exceptions import InputArrayError
from muscle_analyzer.core.loads import torque_limits
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.core.loads.torque_limits import read_torque_rows

SUBJECT = Subject('p01', 'male', 63.5, 1.69, 25)
WEIGHT = 63.5 * 9.80665
BENT = {'hip_flexion': 0.9, 'knee_angle': 0.8, 'ankle_angle': 0.2, 'lumbar_extension': -0.3,
        'arm_flex': 0.6}  # fmt: skip
SETS = 'anderson2007_nonneg'


@pytest.fixture(scope='module')
def analyzer():
    return MuscleAnalyzer(SUBJECT)


def crouch(skeleton, box_weight=100.0, **rates):
    """Hold a box with bent legs and back, the ground under the middle of mass."""
    values = {
        name: value
        for name in skeleton.coordinates
        for joint, value in BENT.items()
        if name in (joint, f'{joint}_r', f'{joint}_l')
    }
    q = skeleton.vector(values, skeleton.standing())
    motion = skeleton.body_motion([0.0], q, skeleton.vector(rates), np.zeros_like(q))
    box = 0.5 * (motion.point('hand_r') + motion.point('hand_l'))[0]
    body = skeleton.centre_of_mass(q)
    cop = np.stack([motion.point('mtp_r'), motion.point('mtp_l')], axis=1)
    cop[..., 0] = (WEIGHT * body[0] + box_weight * box[0]) / (WEIGHT + box_weight)
    ground, hands = np.zeros((1, 2, 3)), np.zeros((1, 2, 3))
    ground[..., 2] = 0.5 * (WEIGHT + box_weight)
    hands[..., 2] = -0.5 * box_weight
    return replace(motion, ground_force=ground, hand_force=hands, centre_of_pressure=cop)


def torques(analyzer, motion):
    analysis = analyzer.analyze(motion, 'lift_1', 'measured')
    return analysis, analyzer.joint_torques(analysis, motion)


def column(result, joint):
    return result.joint_names.index(joint)


@pytest.mark.parametrize('kind', [Skeleton2D, Skeleton3D])
def test_signs_of_a_crouch_with_a_box(analyzer, kind):
    """Back and hips extend, shoulders and elbows hold the box up in front."""
    analysis, result = torques(analyzer, crouch(kind.of(SUBJECT)))
    assert (result.lift_id, result.source, result.status[0]) == ('lift_1', 'measured', 0)
    assert result.torque[0, column(result, 'lumbar_extension')] == pytest.approx(
        -analysis.net_moment_top_down[0, 1], rel=0.2
    )
    for joint, sign in (
        ('lumbar_extension', 1),
        ('arm_flex_r', 1),
        ('elbow_flex_l', 1),
        ('hip_flexion_r', -1),
    ):
        assert sign * result.torque[0, column(result, joint)] > 5.0, joint
    assert np.all(result.lower <= 0.0) and np.all(result.upper >= 0.0)
    assert abs(result.torque[0, column(result, 'lumbar_bending')]) < 1.0


def test_ground_force_further_forward_asks_for_plantarflexion(analyzer):
    motion = crouch(Skeleton3D.of(SUBJECT))
    cop = motion.centre_of_pressure.copy()
    cop[0, :, 0] += 0.1
    results = [torques(analyzer, m)[1] for m in (motion, replace(motion, centre_of_pressure=cop))]
    lever = -0.1 * motion.ground_force[0, 0, 2]
    for joint, sign in (('ankle_angle_r', 1.0), ('knee_angle_l', -1.0), ('hip_flexion_r', 1.0)):
        before, after = (result.torque[0, column(result, joint)] for result in results)
        assert after - before == pytest.approx(sign * lever, rel=0.05), joint


def test_limits_are_those_of_angle_and_speed(analyzer):
    skeleton = Skeleton3D.of(SUBJECT)
    motion = crouch(skeleton, knee_angle_r=-2.0, lumbar_extension=0.5)
    _, result = torques(analyzer, motion)
    strength = JointStrength('3d_40dof', SUBJECT, SETS)
    for joint in ('knee_angle_r', 'lumbar_extension', 'wrist_flex_l'):
        k = skeleton.index(joint)
        lower, upper = strength.limits(joint, motion.position[0, k], motion.velocity[0, k])
        assert result.lower[0, column(result, joint)] == pytest.approx(lower)
        assert result.upper[0, column(result, joint)] == pytest.approx(upper)
    fast, slow = (result.lower[0, column(result, f'knee_angle_{side}')] for side in 'rl')
    assert abs(fast) < 0.9 * abs(slow)


def test_sagittal_skeleton_has_one_limb_and_the_whole_trunk(analyzer):
    skeleton = Skeleton2D.of(SUBJECT)
    motion = crouch(skeleton)
    _, result = torques(analyzer, motion)
    pair, limb = (JointStrength(name, SUBJECT, SETS) for name in ('2d_10dof', '3d_40dof'))
    knee = motion.position[0, skeleton.index('knee_angle')]
    expected = limb.limits('knee_angle_l', knee, 0.0)
    assert expected[1] == pytest.approx(0.5 * pair.limits('knee_angle', knee, 0.0)[1])
    back = motion.position[0, skeleton.index('lumbar_extension')]
    for joint, limits in (
        ('knee_angle_l', expected),
        ('lumbar_extension', pair.limits('lumbar_extension', back, 0.0)),
        ('arm_add_r', limb.limits('arm_add_r', 0.0, 0.0)),
    ):
        found = [side[0, column(result, joint)] for side in (result.lower, result.upper)]
        assert found == pytest.approx(limits), joint


def test_net_moment_is_taken_about_the_axes_of_the_pelvis(analyzer):
    motion = crouch(Skeleton3D.of(SUBJECT))
    analysis = analyzer.analyze(motion)
    frames = motion.frames.copy()
    left = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    frames[0, motion.frame_names.index('pelvis')] = quaternion_from_matrix(left)
    moment = np.array([[1.0, 2.0, 4.0]])
    result = analyzer.joint_torques(
        replace(analysis, net_moment_top_down=moment), replace(motion, frames=frames)
    )
    found = {
        joint: result.torque[0, column(result, f'lumbar_{joint}')]
        for joint in ('extension', 'bending', 'rotation')
    }
    # Facing left: front is the laboratory's y, left its -x.
    assert found == pytest.approx({'extension': 1.0, 'bending': 2.0, 'rotation': 4.0})


def test_status_does_not_hang_on_muscles(analyzer):
    motion = crouch(Skeleton3D.of(SUBJECT), 4000.0)
    analysis, result = torques(analyzer, motion)
    assert analysis.status[0] == SolveStatus.MUSCLE_TOO_WEAK
    assert result.status[0] == SolveStatus.OK
    lost = analyzer.analyze(motion, tracker_status=[SolveStatus.TRACKER_NO_GROUND_FORCE])
    result = analyzer.joint_torques(lost, motion)
    assert result.status[0] == SolveStatus.MUSCLE_NO_GROUND_FORCE
    assert np.isnan(result.torque).all()


def test_wrong_use_is_refused(analyzer):
    motion = crouch(Skeleton3D.of(SUBJECT))
    analysis = analyzer.analyze(motion)
    with pytest.raises(InputArrayError, match='is not the'):
        analyzer.joint_torques(analysis, replace(motion, time=motion.time + 1.0))


def test_table_of_the_package_has_strength_and_torque_for_every_joint(analyzer):
    motion = crouch(Skeleton3D.of(SUBJECT))
    _, result = torques(analyzer, motion)
    assert result.joint_names == tuple(row.joint for row in read_torque_rows())
    assert np.isfinite(result.torque).all()
    # 1000 N m stands for a strength that is not published.
    assert np.abs(result.lower).max() < 1000.0 and result.upper.max() < 1000.0


@pytest.mark.parametrize(
    ('row', 'complaint'),
    [('a,wind,b,1,c,s', "'from': .*'wind'"),
     ('a,net_moment,down,1,c,s', "'name': .*'down'"),
     ('a,coordinate,b,2,c,s', "'sign': .*'2'")],
)  # fmt: skip
def test_bad_rows_are_named(monkeypatch, row, complaint):
    text = f'joint,from,name,sign,coordinate,source\n{row}\n'
    monkeypatch.setattr(
        torque_limits, 'read_table', lambda _, name, columns: parse_table(name, text, columns)
    )
    with pytest.raises(TableError, match=rf'joint_torques\.csv, line 2, column {complaint}'):
        read_torque_rows()
