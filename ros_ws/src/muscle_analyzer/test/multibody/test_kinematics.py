# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Forward kinematics and Jacobians against plane geometry and finite differences."""

import numpy as np
import pytest

from muscle_analyzer.core.multibody.kinematics import (
    body_jacobians,
    forward_kinematics,
    point_jacobian,
)

STEP = 1e-5


def random_state(model, seed=1):
    rng = np.random.default_rng(seed)
    n = len(model.coordinate_names)
    low, high = np.maximum(model.lower, -1.0), np.minimum(model.upper, 1.5)
    return rng.uniform(low, high), rng.normal(size=n), rng.normal(size=n)


def test_pendulum_is_where_geometry_puts_it(pendulum):
    q1, q2 = 0.4, 0.7
    zero = np.zeros(2)
    state = forward_kinematics(pendulum.tree, np.array([q1, q2]), zero, zero)
    elbow = 0.3 * np.array([np.sin(q1), -np.cos(q1), 0.0])
    np.testing.assert_allclose(state.position[2], elbow, atol=1e-15)
    np.testing.assert_allclose(state.joint_position[2], elbow, atol=1e-15)
    tip = state.position[2] + state.rotation[2] @ [0.0, -0.4, 0.0]
    expected = elbow + 0.4 * np.array([np.sin(q1 + q2), -np.cos(q1 + q2), 0.0])
    np.testing.assert_allclose(tip, expected, atol=1e-15)


@pytest.mark.parametrize('name', ['pendulum', 'coupled_pendulum', 'lifting_multibody'])
def test_velocities_and_accelerations_are_time_derivatives(name, request):
    model = request.getfixturevalue(name)
    q, qd, qdd = random_state(model)

    def at(t):
        return forward_kinematics(model.tree, q + t * qd + 0.5 * t**2 * qdd, qd + t * qdd, qdd)

    before, now, after = at(-STEP), at(0.0), at(STEP)

    def rate(field):
        return (getattr(after, field) - getattr(before, field)) / (2.0 * STEP)

    np.testing.assert_allclose(now.velocity, rate('position'), atol=1e-6)
    np.testing.assert_allclose(now.acceleration, rate('velocity'), atol=1e-5)
    np.testing.assert_allclose(now.angular_acceleration, rate('angular_velocity'), atol=1e-5)
    spin = rate('rotation') @ now.rotation.transpose(0, 2, 1)
    omega = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
    np.testing.assert_allclose(now.angular_velocity, omega, atol=1e-6)


@pytest.mark.parametrize('name', ['pendulum', 'coupled_pendulum', 'lifting_multibody'])
def test_jacobians_are_derivatives_of_positions(name, request):
    """Of every body, with respect to every independent coordinate, coupled joints included."""
    model = request.getfixturevalue(name)
    q, _, _ = random_state(model, 2)
    zero = np.zeros(q.size)
    state = forward_kinematics(model.tree, q, zero, zero)
    jacobians = body_jacobians(model.tree, state)
    for k in range(q.size):
        step = np.zeros(q.size)
        step[k] = STEP
        after = forward_kinematics(model.tree, q + step, zero, zero)
        before = forward_kinematics(model.tree, q - step, zero, zero)
        slope = (after.position - before.position) / (2.0 * STEP)
        turned = (after.rotation - before.rotation) / (2.0 * STEP)
        spin = turned @ state.rotation.transpose(0, 2, 1)
        for b in range(len(model.body_names)):
            column = point_jacobian(jacobians[b], state.position[b])[:, k]
            np.testing.assert_allclose(column, slope[b], atol=1e-8)
            turn = [spin[b, 2, 1], spin[b, 0, 2], spin[b, 1, 0]]
            np.testing.assert_allclose(jacobians[b, :3, k], turn, atol=1e-8)


def test_lumbar_levels_turn_by_the_rhythm(lifting_multibody):
    """The thorax turns 7.1429 times as far as L5-S1: 1 + 1.8571 + ... + 0.5714 (facts 4.7)."""
    model = lifting_multibody
    zero = np.zeros(len(model.coordinate_names))
    state = forward_kinematics(model.tree, zero, zero, zero)
    jacobians = body_jacobians(model.tree, state)
    at = model.coordinate_index('L5_S1_Flex_Ext')
    turned = {name: jacobians[model.body_index(name), 2, at] for name in ('lumbar5', 'torso')}
    assert turned['lumbar5'] == pytest.approx(1.0)
    levels = 1.0 + 1.8571 + 1.6429 + 1.1429 + 0.9286 + 0.5714
    assert turned['torso'] == pytest.approx(levels)
