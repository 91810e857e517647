# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The thesis' persons and their printed tables."""

import numpy as np
import pytest
from thesis_parameters import named_parameters

from human_model.exceptions import SubjectError
from human_model.named_subjects import named_subject, subject_names
from human_model.skeletons import Skeleton2D, Skeleton3D

TABLE_2_2 = {  # link: length [m], mass [kg], Izz about the proximal joint [kg m^2]
    'trunk': (0.570, 45.447, 4.073),
    'upper_arm': (0.339, 4.072, 0.176),
    'forearm': (0.311, 3.877, 0.135),
    'thigh': (0.465, 20.35, 1.530),
    'shank': (0.433, 7.988, 0.494),
    'foot': (0.090, 1.7937, 0.081),
    'toes': (0.100, 0.1993, 0.009),
}


def test_subject_of_chapter_iv():
    subject = named_subject('thesis_ch4')
    assert (subject.sex, subject.mass, subject.stature, subject.age) == ('male', 63.5, 1.69, 31)
    assert named_parameters('thesis_ch4').total_mass == pytest.approx(63.5)


def test_table_2_2_is_reproduced():
    parameters = named_parameters('thesis_2d')
    skeleton = Skeleton2D(parameters)
    points = skeleton.points(np.zeros(10))
    span = {
        'trunk': ('l5_s1', 'shoulder_r'),
        'upper_arm': ('shoulder_r', 'elbow_r'),
        'forearm': ('elbow_r', 'hand_r'),
        'thigh': ('hip_r', 'knee_r'),
        'shank': ('knee_r', 'ankle_r'),
        'foot': ('ankle_r', 'mtp_r'),
        'toes': ('mtp_r', 'toe_r'),
    }
    for segment, (length, mass, inertia) in TABLE_2_2.items():
        i = parameters.index(segment)
        start, end = (points[name][[0, 2]] for name in span[segment])
        assert np.linalg.norm(end - start) == pytest.approx(length), segment
        assert parameters.mass[i] == pytest.approx(mass), segment
        about_joint = parameters.inertia[i, 1, 1] + mass * parameters.com[i] @ parameters.com[i]
        assert about_joint == pytest.approx(inertia), segment
    assert parameters.total_mass == pytest.approx(83.727)
    assert points['l5_s1'] == pytest.approx(points['pelvis'])


def test_table_3_2_is_reproduced():
    parameters = named_parameters('thesis_3d')
    skeleton = Skeleton3D(parameters)
    points = skeleton.points(np.zeros(40))
    assert parameters.total_mass == pytest.approx(80.72)
    assert points['c7'][2] == pytest.approx(0.056 + 0.415)  # sacrum and L1 to C7
    assert points['c7'] - points['shoulder_r'] == pytest.approx([0, 0.113, 0.035])
    assert points['hip_l'] == pytest.approx([0, 0.093, 0])
    for start, end, length in (
        ('shoulder_r', 'elbow_r', 0.334),
        ('elbow_r', 'wrist_r', 0.247),
        ('wrist_r', 'hand_r', 0.107),
        ('c7', 'head', 0.212),
        ('hip_r', 'knee_r', 0.438),
        ('knee_r', 'ankle_r', 0.442),
    ):
        assert np.linalg.norm(points[end] - points[start]) == pytest.approx(length)
    assert points['mtp_r'][0] - points['ankle_r'][0] == pytest.approx(0.1)
    assert points['toe_r'][0] - points['mtp_r'][0] == pytest.approx(0.165)
    for segment, mass in (
        ('upper_arm_l', 1.9),
        ('forearm_r', 1.34),
        ('hand_r', 0.5),
        ('head', 5.8),
        ('thigh_l', 9.54),
        ('shank_r', 3.74),
        ('foot_r', 0.7),
        ('toes_l', 0.23),
        ('pelvis', 2.32 + 2 * 4.48),
    ):
        assert parameters.mass[parameters.index(segment)] == pytest.approx(mass)
    torso = sum(parameters.mass[parameters.index(name)] for name in ('lumbar', 'thorax'))
    assert torso == pytest.approx(20.96 + 6.78)


def test_unknown_subject_is_named():
    assert set(subject_names()) == {'thesis_ch4', 'thesis_2d', 'thesis_3d'}
    with pytest.raises(SubjectError, match="no subject named 'nobody'"):
        named_subject('nobody')
