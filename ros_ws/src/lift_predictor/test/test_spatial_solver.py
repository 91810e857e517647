# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The compiled interior-point method on lifts in space against its reference in Python."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lift_predictor.core.models.spatial.assembly import (
    spatial_assembler,
    spatial_library,
    spatial_nlp,
)
from lift_predictor.core.models.spatial.grid import SpatialGrid
from lift_predictor.core.models.spatial.lift_model import SOLVER_OPTIONS
from lift_predictor.core.models.spatial.postures import PostureFinder
from lift_predictor.core.solvers import cache, interior_point
from lift_predictor.core.solvers.solution import InteriorPointOptions, Status
from lift_predictor.core.solvers.solve import solve
from lift_predictor.core.solvers.spline_nlp import SplineNlp

pytestmark = pytest.mark.skipif(
    cache.find_compiler() is None, reason='no C compiler on this machine'
)
GRID = SpatialGrid(5, 9)
OPTIONS = SOLVER_OPTIONS


@pytest.fixture(scope='module')
def lift(placed) -> tuple[SplineNlp, np.ndarray]:
    task, library = placed(GRID, 7.0), spatial_library()
    start = PostureFinder(library).starts(task, GRID, guesses=1)[0]
    programme = spatial_nlp(
        spatial_assembler(library, GRID), GRID, task.parameters.pack(), task.bounds
    )
    return programme, np.append(start.control.ravel(), (start.box_mass, task.duration))


def test_same_iterates_as_the_reference(lift) -> None:
    programme, x0 = lift
    options = replace(OPTIONS, max_iterations=10)
    fast, slow = solve(programme, x0, options), interior_point.solve(programme, x0, options)
    assert fast.status is slow.status is Status.ITERATION_LIMIT
    assert fast.iterations == slow.iterations == 10
    assert fast.objective == pytest.approx(slow.objective, rel=1e-8)
    np.testing.assert_allclose(fast.x, slow.x, atol=1e-7)
    largest = np.abs(slow.lam_g).max()
    np.testing.assert_allclose(fast.lam_g, slow.lam_g, atol=1e-6 * max(largest, 1.0))


def test_same_optimum_as_the_reference_also_from_a_warm_start(lift) -> None:
    programme, x0 = lift
    fast, slow = solve(programme, x0, OPTIONS), interior_point.solve(programme, x0, OPTIONS)
    assert fast.status is slow.status is Status.OPTIMAL
    assert fast.objective == pytest.approx(slow.objective, rel=1e-7)
    for solution in (fast, slow):
        assert max(solution.primal, solution.dual, solution.complementarity) < 1e-6
        point = programme.linearise(solution.x)
        slope = point.gradient + point.transposed(solution.lam_g)
        np.testing.assert_allclose(slope + solution.lam_x, 0.0, atol=1e-6)
    again = solve(programme, fast.x, OPTIONS, fast)
    same = interior_point.solve(programme, fast.x, OPTIONS, fast)
    assert again.status is same.status is Status.OPTIMAL
    assert again.iterations < fast.iterations / 4
    assert again.objective == pytest.approx(fast.objective, rel=1e-7)
    assert same.objective == pytest.approx(fast.objective, rel=1e-7)


def test_small_warm_barrier_follows_a_changed_task_to_the_same_optimum(placed, lift) -> None:
    programme, x0 = lift
    heavier = placed(GRID, 7.05)
    other = spatial_nlp(programme.assembler, GRID, heavier.parameters.pack(), heavier.bounds)
    first = solve(programme, x0, OPTIONS)
    changed = np.clip(first.x, other.lower, other.upper)
    warm = solve(other, changed, OPTIONS, first)
    usual = InteriorPointOptions()
    careful = replace(
        OPTIONS, warm_barrier=usual.warm_barrier, warm_bound_push=usual.warm_bound_push
    )
    slower = solve(other, changed, careful, first)
    assert warm.ok
    assert slower.ok
    assert warm.objective == pytest.approx(slower.objective, rel=1e-6)
    assert warm.iterations < slower.iterations
