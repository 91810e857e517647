# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Random persons and sagittal tasks on which the predictor is measured."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.exceptions import HumanModelError
from human_model.subject import Subject
from lift_predictor.core.exceptions import LiftPredictorError
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.sagittal.plan import build_plan
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.problem.model import Plan

MASS: Final = (3.0, 25.0)
START_HEIGHT: Final = (0.1, 0.7)
END_HEIGHT: Final = (0.7, 1.4)
STATURE: Final = (1.55, 1.95)
BODY_MASS: Final = (55.0, 110.0)
"""Ranges of the population: box [kg], centre of the box [m], stature [m], body mass [kg]."""

AGE: Final = 31.0
STRENGTH_Z: Final = 1.05
"""Age [years] and strength of the dissertation's subject, whose z-score was retrieved from his
maximum lift (sections 2.4 and 3.5)."""
BOX_SIZE: Final = (0.238, 0.305, 0.127)
"""Depth, width, height of the dissertation's box (section 4.3) [m]."""
LOW: Final = 0.25
FARTHEST: Final = 0.63
"""Heights below 0.25 m ask for 5 cm more distance; hands farther than 0.63 m from the ankles are
outside of the revised lifting equation (Waters 1994, NIOSH 94-110) [m]."""


def nearest(height: float, depth: float) -> float:
    """Horizontal distance of the hands from the ankles by the box's depth [m] (NIOSH 94-110)."""
    return (0.25 if height < LOW else 0.20) + 0.5 * depth


def random_case(rng: np.random.Generator, name: str = 'random') -> tuple[Subject, PlanTask]:
    """Draw one person and one task, feet given at the origin."""
    sex = 'male' if rng.random() < 0.5 else 'female'
    subject = Subject(
        'random', sex, rng.uniform(*BODY_MASS), rng.uniform(*STATURE), AGE, STRENGTH_Z
    )
    mass, low, high = (rng.uniform(*limits) for limits in (MASS, START_HEIGHT, END_HEIGHT))
    begin = nearest(low, BOX_SIZE[0])
    finish = rng.uniform(nearest(high, BOX_SIZE[0]), FARTHEST)
    task = PlanTask(
        name, float(mass), BOX_SIZE, (begin, 0.0, low), (finish, 0.0, high), feet=(0.0, 0.0)
    )
    return subject, task


def plan_random(
    rng: np.random.Generator, name: str = 'random'
) -> tuple[Subject, PlanTask, Plan[SagittalTask]]:
    """Draw until the places are within reach, in balance and clear of the body.

    Whether the person is strong enough is left to the solver.
    """
    while True:
        subject, task = random_case(rng, name)
        try:
            return subject, task, build_plan(Person.of(subject), task)
        except (LiftPredictorError, HumanModelError):
            continue
