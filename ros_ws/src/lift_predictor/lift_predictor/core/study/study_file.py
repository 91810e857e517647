# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The YAML file of a study: schema, reading, validation.

::

    name: warehouse
    subjects:                  # exactly one of list, file, sample
      list:                    # persons as in a task file
        - {pseudonym: A, sex: male, mass: 70, stature: 1.75, age: 30}
      file: people.csv         # columns pseudonym, sex, mass, stature, age[, strength_z]
      sample:                  # drawn; the same seed gives the same persons
        count: 40
        seed: 1
        prefix: P              # optional, of the pseudonyms
        sex: {choice: {male: 0.5, female: 0.5}}
        stature: {normal: [1.70, 0.09]}   # m; or {uniform: [low, high]}, or a number
        mass: {uniform: [55, 110]}        # kg; or bmi, kg/m^2
        age: {uniform: [18, 65]}          # years
        strength_z: {normal: [0, 1]}      # optional
    tasks:                     # tasks as in a task file, or files of them
      - name: shelf
        box_mass: maximum
        ...
      - file: shelf_12kg.yaml  # its subject is left out
    weightings:                # optional; for tasks whose box_mass is maximum
      - [0.15, 0.85]           # of effort and of the box's weight; or
      # steps: 21              # in place of the list: evenly from [1, 0] to [0, 1]
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from human_model.subject import Subject
from lift_predictor.core.exceptions import PlanError, TaskError
from lift_predictor.core.planning.fields import Fields
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.task_file import read_task, read_task_file
from lift_predictor.core.problem.maximum_weight import Weighting
from lift_predictor.core.study.cases import Case
from lift_predictor.core.study.population import read_subjects

MIN_STEPS: Final = 2


@dataclass(frozen=True, eq=False)
class Study:
    """A study as its file describes it.

    Attributes
    ----------
    name : str
        Of the study.
    subjects, tasks : tuple
        Who, what.
    weightings : tuple of Weighting
        For tasks that ask for the largest mass.
    """

    name: str
    subjects: tuple[Subject, ...]
    tasks: tuple[PlanTask, ...]
    weightings: tuple[Weighting, ...]

    def cases(self) -> tuple[Case, ...]:
        """All cases; a task of a given mass has one for each subject, whatever the weightings."""
        return tuple(
            Case(subject, task, weighting)
            for subject in self.subjects
            for task in self.tasks
            for weighting in (self.weightings if task.box_mass is None else (None,))
        )


def read_study(path: str | Path) -> Study:
    """Read and validate a study file (schema in the module's docstring).

    Raises
    ------
    PlanError
        Naming file, field and value.
    """
    path = Path(path)
    whole = Fields.read(path)
    name = whole.text('name', path.stem)
    subjects = read_subjects(whole.section('subjects'), path.parent)
    tasks = tuple(
        _task(entry, path.parent, f'task_{i}') for i, entry in enumerate(whole.entries('tasks'))
    )
    names = [task.name for task in tasks]
    for task_name in names:
        if names.count(task_name) > 1:
            raise whole.error('tasks', f'the name {task_name!r} occurs twice')
    weightings = _weightings(whole) if 'weightings' in whole else (Weighting(),)
    whole.finish()
    return Study(name, subjects, tasks, weightings)


def _task(fields: Fields, folder: Path, name: str) -> PlanTask:
    if 'file' not in fields:
        return read_task(fields, name)
    task = read_task_file(folder / fields.text('file')).task
    fields.finish()
    return task


def _weightings(whole: Fields) -> tuple[Weighting, ...]:
    value = whole.take('weightings')
    if isinstance(value, dict):
        inner = Fields(whole.source, 'weightings', value)
        steps = inner.whole('steps')
        inner.finish()
        if steps < MIN_STEPS:
            raise inner.error('steps', f'{steps}: at least {MIN_STEPS} are needed')
        # Rounded, so that both add up to 1 whatever the number of steps.
        value = [[round(1.0 - w, 12), round(w, 12)] for w in np.linspace(0.0, 1.0, steps)]
    if not isinstance(value, list) or not value:
        raise whole.error('weightings', f'a list of pairs is needed, found {value!r}')
    found = []
    for i, _ in enumerate(value):
        pair = Fields(whole.source, 'weightings', dict(enumerate(value))).numbers(str(i), 2)
        try:
            found.append(Weighting(*pair))
        except TaskError as error:
            raise PlanError(f'{whole.source}: weightings[{i}]: {error}') from error
    return tuple(found)
