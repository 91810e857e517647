# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The interior-point method on problems of Hock and Schittkowski (1981) with known optima."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
import pytest

from human_model.typing import Array
from lift_predictor.core.solvers.interior_point import solve
from lift_predictor.core.solvers.ipopt import IpoptSolver
from lift_predictor.core.solvers.solution import InteriorPointOptions, Status

INF = np.inf


class SymbolicNlp:
    """Problem of f(x) and g(x) with dense derivatives, run in CasADi's virtual machine.

    Parameters
    ----------
    objective : callable
        Expression of f from a list of n symbols.
    constraints : callable
        Expressions of the constraints from the same.
    variables : pair of array, shape (n,)
        Lower and upper bounds of the variables.
    g_bounds : pair of array, shape (m,)
        Lower and upper bounds of the constraints.
    """

    def __init__(
        self,
        objective: Callable[[list[Any]], Any],
        constraints: Callable[[list[Any]], list[Any]],
        variables: tuple[Any, Any],
        g_bounds: tuple[Any, Any],
    ) -> None:
        self.lower, self.upper = (np.array(b, dtype=float) for b in variables)
        self.g_lower, self.g_upper = (np.array(b, dtype=float) for b in g_bounds)
        self.n = len(self.lower)
        x = ca.SX.sym('x', self.n)
        parts = [x[i] for i in range(self.n)]
        f, g = ca.SX(objective(parts)), ca.SX(ca.vertcat(*constraints(parts)))
        sigma, y = ca.SX.sym('sigma'), ca.SX.sym('y', len(self.g_lower))
        lagrangian = sigma * f + ca.dot(y, g)
        self._values = ca.Function('values', [x], [f, g])
        self._first = ca.Function('first', [x], [f, g, ca.gradient(f, x), ca.jacobian(g, x)])
        self._second = ca.Function('second', [x, sigma, y], [ca.hessian(lagrangian, x)[0]])

    def constraint_name(self, index: int) -> str:
        """Row and its number."""
        return f'constraint {index}'

    def variable_name(self, index: int) -> str:
        """Letter and number."""
        return f'x{index}'

    def values(self, x: Array) -> tuple[float, Array]:
        """Objective and constraints."""
        f, g = self._values(x)
        return float(f), np.asarray(g).ravel()

    def linearise(self, x: Array) -> SymbolicPoint:
        """First derivatives."""
        return SymbolicPoint(self, x)

    def hessian(self, x: Array, sigma: float, multiplier: Array) -> Array:
        """Hessian of the Lagrangian (n, n)."""
        return np.asarray(self._second(x, sigma, multiplier))


class SymbolicPoint:
    """Dense derivatives of a `SymbolicNlp`."""

    def __init__(self, problem: SymbolicNlp, x: Array) -> None:
        self._problem, self._x = problem, np.array(x)
        f, g, gradient, jacobian = problem._first(x)
        self.objective, self.g = float(f), np.asarray(g).ravel()
        self.gradient, self._jacobian = np.asarray(gradient).ravel(), np.asarray(jacobian)
        self.equality = self._jacobian[problem.g_lower == problem.g_upper]

    def times(self, step: Array) -> Array:
        """Jacobian times a step."""
        return np.asarray(self._jacobian @ step)

    def transposed(self, multiplier: Array) -> Array:
        """Transposed Jacobian times multipliers."""
        return np.asarray(self._jacobian.T @ multiplier)

    def jacobian(self) -> Array:
        """Dense Jacobian."""
        return self._jacobian

    def condensed(self, sigma: float, multiplier: Array, weight: Array) -> Array:
        """Hessian of the Lagrangian and weighted squares of the constraints."""
        hessian = self._problem.hessian(self._x, sigma, multiplier)
        return np.asarray(hessian + (self._jacobian.T * weight) @ self._jacobian)


def free(n: int) -> tuple[list[float], list[float]]:
    return [-INF] * n, [INF] * n


def above(n: int, low: float = 0.0) -> tuple[list[float], list[float]]:
    return [low] * n, [INF] * n


def zero(n: int) -> tuple[list[float], list[float]]:
    return [0.0] * n, [0.0] * n


def hs113(x: list) -> list:
    return [
        105 - 4 * x[0] - 5 * x[1] + 3 * x[6] - 9 * x[7],
        -10 * x[0] + 8 * x[1] + 17 * x[6] - 2 * x[7],
        8 * x[0] - 2 * x[1] - 5 * x[8] + 2 * x[9] + 12,
        -3 * (x[0] - 2) ** 2 - 4 * (x[1] - 3) ** 2 - 2 * x[2] ** 2 + 7 * x[3] + 120,
        -5 * x[0] ** 2 - 8 * x[1] - (x[2] - 6) ** 2 + 2 * x[3] + 40,
        -0.5 * (x[0] - 8) ** 2 - 2 * (x[1] - 4) ** 2 - 3 * x[4] ** 2 + x[5] + 30,
        -(x[0] ** 2) - 2 * (x[1] - 2) ** 2 + 2 * x[0] * x[1] - 14 * x[4] + 6 * x[5],
        3 * x[0] - 6 * x[1] - 12 * (x[8] - 8) ** 2 + 7 * x[9],
    ]


PROBLEMS: dict[str, tuple[Callable, Callable, tuple, tuple, list[float], float]] = {
    'HS6': (
        lambda x: (1 - x[0]) ** 2,
        lambda x: [10 * (x[1] - x[0] ** 2)],
        free(2), zero(1), [-1.2, 1.0], 0.0,
    ),
    'HS12': (
        lambda x: 0.5 * x[0] ** 2 + x[1] ** 2 - x[0] * x[1] - 7 * x[0] - 7 * x[1],
        lambda x: [25 - 4 * x[0] ** 2 - x[1] ** 2],
        free(2), above(1), [0.0, 0.0], -30.0,
    ),
    'HS24': (
        lambda x: ((x[0] - 3) ** 2 - 9) * x[1] ** 3 / (27 * np.sqrt(3)),
        lambda x: [
            x[0] / np.sqrt(3) - x[1], x[0] + np.sqrt(3) * x[1], 6 - x[0] - np.sqrt(3) * x[1],
        ],
        above(2), above(3), [1.0, 0.5], -1.0,
    ),
    'HS35': (
        lambda x: 9 - 8 * x[0] - 6 * x[1] - 4 * x[2] + 2 * x[0] ** 2 + 2 * x[1] ** 2 + x[2] ** 2
        + 2 * x[0] * x[1] + 2 * x[0] * x[2],
        lambda x: [3 - x[0] - x[1] - 2 * x[2]],
        above(3), above(1), [0.5, 0.5, 0.5], 1.0 / 9.0,
    ),
    'HS39': (
        lambda x: -x[0],
        lambda x: [x[1] - x[0] ** 3 - x[2] ** 2, x[0] ** 2 - x[1] - x[3] ** 2],
        free(4), zero(2), [2.0, 2.0, 2.0, 2.0], -1.0,
    ),
    'HS40': (
        lambda x: -x[0] * x[1] * x[2] * x[3],
        lambda x: [x[0] ** 3 + x[1] ** 2 - 1, x[0] ** 2 * x[3] - x[2], x[3] ** 2 - x[1]],
        free(4), zero(3), [0.8, 0.8, 0.8, 0.8], -0.25,
    ),
    'HS43': (
        lambda x: x[0] ** 2 + x[1] ** 2 + 2 * x[2] ** 2 + x[3] ** 2 - 5 * x[0] - 5 * x[1]
        - 21 * x[2] + 7 * x[3],
        lambda x: [
            8 - sum(v**2 for v in x) - x[0] + x[1] - x[2] + x[3],
            10 - x[0] ** 2 - 2 * x[1] ** 2 - x[2] ** 2 - 2 * x[3] ** 2 + x[0] + x[3],
            5 - 2 * x[0] ** 2 - x[1] ** 2 - x[2] ** 2 - 2 * x[0] + x[1] + x[3],
        ],
        free(4), above(3), [0.0] * 4, -44.0,
    ),
    'HS65': (
        lambda x: (x[0] - x[1]) ** 2 + (x[0] + x[1] - 10) ** 2 / 9 + (x[2] - 5) ** 2,
        lambda x: [48 - x[0] ** 2 - x[1] ** 2 - x[2] ** 2],
        ([-4.5, -4.5, -5.0], [4.5, 4.5, 5.0]), above(1), [-5.0, 5.0, 0.0], 0.9535288567,
    ),
    'HS71': (
        lambda x: x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2],
        lambda x: [x[0] * x[1] * x[2] * x[3], sum(v**2 for v in x)],
        ([1.0] * 4, [5.0] * 4), ([25.0, 40.0], [INF, 40.0]), [1.0, 5.0, 5.0, 1.0], 17.0140173,
    ),
    'HS76': (
        lambda x: x[0] ** 2 + 0.5 * x[1] ** 2 + x[2] ** 2 + 0.5 * x[3] ** 2 - x[0] * x[2]
        + x[2] * x[3] - x[0] - 3 * x[1] + x[2] - x[3],
        lambda x: [
            x[0] + 2 * x[1] + x[2] + x[3], 3 * x[0] + x[1] + 2 * x[2] - x[3], x[1] + 4 * x[2],
        ],
        above(4), ([-INF, -INF, 1.5], [5.0, 4.0, INF]), [0.5] * 4, -4.681818181,
    ),
    'HS100': (
        lambda x: (x[0] - 10) ** 2 + 5 * (x[1] - 12) ** 2 + x[2] ** 4 + 3 * (x[3] - 11) ** 2
        + 10 * x[4] ** 6 + 7 * x[5] ** 2 + x[6] ** 4 - 4 * x[5] * x[6] - 10 * x[5] - 8 * x[6],
        lambda x: [
            127 - 2 * x[0] ** 2 - 3 * x[1] ** 4 - x[2] - 4 * x[3] ** 2 - 5 * x[4],
            282 - 7 * x[0] - 3 * x[1] - 10 * x[2] ** 2 - x[3] + x[4],
            196 - 23 * x[0] - x[1] ** 2 - 6 * x[5] ** 2 + 8 * x[6],
            -4 * x[0] ** 2 - x[1] ** 2 + 3 * x[0] * x[1] - 2 * x[2] ** 2 - 5 * x[5] + 11 * x[6],
        ],
        free(7), above(4), [1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0], 680.6300573,
    ),
    'HS113': (
        lambda x: x[0] ** 2 + x[1] ** 2 + x[0] * x[1] - 14 * x[0] - 16 * x[1] + (x[2] - 10) ** 2
        + 4 * (x[3] - 5) ** 2 + (x[4] - 3) ** 2 + 2 * (x[5] - 1) ** 2 + 5 * x[6] ** 2
        + 7 * (x[7] - 11) ** 2 + 2 * (x[8] - 10) ** 2 + (x[9] - 7) ** 2 + 45,
        hs113, free(10), above(8), [2.0, 3.0, 5.0, 5.0, 1.0, 2.0, 7.0, 3.0, 6.0, 10.0],
        24.3062091,
    ),
}  # fmt: skip
"""Objective, rows, bounds, row bounds, start and minimum as published."""


def published(name: str) -> tuple[SymbolicNlp, np.ndarray, float]:
    f, g, bounds, rows, start, optimum = PROBLEMS[name]
    return SymbolicNlp(f, g, bounds, rows), np.array(start), optimum


@pytest.mark.parametrize('name', PROBLEMS)
def test_ipopt_finds_the_same_minimum(name: str) -> None:
    problem, x0, optimum = published(name)
    solution = IpoptSolver(problem, x0).solve(problem, x0)
    assert solution.status is Status.OPTIMAL
    assert solution.objective == pytest.approx(optimum, rel=2e-7, abs=2e-7)
    assert solution.primal < 1e-6
    assert solution.dual < 1e-5
    assert solution.complementarity < 1e-6


@pytest.mark.parametrize('name', PROBLEMS)
def test_published_minimum(name: str) -> None:
    problem, x0, optimum = published(name)
    solution = solve(problem, x0)
    assert solution.status is Status.OPTIMAL
    assert solution.objective == pytest.approx(optimum, rel=2e-7, abs=2e-7)
    assert solution.primal < 1e-6
    assert solution.dual < 1e-5
    assert solution.complementarity < 1e-6
    assert solution.iterations < 60
    point = problem.linearise(solution.x)
    stationarity = point.gradient + point.jacobian().T @ solution.lam_g + solution.lam_x
    np.testing.assert_allclose(stationarity, 0.0, atol=1e-5)


def rosenbrock(x: list) -> ca.SX:
    return 100 * (x[1] - x[0] ** 2) ** 2 + (1 - x[0]) ** 2


def test_rosenbrock_inside_a_disc() -> None:
    """The unconstrained minimum (1, 1) is outside x^2 + y^2 <= 1."""
    problem = SymbolicNlp(rosenbrock, lambda x: [x[0] ** 2 + x[1] ** 2], free(2), ([-INF], [1.0]))
    solution = solve(problem, np.array([-1.2, 1.0]))
    assert solution.ok
    grid = np.linspace(0.0, 0.5 * np.pi, 200001)
    on_circle = rosenbrock([np.cos(grid), np.sin(grid)]).min()
    assert solution.objective == pytest.approx(on_circle, abs=1e-7)
    assert solution.lam_g[0] > 0.0


def test_fixed_variable_is_kept_and_has_its_sensitivity() -> None:
    problem = SymbolicNlp(
        rosenbrock, lambda x: [x[0] + x[1]], ([0.5, -INF], [0.5, INF]), ([-INF], [10.0])
    )
    solution = solve(problem, np.array([3.0, 3.0]))
    assert solution.ok
    np.testing.assert_allclose(solution.x, [0.5, 0.25], atol=1e-6)
    assert solution.lam_x[0] == pytest.approx(1.0, abs=1e-4)


def test_dependent_equality_rows_are_solved() -> None:
    problem = SymbolicNlp(
        lambda x: x[0] ** 2 + x[1] ** 2,
        lambda x: [x[0] + x[1] - 1, 2 * x[0] + 2 * x[1] - 2],
        free(2), zero(2),
    )  # fmt: skip
    solution = solve(problem, np.array([3.0, -1.0]))
    assert solution.ok
    np.testing.assert_allclose(solution.x, 0.5, atol=1e-6)


@pytest.mark.parametrize(
    ('rows', 'bounds', 'worst', 'violation'),
    [
        (lambda x: [x[0] ** 2 + x[1] ** 2, x[0]], ([-INF, 3.0], [1.0, INF]), {0, 1}, 1e-1),
        (lambda x: [x[0] ** 2 + x[1] ** 2 + 1], ([0.0], [0.0]), {0}, 0.99),
        (
            lambda x: [x[0] + x[1], x[0] - x[1], x[0]],
            ([2.0, 2.0, -INF], [INF, INF, 1.0]),
            {0, 1, 2},
            0.1,
        ),
    ],
    ids=['disc and half-plane', 'empty circle', 'three half-planes'],
)
def test_infeasible_problem_is_detected_and_named(rows, bounds, worst, violation) -> None:
    problem = SymbolicNlp(lambda x: x[0] + x[1] ** 2, rows, free(2), bounds)
    solution = solve(problem, np.array([0.3, 0.2]))
    assert solution.status is Status.INFEASIBLE
    assert solution.iterations < 100
    assert solution.violated[0][1] > violation
    assert {name for name, _ in solution.violated} <= {f'constraint {i}' for i in worst}


def test_functions_not_defined_on_the_way_are_avoided() -> None:
    problem = SymbolicNlp(
        lambda x: -ca.log(x[0]) + 10 * x[0], lambda x: [ca.sqrt(x[0])], free(1), ([0.1], [INF])
    )
    solution = solve(problem, np.array([5.0]))
    assert solution.ok
    assert solution.x[0] == pytest.approx(0.1, abs=1e-7)
    assert solve(problem, np.array([-1.0])).status is Status.NOT_FINITE


def test_iteration_limit_is_kept() -> None:
    problem, x0, _ = published('HS113')
    solution = solve(problem, x0, InteriorPointOptions(max_iterations=3))
    assert solution.status is Status.ITERATION_LIMIT
    assert solution.iterations == 3
    assert not solution.ok


@pytest.mark.parametrize('name', ['HS71', 'HS100', 'HS113', 'HS65'])
def test_warm_start_needs_fewer_iterations(name: str) -> None:
    problem, x0, _ = published(name)
    cold = solve(problem, x0)
    again = solve(problem, cold.x, warm=cold)
    assert again.ok
    assert again.objective == pytest.approx(cold.objective, rel=1e-7)
    assert again.iterations < 0.75 * cold.iterations


def test_same_start_gives_the_same_numbers() -> None:
    problem, x0, _ = published('HS100')
    one, two = solve(problem, x0), solve(problem, x0)
    np.testing.assert_array_equal(one.x, two.x)
    assert one.iterations == two.iterations
