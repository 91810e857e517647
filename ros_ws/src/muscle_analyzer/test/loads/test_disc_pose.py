# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The pose of the L5-S1 disc in the laboratory: hand-computed, and against the loads."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from human_model.frames import ROS_FROM_OPENSIM, matrix_from_quaternion, to_opensim
from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer, MuscleAnalyzerOptions
from muscle_analyzer.core.loads.disc_frame import FORWARD_LEFT_UP
from muscle_analyzer.core.loads.disc_pose import world_poses

PERSON = Subject('p01', 'male', 63.5, 1.69, 25)
WEIGHT = 63.5 * 9.80665


def pose(rotation, place=(0.0, 0.0, 0.0)):
    """Return the pose (3, 4) of a frame from its rotation, ground <- frame, OpenSim's axes."""
    return np.column_stack([rotation, place])


def upright(q, skeleton):
    """Return one sample of a posture at rest on both feet."""
    points = skeleton.points(q)
    feet = 0.5 * (points['ankle_r'] + points['mtp_r']), 0.5 * (points['ankle_l'] + points['mtp_l'])
    cop = np.array(feet) * [1.0, 1.0, 0.0]
    force = np.array([[0.0, 0.0, 0.5 * WEIGHT]] * 2)
    return skeleton.body_motion(
        [1.0],
        q[None],
        0.0 * q[None],
        0.0 * q[None],
        ground_force=force[None],
        centre_of_pressure=cop[None],
    )


@pytest.fixture(scope='module')
def standing():
    """Return a function: the analysis of standing upright with the whole body leant forward."""
    skeleton = Skeleton3D.of(PERSON)
    analyzers = {}

    def analyse(option, tilt=0.0, rotation=0.0):
        if option not in analyzers:
            options = MuscleAnalyzerOptions(disc_frame=option)
            analyzers[option] = MuscleAnalyzer(PERSON, options)
        q = skeleton.standing()
        # Positive leans back.
        q[skeleton.index('pelvis_tilt')] = -math.radians(tilt)
        q[skeleton.index('pelvis_rotation')] = math.radians(rotation)
        analysis = analyzers[option].analyze(upright(q, skeleton), source='predicted')
        return analysis, matrix_from_quaternion(analysis.disc_orientation)[0]

    return analyse


def about_left(degrees):
    """Return the rotation about the axis to the left, forward lean positive."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def test_axes_by_hand():
    """Level disc, OpenSim's place (1 forward, 2 up, 3 right): 1 forward, 3 to the right, 2 up."""
    position, orientation = world_poses(pose(FORWARD_LEFT_UP, (1.0, 2.0, 3.0))[None])
    np.testing.assert_array_equal(position, [[1.0, -3.0, 2.0]])
    np.testing.assert_allclose(orientation, [[0.0, 0.0, 0.0, 1.0]], atol=1e-15)


def test_lean_by_hand():
    """21 degrees forward: about the axis to the left by sin and cos of half of it."""
    half = math.radians(10.5)
    rotation = to_opensim(about_left(21.0).T).T
    _, orientation = world_poses(pose(rotation)[None])
    np.testing.assert_allclose(
        orientation, [[0.0, math.sin(half), 0.0, math.cos(half)]], atol=1e-15
    )


quaternions = st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4).filter(
    lambda q: np.linalg.norm(q) > 0.1
)


@given(st.lists(quaternions, min_size=1, max_size=3))
def test_every_orientation_comes_back(asked):
    world = matrix_from_quaternion(asked)
    poses = np.array([pose(ROS_FROM_OPENSIM.T @ rotation) for rotation in world])
    _, found = world_poses(poses)
    np.testing.assert_allclose(matrix_from_quaternion(found), world, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0, atol=1e-12)
    assert np.all(found[:, 3] >= 0.0)


@pytest.mark.parametrize('axis', range(3))
def test_half_turns_lose_no_digits(axis):
    half = -np.eye(3)
    half[axis, axis] = 1.0
    _, found = world_poses(pose(ROS_FROM_OPENSIM.T @ half)[None])
    np.testing.assert_allclose(np.abs(found[0]), np.eye(4)[axis], atol=1e-15)


def test_disc_of_an_upright_person(standing):
    """The vertebra is upright, the normal of bruno2015 leans 21 degrees forward of it."""
    _, vertebral = standing('vertebral')
    _, bruno = standing('bruno2015')
    np.testing.assert_allclose(bruno, vertebral @ about_left(21.0), atol=1e-9)
    analysis, rotation = standing('bruno2015')
    lean = math.degrees(math.atan2(rotation[0, 2], rotation[2, 2]))
    assert lean == pytest.approx(21.0, abs=1.0)
    # In the middle plane, and its left is the left.
    np.testing.assert_allclose(rotation[:, 1], [0.0, 1.0, 0.0], atol=1e-6)
    skeleton = Skeleton3D.of(PERSON)
    place = skeleton.points(skeleton.standing())['l5_s1']
    np.testing.assert_allclose(analysis.disc_position[0], place, atol=1e-3)


def test_thirty_degrees_of_flexion_turn_the_disc_by_thirty_degrees(standing):
    """Trunk and pelvis lean about the axis to the left: normal (sin 51, 0, cos 51)."""
    (_, before), (_, after) = (standing('bruno2015', tilt) for tilt in (0.0, 30.0))
    np.testing.assert_allclose(after @ before.T, about_left(30.0), atol=1e-6)
    normal = [math.sin(math.radians(51.0)), 0.0, math.cos(math.radians(51.0))]
    np.testing.assert_allclose(after[:, 2], normal, atol=0.01)


def test_a_turn_to_the_left_turns_the_disc_to_the_left(standing):
    (_, before), (_, after) = (standing('bruno2015', 0.0, turn) for turn in (0.0, 40.0))
    c, s = math.cos(math.radians(40.0)), math.sin(math.radians(40.0))
    left = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(after, left @ before, atol=1e-6)


@pytest.mark.parametrize('option', ['bruno2015', 'chaffin', 'vertebral'])
def test_pose_takes_the_load_into_the_laboratory(standing, option):
    """Turned into the laboratory, the force on L5 is the same whatever frame it was given in."""
    analysis, rotation = standing(option, 30.0)
    other, reference = standing('vertebral', 30.0)
    force = rotation @ analysis.l5_s1_force[0]
    np.testing.assert_allclose(force, reference @ other.l5_s1_force[0], atol=0.5)
    assert rotation[:, 2] @ force == pytest.approx(analysis.compression[0])
    assert -rotation[:, 0] @ force == pytest.approx(analysis.anterior_shear[0])
    assert rotation[:, 1] @ force == pytest.approx(analysis.lateral_shear[0])


def test_a_sample_without_motion_has_no_pose():
    skeleton = Skeleton3D.of(PERSON)
    analyzer = MuscleAnalyzer(PERSON)
    motion = upright(skeleton.standing(), skeleton)
    lost = analyzer.analyze(motion, tracker_status=[101])
    assert np.isnan(lost.disc_position).all()
    assert np.isnan(lost.disc_orientation).all()
    lifted = replace(
        motion, ground_force=np.zeros((1, 2, 3)), centre_of_pressure=np.full((1, 2, 3), np.nan)
    )
    assert np.isnan(analyzer.analyze(lifted).disc_orientation).all()
