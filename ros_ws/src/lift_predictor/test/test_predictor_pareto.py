# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Pareto curve of one person, and the total error that chooses among its cases."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from human_model.report import SolveReport, SolveStatus
from human_model.task import Box
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.pareto import (
    N_CASES,
    ParetoCurve,
    TotalError,
    best_weighting,
    pareto_curve,
    total_error,
    weightings,
)
from lift_predictor.core.problem.maximum_weight import Weighting, maximum_weight

BOX_SIZE = (0.238, 0.305, 0.127)

BOX = Box(7.0, BOX_SIZE)


@pytest.fixture(scope='module')
def solved(subject, predictor, make_lift):
    """Return the curve, the order of the progress, task and starts."""
    task = predictor.sagittal.model.maximum_weight_task(subject, make_lift(7.0), BOX)
    starts = predictor.sagittal.model.starts(task)
    called = []
    curve = pareto_curve(
        predictor.sagittal, task, starts, lambda case, result: called.append((case, result))
    )
    return curve, called, task, starts


def test_weightings_are_the_cases_of_the_dissertation() -> None:
    cases = weightings()
    assert len(cases) == N_CASES == 21
    assert cases[0] == Weighting(0.0, 1.0)
    assert cases[20] == Weighting(1.0, 0.0)
    assert (cases[3].effort, cases[3].box) == pytest.approx((0.15, 0.85))


def test_every_case_is_solved_and_verified(solved) -> None:
    curve, called, _, _ = solved
    assert [case for case, _ in called] == list(range(N_CASES))
    assert all(result.report.ok for result in curve.results)
    assert all(result.prediction.verification.passed for result in curve.results)


def test_no_case_is_better_than_another_in_both_criteria(solved, predictor) -> None:
    """Of the optima at the nodes; the margins between the nodes that follow differ a little."""
    curve, _, task, starts = solved
    scale = curve.results[0].normalisation
    model = predictor.sagittal.model
    effort, weight = np.empty(N_CASES), np.empty(N_CASES)
    for case, result in enumerate(curve.results):
        run = result.prediction.runs[-len(starts) if case == 0 else -1]
        effort[case] = model.effort(task, run)
        weight[case] = run.box_mass * task.parameters.gravity
    assert np.all(np.diff(effort) <= 1e-6)
    assert np.all(np.diff(weight) <= 1e-4)
    criteria = np.stack((effort / scale.effort, -np.log(weight + 10.0) / scale.log_weight))
    objective = np.array([[w.effort, w.box] for w in weightings()]) @ criteria
    own = np.diagonal(objective)
    np.testing.assert_allclose(own[1:], objective.min(axis=1)[1:], atol=1e-6)
    np.testing.assert_allclose(curve.criteria[0], (1.0, -1.0))


def test_warm_starts_lose_nothing(solved, predictor) -> None:
    curve, _, task, starts = solved
    for case in (3, 12):
        cold = maximum_weight(predictor.sagittal, task, starts, weightings()[case])
        warm = curve.results[case]
        assert warm.report.objective <= cold.report.objective + 1e-4 * abs(cold.report.objective)


def stand_in(angle: float, vertical: float, horizontal: float, weight: float, ok: bool = True):
    status = SolveStatus.OK if ok else SolveStatus.PREDICTOR_INFEASIBLE
    comparison = SimpleNamespace(
        joint_rmse=np.full(6, angle / 6.0),
        vertical_force_rmse=vertical,
        horizontal_force_rmse=horizontal,
    )
    return SimpleNamespace(
        report=SolveReport(status), comparison=comparison, weight=weight,
        prediction=SimpleNamespace(lift_id='made up'),
    )  # fmt: skip


def test_total_error_is_equation_2_24() -> None:
    curve = ParetoCurve((stand_in(60.0, 100.0, 40.0, 230.0), stand_in(30.0, 200.0, 10.0, 190.0)))
    error = total_error(curve, 200.0)
    np.testing.assert_allclose(error.angle, [60.0, 30.0])
    np.testing.assert_allclose(error.weight, [30.0, 10.0])
    np.testing.assert_allclose(error.total, [1.0 + 0.5 + 1.0 + 1.0, 0.5 + 1.0 + 0.25 + 1.0 / 3.0])


def test_failed_cases_take_no_part() -> None:
    curve = ParetoCurve((stand_in(6.0, 1.0, 1.0, 2.0), stand_in(600.0, 9.0, 9.0, 9.0, ok=False)))
    error = total_error(curve, 1.0)
    assert error.total[0] == pytest.approx(4.0)
    assert np.isnan(error.total[1])


def test_an_exact_prediction_has_no_error() -> None:
    curve = ParetoCurve((stand_in(0.0, 0.0, 0.0, 5.0), stand_in(0.0, 0.0, 0.0, 5.0)))
    np.testing.assert_array_equal(total_error(curve, 5.0).total, 0.0)


def test_planned_lifts_cannot_be_compared() -> None:
    with pytest.raises(TaskError, match='made up'):
        total_error(ParetoCurve((replace_comparison(stand_in(1.0, 1.0, 1.0, 1.0)),)), 1.0)


def replace_comparison(result):
    result.comparison = None
    return result


def test_best_weighting_has_the_least_mean_error() -> None:
    zeros = np.zeros(N_CASES)
    one = TotalError(zeros, zeros, zeros, zeros, np.linspace(3.0, 1.0, N_CASES))
    two = replace(one, total=np.where(np.arange(N_CASES) == 3, 0.0, 3.0))
    weighting, mean = best_weighting([one, two])
    assert weighting == weightings()[3]
    np.testing.assert_allclose(mean, (one.total + two.total) / 2.0)
    gap = replace(two, total=np.where(np.arange(N_CASES) == 3, np.nan, two.total))
    assert best_weighting([one, gap])[0] == weightings()[20]
    for nobody in ([], [replace(one, total=np.full(N_CASES, np.nan))]):
        with pytest.raises(TaskError, match='no case'):
            best_weighting(nobody)
