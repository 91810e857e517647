# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Criteria of muscle recruitment against hand solutions, linear programmes and optimality."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from human_model.report import SolveStatus
from muscle_analyzer.core.exceptions import OptionError
from muscle_analyzer.core.recruitment.reserves import Reserve
from muscle_analyzer.core.recruitment.static_optimization import (
    StaticOptimization,
    StaticOptimizationOptions,
)


def solver(n_c, n_m, criterion, weight=None, least=None, **options):
    return StaticOptimization(
        tuple(f'muscle_{i}' for i in range(n_m)),
        tuple(Reserve(f'coordinate_{j}', f'joint_{j}', 1.0, True) for j in range(n_c)),
        StaticOptimizationOptions(criterion=criterion, **options),
        weight,
        least,
    )


def problem(seed, n_c=20, n_m=100):
    """Return a sparse torque matrix [N m] and torques that activations of 0.01 to 0.8 make."""
    rng = np.random.default_rng(seed)
    matrix = rng.normal(0.0, 30.0, (n_c, n_m)) * (rng.random((n_c, n_m)) < 0.2)
    return matrix, matrix @ rng.uniform(0.01, 0.8, n_m)


def test_cubes_share_by_the_square_root_of_the_torque():
    """Of 3 a_i^2 = y T_i: four times the torque, twice the activation; squares: four times."""
    matrix = np.array([[25.0, 100.0]])
    cubes = solver(1, 2, 'cubes').solve(matrix, np.array([60.0])).activation
    assert cubes[1] / cubes[0] == pytest.approx(2.0)
    squares = solver(1, 2, 'squares').solve(matrix, np.array([60.0])).activation
    assert squares[1] / squares[0] == pytest.approx(4.0)


def test_min_max_makes_synergists_equal():
    """Both muscles pull as much as they must: (25 + 100) b + c = 60."""
    result = solver(1, 2, 'min_max').solve(np.array([[25.0, 100.0]]), np.array([60.0]))
    assert result.activation[0] == pytest.approx(result.activation[1], rel=1e-9)
    # A unit less of b saves 1 and a thousandth of 2 b for each muscle, and makes the reserve,
    # which costs 2 c a unit, take 125 N m more.
    b = result.activation[0]
    assert 125.0 * b + result.reserve[0] == pytest.approx(60.0)
    assert result.reserve[0] == pytest.approx((1.0 + 2e-3 * 2.0 * b) / 250.0, rel=1e-6)


@pytest.mark.parametrize('seed', range(6))
def test_min_max_reaches_the_smallest_largest_activation(seed):
    """The linear programme min b, with the same reserves, has no smaller largest activation."""
    matrix, torque = problem(seed)
    n_c, n_m = matrix.shape
    result = solver(n_c, n_m, 'min_max').solve(matrix, torque)
    assert result.report.ok
    balanced = torque - result.reserve
    columns = np.hstack((matrix, np.zeros((n_c, 1))))
    cap = np.hstack((np.eye(n_m), -np.ones((n_m, 1))))
    bounds = [(0.01, 1.0)] * n_m + [(0.0, 1.0)]
    cost = np.append(np.zeros(n_m), 1.0)
    best = linprog(cost, cap, np.zeros(n_m), columns, balanced, bounds)
    assert best.status == 0
    # b + e S is smallest at the solution, so b exceeds the least b by no more than e times what
    # the linear programme's solution has more of squares S.
    more = best.x[:-1] @ best.x[:-1] - result.activation @ result.activation
    assert best.fun <= result.activation.max() + 1e-6
    assert result.activation.max() <= best.fun + 1e-3 * more + 1e-6


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    criterion=st.sampled_from(['squares', 'cubes', 'min_max']),
    scale=st.floats(1e-2, 3.0),
)
def test_every_criterion_satisfies_its_optimality_conditions(seed, criterion, scale):
    matrix, torque = problem(seed)
    n_c, n_m = matrix.shape
    weight = np.random.default_rng(seed).uniform(0.1, 3.0, n_m)
    result = solver(n_c, n_m, criterion, weight).solve(matrix, scale * torque)
    assert result.report.status != SolveStatus.MUSCLE_NOT_CONVERGED
    size = max(1.0, np.abs(scale * torque).max())
    balance = matrix @ result.activation + result.reserve - scale * torque
    assert np.abs(balance).max() < 1e-9 * size
    assert np.all((result.activation >= 0.01) & (result.activation <= 1.0))
    assert result.report.dual_residual < 1e-9


def pressed_on_the_largest(result, matrix, weight):
    """Return what the muscles at the largest activation would save by more of it."""
    top = result.activation >= result.activation.max() - 1e-12
    force = matrix.T @ result.multiplier - 2e-3 * weight * result.activation
    return np.where(top, np.maximum(force, 0.0), 0.0).sum()


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6), scale=st.floats(1e-3, 30.0), twins=st.booleans())
def test_min_max_is_exact_however_weak_the_muscles_are(seed, scale, twins):
    """A unit more of the largest activation saves 1, or more where none is to be had."""
    matrix, torque = problem(seed)
    if twins:
        matrix = np.hstack((matrix[:, :50], matrix[:, :50]))
    weight = np.random.default_rng(seed).uniform(0.1, 3.0, matrix.shape[1])
    result = solver(*matrix.shape, 'min_max', weight).solve(matrix, scale * torque)
    assert result.report.status != SolveStatus.MUSCLE_NOT_CONVERGED
    assert result.report.dual_residual < 1e-9
    saved = pressed_on_the_largest(result, matrix, weight)
    if result.activation.max() < 1.0:
        assert saved == pytest.approx(1.0, abs=1e-8)
    else:
        assert saved > 1.0 - 1e-8


def test_min_max_with_nothing_to_do_leaves_every_muscle_at_its_least():
    """Torques below those of the least activations: the reserves take the difference."""
    matrix = np.abs(problem(3)[0])
    result = solver(*matrix.shape, 'min_max').solve(matrix, 0.001 * matrix.sum(axis=1))
    assert result.report.status != SolveStatus.MUSCLE_NOT_CONVERGED
    assert np.all(result.activation == 0.01)
    assert result.report.dual_residual == 0.0


def test_costs_are_ordered_as_each_criterion_promises():
    """Each criterion is best by its own measure."""
    matrix, torque = problem(11)
    found = {
        name: solver(*matrix.shape, name).solve(matrix, torque).activation
        for name in ('squares', 'cubes', 'min_max')
    }
    for power, best in ((2, 'squares'), (3, 'cubes')):
        cost = {name: float((a**power).sum()) for name, a in found.items()}
        assert cost[best] == pytest.approx(min(cost.values()), rel=1e-3)
    largest = {name: float(a.max()) for name, a in found.items()}
    assert largest['min_max'] < largest['cubes'] < largest['squares']


def test_weights_shift_the_load_to_cheap_muscles():
    """Two equal muscles, one three times as dear: of w a = y T the activations are as 3 to 1."""
    optimizer = solver(1, 2, 'squares', weight=np.array([1.0, 3.0]))
    result = optimizer.solve(np.array([[50.0, 50.0]]), np.array([40.0]))
    assert result.activation[0] / result.activation[1] == pytest.approx(3.0)


def test_least_activation_makes_antagonists_work():
    """The antagonist's least activation is kept, and the agonist pays for it."""
    matrix, torque = np.array([[50.0, -50.0]]), np.array([20.0])
    result = solver(1, 2, 'squares', least=np.array([0.0, 0.2])).solve(matrix, torque)
    assert result.activation[1] == 0.2
    assert 50.0 * result.activation[0] + result.reserve[0] == pytest.approx(30.0)


def test_unusable_settings_are_named():
    with pytest.raises(OptionError, match=r"'entropy' is not known; options: squares, cubes"):
        solver(1, 1, 'entropy')
    with pytest.raises(OptionError, match='positive weight'):
        solver(1, 1, 'squares', weight=np.array([0.0]))
    with pytest.raises(OptionError, match=r'least activation of muscle_1: 1\.0'):
        solver(1, 2, 'squares', least=np.array([0.0, 1.0]))
