# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Derivatives of the sagittal NLP against finite differences; its constraints and the task."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lift_predictor.core.models.sagittal.assembly import (
    sagittal_assembler,
    sagittal_library,
    sagittal_nlp,
)
from lift_predictor.core.models.sagittal.evaluation import evaluate
from lift_predictor.core.models.sagittal.grid import (
    HAND_SCALE,
    NODE_CONSTRAINTS,
    LiftBounds,
    SagittalGrid,
)
from lift_predictor.core.models.sagittal.parameters import LiftParameters
from lift_predictor.core.solvers.spline_nlp import SplineNlp

GRID = SagittalGrid(6, 7)
MASS = np.array([7.0, 30.0])
LIBRARY = sagittal_library()


@pytest.fixture(scope='module')
def point() -> np.ndarray:
    rng = np.random.default_rng(11)
    low, high = np.radians([-60, 0, 10, 10, 10, -10]), np.radians([10, 90, 90, 90, 90, 25])
    return np.append(rng.uniform(low, high, (GRID.spline.n_free, 6)), 7.0)


@pytest.fixture(scope='module', params=[(1.0, 0.0), (0.3, 0.9), (0.0, 1.0)])
def vector(request, parameters: LiftParameters) -> np.ndarray:
    """Person and task with factors a, b of the objective."""
    return replace(parameters, objective=np.array(request.param)).pack()


@pytest.fixture
def nlp(vector: np.ndarray) -> SplineNlp:
    angle, posture = np.full(6, 3.0), np.full((3, 6), 3.0)
    bounds = LiftBounds(-angle, angle, -posture, posture, np.ones((2, 2)), MASS)
    return sagittal_nlp(sagittal_assembler(LIBRARY, GRID), GRID, vector, bounds)


def test_gradient(point: np.ndarray, nlp: SplineNlp) -> None:
    at = nlp.linearise(point)
    assert at.objective == pytest.approx(nlp.values(point)[0], rel=1e-14)
    h = 1e-6
    for i, step in enumerate(h * np.eye(nlp.n)):
        change = nlp.values(point + step)[0] - nlp.values(point - step)[0]
        assert at.gradient[i] == pytest.approx(change / (2 * h), rel=1e-5, abs=1e-5)


def test_jacobian(point: np.ndarray, nlp: SplineNlp) -> None:
    jacobian = nlp.linearise(point).jacobian()
    assert jacobian.shape == (len(GRID.constraint_names), nlp.n)
    h = 1e-6
    for i, step in enumerate(h * np.eye(nlp.n)):
        change = nlp.values(point + step)[1] - nlp.values(point - step)[1]
        np.testing.assert_allclose(jacobian[:, i], change / (2 * h), rtol=2e-5, atol=2e-5)


def test_hessian(point: np.ndarray, nlp: SplineNlp) -> None:
    rng = np.random.default_rng(2)
    sigma, multiplier = 0.7, rng.normal(size=len(GRID.constraint_names))
    hessian = nlp.linearise(point).condensed(sigma, multiplier, np.zeros_like(multiplier))
    np.testing.assert_array_equal(hessian, hessian.T)

    def gradient(x: np.ndarray) -> np.ndarray:
        at = nlp.linearise(x)
        return sigma * at.gradient + at.transposed(multiplier)

    h = 1e-6
    for i, step in enumerate(h * np.eye(nlp.n)):
        column = (gradient(point + step) - gradient(point - step)) / (2 * h)
        np.testing.assert_allclose(hessian[:, i], column, rtol=1e-5, atol=1e-4)


def test_constraints_and_objective_are_those_of_the_model(
    point: np.ndarray, nlp: SplineNlp, vector: np.ndarray, parameters: LiftParameters
) -> None:
    control = point[: GRID.n_splined].reshape(GRID.spline.n_free, 6)
    q, dq, ddq = GRID.spline.sample(control, GRID.times, parameters.duration)
    loads = evaluate(LIBRARY, q, dq, ddq, parameters)
    f, g = nlp.values(point)
    n_node = GRID.n_nodes * len(NODE_CONSTRAINTS)
    np.testing.assert_allclose(g[:n_node], loads.constraints.ravel(), atol=1e-12)
    np.testing.assert_allclose(g[n_node : n_node + q.size], q.ravel(), atol=1e-12)
    hands = g[n_node + q.size : n_node + q.size + 4].reshape(2, 2) * HAND_SCALE
    np.testing.assert_allclose(hands, loads.centres[[0, -1], -1], atol=1e-12)
    np.testing.assert_allclose(g[-6:], q[GRID.n_nodes // 2], atol=1e-12)
    simpson = np.array([1, 4, 2, 4, 2, 4, 1]) / 18.0
    effort = parameters.duration * simpson @ loads.effort
    a, b = vector[-2:]
    objective = a * effort - b * np.log(7.0 * parameters.gravity + 10.0)
    assert f == pytest.approx(objective, rel=1e-12)


def test_bounds_have_the_order_of_the_row_names() -> None:
    angle = np.arange(6.0)
    posture = np.stack([angle - 0.1, angle, angle + 0.1])
    bounds = LiftBounds(-angle - 1, angle + 1, posture - 1, posture + 1, np.ones((2, 2)), MASS)
    lower, upper = bounds.constraints(GRID)
    assert len(lower) == len(upper) == len(GRID.constraint_names)
    at = GRID.constraint_names.index('posture (4.8) of hip_flexion at 50 % of the lift')
    assert (lower[at], upper[at]) == (2.0, 4.0)
    at = GRID.constraint_names.index('hand position (4.6) up at the end [cm]')
    assert lower[at] == upper[at] == 1.0 / HAND_SCALE
    at = GRID.constraint_names.index('joint torque limit (4.2) of arm_flex at 50 % of the lift')
    assert (lower[at], upper[at]) == (0.0, 1.0)
    at = GRID.constraint_names.index('joint angle limit (4.1) of ankle_angle at 100 % of the lift')
    assert (lower[at], upper[at]) == (-6.0, 6.0)
    lower, upper = bounds.variables(GRID)
    assert len(lower) == len(upper) == GRID.n_variables
    assert (lower[-1], upper[-1]) == (7.0, 30.0)
    assert (lower[1], upper[1]) == pytest.approx((-0.1, 1.9))


def test_margin_tightens_node_rows() -> None:
    angle = np.ones(6)
    posture = np.zeros((3, 6))
    margin = np.zeros((2, GRID.n_nodes, len(NODE_CONSTRAINTS) + 6))
    margin[0, 2, 1], margin[1, 2, 1], margin[1, 0, -1] = 0.1, 0.2, 0.3
    bounds = LiftBounds(-angle, angle, posture - 1, posture + 1, np.ones((2, 2)), MASS, margin)
    lower, upper = bounds.constraints(GRID)
    row = 2 * len(NODE_CONSTRAINTS) + 1
    assert (lower[row], upper[row]) == (0.1, 0.8)
    assert upper[GRID.n_nodes * len(NODE_CONSTRAINTS) + 5] == pytest.approx(0.7)
