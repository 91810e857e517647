# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Fitting poses: known poses are found, bounds hold, derivatives are right."""

import numpy as np
import pytest

from muscle_analyzer.core.multibody.kinematics import forward_kinematics
from muscle_analyzer.core.transfer.pose_fit import Rates, fit_pose, map_rates
from muscle_analyzer.core.transfer.pose_misfit import Targets, misfit, misfit_jacobian

FREE = np.full(2, np.inf)
BOTH = np.array([True, True])
LOCAL = np.array([[0.02, -0.3, 0.0], [0.0, -0.4, 0.01]])


def targets_at(model, q, reference=None, weight=0.0):
    """Return the two links' ends and the lower link's axes of a pose as targets."""
    zero = np.zeros(2)
    state = forward_kinematics(model.tree, q, zero, zero)
    body = np.array([1, 2])
    place = np.array(
        [
            state.position[b] + state.rotation[b] @ local
            for b, local in zip(body, LOCAL, strict=True)
        ]
    )
    return Targets(
        body,
        LOCAL,
        place,
        np.array([100.0, 200.0]),
        np.array([2]),
        state.rotation[2:].copy(),
        np.array([10.0]),
        zero if reference is None else reference,
        np.full(2, weight),
    )


@pytest.mark.parametrize('start', [[0.0, 0.0], [-1.0, 1.5]])
def test_known_pose_is_found(pendulum, start):
    q = np.array([0.7, -0.5])
    fit = fit_pose(
        pendulum.tree, targets_at(pendulum, q), np.array(start), -FREE, FREE, BOTH, 1e-10, 50
    )
    assert fit.converged
    assert fit.q == pytest.approx(q, abs=1e-8)
    assert fit.cost == pytest.approx(0.0, abs=1e-12)


def test_bounds_hold_and_the_rest_is_fitted(pendulum):
    """With the elbow stopped at -0.2 the shoulder alone makes the best of it."""
    targets = targets_at(pendulum, np.array([0.7, -0.5]))
    lower = np.array([-np.inf, -0.2])
    fit = fit_pose(pendulum.tree, targets, np.zeros(2), lower, FREE, BOTH, 1e-10, 50)
    assert fit.converged
    assert fit.q[1] == -0.2
    for nearby in (-1e-3, 1e-3):
        q = fit.q + [nearby, 0.0]
        zero = np.zeros(2)
        off = misfit(targets, forward_kinematics(pendulum.tree, q, zero, zero))
        assert 0.5 * off @ off > fit.cost


def test_coordinates_that_are_not_fitted_stay(pendulum):
    targets = targets_at(pendulum, np.array([0.7, -0.5]))
    fit = fit_pose(
        pendulum.tree,
        targets,
        np.array([0.1, 0.3]),
        -FREE,
        FREE,
        np.array([True, False]),
        1e-10,
        50,
    )
    assert fit.q[1] == 0.3


def test_too_few_iterations_are_told(pendulum):
    targets = targets_at(pendulum, np.array([0.7, -0.5]))
    fit = fit_pose(pendulum.tree, targets, np.array([-2.0, 2.0]), -FREE, FREE, BOTH, 1e-10, 1)
    assert not fit.converged


def test_jacobian_of_the_misfit_by_finite_differences(pendulum):
    """At the targets, where the first order of the rotations is all there is."""
    q = np.array([0.4, 0.9])
    targets = targets_at(pendulum, q)
    zero, step = np.zeros(2), 1e-6
    jacobian = misfit_jacobian(
        pendulum.tree, targets, forward_kinematics(pendulum.tree, q, zero, zero)
    )
    for k in range(2):
        change = np.zeros(2)
        change[k] = step
        after = misfit(targets, forward_kinematics(pendulum.tree, q + change, zero, zero))
        before = misfit(targets, forward_kinematics(pendulum.tree, q - change, zero, zero))
        np.testing.assert_allclose(jacobian[:, k], (after - before) / (2 * step), atol=1e-6)


def test_rates_of_points_are_those_of_the_coordinates(pendulum):
    """Points that move with the coordinates give back their rates and accelerations."""
    q, qd, qdd = np.array([0.4, 0.9]), np.array([1.2, -0.7]), np.array([-2.0, 3.0])
    targets = targets_at(pendulum, q)
    state = forward_kinematics(pendulum.tree, q, qd, qdd)

    def of_points(spin, speed):
        return np.array(
            [
                speed(b, state.rotation[b] @ local, spin)
                for b, local in zip(targets.point_body, LOCAL, strict=True)
            ]
        )

    velocity = of_points(
        state.angular_velocity, lambda b, arm, w: state.velocity[b] + np.cross(w[b], arm)
    )
    acceleration = of_points(
        state.angular_velocity,
        lambda b, arm, w: (
            state.acceleration[b]
            + np.cross(state.angular_acceleration[b], arm)
            + np.cross(w[b], np.cross(w[b], arm))
        ),
    )
    rate, again = map_rates(
        pendulum.tree,
        targets,
        q,
        state,
        BOTH,
        Rates(velocity, state.angular_velocity[2:], np.zeros(2)),
        Rates(acceleration, state.angular_acceleration[2:], np.zeros(2)),
    )
    assert rate == pytest.approx(qd, abs=1e-8)
    assert again == pytest.approx(qdd, abs=1e-7)


def test_reference_decides_what_points_leave_open(pendulum):
    """Only the lower link's axes are given: they fix q1 + q2 and not their difference."""
    targets = targets_at(pendulum, np.array([0.7, -0.5]), np.array([0.5, 0.3]), 0.1)
    targets = targets._replace(point_weight=np.zeros(2))
    fit = fit_pose(pendulum.tree, targets, np.zeros(2), -FREE, FREE, BOTH, 1e-12, 100)
    assert fit.q.sum() == pytest.approx(0.2, abs=1e-3)
    assert fit.q[0] - fit.q[1] == pytest.approx(0.2, abs=1e-6)


def test_targets_that_are_not_numbers_end_as_not_converged(pendulum):
    targets = targets_at(pendulum, np.array([0.7, -0.5]))
    targets.point[0, 0] = np.nan
    fit = fit_pose(pendulum.tree, targets, np.zeros(2), -FREE, FREE, BOTH, 1e-10, 50)
    assert not fit.converged
