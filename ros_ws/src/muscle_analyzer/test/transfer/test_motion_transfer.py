# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Taking motions over from the skeletons: distances, rates, limits, bad input."""

from dataclasses import replace

import numpy as np
import pytest

from human_model.frames import (
    ROS_FROM_OPENSIM,
    from_opensim,
    matrix_from_quaternion,
    quaternion_from_matrix,
)
from human_model.skeletons import Skeleton2D, Skeleton3D
from human_model.subject import Subject
from muscle_analyzer.core.exceptions import ScalingError, TransferError
from muscle_analyzer.core.multibody.inverse_dynamics import inverse_dynamics
from muscle_analyzer.core.multibody.joint_reaction import net_moment
from muscle_analyzer.core.multibody.kinematics import forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.opensim_bridge.derivatives import differentiate
from muscle_analyzer.core.subject.body_points import attach_points, scale_factors, upright_state
from muscle_analyzer.core.subject.model import subject_model
from muscle_analyzer.core.transfer.motion_transfer import MotionTransfer

STEP = 0.01
END_POINTS = ('hand_r', 'hand_l', 'heel_r', 'heel_l', 'mtp_r', 'mtp_l')
END_FRAMES = ('thorax', 'hand_r', 'hand_l', 'foot_r', 'foot_l')
SQUAT_LIFT = {
    'pelvis_tx': -0.15, 'pelvis_ty': -0.35, 'pelvis_tilt': -0.5,
    'lumbar_extension': -0.6, 'thorax_extension': -0.2,
    'arm_flex': 1.0, 'arm_add': -0.1, 'elbow_flex': 0.8,
    'hip_flexion': 1.5, 'knee_angle': 1.6, 'ankle_angle': 0.4,
}  # fmt: skip
TWIST = {
    'lumbar_rotation': 0.3, 'lumbar_bending': 0.1, 'thorax_rotation': 0.2, 'arm_rot_r': 0.2,
    'wrist_flex_r': 0.2, 'hip_rotation_r': -0.1, 'pelvis_rotation': 0.2, 'pro_sup_r': 0.3,
}  # fmt: skip


@pytest.fixture(scope='module')
def subject():
    """Return a person of the size of the thesis' participants."""
    return Subject('p1', 'male', 63.5, 1.69, 30.0)


@pytest.fixture(scope='module')
def scaled(lifting_model, subject):
    skeleton = Skeleton3D.of(subject)
    points = skeleton.points(np.zeros(len(skeleton.coordinates)))
    return subject_model(lifting_model, points, skeleton.parameters.lengths, subject.mass)


def lift(skeleton, amplitudes, duration=2.0):
    """Return a motion from standing into the posture and back, smooth and differentiable."""
    time = np.arange(0.0, duration, STEP)
    wave = 2.0 * np.pi / duration
    shape = 0.5 * (1.0 - np.cos(wave * time))
    rate = 0.5 * wave * np.sin(wave * time)
    acceleration = 0.5 * wave**2 * np.cos(wave * time)
    size = np.array(
        [amplitudes.get(name, amplitudes.get(name[:-2], 0.0)) for name in skeleton.coordinates]
    )
    q = skeleton.standing() + np.outer(shape, size)
    return skeleton.body_motion(time, q, np.outer(rate, size), np.outer(acceleration, size))


def motions(subject):
    """Return skeletons with motions: symmetric and twisted in 3D, and in the sagittal plane."""
    whole, sagittal = Skeleton3D.of(subject), Skeleton2D.of(subject)
    return {
        'symmetric': (whole, lift(whole, SQUAT_LIFT)),
        'twisted': (whole, lift(whole, {**SQUAT_LIFT, **TWIST})),
        'sagittal': (sagittal, lift(sagittal, SQUAT_LIFT)),
    }


@pytest.mark.parametrize('name', ['symmetric', 'twisted', 'sagittal'])
def test_hands_feet_and_trunk_are_where_they_were(scaled, subject, name):
    """Goals 5 mm and 1 degree; hands and feet within 0.4 mm, all within 0.11 degrees."""
    skeleton, motion = motions(subject)[name]
    transfer = MotionTransfer(scaled, skeleton)
    for sample in range(len(motion)):
        pose = transfer.step(motion, sample)
        assert pose.converged
        for point in END_POINTS:
            assert pose.point_distance[scaled.points.names.index(point)] <= 5e-3
        for frame in END_FRAMES:
            angle = pose.frame_angle[scaled.points.frame_names.index(frame)]
            assert np.degrees(angle) <= 1.0


@pytest.mark.parametrize('name', ['symmetric', 'twisted'])
def test_rates_without_filter_give_the_moment_of_splined_rates(scaled, subject, name):
    """Net L5-S1 moment from mapped rates against that from derivatives of the fit: 1 N m."""
    skeleton, motion = motions(subject)[name]
    transfer = MotionTransfer(scaled, skeleton)
    poses = [transfer.step(motion, sample) for sample in range(len(motion))]
    rate, acceleration = differentiate(motion.time, np.array([pose.q for pose in poses]))
    model = scaled.multibody
    root, l5 = model.body_index('pelvis'), model.body_index('lumbar5')
    nothing = np.zeros((len(model.body_names), 6))

    def moment(q, qd, qdd):
        state = forward_kinematics(model.tree, q, qd, qdd)
        needed = inverse_dynamics(model.tree, state, nothing)
        return net_moment(needed.joint_wrench, state, l5, root).top_down

    for i in range(20, len(poses) - 20):
        mapped = moment(poses[i].q, poses[i].qd, poses[i].qdd)
        assert np.abs(mapped - moment(poses[i].q, rate[i], acceleration[i])).max() <= 1.0


def test_block_equals_samples_one_after_the_other(scaled, subject):
    skeleton, motion = motions(subject)['twisted']
    block = MotionTransfer(scaled, skeleton).block(motion)
    transfer = MotionTransfer(scaled, skeleton)
    for k in range(20):
        pose = transfer.step(motion, k)
        for name in ('q', 'qd', 'qdd', 'point_distance', 'frame_angle', 'iterations'):
            assert np.array_equal(getattr(block, name)[k], getattr(pose, name)), name
        assert block.limits(k) == pose.at_limit


def test_scaled_model_has_the_subjects_joint_distances(scaled, subject):
    skeleton = Skeleton3D.of(subject)
    points = skeleton.points(np.zeros(len(skeleton.coordinates)))
    model = scaled.multibody
    state = upright_state(model)

    def ours(first, second):
        at = [scaled.points.names.index(name) for name in (first, second)]
        place = [
            state.position[b] + state.rotation[b] @ local
            for b, local in zip(scaled.points.body[at], scaled.points.local[at], strict=True)
        ]
        return np.linalg.norm(place[0] - place[1])

    for first, second in (
        ('hip_r', 'hip_l'),
        ('hip_r', 'knee_r'),
        ('knee_l', 'ankle_l'),
        ('shoulder_r', 'elbow_r'),
        ('elbow_l', 'wrist_l'),
        ('wrist_r', 'hand_r'),
        ('pelvis', 'l5_s1'),
        ('heel_l', 'toe_l'),
    ):
        expected = np.linalg.norm(points[first] - points[second])
        assert ours(first, second) == pytest.approx(expected, abs=1e-6), (first, second)
    assert model.source.mass == pytest.approx(subject.mass)


def test_place_and_heading_do_not_matter(scaled, subject):
    """A person who faces backwards, 3 m away, is taken over as well."""
    skeleton = Skeleton3D.of(subject)
    away = {'pelvis_tx': 3.0, 'pelvis_rotation': np.pi - 0.01}
    q = skeleton.vector(away, skeleton.standing())
    still = np.zeros_like(q)
    pose = MotionTransfer(scaled, skeleton).step(skeleton.body_motion([0.0], q, still, still))
    assert pose.converged
    assert pose.point_distance[scaled.points.names.index('hand_r')] <= 5e-3


@pytest.mark.parametrize('pronation', [-60.0, 0.0, 50.0, 70.0])
@pytest.mark.parametrize('elbow', [5.0, 30.0, 90.0])
def test_hands_keep_their_direction_however_the_forearm_is_turned(
    scaled, subject, pronation, elbow
):
    """Arms that hang relaxed are pronated by some 50 degrees from palms in."""
    skeleton = Skeleton3D.of(subject)
    values = {'arm_flex': 0.2, 'elbow_flex': np.radians(elbow), 'pro_sup': np.radians(pronation)}
    sides = {f'{name}_{side}': value for name, value in values.items() for side in 'rl'}
    q = skeleton.vector(sides, skeleton.standing())
    pose = MotionTransfer(scaled, skeleton).step(skeleton.body_motion([0.0], q, 0 * q, 0 * q))
    assert pose.converged
    assert pose.at_limit == ()
    for name in ('hand_r', 'hand_l'):
        assert np.degrees(pose.frame_angle[scaled.points.frame_names.index(name)]) <= 1.0


def test_coordinate_at_its_limit_is_named_and_does_not_move(scaled, subject):
    """The wrist's deviation ends at 35 degrees (0.611 rad); the skeleton's goes further here."""
    skeleton = Skeleton3D.of(subject)
    q = skeleton.vector({'wrist_dev_r': 0.9, 'elbow_flex_r': 1.2}, skeleton.standing())
    qd = skeleton.vector({'wrist_dev_r': 1.0})
    pose = MotionTransfer(scaled, skeleton).step(skeleton.body_motion([0.0], q, qd, 0.0 * q))
    assert pose.converged
    assert pose.at_limit == ('wrist_dev_r',)
    assert pose.qd[scaled.multibody.coordinate_index('wrist_dev_r')] == 0.0


def test_motion_of_another_person_is_refused(scaled, subject):
    other = Skeleton3D.of(Subject('p2', 'male', 90.0, 1.9, 30.0))
    q = other.standing()
    motion = other.body_motion([0.0], q, 0.0 * q, 0.0 * q)
    with pytest.raises(TransferError, match='away from the skeleton of the subject'):
        MotionTransfer(scaled, Skeleton3D.of(subject)).step(motion)
    with pytest.raises(TransferError, match='3d_40dof'):
        MotionTransfer(scaled, Skeleton2D.of(subject)).step(motion)


def test_missing_and_bad_points_are_named(lifting_model, subject):
    skeleton = Skeleton3D.of(subject)
    points = skeleton.points(np.zeros(len(skeleton.coordinates)))
    model, lengths = compile_model(lifting_model), skeleton.parameters.lengths
    with pytest.raises(ScalingError, match="'knee_r' is missing"):
        scale_factors(model, {k: v for k, v in points.items() if k != 'knee_r'}, lengths)
    with pytest.raises(ScalingError, match="'knee_r'"):
        attach_points(model, {**points, 'knee_r': np.full(3, np.nan)})
    with pytest.raises(ScalingError, match='hip_r to knee_r'):
        scale_factors(model, {**points, 'knee_r': points['hip_r']}, lengths)
    with pytest.raises(ScalingError, match="'pelvis_depth' is missing"):
        scale_factors(model, points, {})
    with pytest.raises(ScalingError, match='pelvis_depth'):
        scale_factors(model, points, {**lengths, 'pelvis_depth': np.nan})


def test_deep_pelvis_keeps_the_lumbosacral_joint(lifting_model, subject):
    """The pelvis takes the measured depth; hips, L5-S1 and hence lever arms of weights stay."""
    usual = Skeleton3D.of(subject)
    depth = 1.12 * usual.parameters.lengths['pelvis_depth']
    deep = Skeleton3D.of(replace(subject, lengths={'pelvis_depth': depth}))
    places, factors = [], []
    for skeleton in (usual, deep):
        points = skeleton.points(np.zeros(len(skeleton.coordinates)))
        scaled = subject_model(lifting_model, points, skeleton.parameters.lengths, subject.mass)
        model = scaled.multibody
        at = upright_state(model).joint_position
        hips = 0.5 * (at[model.body_index('femur_r')] + at[model.body_index('femur_l')])
        l5s1 = from_opensim(at[model.body_index('lumbar5')] - hips)
        assert l5s1 == pytest.approx(points['l5_s1'] - points['pelvis'], abs=1e-9)
        places.append(l5s1)
        factors.append(scaled.factors['pelvis'])
    assert places[0] == pytest.approx(places[1], abs=1e-9)
    assert factors[1] / factors[0] == pytest.approx([1.12, 1.12, 1.0])


@pytest.mark.parametrize('heading', [0.0, 0.8, -2.5])
def test_sagittal_motion_may_stand_anywhere(scaled, subject, heading):
    """Points and frames turned about the vertical and shifted, coordinates in the own plane."""
    skeleton, motion = motions(subject)['sagittal']
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    frames = quaternion_from_matrix(turn @ matrix_from_quaternion(motion.frames))
    moved = replace(motion, points=motion.points @ turn.T + [1.0, -2.0, 0.0], frames=frames)
    here, there = (MotionTransfer(scaled, skeleton).step(m, 60) for m in (motion, moved))
    pelvis = [
        scaled.multibody.coordinate_index(f'pelvis_{k}')
        for k in ('tx', 'ty', 'tz', 'tilt', 'list', 'rotation')
    ]
    inner = np.setdiff1d(np.arange(here.q.size), pelvis)
    for field in ('q', 'qd', 'qdd'):
        np.testing.assert_allclose(
            getattr(there, field)[inner], getattr(here, field)[inner], atol=1e-3
        )
    thorax = scaled.multibody.body_index('torso')
    first, second = (
        forward_kinematics(scaled.multibody.tree, p.q, p.qd, p.qdd) for p in (here, there)
    )
    np.testing.assert_allclose(
        ROS_FROM_OPENSIM @ second.rotation[thorax],
        turn @ ROS_FROM_OPENSIM @ first.rotation[thorax],
        atol=1e-4,
    )
    np.testing.assert_allclose(
        from_opensim(second.acceleration[thorax]),
        turn @ from_opensim(first.acceleration[thorax]),
        atol=1e-3,
    )


def test_deep_postures_are_found_from_upright_standing(scaled, subject):
    """Random bent and twisted postures, each from scratch, within the goals."""
    rng = np.random.default_rng(3)
    skeleton = Skeleton3D.of(subject)
    points, frames = scaled.points.names, scaled.points.frame_names
    for _ in range(20):
        depth = rng.uniform()
        values = {
            'pelvis_tilt': -rng.uniform(),
            'lumbar_extension': -0.8 * rng.uniform(),
            'lumbar_rotation': rng.uniform(-0.3, 0.3),
            'pelvis_rotation': rng.normal(),
        }
        for side in ('_r', '_l'):
            values |= {
                'arm_flex' + side: rng.uniform(-0.2, 1.8),
                'arm_rot' + side: rng.uniform(-0.5, 0.5),
                'elbow_flex' + side: rng.uniform(0.0, 1.5),
                'pro_sup' + side: rng.uniform(-0.5, 0.4),
                'hip_flexion' + side: 2.1 * depth,
                'hip_rotation' + side: rng.uniform(-0.3, 0.3),
                'knee_angle' + side: 2.3 * depth,
                'ankle_angle' + side: 0.5 * depth,
            }
        q = skeleton.vector(values, skeleton.standing())
        motion = skeleton.body_motion([0.0], q, 0.0 * q, 0.0 * q)
        pose = MotionTransfer(scaled, skeleton).step(motion)
        assert pose.converged
        assert max(pose.point_distance[points.index(name)] for name in END_POINTS) <= 5e-3
        angles = [pose.frame_angle[frames.index(name)] for name in END_FRAMES]
        assert np.degrees(max(angles)) <= 1.0
