# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Planned lifts: solved and checked, in the technique asked for, from feet that are searched."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from human_model.report import SolveStatus
from lift_predictor.core.exceptions import CancelledError, PlanError
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.planning.summary import summarise
from lift_predictor.core.planning.task_file import read_task_file
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.study.study_file import read_study

ROOT = Path(__file__).resolve().parents[4]
TASK = PlanTask(
    'shelf', 7.0, (0.238, 0.305, 0.127), (0.35, 0.0, 0.0635), (0.55, 0.0, 0.9635), (0.0, 0.0), 1.2
)


@pytest.fixture(scope='module')
def planner() -> LiftPlanner:
    return LiftPlanner(LiftPredictor())


@pytest.fixture(scope='module')
def free(planner, subject):
    return planner.plan(subject, TASK)


def test_given_mass_is_planned_and_checked_between_the_nodes(free) -> None:
    prediction = free.prediction
    assert prediction.report.ok, prediction.report.message
    assert prediction.verification.passed
    motion = prediction.lift.motion
    np.testing.assert_allclose(motion.box_position[[0, -1]], [TASK.start, TASK.end], atol=1e-4)
    np.testing.assert_allclose(motion.velocity[[0, -1]], 0.0, atol=1e-6)
    assert motion.time[-1] == pytest.approx(1.2)
    hands = [motion.point_names.index(f'hand_{side}') for side in 'rl']
    grip = motion.points[:, hands].mean(axis=1)
    np.testing.assert_allclose(grip, motion.box_position, atol=1e-9)


def test_technique_costs_effort_and_is_kept(planner, subject) -> None:
    # From the floor the knees are too weak to hold a full squat at rest.
    low = planner.plan(subject, replace(TASK, technique='squat'))
    assert low.report.status is SolveStatus.PREDICTOR_INFEASIBLE
    assert 'knee_angle' in low.report.message
    raised = replace(TASK, start=(0.35, 0.0, 0.1))
    squat = planner.plan(subject, replace(raised, technique='squat'))
    assert squat.report.ok, squat.report.message
    assert 0.0 <= squat.index <= 30.0
    assert squat.report.objective > planner.plan(subject, raised).report.objective
    assert squat.prediction.active_constraints


def test_summary_agrees_with_the_objective(free) -> None:
    summary = summarise(free)
    assert summary.effort == pytest.approx(free.report.objective, rel=2e-3)
    assert summary.box_path[0][1:] == pytest.approx(TASK.start, abs=1e-4)
    assert summary.peak_vertical_force > (63.5 + 7.0) * 9.8
    shares = [peak.share for peak in summary.peaks]
    assert max(shares) < 1.01
    assert all(peak.torque * peak.limit > 0.0 for peak in summary.peaks if peak.torque)


def test_free_feet_are_at_least_as_good_as_any_place_tried(planner, subject) -> None:
    stages = []
    planned = planner.plan(subject, replace(TASK, feet=None), stages.append)
    assert planned.report.ok, planned.report.message
    assert len(planned.placements) >= 5
    best = min(placement.value for placement in planned.placements)
    assert planned.report.objective <= best * (1.0 + 1e-6)
    near = TASK.start[0] - planned.feet.forward
    assert 0.25 - 1e-9 <= near <= 0.63 + 1e-9
    assert [s.stage for s in stages].index('lift') >= 5
    given = planner.plan(subject, replace(TASK, feet=(planned.feet.forward, 0.0)))
    assert given.report.objective == pytest.approx(planned.report.objective, rel=1e-3)


def test_largest_mass_is_heavier_than_what_can_be_lifted_with_less_effort(
    planner, subject, free
) -> None:
    heaviest = planner.plan(subject, replace(TASK, box_mass=None))
    assert heaviest.report.ok, heaviest.report.message
    assert heaviest.prediction.box_mass > 12.0
    assert any('torque limit' in name for name in heaviest.prediction.active_constraints)
    # The default weighting leaves some weight for less effort: twice as much is beyond both.
    heavier = replace(TASK, box_mass=2.0 * heaviest.prediction.box_mass)
    too_heavy = planner.plan(subject, heavier)
    assert too_heavy.report.status is SolveStatus.PREDICTOR_INFEASIBLE, too_heavy.report.message
    assert 'joint torque limit' in too_heavy.report.message
    assert too_heavy.prediction.lift is None
    assert summarise(too_heavy) is None


@pytest.mark.long  # half a minute; lift predict and a bad recording have shorter tests of it
def test_out_of_reach_is_a_report(planner, subject) -> None:
    high = planner.plan(subject, replace(TASK, end=(0.55, 0.0, 2.4)))
    assert high.report.status is SolveStatus.PREDICTOR_UNREACHABLE
    assert 'task.end' in high.report.message
    nowhere = replace(TASK, end=(0.55, 0.0, 2.4), feet=None)
    none = planner.plan(subject, nowhere)
    assert none.report.status is SolveStatus.PREDICTOR_UNREACHABLE
    assert 'task.feet: from none of 5 places' in none.report.message
    flat = LiftPlanner(LiftPredictor(PredictorOptions(dimension='2d')))
    aside = flat.plan(subject, replace(TASK, end=(0.4, 0.4, 1.0)))
    assert aside.report.status is SolveStatus.PREDICTOR_BAD_INPUT
    assert 'sagittal model allows' in aside.report.message


def test_listener_ends_the_work_between_two_runs(planner, subject) -> None:
    told = []

    def stop(progress) -> None:
        told.append(progress)
        raise CancelledError('enough')

    with pytest.raises(CancelledError):
        planner.plan(subject, TASK, stop)
    assert len(told) == 1
    assert told[0].done == 1 < told[0].total


EXAMPLES = sorted((ROOT / 'examples').glob('*.yaml'))


@pytest.mark.parametrize('path', EXAMPLES, ids=lambda p: p.stem)
def test_example_is_read(path: Path) -> None:
    if path.stem.startswith('study_'):
        study = read_study(path)
        assert len(study.cases()) == len(study.subjects) * len(study.tasks)
        return
    entry = read_task_file(path)
    assert entry.task.name == path.stem
    assert entry.task.box_size == (0.238, 0.305, 0.127)


def change_example(tmp_path: Path, old: str, new: str) -> Path:
    text = (ROOT / 'examples' / 'shelf_12kg.yaml').read_text(encoding='utf-8')
    assert old in text
    path = tmp_path / 'changed.yaml'
    path.write_text(text.replace(old, new), encoding='utf-8')
    return path


@pytest.mark.parametrize(
    ('old', 'new', 'words'),
    [
        ('mass: 63.5', 'mass: 63500', r'subject\.mass: 63500'),
        ('sex: male', 'sex: unknown', r"subject\.sex: .*'unknown'"),
        ('box_mass: 12.0', 'box_mass: heavy', r"task\.box_mass: .*'heavy'"),
        ('feet: [0.0, 0.0]', 'feet: here', r"task\.feet: .*'here'"),
        ('technique: semi_squat', 'technique: jump', r"task\.technique: 'jump'"),
        ('  duration: 1.2', '  time: 1.2', r'task\.time: is not a known field'),
        ('coupling: good', 'coupling: loose', r"work\.coupling: 'loose'"),
        ('  end: [0.55, 0.0, 0.9635]\n', '', r'task\.end: is missing'),
        ('  end: [0.55, 0.0, 0.9635]', '  end: [0.55, 0.9635]', r'task\.end: 3 numbers'),
        ('subject:', 'person:', r'subject: is missing'),
    ],
)
def test_bad_task_file_names_file_field_and_value(tmp_path, old, new, words) -> None:
    path = change_example(tmp_path, old, new)
    with pytest.raises(PlanError, match=words) as caught:
        read_task_file(path)
    assert str(path) in str(caught.value)
