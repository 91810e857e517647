# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The interior-point method on problems of Hock and Schittkowski (1981) with known optima."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest

from lift_predictor.core.solvers.interior_point import solve
from lift_predictor.core.solvers.solution import InteriorPointOptions, Status
from lift_predictor.core.solvers.symbolic import SymbolicProgramme

INF = np.inf


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


def problem(name: str) -> tuple[SymbolicProgramme, np.ndarray, float]:
    f, g, bounds, rows, start, optimum = PROBLEMS[name]
    return SymbolicProgramme(f, g, bounds, rows), np.array(start), optimum


@pytest.mark.parametrize('name', PROBLEMS)
def test_published_minimum(name: str) -> None:
    programme, x0, optimum = problem(name)
    solution = solve(programme, x0)
    assert solution.status is Status.OPTIMAL
    assert solution.objective == pytest.approx(optimum, rel=2e-7, abs=2e-7)
    assert solution.primal < 1e-6
    assert solution.dual < 1e-5
    assert solution.complementarity < 1e-6
    assert solution.iterations < 60
    point = programme.linearise(solution.x)
    stationarity = (
        point.gradient + point.jacobian.T @ solution.row_multiplier + solution.bound_multiplier
    )
    np.testing.assert_allclose(stationarity, 0.0, atol=1e-5)


def rosenbrock(x: list) -> ca.SX:
    return 100 * (x[1] - x[0] ** 2) ** 2 + (1 - x[0]) ** 2


def test_rosenbrock_inside_a_disc() -> None:
    """The unconstrained minimum (1, 1) is outside x^2 + y^2 <= 1."""
    programme = SymbolicProgramme(
        rosenbrock, lambda x: [x[0] ** 2 + x[1] ** 2], free(2), ([-INF], [1.0])
    )
    solution = solve(programme, np.array([-1.2, 1.0]))
    assert solution.ok
    grid = np.linspace(0.0, 0.5 * np.pi, 200001)
    on_circle = rosenbrock([np.cos(grid), np.sin(grid)]).min()
    assert solution.objective == pytest.approx(on_circle, abs=1e-7)
    assert solution.row_multiplier[0] > 0.0


def test_fixed_variable_is_kept_and_has_its_sensitivity() -> None:
    programme = SymbolicProgramme(
        rosenbrock, lambda x: [x[0] + x[1]], ([0.5, -INF], [0.5, INF]), ([-INF], [10.0])
    )
    solution = solve(programme, np.array([3.0, 3.0]))
    assert solution.ok
    np.testing.assert_allclose(solution.x, [0.5, 0.25], atol=1e-6)
    assert solution.bound_multiplier[0] == pytest.approx(1.0, abs=1e-4)


def test_dependent_equality_rows_are_solved() -> None:
    programme = SymbolicProgramme(
        lambda x: x[0] ** 2 + x[1] ** 2,
        lambda x: [x[0] + x[1] - 1, 2 * x[0] + 2 * x[1] - 2],
        free(2), zero(2),
    )  # fmt: skip
    solution = solve(programme, np.array([3.0, -1.0]))
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
    programme = SymbolicProgramme(lambda x: x[0] + x[1] ** 2, rows, free(2), bounds)
    solution = solve(programme, np.array([0.3, 0.2]))
    assert solution.status is Status.INFEASIBLE
    assert solution.iterations < 100
    assert solution.violated[0][1] > violation
    assert {name for name, _ in solution.violated} <= {f'row {i}' for i in worst}


def test_functions_not_defined_on_the_way_are_avoided() -> None:
    programme = SymbolicProgramme(
        lambda x: -ca.log(x[0]) + 10 * x[0], lambda x: [ca.sqrt(x[0])], free(1), ([0.1], [INF])
    )
    solution = solve(programme, np.array([5.0]))
    assert solution.ok
    assert solution.x[0] == pytest.approx(0.1, abs=1e-7)
    assert solve(programme, np.array([-1.0])).status is Status.NOT_FINITE


def test_iteration_limit_is_kept() -> None:
    programme, x0, _ = problem('HS113')
    solution = solve(programme, x0, InteriorPointOptions(max_iterations=3))
    assert solution.status is Status.ITERATION_LIMIT
    assert solution.iterations == 3
    assert not solution.ok


@pytest.mark.parametrize('name', ['HS71', 'HS100', 'HS113', 'HS65'])
def test_warm_start_needs_fewer_iterations(name: str) -> None:
    programme, x0, _ = problem(name)
    cold = solve(programme, x0)
    again = solve(programme, cold.x, warm=cold)
    assert again.ok
    assert again.objective == pytest.approx(cold.objective, rel=1e-7)
    assert again.iterations < 0.75 * cold.iterations


def test_same_start_gives_the_same_numbers() -> None:
    programme, x0, _ = problem('HS100')
    one, two = solve(programme, x0), solve(programme, x0)
    np.testing.assert_array_equal(one.x, two.x)
    assert one.iterations == two.iterations
