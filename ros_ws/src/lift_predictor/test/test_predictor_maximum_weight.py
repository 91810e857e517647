# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The heaviest box: against lifts of given weights, and the two criteria against each other."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from human_model.report import SolveStatus
from human_model.task import Box
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.sagittal.lift_model import POSTURE_TOLERANCES
from lift_predictor.core.models.sagittal.task import build_task
from lift_predictor.core.problem.maximum_weight import (
    LARGEST_WEIGHT,
    REGULARISATION,
    MaximumWeight,
    Weighting,
    heaviest_box,
    maximum_weight,
)
from lift_predictor.core.problem.run import Start, best_first

SIZE = (0.238, 0.305, 0.127)
BOX = Box(7.0, SIZE)


@pytest.fixture(scope='module')
def open_task(subject, predictor, make_lift):
    """Return the task with an open mass, and its starts."""
    model = predictor.sagittal.model
    task = model.maximum_weight_task(subject, make_lift(7.0), BOX)
    return task, model.starts(task)


@pytest.fixture(scope='module')
def solve(predictor, open_task):
    """Return a function from w1 to the result."""
    heaviest = heaviest_box(predictor.sagittal, *open_task)

    @cache
    def run(effort: float) -> MaximumWeight:
        weighting = Weighting(effort, 1.0 - effort)
        return maximum_weight(predictor.sagittal, *open_task, weighting, heaviest)

    return run


def test_default_is_the_weighting_and_tolerances_of_chapter_two(
    subject, predictor, make_lift
) -> None:
    result = predictor.maximum_weight(subject, make_lift(7.0), BOX)
    assert result.report.ok, result.report.message
    assert result.weighting == Weighting(0.15, 0.85)
    assert result.prediction.verification.passed
    assert result.weight == pytest.approx(result.mass * 9.80665)
    assert 0.0 < result.weight < LARGEST_WEIGHT
    assert result.prediction.box_mass == result.prediction.lift.box_mass == result.mass
    assert result.comparison.predicted_effort == pytest.approx(result.effort)
    assert result.active_constraints
    assert any('torque limit' in name for name in result.active_constraints)
    motion, recorded = result.prediction.lift.motion, make_lift(7.0).motion
    for sample, tolerance in zip((0, len(motion) // 2, -1), POSTURE_TOLERANCES, strict=True):
        for joint in ('hip_flexion', 'knee_angle'):
            apart = motion.coordinate(joint)[sample] - recorded.coordinate(joint)[sample]
            assert abs(apart) <= tolerance + 1e-3


def test_hands_carry_the_predicted_weight(solve) -> None:
    result = solve(0.15)
    motion = result.prediction.lift.motion
    impulse = np.trapezoid(motion.hand_force.sum(axis=1), motion.time, axis=0)
    duration = motion.time[-1] - motion.time[0]
    np.testing.assert_allclose(impulse, [0.0, 0.0, -result.weight * duration], atol=0.1)


def test_a_little_less_can_be_lifted_and_a_little_more_cannot(solve, predictor, open_task) -> None:
    task, starts = open_task
    # Before margins between the nodes were asked for: the bounds of these solves have none.
    heaviest = solve(0.0).prediction.runs[-len(starts)]
    start = heaviest.as_start()
    found = []
    for factor in (0.99, 1.01):
        mass = np.full(2, factor * heaviest.box_mass)
        heavier = replace(task, bounds=replace(task.bounds, box_mass=mass))
        (run,) = predictor.sagittal.reference_runs(heavier, [start])
        found.append(run.converged)
    assert found == [True, False]


def test_more_weight_on_the_effort_means_less_effort_and_a_lighter_box(solve) -> None:
    curve = [solve(w) for w in (0.0, 0.15, 0.5, 0.85, 1.0)]
    assert all(result.report.ok for result in curve)
    efforts = [result.effort for result in curve]
    masses = [result.mass for result in curve]
    # The last two lift next to nothing: they are equal but for the tolerance of the solver.
    assert np.all(np.diff(efforts) <= 1e-5)
    assert np.all(np.diff(masses) <= 1e-5)
    assert curve[-1].mass == pytest.approx(0.0, abs=1e-3)


def test_criteria_are_normalised_by_the_heaviest_lift(solve) -> None:
    heaviest = solve(0.0)
    assert heaviest.criteria == pytest.approx((1.0, -1.0))
    effort, weight = solve(0.5).criteria
    assert 0.0 < effort < 1.0
    assert -1.0 < weight < 0.0


def test_objective_is_equation_2_11(solve) -> None:
    for w1 in (0.15, 0.5):
        result = solve(w1)
        effort, weight = result.criteria
        # Best of the runs at the nodes, before a margin between them was asked for.
        assert result.report.objective == pytest.approx(
            w1 * effort + (1.0 - w1) * weight, rel=1e-9
        )


def test_the_tie_break_costs_next_to_nothing(predictor, open_task, solve) -> None:
    task, starts = open_task
    parameters = replace(task.parameters, objective=np.array([0.0, 1.0]))
    runs = predictor.sagittal.reference_runs(replace(task, parameters=parameters), starts)
    pure = best_first(list(runs))[0]
    assert pure.converged
    first = solve(0.0).prediction.runs[-len(starts)]
    assert REGULARISATION > 0.0
    assert first.box_mass == pytest.approx(pure.box_mass, rel=5e-4)
    assert first.box_mass <= pure.box_mass * (1.0 + 1e-6)


@pytest.mark.long  # IPOPT from many starts: a quarter of a minute
def test_random_starts_find_no_heavier_box(predictor, open_task, solve) -> None:
    task, starts = open_task
    person = task.person
    rng = np.random.default_rng(3)
    shape = (predictor.sagittal.model.grid.spline.n_free, 6)
    parameters = replace(task.parameters, objective=np.array([REGULARISATION, 1.0]))
    task = replace(task, parameters=parameters)
    low, high = person.angle_lower, person.angle_upper
    guesses = [Start(f'random {k}', rng.uniform(low, high, shape), 20.0) for k in range(5)]
    runs = predictor.sagittal.reference_runs(task, guesses)
    masses = [run.box_mass for run in runs if run.converged]
    assert masses
    first = solve(0.0).prediction.runs[-len(starts)]
    assert max(masses) <= first.box_mass * 1.001


def test_stronger_people_lift_more(subject, predictor, make_lift) -> None:
    from lift_predictor.core.predictor import LiftPredictor

    strong = LiftPredictor()
    weights = []
    for z in (-0.5, 0.0, 1.0):
        person = replace(subject, strength_z=z)
        weights.append(strong.maximum_weight(person, make_lift(7.0), BOX).weight)
    assert weights[0] < weights[1] < weights[2]


def test_refusals_carry_no_numbers(subject, predictor, make_lift) -> None:
    far = Box(7.0, SIZE, end=np.array([1.6, 0.0, 1.0]))
    result = predictor.maximum_weight(subject, make_lift(7.0), far)
    assert result.report.status is SolveStatus.PREDICTOR_UNREACHABLE
    assert np.isnan([result.mass, result.weight, result.effort, *result.criteria]).all()
    assert result.prediction.lift is None
    assert result.active_constraints == ()


@pytest.mark.parametrize('pair', [(0.5, 0.6), (-0.1, 1.1), (1.0, 0.5)])
def test_weighting_must_sum_to_one(pair) -> None:
    with pytest.raises(TaskError, match='weighting'):
        Weighting(*pair)


def test_a_tolerance_for_each_instant(person, make_lift) -> None:
    task = build_task(person, make_lift(7.0), BOX, (0.1, 0.2, 0.3))
    width = 0.5 * (task.bounds.posture_upper - task.bounds.posture_lower)
    free = (task.bounds.posture_upper < person.angle_upper) & (
        task.bounds.posture_lower > person.angle_lower
    )
    expected = np.broadcast_to(np.array([[0.1], [0.2], [0.3]]), width.shape)
    np.testing.assert_allclose(width[free], expected[free])
