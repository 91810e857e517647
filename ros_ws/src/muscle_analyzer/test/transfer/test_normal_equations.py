# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Normal equations and their solution against numpy's."""

import numpy as np
import pytest

from muscle_analyzer.core.transfer.normal_equations import (
    damped_part,
    factorise,
    normal_equations,
    solution,
    solve_factorised,
)

RNG = np.random.default_rng(1)


def sparse_jacobian(points=9, unknowns=7):
    """Return a Jacobian whose rows hang on the same unknowns in threes."""
    hangs = np.repeat(RNG.random((points, unknowns)) < 0.4, 3, axis=0)
    return np.where(hangs, RNG.normal(size=hangs.shape), 0.0)


def test_products_are_those_of_the_matrix():
    jacobian, residual = sparse_jacobian(), RNG.normal(size=27)
    normal, gradient = normal_equations(jacobian, residual)
    np.testing.assert_allclose(normal, jacobian.T @ jacobian, atol=1e-13)
    np.testing.assert_allclose(gradient, jacobian.T @ residual, atol=1e-13)


def test_solution_of_some_unknowns_with_damping():
    half = RNG.normal(size=(5, 9))
    normal, right = half @ half.T, RNG.normal(size=5)
    index = np.array([0, 2, 3])
    factor = damped_part(normal, index, 0.1)
    wanted = np.linalg.solve(normal[np.ix_(index, index)] + 0.1 * np.eye(3), right[index])
    assert factorise(factor)
    x = solution(factor, True, index, right)
    np.testing.assert_allclose(x[index], wanted, rtol=1e-10)
    assert not x[[1, 4]].any()
    part = right[index].copy()
    solve_factorised(factor, part)
    np.testing.assert_array_equal(part, x[index])


@pytest.mark.parametrize('bad', [-1.0, 0.0, np.nan])
def test_matrix_that_is_not_positive_has_no_factor(bad):
    assert not factorise(np.diag([1.0, bad, 2.0]))
    assert np.isnan(solution(np.eye(2), False, np.arange(2), np.ones(3))[:2]).all()
