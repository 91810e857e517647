# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Static optimisation against hand solutions, a general solver and its own optimality."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from human_model.report import SolveStatus
from muscle_analyzer.core.exceptions import InputArrayError, OptionError
from muscle_analyzer.core.recruitment.reserves import Reserve
from muscle_analyzer.core.recruitment.static_optimization import (
    StaticOptimization,
    StaticOptimizationOptions,
)


def solver(n_c, n_m, reserves=None, joints=None, **options):
    reserves, joints = reserves or n_c * [1.0], joints or range(n_c)
    return StaticOptimization(
        tuple(f'muscle_{i}' for i in range(n_m)),
        tuple(
            Reserve(f'coordinate_{j}', f'joint_{joint}', unit, unit < 10.0)
            for j, (joint, unit) in enumerate(zip(joints, reserves, strict=True))
        ),
        StaticOptimizationOptions(**options),
    )


def random_problem(seed, n_c=25, n_m=120, share=0.15):
    """Return a sparse torque matrix of a muscular system's size [N m] and torques to match."""
    rng = np.random.default_rng(seed)
    matrix = rng.normal(0.0, 30.0, (n_c, n_m)) * (rng.random((n_c, n_m)) < share)
    return matrix, matrix @ rng.uniform(0.0, 1.2, n_m) * rng.choice([0.3, 1.0])


def test_one_muscle_joint_by_hand():
    """Minimise a^2 + c^2 with 50 a + c = 20: a = 20 * 50 / (50^2 + 1)."""
    result = solver(1, 1).solve(np.array([[50.0]]), np.array([20.0]))
    assert result.activation[0] == pytest.approx(1000.0 / 2501.0, abs=1e-12)
    assert result.reserve[0] == pytest.approx(20.0 / 2501.0, abs=1e-12)
    assert result.report.ok
    assert result.report.objective == pytest.approx(20.0**2 / 2501.0, abs=1e-12)


def test_two_muscles_share_in_proportion_to_their_torque():
    matrix = np.array([[30.0, 60.0]])
    result = solver(1, 2).solve(matrix, np.array([40.0]))
    assert result.activation[1] / result.activation[0] == pytest.approx(2.0)


def test_antagonist_stays_at_minimum_activation():
    result = solver(1, 2).solve(np.array([[50.0, -50.0]]), np.array([20.0]))
    assert result.activation[1] == 0.01
    assert result.at_lower.tolist() == [False, True]
    # The agonist carries the antagonist's share too.
    assert 50.0 * result.activation[0] - 0.5 + result.reserve[0] == pytest.approx(20.0)


def test_weak_muscle_is_named_with_its_coordinate():
    result = solver(2, 2).solve(np.array([[50.0, 0.0], [0.0, 50.0]]), np.array([20.0, 80.0]))
    assert result.report.status == SolveStatus.MUSCLE_TOO_WEAK
    assert result.unbalanced == ('coordinate_1',)
    assert 'coordinate_1 by 30.0 N m' in result.report.message
    assert 'muscle_1' in result.report.message
    assert result.at_upper.tolist() == [False, True]
    assert result.reserve[1] == pytest.approx(30.0)


def test_reserve_is_compared_with_the_net_moment_of_its_joint():
    """Help of 3 N m with 53 N m counts, but not where the joint bears 100 N m beside it."""
    matrix = np.array([[500.0, 0.0], [0.0, 50.0]])
    for beside, status in ((10.0, SolveStatus.MUSCLE_TOO_WEAK), (100.0, SolveStatus.OK)):
        torque = np.array([beside, 53.0])
        alone = solver(2, 2).solve(matrix, torque)
        joined = solver(2, 2, joints=(0, 0)).solve(matrix, torque)
        assert alone.unbalanced == ('coordinate_1',)
        assert joined.report.status == status


def test_coordinate_without_muscle_is_carried_by_its_reserve():
    optimizer = solver(2, 1, reserves=[1.0, 100.0])
    result = optimizer.solve(np.array([[50.0], [0.0]]), np.array([20.0, 70.0]))
    assert result.reserve[1] == pytest.approx(70.0)
    # Cost of the unit reserve of 100 N m.
    assert result.report.objective == pytest.approx(20.0**2 / 2501.0 + 0.7**2)
    assert result.report.ok


@pytest.mark.parametrize('seed', range(20))
def test_random_problems_agree_with_bounded_least_squares(seed):
    """Eliminate the reserves exactly by a least-squares problem solved by SciPy."""
    matrix, torque = random_problem(seed)
    n_c, n_m = matrix.shape
    unit = np.where(np.arange(n_c) % 3 == 0, 100.0, 1.0)
    result = solver(n_c, n_m, reserves=unit.tolist()).solve(matrix, torque)
    assert result.report.status != SolveStatus.MUSCLE_NOT_CONVERGED
    stacked = np.vstack([np.eye(n_m), matrix / unit[:, None]])
    reference = lsq_linear(
        stacked, np.concatenate([np.zeros(n_m), torque / unit]), (0.01, 1.0), 'bvls', tol=1e-14
    )
    assert result.activation == pytest.approx(reference.x, abs=1e-8)
    assert result.report.objective == pytest.approx(2.0 * reference.cost, rel=1e-9)


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    scale=st.floats(1e-3, 1e2),
    share=st.floats(0.02, 0.9),
    n_c=st.integers(1, 40),
    n_m=st.integers(1, 120),
)
@example(seed=3, scale=6.0, share=0.5, n_c=16, n_m=36)  # every coordinate too weak by far
def test_solution_satisfies_the_optimality_conditions(seed, scale, share, n_c, n_m):
    """Check bounds, balance and stationarity of whatever comes."""
    matrix, torque = random_problem(seed, n_c, n_m, share)
    torque = scale * torque
    result = solver(n_c, n_m).solve(matrix, torque)
    assert result.report.status != SolveStatus.MUSCLE_NOT_CONVERGED
    size = max(1.0, np.abs(torque).max())
    assert np.all((result.activation >= 0.01) & (result.activation <= 1.0))
    balance = matrix @ result.activation + result.reserve - torque
    assert np.abs(balance).max() < 1e-9 * size
    assert result.report.dual_residual < 1e-9
    # Multipliers of active bounds have the right sign.
    gradient = 2.0 * result.activation - matrix.T @ result.multiplier
    assert np.all(gradient[result.at_lower] >= -1e-9)
    assert np.all(gradient[result.at_upper] <= 1e-9)


def test_warm_start_gives_the_same_answer_in_fewer_steps():
    matrix, torque = random_problem(3)
    warm = solver(*matrix.shape)
    warm.solve(matrix, torque)
    again = warm.solve(matrix, 1.001 * torque)
    cold = solver(*matrix.shape).solve(matrix, 1.001 * torque)
    assert again.activation == pytest.approx(cold.activation, abs=1e-9)
    assert again.report.iterations < cold.report.iterations
    warm.reset()
    assert warm.solve(matrix, 1.001 * torque).report.iterations == cold.report.iterations


def test_iteration_limit_is_reported_and_not_carried_over():
    matrix, torque = random_problem(5)
    result = solver(*matrix.shape, max_iterations=1).solve(matrix, torque)
    assert result.report.status == SolveStatus.MUSCLE_NOT_CONVERGED
    assert result.report.primal_residual > 1e-3
    assert 'coordinate_' in result.report.message


def test_bad_numbers_are_named():
    optimizer = solver(2, 2)
    with pytest.raises(InputArrayError, match='coordinate_1: torque nan'):
        optimizer.solve(np.eye(2), np.array([1.0, np.nan]))
    with pytest.raises(InputArrayError, match=r'\(2, 2\)'):
        optimizer.solve(np.eye(3), np.zeros(3))
    with pytest.raises(OptionError, match='coordinate_0: torque 0'):
        solver(1, 1, reserves=[0.0])
    with pytest.raises(OptionError, match='minimum_activation 2'):
        solver(1, 1, minimum_activation=2.0)


def test_start_goes_on_as_the_two_frames_before():
    matrix, torque = random_problem(3)
    onward, last = solver(*matrix.shape), solver(*matrix.shape)
    steps = []
    for k in range(8):
        # The other solver is told that nothing changed between the frames before.
        last.warm_start[1] = last.warm_start[0]
        torques = (1.0 + 0.01 * k) * torque
        steps.append([s.solve(matrix, torques).report.iterations for s in (onward, last)])
    assert steps[:2] == [steps[0], [steps[1][0]] * 2]  # one frame before: no change known
    assert np.sum(steps, axis=0)[0] < np.sum(steps, axis=0)[1]


def test_failed_frame_leaves_no_start():
    matrix, torque = random_problem(3)
    optimizer = solver(*matrix.shape, max_iterations=1)
    optimizer.warm_start[:] = 1.0
    assert not optimizer.solve(matrix, torque).converged
    assert not optimizer.warm_start.any()
