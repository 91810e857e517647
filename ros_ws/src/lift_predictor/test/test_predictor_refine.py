# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifts that can be done are not refused for what happens between the nodes, or for a bad start.

All are random planned lifts that were refused once although they can be done.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from human_model.subject import Subject
from lift_predictor.core.planning.build import Plan, build_plan
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.sagittal.grid import Grid
from lift_predictor.core.sagittal.person import Person
from lift_predictor.core.sagittal.refine import Refiner
from lift_predictor.core.sagittal.verify import verify
from lift_predictor.core.solvers.solver_run import best_objective

BETWEEN_NODES = {
    'margins have no room at the collision circles': (
        Subject('a', 'female', 73.67513016059044, 1.752083642416823, 30.0, 0.0),
        PlanTask(
            'crate', 5.0, (0.24, 0.3, 0.13), (0.37, 0.0, 0.07), (0.5, 0.0, 0.95), (0.0, 0.0)
        ),
    ),
    'two limits at once': (
        Subject('b', 'female', 85.1123, 1.72957, 46.481, -0.893964),
        PlanTask(
            'crate', 5.86563, (0.285578, 0.497971, 0.231471), (0.556846, 0.0, 0.115736),
            (0.36901, 0.0, 0.579342), (0.0, 0.0), 2.0, 'semi_squat',
        ),
    ),
}  # fmt: skip
HARD_TO_FIND = {
    'squat': (
        Subject('c', 'male', 85.896, 1.692678, 42.6829, 1.167088),
        PlanTask(
            'crate', 4.163594, (0.380047, 0.387707, 0.297212), (0.592846, 0.0, 0.324153),
            (0.467959, 0.0, 1.05795), (0.0, 0.0), 2.0, 'squat',
        ),
    ),
    'stoop': (
        Subject('d', 'female', 90.4552, 1.923589, 45.5194, -0.809735),
        PlanTask(
            'crate', 3.667134, (0.212476, 0.309834, 0.372631), (0.479011, 0.0, 0.670389),
            (0.360435, 0.0, 1.30977), (0.0, 0.0), 1.32, 'stoop',
        ),
    ),
}  # fmt: skip


@pytest.fixture(scope='module')
def own_predictor() -> LiftPredictor:
    return LiftPredictor()


def plan_of(predictor: LiftPredictor, subject: Subject, task: PlanTask) -> Plan:
    predictor.configure(subject)
    return build_plan(Person.of(subject), task)


@pytest.mark.parametrize('case', [*BETWEEN_NODES, *HARD_TO_FIND])
def test_a_lift_that_can_be_done_is_found_and_holds_between_the_nodes(
    own_predictor, case: str
) -> None:
    subject, task = (BETWEEN_NODES | HARD_TO_FIND)[case]
    plan = plan_of(own_predictor, subject, task)
    starts = plan.starts(own_predictor.programme.grid.spline, 4)
    predicted = own_predictor.solve_task(plan.task, starts)
    assert predicted.report.ok, predicted.report.message
    assert predicted.box_mass == pytest.approx(task.box_mass)
    best = predicted.optima[0]
    check = verify(
        own_predictor.programme.report, Grid(7, 97), best.control,
        replace(plan.task.parameters, box_mass=best.box_mass), plan.task.bounds,
    )  # fmt: skip
    assert check.n_points == 961
    assert check.passed, check.failures()


@pytest.fixture(scope='module')
def between_nodes(own_predictor):
    plan = plan_of(own_predictor, *BETWEEN_NODES['margins have no room at the collision circles'])
    vector = plan.task.parameters.pack()
    starts = plan.starts(own_predictor.programme.grid.spline, 4)
    return plan.task, vector, own_predictor.programme.solve_all(vector, plan.task.bounds, starts)


def test_more_nodes_do_what_margins_cannot(own_predictor, between_nodes) -> None:
    task, vector, optima = between_nodes
    refiner = Refiner(own_predictor.programme, refinements=0)
    runs, check = refiner.refine(task, vector, optima)
    assert check.passed
    assert '49 nodes' in runs[0].start
    least = best_objective(optima)
    assert least < runs[0].objective < 1.01 * least


def test_what_cannot_hold_between_the_nodes_is_not_passed_off_as_solved(
    own_predictor, between_nodes
) -> None:
    task, vector, optima = between_nodes
    # The check is of a box that nobody can carry past the knees.
    # The programme knows a small one.
    wide = replace(task, parameters=replace(task.parameters, box_radius=0.6))
    runs, check = Refiner(own_predictor.programme, 1).refine(wide, vector, optima)
    assert not check.passed
    assert check.violation['collision [m]'] > 0.01
    assert len(runs) > len(optima)


def test_no_run_is_begun_after_the_deadline(own_predictor, between_nodes) -> None:
    task, vector, optima = between_nodes
    runs, check = Refiner(own_predictor.programme, 6).refine(task, vector, optima, deadline=0.0)
    assert not check.passed
    assert len(runs) == len(optima)
