# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Torques and strength of a block against the same in numpy."""

import numpy as np
import pytest

from human_model.frames import matrix_from_quaternion
from human_model.strength import JointStrength
from human_model.subject import Subject
from muscle_analyzer.core.boxed_tuple import boxed
from muscle_analyzer.core.loads.torque_arrays import TorqueTable, torques_and_limits

N = 5
RNG = np.random.default_rng(3)
NAMES = ('lumbar_extension', 'knee_angle_r', 'elbow_flex_l', 'hip_flexion_r')


@pytest.fixture(scope='module')
def bounds():
    strength = JointStrength('3d_40dof', Subject('p1', 'female', 61.0, 1.65, 40))
    return [[strength.bound(name, side) for name in NAMES] for side in ('lower', 'upper')]


@pytest.fixture(scope='module')
def table(bounds):
    """Return four joints: the first has the moment about an axis, the third stands still."""
    return TorqueTable(
        np.array([True, False, False, False]),
        np.array([1, 2, 0, 1]),
        np.array([-1.0, 1.0, 1.0, -1.0]),
        np.array([3, 0, -1, 1]),
        **{
            name: np.array([[getattr(bound, name) for bound in side] for side in bounds])
            for name in ('coefficients', 'magnitude', 'angle_factor', 'speed_factor')
        },
    )


def test_block_of_torques_and_limits(table, bounds):
    position, velocity = RNG.normal(size=(2, N, 4))
    frames = RNG.normal(size=(N, 3, 4))
    frames /= np.linalg.norm(frames, axis=2, keepdims=True)
    net, torque = RNG.normal(size=(N, 3)), RNG.normal(size=(N, 3))
    got, lower, upper = torques_and_limits(
        boxed(table), position, velocity, frames, 2, net, torque
    )
    left = matrix_from_quaternion(frames[:, 2])[:, :, 1]
    np.testing.assert_allclose(got[:, 0], -(left * net).sum(axis=1))
    np.testing.assert_array_equal(got[:, 1:], torque[:, [2, 0, 1]] * [1.0, 1.0, -1.0])
    for j, column in enumerate(table.column):
        q = position[:, column] if column >= 0 else np.zeros(N)
        v = velocity[:, column] if column >= 0 else np.zeros(N)
        np.testing.assert_allclose(lower[:, j], np.minimum(bounds[0][j](q, v), 0.0), rtol=1e-12)
        np.testing.assert_allclose(upper[:, j], np.maximum(bounds[1][j](q, v), 0.0), rtol=1e-12)


@pytest.mark.parametrize('axis', [0, 1, 2])
def test_axes_of_the_pelvis(table, axis):
    quaternion = np.array([[[0.1, -0.2, 0.3, 0.9]]]) / np.sqrt(0.95)
    one = table._replace(source=np.array([axis, 0, 0, 0]), sign=np.ones(4))
    zero = np.zeros((1, 4))
    matrix = matrix_from_quaternion(quaternion)[0, 0]
    for world in range(3):
        net = np.eye(3)[world : world + 1]
        got = torques_and_limits(boxed(one), zero, zero, quaternion, 0, net, np.zeros((1, 3)))[0]
        assert got[0, 0] == pytest.approx(matrix[world, axis], abs=1e-14)


def test_strength_does_not_change_its_direction(table):
    """A surface below zero counts as no strength, not as strength the other way."""
    negative = table._replace(coefficients=-np.abs(table.coefficients))
    zero = np.zeros((1, 4))
    args = np.array([[[0.0, 0.0, 0.0, 1.0]]]), 0, np.zeros((1, 3)), np.zeros((1, 3))
    _, lower, upper = torques_and_limits(boxed(negative), zero, zero, *args)
    assert not lower.any() and not upper.any()
