# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Min/max recruitment where it is hard: passive forces beyond all strength, ties, real frames."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit
from scipy.optimize import linprog

from human_model.report import SolveStatus
from muscle_analyzer.core.loads.load_solver import LoadSolver
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.loads.sample import compute_joint_torques
from muscle_analyzer.core.loads.sample_data import allocate_workspace
from muscle_analyzer.core.recruitment.min_max import SQUARES_WEIGHT, WARM_STEPS
from muscle_analyzer.core.recruitment.reserves import Reserve
from muscle_analyzer.core.recruitment.static_optimization import (
    StaticOptimization,
    StaticOptimizationOptions,
)

#: A person bends forward with all joints at once, rad a unit.
BEND = {
    'pelvis_tilt': -0.3, 'hip_flexion_r': 0.9, 'hip_flexion_l': 0.8, 'knee_angle_r': 0.9,
    'knee_angle_l': 0.8, 'L5_S1_Flex_Ext': -0.3, 'L5_S1_Lat_Bending': 0.05, 'arm_flex_r': 0.6,
}  # fmt: skip


def solver(n_c, n_m, weight=None, **options):
    """Return the optimisation of n_m muscles on n_c coordinates, reserves of 1 N m."""
    return StaticOptimization(
        tuple(f'muscle_{i}' for i in range(n_m)),
        tuple(Reserve(f'coordinate_{j}', f'joint_{j}', 1.0, True) for j in range(n_c)),
        StaticOptimizationOptions(criterion='min_max', **options),
        weight,
    )


@pytest.mark.parametrize('stretched', [-20.0, 0.0, 30.0, 55.0, 1e3, 1e9])
def test_passive_torque_moves_the_activation_along_its_bounds(stretched):
    """One extensor of 100 N m holds 40 N m and what stretched flexors pull.

    b + e b^2 + (T - 100 b)^2 is smallest at b = (200 T - 1) / (20000 + 2 e), between the bounds.
    """
    torque = 40.0 + stretched
    expected = np.clip((200.0 * torque - 1.0) / (20000.0 + 2.0 * SQUARES_WEIGHT), 0.01, 1.0)
    result = solver(1, 1).solve(np.array([[100.0]]), np.array([torque]))
    assert result.activation[0] == pytest.approx(expected, rel=1e-12)
    assert result.reserve[0] == pytest.approx(torque - 100.0 * expected, rel=1e-9, abs=1e-9)
    weak = torque > 105.0
    assert result.report.status == (SolveStatus.MUSCLE_TOO_WEAK if weak else SolveStatus.OK)


@pytest.mark.parametrize('passive', [1e3, 1e5, 1e7, 1e9])
def test_a_joint_that_passive_forces_overpower_leaves_the_other_one_solved(passive):
    """Back: 50 a_0 + 30 a_1; hip: 40 a_1 - 60 a_2.

    The back takes all of a_0 and a_1. The hip has 40 N m of that, which a_2 holds: of
    e a_2^2 + (40 - 60 a_2)^2 the smallest is at a_2 = 2400 / (3600 + e).
    """
    matrix = np.array([[50.0, 30.0, 0.0], [0.0, 40.0, -60.0]])
    result = solver(2, 3).solve(matrix, np.array([passive, 0.0]))
    third = 2400.0 / (3600.0 + SQUARES_WEIGHT)
    assert result.activation == pytest.approx([1.0, 1.0, third], rel=1e-9)
    assert result.reserve == pytest.approx([passive - 80.0, 60.0 * third - 40.0], rel=1e-9)
    assert result.report.status is SolveStatus.MUSCLE_TOO_WEAK
    assert result.unbalanced == ('coordinate_0',)
    assert result.report.dual_residual < 1e-12 * passive


@pytest.mark.parametrize('torque', [30.0, 300.0, 1e8])
@pytest.mark.parametrize('copies', [2, 40])
def test_ties_at_the_largest_activation(torque, copies):
    """Equal muscles, muscles without strength and an antagonist: the equal ones share equally.

    With A the torque of all the equal ones and V that of the antagonist at its least activation l,
    b + e W b^2 + (T + V - A b)^2 is smallest at b = (2 A (T + V) - 1) / (2 A^2 + 2 e W).
    """
    matrix = np.concatenate([np.full(copies, 400.0 / copies), np.zeros(5), [-50.0]])[None]
    weight = np.linspace(0.5, 2.0, matrix.size)
    result = solver(1, matrix.size, weight).solve(matrix, np.array([torque]))
    total = SQUARES_WEIGHT * weight[:copies].sum()
    b = min((800.0 * (torque + 0.5) - 1.0) / (2.0 * 400.0**2 + 2.0 * total), 1.0)
    assert result.activation[:copies] == pytest.approx(np.full(copies, b), rel=1e-9)
    assert np.all(result.activation[copies:] == 0.01)
    assert result.report.status is not SolveStatus.MUSCLE_NOT_CONVERGED


def gap(optimizer, matrix, torque, result):
    """Return by how much the cost exceeds what the multipliers prove to be the least, and that.

    For any multipliers the least of cost less y times the balance's error is no more than the
    least cost. Muscles at b together press on it with the cost of a unit of b, unless b is at a
    bound: then the least is taken there.
    """
    a = optimizer.actuators
    share = SQUARES_WEIGHT * a.weight
    control = (torque - matrix @ result.activation) / a.unit
    b = result.activation.max()
    cost = b + share @ result.activation**2 + control @ control
    pull = matrix.T @ result.multiplier

    def least(largest):
        best = np.clip(pull / (2.0 * share), a.lower, largest)
        return largest + (share * best**2 - pull * best).sum()

    # Convex in the largest activation: the least is where the slope passes 0.
    low, high = a.lower.max(), a.upper.min()
    for _ in range(200):
        middle = 0.5 * (low + high)
        slope = 1.0 - np.maximum(pull - 2.0 * share * middle, 0.0).sum()
        low, high = (middle, high) if slope < 0.0 else (low, middle)
    bound = result.multiplier @ torque - 0.25 * ((a.unit * result.multiplier) ** 2).sum()
    return cost - bound - least(high), cost


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    overload=st.floats(0.0, 9.0),
    overloaded=st.integers(0, 6),
    twins=st.booleans(),
    spread=st.floats(0.0, 2.0),
)
def test_overloaded_joints_do_not_keep_it_from_the_solution(
    seed, overload, overloaded, twins, spread
):
    """Torques up to 1e9 N m on some coordinates, equal muscles, weights of four decades."""
    rng = np.random.default_rng(seed)
    n_c, n_m = 20, 100
    matrix = rng.normal(0.0, 30.0, (n_c, n_m)) * (rng.random((n_c, n_m)) < 0.2)
    if twins:
        matrix[:, 50:] = matrix[:, :50]
    torque = matrix @ rng.uniform(0.01, 0.8, n_m)
    torque[:overloaded] += 10.0**overload * rng.choice([-1.0, 1.0], overloaded)
    optimizer = solver(n_c, n_m, 10.0 ** rng.uniform(-spread, spread, n_m))
    result = optimizer.solve(matrix, torque)
    assert result.report.status is not SolveStatus.MUSCLE_NOT_CONVERGED
    size = max(1.0, np.abs(torque).max())
    assert np.abs(matrix @ result.activation + result.reserve - torque).max() < 1e-11 * size
    beyond, cost = gap(optimizer, matrix, torque, result)
    assert abs(beyond) < 1e-11 * max(1.0, cost)


def test_a_start_far_away_leads_to_the_same_solution():
    """From the solution of other torques, and from one a million times as large."""
    rng = np.random.default_rng(4)
    matrix = rng.normal(0.0, 30.0, (20, 100)) * (rng.random((20, 100)) < 0.2)
    torque = matrix @ rng.uniform(0.01, 0.8, 100)
    cold = solver(20, 100).solve(matrix, torque)
    for before in (1.02 * torque, -torque, 1e6 * torque):
        optimizer = solver(20, 100)
        optimizer.solve(matrix, before)
        warm = optimizer.solve(matrix, torque)
        np.testing.assert_allclose(warm.activation, cold.activation, atol=1e-11)
    near = solver(20, 100)
    near.solve(matrix, 1.0001 * torque)
    assert near.solve(matrix, torque).report.iterations <= WARM_STEPS < cold.report.iterations


@pytest.fixture(scope='module')
def bending(lifting_multibody):
    """Return a function: problems of static bending, with or without passive forces."""

    def problems(amount, stretched):
        options = MuscleAnalyzerOptions(
            force_length_velocity=True,
            passive_force=stretched,
            static_optimization=StaticOptimizationOptions(criterion='min_max'),
        ).as_opensim()
        loads = LoadSolver(lifting_multibody, options)
        names = lifting_multibody.coordinate_names
        q = np.array(amount)[:, None] * np.array([BEND.get(name, 0.0) for name in names])
        still = np.zeros_like(q)
        external = np.zeros((len(amount), len(lifting_multibody.body_names), 6))
        found = loads.solve_block(q, still, still, external)
        solutions = [loads.solution(found, k, 0.0) for k in range(len(amount))]
        given = [
            _torque_problem(loads.sample_model, q[k], still[k], external[k])
            for k in range(len(amount))
        ]
        return loads, given, solutions

    return problems


def _torque_problem(model, q, still, external):
    """Return torque of each muscle at full activation (n_c, n_m) and torque to balance (n_c,)."""
    workspace = allocate_workspace(model)
    _compute(model, workspace, q, still, external)
    start, row, value = workspace.columns
    matrix = np.zeros((workspace.to_balance.size, start.size - 1))
    for m in range(start.size - 1):
        entries = slice(start[m], start[m + 1])
        matrix[row[entries], m] = value[entries]
    return matrix, workspace.to_balance


@njit
def _compute(model, workspace, q, still, external):
    workspace.q[:], workspace.qd[:], workspace.qdd[:] = q, still, still
    compute_joint_torques(model, workspace, external)


def test_passive_forces_of_the_generic_model_are_too_strong_and_it_says_so(bending):
    """Bent far, its stretched fibres ask for 1e7 N m at L5-S1, and all muscles have 5000."""
    loads, given, solutions = bending(np.linspace(0.8, 1.0, 5), True)
    for (matrix, torque), solution in zip(given, solutions, strict=True):
        assert np.abs(torque).max() > 1e3 * np.abs(matrix).sum(axis=1).max()
        report = solution.balance.report
        assert report.status is SolveStatus.MUSCLE_TOO_WEAK
        assert 'L5_S1_Lat_Bending by' in report.message
        assert solution.balance.activation.max() == 1.0
        assert report.primal_residual < 1e-12 * np.abs(torque).max()
        beyond, cost = gap(loads.optimization, matrix, torque, solution.balance)
        assert abs(beyond) < 1e-12 * cost


@pytest.mark.parametrize(('amount', 'stretched'), [(0.1, False), (0.3, False), (0.02, True)])
def test_no_smaller_largest_activation_balances_a_real_frame(bending, amount, stretched):
    """Reference: the linear programme min t, |a| <= t, with the same reserves (HiGHS)."""
    loads, ((matrix, torque),), (solution,) = bending([amount], stretched)
    balance, low = solution.balance, loads.optimization.actuators.lower
    assert balance.converged
    n_c, n_m = matrix.shape
    best = linprog(
        np.append(np.zeros(n_m), 1.0),
        np.hstack((np.eye(n_m), -np.ones((n_m, 1)))), np.zeros(n_m),
        np.hstack((matrix, np.zeros((n_c, 1)))), torque - balance.reserve,
        [*((x, 1.0) for x in low), (0.0, 1.0)],
    )  # fmt: skip
    assert best.status == 0
    largest = balance.activation.max()
    more = best.x[:-1] @ best.x[:-1] - balance.activation @ balance.activation
    assert best.fun - 1e-6 <= largest <= best.fun + SQUARES_WEIGHT * max(more, 0.0) + 1e-6
    beyond, cost = gap(loads.optimization, matrix, torque, balance)
    assert abs(beyond) < 1e-12 * max(1.0, cost)
