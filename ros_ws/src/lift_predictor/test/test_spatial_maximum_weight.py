# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The heaviest box in space, on a coarse grid."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from human_model.subject import Subject
from lift_predictor.core.maximum_weight import LARGEST_WEIGHT, Weighting
from lift_predictor.core.spatial.grid import WEIGHT_OFFSET
from lift_predictor.core.spatial.maximum_weight import (
    SpatialMaximum,
    for_weight_alone,
    maximum_weight,
    open_mass,
    total_effort,
)
from lift_predictor.core.spatial.postures import PostureFinder
from lift_predictor.core.spatial.predictor import SpatialOptions, SpatialPredictor
from lift_predictor.core.spatial.refine import as_start
from lift_predictor.core.spatial.starts import SpatialStart
from lift_predictor.core.spatial.task import SpatialTask


@pytest.fixture(scope='module')
def spatial(subject: Subject) -> SpatialPredictor:
    predictor = SpatialPredictor(SpatialOptions(n_control=6, n_nodes=13, hops=0))
    predictor.configure(subject)
    return predictor


@pytest.fixture(scope='module')
def task(placed, spatial: SpatialPredictor) -> SpatialTask:
    return open_mass(placed(spatial.grid, 7.0))


@pytest.fixture(scope='module')
def starts(spatial: SpatialPredictor, task: SpatialTask) -> tuple[SpatialStart, ...]:
    return PostureFinder(spatial.library).starts(task, spatial.grid, guesses=1)[:1]


@pytest.fixture(scope='module')
def heaviest(spatial: SpatialPredictor, task: SpatialTask, starts) -> SpatialMaximum:
    return maximum_weight(spatial, task, starts, Weighting(0.0, 1.0))


@pytest.fixture(scope='module')
def weighted(spatial: SpatialPredictor, task: SpatialTask, starts) -> SpatialMaximum:
    return maximum_weight(spatial, task, starts)


def test_open_mass_leaves_the_rest_as_it_is(placed, spatial: SpatialPredictor) -> None:
    given = placed(spatial.grid, 7.0)
    opened = open_mass(given)
    low, high = opened.bounds.box_mass
    assert low == 0.0
    assert high * given.parameters.gravity == pytest.approx(LARGEST_WEIGHT)
    assert opened.bounds.hand is given.bounds.hand
    assert opened.parameters is given.parameters


def test_nothing_heavier_can_be_lifted_from_there(
    spatial: SpatialPredictor, task: SpatialTask, heaviest: SpatialMaximum
) -> None:
    assert heaviest.prediction.report.ok, heaviest.prediction.report.message
    assert heaviest.weight == pytest.approx(heaviest.mass * task.parameters.gravity)
    assert 100.0 < heaviest.weight < LARGEST_WEIGHT
    # The margins for the time between the nodes cost up to a few percent of the mass.
    best = max(float(run.solution.x[-2]) for run in heaviest.prediction.optima if run.converged)
    start = as_start(heaviest.prediction.optima[0], spatial.grid)
    for factor, possible in ((0.99, True), (1.05, False)):
        mass = np.full(2, (heaviest.mass if possible else best) * factor)
        given = replace(task, bounds=replace(task.bounds, box_mass=mass))
        assert spatial.run(given, replace(start, box_mass=float(mass[0]))).converged is possible


def test_effort_is_traded_for_weight(heaviest: SpatialMaximum, weighted: SpatialMaximum) -> None:
    assert weighted.prediction.report.ok, weighted.prediction.report.message
    assert weighted.weighting == Weighting()
    assert weighted.weight <= heaviest.weight * 1.001
    assert weighted.effort < heaviest.effort


def test_criteria_are_normalised_by_the_heaviest_lift(
    spatial: SpatialPredictor,
    task: SpatialTask,
    heaviest: SpatialMaximum,
    weighted: SpatialMaximum,
) -> None:
    scale = weighted.normalisation
    assert scale is not None
    assert scale == heaviest.normalisation
    assert scale.effort == heaviest.effort
    assert scale.log_weight == pytest.approx(np.log(heaviest.weight + WEIGHT_OFFSET))
    share = Weighting()
    effort = total_effort(spatial, task, weighted.prediction)
    assert effort == weighted.effort
    criterion = share.effort * effort / scale.effort - share.box * (
        np.log(weighted.weight + WEIGHT_OFFSET) / scale.log_weight
    )
    # The optimiser integrates by Simpson's rule over its nodes.
    assert weighted.prediction.report.objective == pytest.approx(criterion, rel=1e-2)


def test_without_a_lift_there_are_no_numbers(
    spatial: SpatialPredictor, task: SpatialTask, starts
) -> None:
    hand = task.bounds.hand.copy()
    hand[1, [0, 3]] += 2.0
    far = replace(task, bounds=replace(task.bounds, hand=hand))
    result = maximum_weight(spatial, far, starts)
    assert not result.prediction.report.ok
    assert result.normalisation is None
    assert np.isnan([result.mass, result.weight, result.effort]).all()
    objective = for_weight_alone(far).parameters.objective
    assert objective[0] < 1e-3 * objective[1]
