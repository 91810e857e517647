# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Studies: files and samples, ids by content, rows for everything, killed and gone on with."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip('pyarrow', reason='pyarrow is not installed')

from human_model.report import SolveStatus
from human_model.subject import Subject
from lift_predictor.core.exceptions import PlanError, StudyError
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.problem.maximum_weight import Weighting
from lift_predictor.core.study.cases import Case
from lift_predictor.core.study.rows import COLUMNS, CRASHED, crashed, empty_row, solve_case
from lift_predictor.core.study.runner import run_study
from lift_predictor.core.study.schedulers import LocalScheduler, Row
from lift_predictor.core.study.store import Store, read_table
from lift_predictor.core.study.study_file import read_study

SUBJECT = Subject('A', 'male', 70.0, 1.75, 30.0)
TASK = PlanTask(
    'shelf', 7.0, (0.238, 0.305, 0.127), (0.37, 0.0, 0.0635), (0.55, 0.0, 0.95), (0.0, 0.0)
)
STUDY = """
name: test
subjects:
  sample: {count: 3, seed: 7, sex: {choice: {male: 1, female: 1}}, stature: {normal: [1.7, 0.1]},
           bmi: {uniform: [20, 28]}, age: {uniform: [20, 60]}, strength_z: {normal: [0, 1]}}
tasks:
  - {name: given, box_mass: 7.0, box_size: [0.24, 0.3, 0.13], start: [0.37, 0, 0.07],
     end: [0.55, 0, 0.95], feet: [0, 0]}
  - {name: most, box_mass: maximum, box_size: [0.24, 0.3, 0.13], start: [0.37, 0, 0.07],
     end: [0.55, 0, 0.95], feet: free}
weightings: {steps: 21}
"""


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / 'study.yaml'
    path.write_text(text, encoding='utf-8')
    return path


def cases(n: int) -> list[Case]:
    """Cases that differ in age, which nothing depends on but the id."""
    return [Case(Subject('A', 'male', 70.0, 1.75, 30.0 + 0.5 * i), TASK, None) for i in range(n)]


class Counting:
    """A scheduler that solves nothing, and stops after so many rows."""

    described = 'nowhere'

    def __init__(self, rows: int) -> None:
        self.rows, self.asked = rows, 0

    def solve(self, cases: Sequence[Case]) -> Iterator[Row]:
        """Give a row for each case until the allowed number is reached."""
        for case in cases:
            if self.asked == self.rows:
                raise KeyboardInterrupt
            self.asked += 1
            yield empty_row(case) | {'status': 0, 'status_name': 'OK', 'message': 'made up'}


def test_study_has_every_subject_with_every_task_and_weighting(tmp_path: Path) -> None:
    study = read_study(write(tmp_path, STUDY))
    found = study.cases()
    assert len(found) == 3 * (1 + 21)
    assert len({case.case_id for case in found}) == len(found)
    weights = [(case.weighting.effort, case.weighting.box) for case in found if case.weighting]
    assert weights[0] == (1.0, 0.0)
    assert weights[20] == (0.0, 1.0)
    assert study.tasks[1].feet is None
    assert study.tasks[1].box_mass is None


def test_sample_is_the_same_for_the_same_seed_and_grows_at_its_end(tmp_path: Path) -> None:
    few = read_study(write(tmp_path, STUDY)).subjects
    many = read_study(write(tmp_path, STUDY.replace('count: 3', 'count: 200'))).subjects
    assert [s.to_dict() for s in few] == [s.to_dict() for s in many[:3]]
    other = read_study(write(tmp_path, STUDY.replace('seed: 7', 'seed: 8'))).subjects
    assert few[0].to_dict() != other[0].to_dict()
    bmi = np.array([s.mass / s.stature**2 for s in many])
    assert bmi.min() >= 20.0
    assert bmi.max() <= 28.0
    stature = np.array([s.stature for s in many])
    assert abs(stature.mean() - 1.7) < 4.0 * 0.1 / np.sqrt(200)
    share = np.mean([s.sex == 'male' for s in many])
    assert abs(share - 0.5) < 4.0 * np.sqrt(0.25 / 200)


def test_subjects_from_a_table(tmp_path: Path) -> None:
    table = tmp_path / 'people.csv'
    table.write_text('# made up\npseudonym,sex,mass,stature,age\nA,male,70,1.75,30\n')
    head, tail = STUDY.split('subjects:', maxsplit=1)[0], STUDY.split('tasks:')[1]
    path = write(tmp_path, f'{head}subjects: {{file: people.csv}}\ntasks:{tail}')
    (subject,) = read_study(path).subjects
    assert subject.to_dict() == SUBJECT.to_dict()
    table.write_text('pseudonym,sex,mass,stature,age\nA,male,heavy,1.75,30\n')
    with pytest.raises(PlanError, match=r"people\.csv, line 2, column 'mass': .*'heavy'"):
        read_study(path)


@pytest.mark.parametrize(
    ('old', 'new', 'words'),
    [
        ('count: 3', 'count: 0', r'sample\.count: 0'),
        ('seed: 7', 'seed: x', r"sample\.seed: .*'x'"),
        ('{normal: [1.7, 0.1]}', '{gamma: [1, 2]}', r"sample\.stature: 'gamma'"),
        ('{normal: [1.7, 0.1]}', '{uniform: [3.0, 4.0]}', r'sample\.count: 1000 draws'),
        ('{normal: [1.7, 0.1]}', 'tall', r"sample\.stature: .*'tall'"),
        ('  sample:', '  file: x.csv\n  sample:', r'exactly one'),
        ('name: most', 'name: given', r"tasks: the name 'given' occurs twice"),
        ('{steps: 21}', '{steps: 1}', r'weightings\.steps: 1'),
        ('{steps: 21}', '[[0.5, 0.6]]', r'weightings\[0\]: .*0\.6'),
        ('feet: free', 'feet: bare', r"tasks\[1\]\.feet: .*'bare'"),
        ('name: test', 'nam: test', r'nam: is not a known field'),
    ],
)
def test_bad_study_names_file_field_and_value(tmp_path, old, new, words) -> None:
    assert old in STUDY
    path = write(tmp_path, STUDY.replace(old, new))
    with pytest.raises(PlanError, match=words) as caught:
        read_study(path)
    assert '.yaml' in str(caught.value)


def test_id_depends_on_the_content_and_survives_a_journey() -> None:
    case = Case(SUBJECT, TASK, Weighting(0.15, 0.85))
    again = Case.from_dict(case.to_dict())
    assert again.case_id == case.case_id
    assert Case(SUBJECT, TASK, Weighting(0.2, 0.8)).case_id != case.case_id
    assert len({case.case_id for case in cases(50)}) == 50


def test_row_of_a_solved_case_has_the_numbers_and_the_report() -> None:
    row = solve_case(Case(SUBJECT, TASK, None).to_dict())
    assert list(row) == list(COLUMNS)
    assert row['status'] == 0, row['message']
    assert row['box_mass'] == 7.0
    assert row['effort'] == pytest.approx(row['objective'], rel=5e-3)
    assert row['iterations'] > 0
    assert row['runs'] >= 1
    assert 0.0 < row['largest_share'] < 1.01
    assert row['solve_time'] > 0.0


def test_failed_solve_is_a_row_with_its_reason() -> None:
    high = PlanTask(
        'high', 7.0, (0.238, 0.305, 0.127), (0.37, 0.0, 0.0635), (0.55, 0.0, 2.6), (0.0, 0.0)
    )
    row = solve_case(Case(SUBJECT, high, None).to_dict())
    assert row['status'] == SolveStatus.PREDICTOR_UNREACHABLE
    assert 'task.end' in row['message']
    assert row['effort'] is None
    assert row['box_mass'] is None


def test_interrupted_study_goes_on_where_it_was(tmp_path: Path) -> None:
    todo = cases(120)
    with pytest.raises(KeyboardInterrupt):
        run_study(todo, tmp_path, Counting(70))
    second = Counting(120)
    told = []
    report = run_study(todo, tmp_path, second, lambda *what: told.append(what[:2]))
    assert second.asked == 50
    assert told[0] == (70, 120)
    assert told[-1] == (120, 120)
    assert (report.cases, report.earlier, report.statuses) == (120, 70, {'OK': 120})
    rows = read_table(report.table)
    assert [row['case_id'] for row in rows] == [case.case_id for case in todo]
    assert not list((tmp_path / 'parts').iterdir())
    third = Counting(0)
    assert run_study(todo, tmp_path, third).earlier == 120
    assert third.asked == 0


def test_crashed_cases_are_solved_again_on_request(tmp_path: Path) -> None:
    todo = cases(3)
    store = Store(tmp_path)
    store.add(empty_row(todo[1]) | crashed('made up'))
    store.close()
    assert run_study(todo, tmp_path, Counting(2)).statuses == {'OK': 2, 'CRASHED': 1}
    assert run_study(todo, tmp_path, Counting(1), retry_crashed=True).statuses == {'OK': 3}


def test_folder_is_not_shared_and_not_misread(tmp_path: Path) -> None:
    store = Store(tmp_path)
    with pytest.raises(StudyError, match='another study'):
        Store(tmp_path)
    store.close()
    (tmp_path / 'results.parquet.99.tmp').write_bytes(b'half a table')
    Store(tmp_path).close()
    assert not list(tmp_path.glob('*.tmp'))
    (tmp_path / 'results.parquet').write_bytes(b'no table')
    with pytest.raises(StudyError, match=r'results\.parquet'):
        Store(tmp_path)


def test_process_that_dies_costs_its_own_cases_only() -> None:
    todo = cases(5)
    victim = todo[2].subject.age
    # exec with the case as its names: a function every fresh interpreter has.
    deadly = functools.partial(
        exec, f'import os; os._exit(3) if subject["age"] == {victim} else None'
    )
    rows = list(LocalScheduler(2, deadly).solve(todo))
    assert len(rows) == 5
    # exec answers None for the others.
    dead = [row for row in rows if row is not None]
    assert [row['case_id'] for row in dead] == [todo[2].case_id]
    assert dead[0]['status'] == CRASHED
    assert 'its process ended' in dead[0]['message']
