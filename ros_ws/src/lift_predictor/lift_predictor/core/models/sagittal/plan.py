# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a planned task and a person to the numbers of the sagittal problem."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import PlanError
from lift_predictor.core.models.sagittal.grid import LiftBounds
from lift_predictor.core.models.sagittal.parameters import N_JOINTS, LiftParameters
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.sagittal.plan_postures import find_postures
from lift_predictor.core.models.sagittal.plane import SagittalPlane
from lift_predictor.core.models.sagittal.task import SagittalTask, lowest_grip
from lift_predictor.core.options import POSTURE_TOLERANCE
from lift_predictor.core.planning.plan_task import Feet, PlanTask
from lift_predictor.core.planning.postures import HIGH_GUESSES, LOW_GUESSES, Posture
from lift_predictor.core.planning.technique import FREE, technique
from lift_predictor.core.problem.model import Plan
from lift_predictor.core.problem.task import largest_acceleration
from lift_predictor.core.solvers.stop import StopFlag

SAME_POSTURE: Final = 0.02
"""Largest difference of joint angles up to which two postures are one [rad]."""


def build_plan(
    person: Person,
    task: PlanTask,
    feet: Feet | None = None,
    tolerance: float = POSTURE_TOLERANCE,
    stop: StopFlag | None = None,
) -> Plan[SagittalTask]:
    """Build the task of the NLP for feet at a given place.

    Parameters
    ----------
    person : Person
        Person.
    task : PlanTask
        What is lifted.
    feet : Feet, optional
        Place of the ankles; default: `task.feet`.
    tolerance : float
        Epsilon of equation 4.8 [rad], about the first posture found where a technique or an
        upright end is asked for. Otherwise the postures are free between the joint limits.
    stop : StopFlag, optional
        Ends the work before the next posture is sought (`CancelledError`).

    Raises
    ------
    PlanError
        The feet are free and no place is given, or the task is asymmetric.
    UnreachableError
        A place of the box is out of reach, or only out of balance, or only inside the body.
    """
    if feet is None:
        if task.feet is None:
            raise PlanError('task.feet: free, but no place was chosen for them')
        feet = Feet(*task.feet)
    if reason := task.asymmetry_from(feet.forward):
        raise PlanError(reason)
    parameters = plan_parameters(person, task, feet.forward)
    hand = _grips(task)
    style = technique(task.technique)
    guesses = (*LOW_GUESSES, *HIGH_GUESSES)
    first = find_postures('start', guesses, hand[0], person, parameters, style, stop)
    guesses = (*HIGH_GUESSES, *LOW_GUESSES)
    last = find_postures('end', guesses, hand[1], person, parameters, stop=stop)
    pairs = _pairs(first, last)
    free = np.full((3, N_JOINTS), np.inf)
    low, high = -free, free.copy()
    for row, end, demand in ((0, 0, task.technique), (2, 1, task.end_posture)):
        if demand != FREE:
            window = pairs[0][end]
            low[row] = np.maximum(window - tolerance, person.angle_lower)
            high[row] = np.minimum(window + tolerance, person.angle_upper)
            pairs = tuple(np.where(np.arange(2)[:, None] == end, window, pair) for pair in pairs)
    pairs = _distinct(pairs)
    mass = 0.0 if task.box_mass is None else task.box_mass
    bounds = LiftBounds(
        person.angle_lower, person.angle_upper, low, high, hand, np.array([mass, mass])
    )
    plane = SagittalPlane(0.0, task.lateral)
    built = SagittalTask(task.name, 0.0, person, plane, None, parameters, bounds, pairs[0], ())
    return Plan(feet, built, pairs)


def plan_parameters(person: Person, task: PlanTask, ankle: float) -> LiftParameters:
    """Numbers of the task for feet with the ankles at a place, forward [m]; the floor is at 0."""
    neutral = person.neutral
    edges = [neutral[name][0] - neutral['ankle_r'][0] for name in ('heel_r', 'toe_r')]
    return LiftParameters(
        body=person.body,
        strength_lower=person.strength_lower,
        strength_upper=person.strength_upper,
        circle=person.circle,
        hip_range=person.hip_range,
        ankle=np.array([ankle, person.ankle_height]),
        support=ankle + np.array(edges),
        ground_height=0.0,
        gravity=person.gravity,
        duration=task.duration,
        box_mass=0.0 if task.box_mass is None else task.box_mass,
        box_half=0.5 * np.array([task.box_size[0], task.box_size[2]]),
        box_acceleration=largest_acceleration(_grips(task), task.duration),
        box_from_hand=np.array(task.box_from_grip),
        lowest_grip=lowest_grip(_grips(task)),
    )


def _grips(task: PlanTask) -> Array:
    """Grip at start and end, shape (2, 2), forward and up [m]."""
    forward, up = task.box_from_grip
    return np.array([(x - forward, z - up) for x, _, z in (task.start, task.end)])


def _pairs(first: tuple[Posture, ...], last: tuple[Posture, ...]) -> tuple[Array, ...]:
    """Combine end postures so that each occurs, without all combinations."""
    n = max(len(first), len(last))
    pairs = [np.stack((first[i % len(first)].q, last[i % len(last)].q)) for i in range(n)]
    return _distinct(tuple(pairs))


def _distinct(pairs: tuple[Array, ...]) -> tuple[Array, ...]:
    kept: list[Array] = []
    for pair in pairs:
        if all(np.abs(pair - other).max() > SAME_POSTURE for other in kept):
            kept.append(pair)
    return tuple(kept)
