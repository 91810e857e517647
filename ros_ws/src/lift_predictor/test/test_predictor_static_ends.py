# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifts that begin and end at rest in acceleration too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lift_predictor.core.exceptions import SplineError
from lift_predictor.core.models.sagittal.evaluation import evaluate
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.verify import verify
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.predictor import LiftPredictor


@pytest.fixture(scope='module')
def still() -> LiftPredictor:
    return LiftPredictor(PredictorOptions(static_ends='acceleration'))


@pytest.fixture(scope='module')
def only_velocity(subject):
    """Return a function that predicts an outcome's lift with rest in velocity only."""
    predictor = LiftPredictor(PredictorOptions(static_ends='velocity'))
    return lambda result: predictor.predict(subject, result.lift, result.box)


@pytest.fixture(scope='module')
def predicted(subject, still, outcome):
    result = outcome(7.0)
    return still.predict(subject, result.lift, result.box)


def test_ends_are_postures_held_still(predicted, person, outcome, only_velocity) -> None:
    assert predicted.report.ok, predicted.report.message
    motion = predicted.lift.motion
    for rates in (motion.velocity, motion.acceleration):
        np.testing.assert_allclose(rates[[0, -1]], 0.0, atol=1e-9)
    weight = (person.body[:, 0].sum() + 7.0) * person.gravity
    force = motion.ground_force.sum(axis=1)
    np.testing.assert_allclose(force[[0, -1]], [[0.0, 0.0, weight]] * 2, atol=1e-6)
    np.testing.assert_allclose(motion.hand_force.sum(axis=1)[[0, -1], 2], -7.0 * person.gravity)
    # With rest in velocity only the motion begins with accelerations.
    usual = only_velocity(outcome(7.0)).lift.motion
    assert np.abs(usual.acceleration[0]).max() > 10.0
    np.testing.assert_allclose(usual.velocity[[0, -1]], 0.0, atol=1e-9)


def test_torques_at_the_ends_are_those_of_holding_the_box(
    subject, still, predicted, outcome
) -> None:
    task = still.sagittal.model.recorded_task(subject, outcome(7.0).lift, outcome(7.0).box)
    columns = [predicted.lift.motion.coordinates.index(joint) for joint in JOINTS]
    q = predicted.lift.motion.position[[0, -1]][:, columns]
    held = evaluate(still.sagittal.model.library, q, 0.0 * q, 0.0 * q, task.parameters)
    np.testing.assert_allclose(predicted.torque[[0, -1], :6], held.torque, atol=1e-6)


def test_rest_costs_effort(predicted, outcome, only_velocity) -> None:
    assert predicted.report.objective > only_velocity(outcome(7.0)).report.objective


def test_the_check_finds_accelerations_at_the_ends(subject, still, predicted, outcome) -> None:
    result = outcome(7.0)
    task = still.sagittal.model.recorded_task(subject, result.lift, result.box)
    grid = still.sagittal.model.grid
    assert predicted.verification.violation['static_ends [rad/s^2]'] < 1e-6
    # The same control points on a spline that rests in velocity only: the ends accelerate.
    other = replace(grid, n_control=grid.n_control - 2, n_nodes=31, rest='velocity')
    control = predicted.runs[0].control
    assert verify(
        still.sagittal.model.library, other, control, task.parameters, task.bounds
    ).violation['static_ends [rad/s^2]'] == pytest.approx(0.0), 'not asked for there'


def test_plans_rest_too(still, subject) -> None:
    task = PlanTask(
        'shelf', 7.0, (0.238, 0.305, 0.127), (0.35, 0.0, 0.0635), (0.55, 0.0, 0.9635), (0.0, 0.0)
    )
    planned = LiftPlanner(still).plan(subject, task)
    assert planned.report.ok, planned.report.message
    np.testing.assert_allclose(planned.prediction.lift.motion.acceleration[[0, -1]], 0, atol=1e-9)
    aside = replace(task, end=(0.1, 0.5, 0.9))
    aside_planned = LiftPlanner(still).plan(subject, aside)
    assert aside_planned.report.ok, aside_planned.report.message
    np.testing.assert_allclose(
        aside_planned.prediction.lift.motion.acceleration[[0, -1]], 0.0, atol=1e-6
    )


def test_refuses_what_does_not_fit() -> None:
    with pytest.raises(SplineError, match="'jerk'"):
        LiftPredictor(PredictorOptions(static_ends='jerk'))
    with pytest.raises(SplineError, match='n_nodes = 27'):
        LiftPredictor(PredictorOptions(n_nodes=27, static_ends='acceleration'))
