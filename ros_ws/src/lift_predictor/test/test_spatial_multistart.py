# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which runs are made, and which is kept, with a made-up solver."""

from __future__ import annotations

import time

import numpy as np
import pytest

from lift_predictor.core.exceptions import CancelledError
from lift_predictor.core.models.spatial.grid import SpatialGrid
from lift_predictor.core.models.spatial.lift_model import SpatialModel
from lift_predictor.core.models.spatial.parameters import N_SPLINED
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.problem.run import SolverRun, Start
from lift_predictor.core.problem.task_solver import TaskSolver
from lift_predictor.core.solvers.solution import Solution, Status

GRID = SpatialGrid(10, 25, 'acceleration')
SHAPE = (GRID.spline.n_free, N_SPLINED)


class MadeUp:
    """Objectives by turns; where a run began is kept. Infinite: no solution."""

    def __init__(self, *objectives: float, seconds: float = 0.0) -> None:
        self.objectives, self.begun, self.seconds = objectives, [], seconds

    def __call__(self, task: SpatialTask, start: Start, deadline: float) -> SolverRun:
        objective = self.objectives[len(self.begun)]
        self.begun.append(start)
        time.sleep(self.seconds)
        status = Status.OPTIMAL if np.isfinite(objective) else Status.STUCK
        none, primal = np.zeros(0), 0.0 if np.isfinite(objective) else 0.5
        solution = Solution(status, none, objective, none, none, 1, primal, 0.0, 0.0, (), 0.0)
        return SolverRun(start.name, solution, start.control, start.box_mass, 1.3, '')


@pytest.fixture
def runs_from(placed, monkeypatch: pytest.MonkeyPatch):
    """Return a function that makes the runs of a made-up solver."""
    solver = TaskSolver(SpatialModel(PredictorOptions(dimension='3d')))

    def runs(run: MadeUp, begun: list[Start], *rest, **named) -> tuple[SolverRun, ...]:
        monkeypatch.setattr(solver, 'run', run)
        return solver.runs(placed(solver.model.grid, 7.0), begun, *rest, **named)

    return runs


def starts(count: int) -> list[Start]:
    return [Start(f's{i}', np.full(SHAPE, float(i)), 7.0, 1.3) for i in range(count)]


def test_best_comes_first_and_failures_last(runs_from) -> None:
    run = MadeUp(2.0, float('inf'), 1.0)
    assert [one.start for one in runs_from(run, starts(3))] == ['s2', 's0', 's1']


def test_hops_begin_at_the_best_so_far(runs_from) -> None:
    run = MadeUp(2.0, 1.0, 3.0, 0.5, 0.7)
    runs = runs_from(run, starts(2), basin_hops=3)
    assert [one.start for one in runs] == ['basin hop 2', 'basin hop 3', 's1', 's0', 'basin hop 1']
    shifts = [
        run.begun[k].control - run.begun[origin].control for k, origin in ((2, 1), (3, 1), (4, 3))
    ]
    for shift in shifts:
        assert 0.1 < shift.std() < 0.6
    # The whole motion of a coordinate, or each control value.
    assert np.ptp(shifts[0], axis=0).max() < 1e-12
    assert np.ptp(shifts[1], axis=0).min() > 1e-3
    assert np.ptp(shifts[2], axis=0).max() < 1e-12
    again = MadeUp(2.0, 1.0, 3.0, 0.5, 0.7)
    runs_from(again, starts(2), basin_hops=3)
    for one, other in zip(run.begun, again.begun, strict=True):
        np.testing.assert_array_equal(one.control, other.control)


def test_no_hops_without_a_solution(runs_from) -> None:
    run = MadeUp(float('inf'), float('inf'))
    assert len(runs_from(run, starts(2), basin_hops=3)) == 2


def test_no_start_begins_after_the_deadline(runs_from) -> None:
    assert len(runs_from(MadeUp(1.0, 2.0), starts(2), time.perf_counter() - 1.0)) == 1


def test_no_hop_begins_after_half_of_the_time(runs_from) -> None:
    """The rest is for margins."""
    run = MadeUp(1.0, 2.0, 3.0, seconds=0.3)
    assert len(runs_from(run, starts(2), time.perf_counter() + 1.0, basin_hops=1)) == 2


def test_progress_is_called_and_may_end_the_work(runs_from) -> None:
    called = []

    def listen(*facts: float) -> None:
        called.append(facts)
        if len(called) == 3:
            raise CancelledError('enough')

    run = MadeUp(float('inf'), 2.0, 1.0, 0.5)
    with pytest.raises(CancelledError):
        runs_from(run, starts(2), progress=listen, basin_hops=2)
    assert called[1:] == [(2, 4, 2.0), (3, 4, 1.0)]
    assert np.isnan(called[0][2])
