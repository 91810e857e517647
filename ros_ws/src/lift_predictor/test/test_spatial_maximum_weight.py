# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The heaviest box in space, on a coarse grid."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lift_predictor.core.models.spatial.postures import PostureFinder
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.maximum_weight import (
    LARGEST_WEIGHT,
    MaximumWeight,
    Weighting,
    maximum_weight,
    open_mass,
)
from lift_predictor.core.problem.run import Start
from lift_predictor.core.problem.task import WEIGHT_OFFSET
from lift_predictor.core.problem.task_solver import TaskSolver


@pytest.fixture(scope='module')
def spatial() -> TaskSolver[SpatialTask]:
    options = PredictorOptions(n_control=6, n_nodes=21, basin_hops=0, refinements=5)
    return LiftPredictor(options).spatial


@pytest.fixture(scope='module')
def task(placed, spatial: TaskSolver[SpatialTask]) -> SpatialTask:
    return open_mass(placed(spatial.model.grid, 7.0))


@pytest.fixture(scope='module')
def starts(spatial: TaskSolver[SpatialTask], task: SpatialTask) -> tuple[Start, ...]:
    return PostureFinder(spatial.model.library).starts(task, spatial.model.grid, guesses=1)[:1]


@pytest.fixture(scope='module')
def heaviest(spatial: TaskSolver[SpatialTask], task: SpatialTask, starts) -> MaximumWeight:
    return maximum_weight(spatial, task, starts, Weighting(0.0, 1.0))


@pytest.fixture(scope='module')
def weighted(spatial: TaskSolver[SpatialTask], task: SpatialTask, starts) -> MaximumWeight:
    return maximum_weight(spatial, task, starts)


def test_open_mass_leaves_the_rest_as_it_is(placed, spatial: TaskSolver[SpatialTask]) -> None:
    given = placed(spatial.model.grid, 7.0)
    opened = open_mass(given)
    low, high = opened.bounds.box_mass
    assert low == 0.0
    assert high * given.parameters.gravity == pytest.approx(LARGEST_WEIGHT)
    assert opened.bounds.hand is given.bounds.hand
    assert opened.parameters is given.parameters


def test_nothing_heavier_can_be_lifted_from_there(
    spatial: TaskSolver[SpatialTask], task: SpatialTask, heaviest: MaximumWeight
) -> None:
    assert heaviest.prediction.report.ok, heaviest.prediction.report.message
    assert heaviest.weight == pytest.approx(heaviest.mass * task.parameters.gravity)
    assert 100.0 < heaviest.weight < LARGEST_WEIGHT
    # The margins for the time between the nodes cost up to a few percent of the mass.
    best = max(run.box_mass for run in heaviest.prediction.runs if run.converged)
    start = heaviest.prediction.runs[0].as_start()
    for factor, possible in ((0.99, True), (1.05, False)):
        mass = np.full(2, (heaviest.mass if possible else best) * factor)
        given = replace(task, bounds=replace(task.bounds, box_mass=mass))
        assert spatial.run(given, replace(start, box_mass=float(mass[0]))).converged is possible


def test_effort_is_traded_for_weight(heaviest: MaximumWeight, weighted: MaximumWeight) -> None:
    assert weighted.prediction.report.ok, weighted.prediction.report.message
    assert weighted.weighting == Weighting()
    assert weighted.weight <= heaviest.weight * 1.001
    assert weighted.effort < heaviest.effort


def test_criteria_are_normalised_by_the_heaviest_lift(
    spatial: TaskSolver[SpatialTask],
    task: SpatialTask,
    heaviest: MaximumWeight,
    weighted: MaximumWeight,
) -> None:
    scale = weighted.normalisation
    assert scale is not None
    assert scale == heaviest.normalisation
    assert scale.effort == heaviest.effort
    assert scale.log_weight == pytest.approx(np.log(heaviest.weight + WEIGHT_OFFSET))
    share = Weighting()
    effort = spatial.model.effort(task, weighted.prediction.runs[0])
    assert effort == weighted.effort
    criterion = share.effort * effort / scale.effort - share.box * (
        np.log(weighted.weight + WEIGHT_OFFSET) / scale.log_weight
    )
    # The optimiser integrates by Simpson's rule over its nodes.
    assert weighted.prediction.report.objective == pytest.approx(criterion, rel=1e-2)


def test_without_a_lift_there_are_no_numbers(
    spatial: TaskSolver[SpatialTask], task: SpatialTask, starts
) -> None:
    hand = task.bounds.hand.copy()
    hand[1, [0, 3]] += 2.0
    far = replace(task, bounds=replace(task.bounds, hand=hand))
    result = maximum_weight(spatial, far, starts)
    assert not result.prediction.report.ok
    assert result.normalisation is None
    assert np.isnan([result.mass, result.weight, result.effort]).all()
