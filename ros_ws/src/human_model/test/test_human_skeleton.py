# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Skeletons: points, Jacobian, limits, motion blocks."""

import time

import numpy as np
import pytest

from human_model import compiled
from human_model.exceptions import AnthropometryError, ChainError, MotionError
from human_model.frames import matrix_from_quaternion
from human_model.motion import FRAMES, POINTS
from human_model.skeletons import Skeleton2D, Skeleton3D


def test_jacobian_by_finite_differences(skeleton, rng):
    q = rng.normal(size=len(skeleton.coordinates))
    position, jacobian = compiled.points_and_jacobian(
        skeleton.tree, q, skeleton.point_segment, skeleton.point_local
    )
    assert position == pytest.approx(np.array(list(skeleton.points(q).values())))
    h = 1e-6
    for j in range(len(q)):
        step = np.zeros_like(q)
        step[j] = h
        slope = (skeleton.point_array([q + step]) - skeleton.point_array([q - step]))[0] / (2 * h)
        assert jacobian[:, :, j] == pytest.approx(slope, abs=1e-8)
    local = np.array([[0.1, 0.0, -0.2], [0.0, 0.3, 0.0]])
    assert skeleton.point_jacobian(q, skeleton.segments[3], local).shape == (2, 3, len(q))


def test_bones_keep_their_length(body, rng):
    spans = [
        ('hip_r', 'knee_r', 'thigh'),
        ('knee_l', 'ankle_l', 'shank'),
        ('shoulder_l', 'elbow_l', 'upper_arm'),
        ('elbow_r', 'wrist_r', 'forearm'),
        ('wrist_r', 'hand_r', 'hand_grip'),
        ('c7', 'head', 'head_neck'),
    ]
    for q in rng.normal(size=(10, 40)):
        points = body.points(q)
        for start, end, name in spans:
            assert np.linalg.norm(points[end] - points[start]) == pytest.approx(
                body.parameters.lengths[name]
            )


def test_sagittal_and_full_skeleton_agree_in_the_plane(man):
    """A symmetric motion gives the same points, torques and centre of mass in both skeletons."""
    flat, full = Skeleton2D.of(man), Skeleton3D.of(man)
    rng = np.random.default_rng(3)
    states = rng.normal(size=(3, 10))
    wide = np.zeros((3, 40))
    for i, name in enumerate(flat.coordinates):
        for side in ('', '_r', '_l'):
            if name + side in full.coordinates:
                wide[:, full.index(name + side)] = states[:, i]
    for name in POINTS:
        assert flat.points(states[0])[name] == pytest.approx(full.points(wide[0])[name])
    assert flat.centre_of_mass(states[0]) == pytest.approx(full.centre_of_mass(wide[0]))
    tau, wide_tau = flat.inverse_dynamics(*states), full.inverse_dynamics(*wide)
    for i, name in enumerate(flat.coordinates):
        same = [
            full.index(name + side) for side in ('', '_r', '_l') if name + side in full.coordinates
        ]
        assert tau[i] == pytest.approx(wide_tau[same].sum(), abs=1e-9), name


def test_frames_are_those_of_their_segments(skeleton, rng):
    q = rng.normal(size=(3, len(skeleton.coordinates)))
    quaternions = skeleton.points_and_frames(q)[1]
    assert quaternions.shape == (3, len(FRAMES), 4)
    for k in range(3):
        frames = skeleton.forward(q[k])
        for f, s in enumerate(skeleton.frame_segment):
            assert matrix_from_quaternion(quaternions[k, f]) == pytest.approx(
                frames[s, :3, :3], abs=1e-12
            )


def test_motion_block(skeleton):
    q = np.array([skeleton.standing()] * 4)
    motion = skeleton.body_motion(
        [0, 0.01, 0.02, 0.03],
        q,
        0 * q,
        0 * q,
        ground_force=np.full((4, 2, 3), 9.0),
        centre_of_pressure=None,
    )
    assert motion.skeleton == skeleton.name
    assert motion.point_names == POINTS
    assert motion.points == pytest.approx(skeleton.point_array(q))
    assert np.all(motion.ground_force == 9.0)
    assert np.all(np.isnan(motion.centre_of_pressure))
    assert np.all(motion.hand_force == 0.0)
    with pytest.raises(MotionError, match="unknown field 'wind'"):
        skeleton.body_motion([0.0], q[0], q[0], q[0], wind=1.0)


def test_limits_hold_the_neutral_posture_and_are_mirrored(skeleton):
    assert np.all(skeleton.limits[:, 0] <= 0) and np.all(skeleton.limits[:, 1] >= 0)
    assert np.all(skeleton.limits[:, 1] > skeleton.limits[:, 0])
    for i, name in enumerate(skeleton.coordinates):
        if name.endswith('_r'):
            assert np.array_equal(
                skeleton.limits[i], skeleton.limits[skeleton.index(name[:-1] + 'l')]
            )


def test_standing_height(man):
    skeleton = Skeleton3D.of(man)
    lengths = skeleton.parameters.lengths
    assert skeleton.standing_height == pytest.approx(
        lengths['thigh'] + lengths['shank'] + lengths['ankle_height']
    )


def test_bad_input_is_named(body):
    with pytest.raises(MotionError, match=r'q must have shape \(40,\), got \(10,\)'):
        body.points(np.zeros(10))
    bad = body.standing()
    bad[body.index('knee_angle_r')] = np.nan
    with pytest.raises(MotionError, match=r'q\[knee_angle_r\] is not finite'):
        body.inverse_dynamics(bad, bad, bad)
    with pytest.raises(ChainError, match="no coordinate named 'tail'"):
        body.index('tail')
    with pytest.raises(AnthropometryError, match="no segment named 'tail'"):
        body.point_jacobian(body.standing(), 'tail', [0, 0, 0])
    with pytest.raises(MotionError, match=r'shape \(n, 40\)'):
        body.point_array(np.zeros((2, 3)))


def test_fast_enough_for_100_hz(body):
    """One frame of Jacobian and dynamics takes a small part of a 10 ms cycle."""
    q = body.standing()
    wrench = np.zeros((len(body.segments), 6))
    compiled.points_and_jacobian(body.tree, q, body.point_segment, body.point_local)
    compiled.newton_euler(body.tree, q, q, q, wrench, 9.81)
    best = np.inf
    for _ in range(20):
        start = time.perf_counter()
        compiled.points_and_jacobian(body.tree, q, body.point_segment, body.point_local)
        compiled.newton_euler(body.tree, q, q, q, wrench, 9.81)
        best = min(best, time.perf_counter() - start)
    assert best < 2e-3
