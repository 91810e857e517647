# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Work ends between two iterations when another thread wants it to, or at its deadline."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest

from human_model.task import Box
from lift_predictor.core.exceptions import CancelledError
from lift_predictor.core.models.sagittal.grid import SagittalGrid
from lift_predictor.core.models.sagittal.lift_model import COLD, SagittalModel
from lift_predictor.core.models.sagittal.starts import make_starts
from lift_predictor.core.models.sagittal.task import build_task
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.task_solver import TaskSolver
from lift_predictor.core.solvers import interior_point
from lift_predictor.core.solvers.solution import InteriorPointOptions, Status
from lift_predictor.core.solvers.solve import solve
from lift_predictor.core.solvers.stop import StopFlag

BOX_SIZE = (0.238, 0.305, 0.127)

PROMPT = 0.5
"""Time within which work ends on a machine that has much else to do [s]; alone it is 20 ms."""


@pytest.fixture(scope='module')
def task(person, make_lift):
    return build_task(person, make_lift(7.0), Box(7.0, BOX_SIZE))


def test_flag_tells_why_and_can_be_used_again() -> None:
    flag = StopFlag()
    flag.check()
    flag.set('no longer wanted')
    with pytest.raises(CancelledError, match='no longer wanted'):
        flag.check()
    flag.clear()
    flag.check()


@pytest.mark.parametrize('method', [solve, interior_point.solve])
def test_no_iteration_is_done_after_the_flag_was_set(task, method) -> None:
    model = SagittalModel()
    nlp = model.nlp(task)
    start = make_starts(task, model.grid.spline)[0]
    x0 = np.append(start.control, 7.0)
    flag = StopFlag()
    assert method(nlp, x0, InteriorPointOptions(stop=flag)).ok
    flag.set('enough')
    with pytest.raises(CancelledError, match='enough'):
        method(nlp, x0, InteriorPointOptions(stop=flag))


def test_flag_changes_no_number(task) -> None:
    model = SagittalModel()
    nlp = model.nlp(task)
    x0 = np.append(make_starts(task, model.grid.spline)[0].control, 7.0)
    bare, watched = (
        solve(nlp, x0, InteriorPointOptions(barrier=COLD.barrier, stop=stop))
        for stop in (None, StopFlag())
    )
    assert bare.iterations == watched.iterations
    np.testing.assert_array_equal(bare.x, watched.x)


def test_a_long_run_is_ended_between_its_iterations(task) -> None:
    stop = StopFlag()
    # So many nodes that one run takes a second.
    model = SagittalModel(PredictorOptions(time_limit=60.0), grid=SagittalGrid(7, 20001))
    start = make_starts(task, model.grid.spline)[0]
    asked: list[float] = []

    def ask() -> None:
        asked.append(time.perf_counter())
        stop.set('cancelled')

    timer = threading.Timer(0.1, ask)
    timer.start()
    with pytest.raises(CancelledError, match='cancelled'):
        TaskSolver(model, stop).run(task, start)
    assert time.perf_counter() - asked[0] < PROMPT
    timer.join()


def test_a_run_ends_at_the_deadline(task) -> None:
    model = SagittalModel()
    start = make_starts(task, model.grid.spline)[0]
    run = TaskSolver(model).run(task, start, deadline=time.perf_counter() - 1.0)
    assert run.status is Status.TIME_LIMIT
    assert run.solution.iterations == 0
    assert not run.converged


def test_a_plan_with_free_feet_ends_at_once(subject) -> None:
    predictor = LiftPredictor()
    task = PlanTask('shelf', 7.0, (0.238, 0.305, 0.127), (0.35, 0.0, 0.0635), (0.55, 0.0, 0.9635))
    asked: list[float] = []

    def ask() -> None:
        asked.append(time.perf_counter())
        predictor.stop.set('cancelled')

    timer = threading.Timer(0.2, ask)
    timer.start()
    with pytest.raises(CancelledError):
        LiftPlanner(predictor).plan(subject, task)
    assert time.perf_counter() - asked[0] < PROMPT
    timer.join()
    predictor.stop.clear()
    assert LiftPlanner(predictor).plan(subject, task).report.ok
