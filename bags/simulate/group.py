# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated lifts of a simulated group, for studies of the predictor without recordings.

The group has the number, statures, masses and ages of the men of chapter II of the source
dissertation (Zaman 2022, section 2.4: mean and standard deviation; nothing else of them is
published). Nobody was measured.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Final

import numpy as np
from bags.simulate.balance import balanced_motion
from bags.simulate.body import Body
from bags.simulate.forces import simulate_forces
from bags.simulate.motion import MotionBuilder
from bags.simulate.tasks import Task, load_tasks

from human_model.motion import Lift
from human_model.report import SolveReport
from human_model.subject import Subject
from human_model.typing import Array

GROUP_SIZE: Final = 12
"""Men in the study of chapter II."""
STATURE: Final = (1.8064, 0.0515)
MASS: Final = (82.34, 10.45)
AGE: Final = (25.50, 7.22)
"""Mean and standard deviation, section 2.4 [m], [kg], [years]."""
AGE_RANGE: Final = (20.0, 50.0)
"""Ages of recruitment, section 2.4 [years]."""
SEED: Final = 2022
SAMPLE_RATE: Final = 100.0


def study_group(size: int = GROUP_SIZE, seed: int = SEED) -> tuple[Subject, ...]:
    """Draw a group of men; statures and masses have the published mean and deviation exactly.

    Stature and mass are drawn independently, as no correlation is published; ages outside the
    range of recruitment are drawn again.

    Parameters
    ----------
    size : int
        Number of men, at least 2.
    seed : int
        Of the draw.
    """
    rng = np.random.default_rng(seed)
    stature = _exactly(rng.normal(size=size), STATURE)
    mass = _exactly(rng.normal(size=size), MASS)
    ages: list[float] = []
    while len(ages) < size:
        age = rng.normal(*AGE)
        if AGE_RANGE[0] <= age <= AGE_RANGE[1]:
            ages.append(float(age))
    return tuple(
        Subject(
            pseudonym=f'simulated {k + 1}',
            sex='male',
            mass=round(float(mass[k]), 3),
            stature=round(float(stature[k]), 4),
            age=round(ages[k], 1),
        )
        for k in range(size)
    )


@cache
def lifting_task(name: str) -> Task:
    """Return one task of `tasks.yaml`; KeyError if there is none of that name."""
    return {task.name: task for task in load_tasks()[1]}[name]


def simulated_lift(subject: Subject, task: Task, seed: int | None = None) -> Lift:
    """Simulate the true motion and forces of a lift, from lift-off to its highest point.

    Parameters
    ----------
    subject : Subject
        Who lifts.
    task : Task
        What and where.
    seed : int, optional
        Of sway and timing, in place of the task's.
    """
    stage, _ = load_tasks()
    if seed is not None:
        task = replace(task, seed=seed)
    body = Body(stage, subject)
    motion = balanced_motion(MotionBuilder(stage, body), task)
    begin, end = motion.phases.lift_off, motion.phases.peak
    time = np.linspace(begin, end, round((end - begin) * SAMPLE_RATE) + 1)
    truth = simulate_forces(stage, body, motion, time)
    block = body.skeleton.body_motion(
        time, truth.position, truth.velocity, truth.acceleration,
        ground_force=truth.ground_force, centre_of_pressure=truth.centre_of_pressure,
        free_moment=truth.free_moment, hand_force=truth.hand_force, box_position=truth.box[:, :3],
    )  # fmt: skip
    name = f'{task.name} of {subject.pseudonym}'
    return Lift(
        name, 'measured', float(begin), float(end), task.box_mass, block,
        SolveReport(message='simulated, not measured'),
    )  # fmt: skip


def _exactly(draw: Array, target: tuple[float, float]) -> Array:
    """Move and stretch a draw to a mean and a (sample) standard deviation."""
    mean, deviation = target
    return np.asarray(mean + deviation * (draw - draw.mean()) / draw.std(ddof=1))
