# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The sagittal optimiser: against IPOPT, from bad starts, and when it gives up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from human_model.task import Box
from lift_predictor.core.models.sagittal.grid import SagittalGrid
from lift_predictor.core.models.sagittal.lift_model import COLD, SagittalModel
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.sagittal.starts import make_starts
from lift_predictor.core.models.sagittal.task import SagittalTask, build_task
from lift_predictor.core.problem.run import Start
from lift_predictor.core.problem.task_solver import TaskSolver
from lift_predictor.core.solvers.solution import InteriorPointOptions, Status

BOX_SIZE = (0.238, 0.305, 0.127)

GRID = SagittalGrid(10, 25, 'acceleration')


@pytest.fixture(scope='module')
def solver() -> TaskSolver[SagittalTask]:
    return TaskSolver(SagittalModel())


@pytest.fixture(scope='module')
def task(make_lift, person: Person) -> Callable[[float], SagittalTask]:
    return lambda mass: build_task(person, make_lift(mass), Box(mass, BOX_SIZE))


@pytest.mark.parametrize('mass', [7.0, 12.0])
def test_same_minimum_and_binding_limits_as_ipopt(solver, task, mass) -> None:
    lift = task(mass)
    starts = make_starts(lift, GRID.spline)
    for start, other in zip(starts, solver.reference_runs(lift, starts), strict=True):
        own = solver.run(lift, start)
        assert own.converged and other.converged
        assert own.objective == pytest.approx(other.objective, rel=1e-6)
        np.testing.assert_allclose(own.control, other.control, atol=1e-3)
        strong = {name: size for name, size in other.active_constraints if size > 1e-3}
        found = dict(own.active_constraints)
        for name, size in strong.items():
            assert found[name] == pytest.approx(size, rel=0.05)


def test_near_start_that_fails_is_solved_with_a_large_barrier(
    monkeypatch: pytest.MonkeyPatch, solver, task
) -> None:
    lift = task(7.0)
    start = make_starts(lift, GRID.spline)[0]
    good = solver.run(lift, start)
    method = replace(solver.model.method, near=InteriorPointOptions(max_iterations=2))
    monkeypatch.setattr(solver.model, 'method', method)
    run = solver.run(lift, Start('near', start.control, near=True))
    assert run.converged
    assert run.objective == pytest.approx(good.objective, rel=1e-9)
    assert run.solution.iterations == good.solution.iterations + 2


def test_near_start_stays_at_its_minimum(solver, task) -> None:
    lift = task(12.0)
    first = solver.run(lift, make_starts(lift, GRID.spline)[1])
    again = solver.run(lift, first.as_start())
    assert again.converged
    assert again.objective == pytest.approx(first.objective, rel=1e-7)


def test_ipopt_is_tried_and_named_where_no_start_gives_an_answer(
    monkeypatch: pytest.MonkeyPatch, solver, task
) -> None:
    lift = task(7.0)
    method = replace(solver.model.method, cold=replace(COLD, max_iterations=2))
    monkeypatch.setattr(solver.model, 'method', method)
    starts = make_starts(lift, GRID.spline)[:2]
    runs = solver.runs(lift, starts)
    assert runs[0].converged
    assert runs[0].start.endswith(', IPOPT')
    assert [run.status for run in runs[2:]] == [Status.ITERATION_LIMIT] * 2


def test_infeasible_lift_is_not_given_to_ipopt(
    monkeypatch: pytest.MonkeyPatch, solver, task
) -> None:
    lift = task(30.0)
    starts = make_starts(lift, GRID.spline)
    runs = solver.runs(lift, starts)
    assert len(runs) == len(starts)
    assert {run.status for run in runs} == {Status.INFEASIBLE}
    assert 'joint torque limit' in runs[0].violated
