# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which runs are made, and which is kept, with a made-up solver."""

from __future__ import annotations

import time

import numpy as np
import pytest

from lift_predictor.core.exceptions import CancelledError
from lift_predictor.core.solvers.solution import Solution, Status
from lift_predictor.core.spatial.grid import SpatialGrid
from lift_predictor.core.spatial.multistart import runs_from
from lift_predictor.core.spatial.parameters import N_SPLINED
from lift_predictor.core.spatial.prediction import SpatialOptimum
from lift_predictor.core.spatial.starts import SpatialStart

GRID = SpatialGrid(7, 25)
SHAPE = (GRID.spline.n_free, N_SPLINED)
LATER = (float('inf'), float('inf'))


class MadeUp:
    """Objectives by turns; where a run began is kept. Infinite: no solution."""

    def __init__(self, *objectives: float) -> None:
        self.objectives, self.begun = objectives, []

    def __call__(self, start: SpatialStart) -> SpatialOptimum:
        objective = self.objectives[len(self.begun)]
        self.begun.append(start)
        status = Status.OPTIMAL if np.isfinite(objective) else Status.STUCK
        x, none = start.variables(), np.zeros(0)
        return SpatialOptimum(
            start.name, Solution(status, x, objective, none, none, 1, 0.5, 0.0, 0.0, (), 0.0)
        )


def starts(count: int) -> list[SpatialStart]:
    return [SpatialStart(f's{i}', np.full(SHAPE, float(i)), 7.0, 1.3) for i in range(count)]


def test_best_comes_first_and_failures_last() -> None:
    run = MadeUp(2.0, float('inf'), 1.0)
    assert [one.start for one in runs_from(run, starts(3), 0, GRID, LATER)] == ['s2', 's0', 's1']


def test_hops_begin_at_the_best_so_far() -> None:
    run = MadeUp(2.0, 1.0, 3.0, 0.5, 0.7)
    runs = runs_from(run, starts(2), 3, GRID, LATER)
    assert [one.start for one in runs] == ['hop 2', 'hop 3', 's1', 's0', 'hop 1']
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
    runs_from(again, starts(2), 3, GRID, LATER)
    for one, other in zip(run.begun, again.begun, strict=True):
        np.testing.assert_array_equal(one.control, other.control)


def test_no_hops_without_a_solution() -> None:
    run = MadeUp(float('inf'), float('inf'))
    assert len(runs_from(run, starts(2), 3, GRID, LATER)) == 2


@pytest.mark.parametrize(('seconds', 'count'), [((-1.0, -2.0), 1), ((60.0, -1.0), 2)])
def test_time_limits(seconds: tuple[float, float], count: int) -> None:
    now = time.perf_counter()
    run = MadeUp(1.0, 2.0, 3.0)
    assert len(runs_from(run, starts(2), 1, GRID, (now + seconds[0], now + seconds[1]))) == count


def test_progress_is_told_and_may_end_the_work() -> None:
    told = []

    def listen(*facts: float) -> None:
        told.append(facts)
        if len(told) == 3:
            raise CancelledError('enough')

    run = MadeUp(float('inf'), 2.0, 1.0, 0.5)
    with pytest.raises(CancelledError):
        runs_from(run, starts(2), 2, GRID, LATER, listen)
    assert told[1:] == [(2, 4, 2.0), (3, 4, 1.0)]
    assert np.isnan(told[0][2])
