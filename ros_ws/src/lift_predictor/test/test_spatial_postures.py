# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Postures at rest that hold the box, and the starts made of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.models.spatial.assembly import spatial_library
from lift_predictor.core.models.spatial.evaluation import evaluate
from lift_predictor.core.models.spatial.grid import LIMITED, SpatialGrid
from lift_predictor.core.models.spatial.parameters import N_SPLINED
from lift_predictor.core.models.spatial.postures import SAME, PostureFinder, guess
from lift_predictor.core.models.spatial.starts import Start
from lift_predictor.core.models.spatial.task import SpatialTask

GRID, MASS = SpatialGrid(7, 25), 7.0


@pytest.fixture(scope='module')
def task(placed) -> SpatialTask:
    return placed(GRID, MASS)


@pytest.fixture(scope='module')
def finder() -> PostureFinder:
    return PostureFinder(spatial_library())


@pytest.mark.parametrize('end', [0, 1])
def test_box_is_held_in_balance_within_all_limits_with_less_effort_than_beside(
    finder: PostureFinder, task: SpatialTask, end: int
) -> None:
    q = finder.posture(task, end, MASS)
    loads = evaluate(
        spatial_library(), q[None], 0.0 * q[None], 0.0 * q[None], MASS, task.parameters
    )
    np.testing.assert_allclose(loads.hand[0].ravel(), task.bounds.hand[end], atol=1e-6)
    assert np.all(loads.torque > loads.lower - 1e-3)
    assert np.all(loads.torque < loads.upper + 1e-3)
    assert 0.0 <= loads.fraction[0] <= 1.0
    weight = task.parameters.gravity * (task.parameters.body_mass + MASS)
    assert loads.ground_force[0, :, 2].sum() == pytest.approx(weight, rel=1e-9)
    low, high = task.person.limits(LIMITED)
    limited = q[N_SPLINED - len(LIMITED) :]
    assert np.all(limited > low - 1e-6)
    assert np.all(limited < high + 1e-6)
    (best, effort), *others = finder.postures(task, end, MASS, 3)
    assert effort == pytest.approx(loads.effort[0], rel=1e-4) or effort < loads.effort[0]
    # At a minimum of the effort no way along the constraints is downhill: moving the other found
    # postures' way only leads up, or out of the hands' places.
    for other, more in others:
        assert more >= effort
        assert np.abs(other - best).max() > SAME


def test_starts_rest_in_the_postures_and_differ(finder: PostureFinder, task: SpatialTask) -> None:
    starts = finder.starts(task, GRID)
    assert starts[0].name == 'between postures'
    assert starts[-1].name == 'through a middle'
    assert len({start.name for start in starts}) == len(starts)
    best = [finder.postures(task, end, MASS, 4)[0][0] for end in (0, 1)]
    np.testing.assert_allclose(ends(starts[0]), best, atol=1e-9)
    np.testing.assert_allclose(ends(starts[-1]), best, atol=1e-9)
    assert np.abs(starts[0].control - starts[-1].control).max() > 0.01
    for start in starts:
        assert start.box_mass == MASS
        assert start.duration == pytest.approx(1.3)


def ends(start: Start) -> np.ndarray:
    basis = GRID.spline.basis(np.array([0.0, 1.0]), 0)
    return np.asarray(basis @ start.control)


def test_same_starts_each_time(finder: PostureFinder, task: SpatialTask) -> None:
    first, again = (finder.starts(task, GRID, guesses=2) for _ in range(2))
    for one, other in zip(first, again, strict=True):
        np.testing.assert_array_equal(one.control, other.control)


def test_box_out_of_reach_is_named(finder: PostureFinder, task: SpatialTask) -> None:
    hand = task.bounds.hand.copy()
    hand[1, [0, 3]] += 2.0
    far = replace(task, bounds=replace(task.bounds, hand=hand))
    with pytest.raises(UnreachableError, match=r'2\.\d+.*at the end of the lift'):
        finder.starts(far, GRID)


def test_guesses_turn_and_crouch_with_the_box(task: SpatialTask) -> None:
    low, high = guess(task, 0), guess(task, 1)
    assert low.shape == high.shape == (N_SPLINED,)
    knee = [q[N_SPLINED - len(LIMITED)] for q in (low, high)]
    assert knee[0] > knee[1]
    # The end is at the left, the start in front.
    assert high[3] > low[3] == pytest.approx(0.0, abs=1e-12)
