# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The YAML file of a lift to plan: schema, reading, validation.

::

    subject:
      pseudonym: S04           # never a name or a personnel number
      sex: female              # or male
      mass: 62.6               # kg, without the load
      stature: 1.68            # m
      age: 31                  # years
      strength_z: 0.0          # optional, standard deviations from the population mean
    task:
      name: shelf_12kg         # optional, default: name of the file
      box_mass: 12.0           # kg; 0: no box; maximum: the heaviest this person can lift
      box_size: [0.24, 0.30, 0.13]  # depth, width between the hands, height [m]
      start: [0.40, 0.0, 0.07] # centre of the box before the lift: forward, left, up [m]
      end: [0.55, 0.0, 0.97]   # and after it
      feet: [0.0, 0.0]         # middle of the ankles: forward, left [m]; or free
      duration: 1.2            # s; optional, default 1.32
      technique: semi_squat    # optional: free, squat, semi_squat, stoop
      end_posture: upright     # optional: free, upright
      box_from_grip: [0.0, 0.0]  # optional, box centre minus hands: forward, up [m]
    work:                      # optional; chooses the shear limit, as in a recording's task
      lifts_per_day: 100
      lifts_per_minute: 0.2
      duration_hours: 8.0
      coupling: fair           # good, fair or poor

The person stands at `feet`, faces x (forward); the floor is at height 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from human_model.subject import Subject, read_subject
from human_model.task import Point, Work, read_work
from lift_predictor.core.exceptions import PlanError
from lift_predictor.core.planning.fields import Fields
from lift_predictor.core.planning.plan_task import DEFAULT_DURATION, PlanTask
from lift_predictor.core.planning.technique import FREE

MAXIMUM: Final = 'maximum'


@dataclass(frozen=True, eq=False)
class TaskFile:
    """The whole file."""

    path: Path
    subject: Subject
    task: PlanTask
    work: Work


def read_task_file(path: str | Path) -> TaskFile:
    """Read and validate a task file (schema in the module's docstring).

    Raises
    ------
    PlanError
        Naming file, field and value.
    """
    path = Path(path)
    whole = Fields.read(path)
    subject = read_subject(whole.section('subject'))
    task = read_task(whole.section('task'), path.stem)
    section = whole.section('work', {})
    work = read_work(section, Work())
    section.finish()
    whole.finish()
    return TaskFile(path, subject, task, work)


def read_task(fields: Fields, name: str) -> PlanTask:
    """Read one task; `name` is used where it has none."""
    mass = fields.take('box_mass')
    feet = fields.take('feet')
    if feet != FREE:
        feet = _again(fields, 'feet', feet).numbers('feet', 2)
    if mass != MAXIMUM:
        mass = _again(fields, 'box_mass', mass).number('box_mass')
    name = fields.text('name', name)
    size, start, end = (_place(fields, key) for key in ('box_size', 'start', 'end'))
    duration = fields.number('duration', DEFAULT_DURATION)
    technique = fields.text('technique', FREE)
    end_posture = fields.text('end_posture', FREE)
    grip = fields.numbers('box_from_grip', 2, (0.0, 0.0))
    fields.finish()
    try:
        return PlanTask(
            name=name,
            box_mass=None if mass == MAXIMUM else mass,
            box_size=size,
            start=start,
            end=end,
            feet=None if feet == FREE else (feet[0], feet[1]),
            duration=duration,
            technique=technique,
            end_posture=end_posture,
            box_from_grip=(grip[0], grip[1]),
        )
    except PlanError as error:
        raise PlanError(f'{fields.source}: {error}') from error


def _place(fields: Fields, key: str) -> Point:
    forward, left, up = fields.numbers(key, 3)
    return forward, left, up


def _again(fields: Fields, key: str, value: object) -> Fields:
    """Put one value back, to be taken as another kind."""
    return Fields(fields.source, fields.name, {key: value})
