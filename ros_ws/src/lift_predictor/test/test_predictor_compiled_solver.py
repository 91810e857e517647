# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The compiled interior-point method against its reference in Python, and on hard cases."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from human_model.task import Box
from lift_predictor.core.models.sagittal.assembly import (
    sagittal_assembler,
    sagittal_library,
    sagittal_nlp,
)
from lift_predictor.core.models.sagittal.grid import SagittalGrid
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.sagittal.starts import make_starts
from lift_predictor.core.models.sagittal.task import build_task
from lift_predictor.core.solvers import cache, interior_point
from lift_predictor.core.solvers.layout import Channel, Group
from lift_predictor.core.solvers.library import load_library
from lift_predictor.core.solvers.node_function import NodeFunction
from lift_predictor.core.solvers.solution import InteriorPointOptions, Status
from lift_predictor.core.solvers.solve import solve
from lift_predictor.core.solvers.spline_nlp import SplineNlp, make_assembler

BOX_SIZE = (0.238, 0.305, 0.127)

pytestmark = pytest.mark.skipif(
    cache.find_compiler() is None, reason='no C compiler on this machine'
)
GRID = SagittalGrid(10, 25, 'acceleration')


@pytest.fixture(scope='module')
def lift(make_lift, person: Person) -> Callable[[float], tuple[SplineNlp, list[np.ndarray]]]:
    assembler = sagittal_assembler(sagittal_library(), GRID)

    def make(mass: float) -> tuple[SplineNlp, list[np.ndarray]]:
        task = build_task(person, make_lift(mass), Box(mass, BOX_SIZE))
        programme = sagittal_nlp(assembler, GRID, task.parameters.pack(), task.bounds)
        starts = [
            np.append(start.control.ravel(), mass) for start in make_starts(task, GRID.spline)
        ]
        return programme, starts

    return make


@pytest.mark.parametrize('mass', [0.0, 7.0, 12.0])
def test_same_steps_as_the_reference(lift, mass: float) -> None:
    programme, starts = lift(mass)
    for x0 in starts:
        fast, slow = solve(programme, x0), interior_point.solve(programme, x0)
        assert fast.status is slow.status is Status.OPTIMAL
        assert fast.iterations == slow.iterations
        assert fast.objective == pytest.approx(slow.objective, rel=1e-9)
        np.testing.assert_allclose(fast.x, slow.x, atol=1e-6)
        np.testing.assert_allclose(fast.lam_g, slow.lam_g, atol=1e-5)
        np.testing.assert_allclose(fast.lam_x, slow.lam_x, atol=1e-5)
        assert max(fast.primal, fast.dual, fast.complementarity) < 1e-6
        point = programme.linearise(fast.x)
        gradient = point.gradient + point.transposed(fast.lam_g) + fast.lam_x
        np.testing.assert_allclose(gradient, 0.0, atol=1e-6)


def test_same_numbers_each_time_whatever_was_solved_before(lift) -> None:
    programme, starts = lift(7.0)
    first = solve(programme, starts[0])
    heavy, heavy_starts = lift(12.0)
    solve(heavy, heavy_starts[0])
    again = solve(programme, starts[0])
    np.testing.assert_array_equal(first.x, again.x)
    assert first.iterations == again.iterations


def test_too_heavy_is_infeasible_and_named(lift) -> None:
    programme, starts = lift(30.0)
    for x0 in starts:
        solution = solve(programme, x0)
        assert solution.status is Status.INFEASIBLE
        assert 'joint torque limit' in solution.violated[0][0]
        reference = interior_point.solve(programme, x0)
        assert reference.status is Status.INFEASIBLE
        assert reference.violated[0][0] == solution.violated[0][0]


def test_warm_start_after_a_small_change(lift) -> None:
    programme, starts = lift(7.0)
    cold = solve(programme, starts[0])
    changed, _ = lift(7.0)
    changed.lower[-1] = changed.upper[-1] = 7.05
    fresh = solve(changed, starts[0])
    warm = solve(changed, cold.x, warm=cold)
    assert warm.ok
    assert warm.objective == pytest.approx(fresh.objective, rel=1e-7)
    assert warm.iterations <= 0.5 * fresh.iterations


def test_limits_are_kept(lift) -> None:
    programme, starts = lift(7.0)
    short = solve(programme, starts[0], InteriorPointOptions(max_iterations=4))
    assert (short.status, short.iterations) == (Status.ITERATION_LIMIT, 4)
    assert solve(programme, starts[0], InteriorPointOptions(time_limit=0.0)).status is (
        Status.TIME_LIMIT
    )


def hock_schittkowski() -> list[NodeFunction]:
    z, none, p = ca.SX.sym('z', 4), ca.SX(0, 1), ca.SX.sym('p', 1)
    rows = ca.vertcat(z[0] * z[1] * z[2] * z[3], ca.sumsqr(z))
    hs71 = NodeFunction('hs71', z, none, p, rows, z[0] * z[3] * (z[0] + z[1] + z[2]) + z[2])
    circle = NodeFunction('circle', z[:2], none, p, ca.sumsqr(z[:2]) + p[0], z[0])
    double = NodeFunction(
        'double', z[:2], none, p, ca.vertcat(z[0] + z[1], 2 * (z[0] + z[1])), ca.sumsqr(z[:2])
    )
    return [hs71, circle, double]


def small(function: str, n: int, rows, variables, p: float = 0.0) -> SplineNlp:
    library = load_library('hock_schittkowski', [Path(__file__)], hock_schittkowski)
    channel = Channel(0, n, np.ones((1, 1, 1)))
    group = Group(function, (channel,), (), len(rows[0]), np.ones(1))
    assembler = make_assembler(library, [group], n)
    bounds = [(np.array(low), np.array(high)) for low, high in (variables, rows)]
    return SplineNlp(assembler, np.array([p]), *bounds, lambda i: f'row {i}', str)


def free(n: int) -> tuple[list[float], list[float]]:
    return [-np.inf] * n, [np.inf] * n


def test_published_minimum_and_degenerate_rows(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv('LIFT_CACHE', str(tmp_path))
    hs71 = small('hs71', 4, ([25.0, 40.0], [np.inf, 40.0]), ([1.0] * 4, [5.0] * 4))
    x0 = np.array([1.0, 5.0, 5.0, 1.0])
    solution = solve(hs71, x0)
    assert solution.ok
    assert solution.objective == pytest.approx(17.0140173, rel=1e-8)
    assert solution.iterations == interior_point.solve(hs71, x0).iterations
    double = solve(small('double', 2, ([1.0, 2.0], [1.0, 2.0]), free(2)), np.array([3.0, -1.0]))
    assert double.ok
    np.testing.assert_allclose(double.x, 0.5, atol=1e-6)
    empty = solve(small('circle', 2, ([0.0], [0.0]), free(2), 1.0), np.array([0.3, 0.2]))
    assert empty.status is Status.INFEASIBLE
    assert empty.violated == (('row 0', pytest.approx(1.0, abs=1e-3)),)
    wild = solve(small('circle', 2, ([0.0], [1.0]), free(2)), np.array([np.nan, 0.2]))
    assert wild.status is Status.NOT_FINITE
