# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a task and a person to the sagittal programme's numbers and starts."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.bspline import RestToRestSpline
from lift_predictor.core.exceptions import PlanError
from lift_predictor.core.planning.plan_task import LATERAL_TOLERANCE, PlanTask
from lift_predictor.core.planning.postures import HIGH_GUESSES, LOW_GUESSES, Posture, find_postures
from lift_predictor.core.planning.technique import FREE, technique
from lift_predictor.core.sagittal.grid import LiftBounds
from lift_predictor.core.sagittal.parameters import N_JOINTS, LiftParameters
from lift_predictor.core.sagittal.person import Person
from lift_predictor.core.sagittal.plane import SagittalPlane
from lift_predictor.core.sagittal.starts import make_starts
from lift_predictor.core.sagittal.task import POSTURE_TOLERANCE, LiftTask2D, lowest_grip
from lift_predictor.core.solvers.solver_run import Start
from lift_predictor.core.solvers.stop import StopFlag

SAME_POSTURE: Final = 0.02
"""Largest difference of joint angles up to which two postures are one [rad]."""


@dataclass(frozen=True, eq=False)
class Plan:
    """A task ready to be solved.

    Attributes
    ----------
    task : LiftTask2D
        Numbers and demands; `ends` is the first pair of end postures.
    pairs : tuple of array, shape (2, 6)
        Pairs of end postures to start from [rad].
    """

    task: LiftTask2D
    pairs: tuple[Array, ...]

    def starts(
        self, spline: RestToRestSpline, limit: int | None = None, stop: StopFlag | None = None
    ) -> tuple[Start, ...]:
        """Return initial guesses, at most `limit`; `stop` may end the work in between.

        For each pair of end postures there is a smooth step and an arc clear of the body; first
        come the steps and arcs of the first pair, then those of the next.
        """
        starts: list[Start] = []
        for number, ends in enumerate(self.pairs, 1):
            if limit is not None and len(starts) >= limit:
                break
            if stop is not None:
                stop.check()
            made = make_starts(replace(self.task, ends=ends), spline)
            starts += [replace(start, name=f'{start.name} {number}') for start in made]
        return tuple(starts[:limit])


def build_plan(
    person: Person,
    task: PlanTask,
    ankle: float | None = None,
    tolerance: float = POSTURE_TOLERANCE,
    stop: StopFlag | None = None,
) -> Plan:
    """Build the programme's task for feet at a given place.

    Parameters
    ----------
    person : Person
        Who lifts.
    task : PlanTask
        What is lifted.
    ankle : float, optional
        Middle of the ankles, forward [m]; default: `task.feet`.
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
    if ankle is None:
        if task.feet is None:
            raise PlanError('task.feet: free, but no place was chosen for them')
        ankle = task.feet[0]
    angle = task.asymmetry(ankle)
    if angle > LATERAL_TOLERANCE:
        raise PlanError(
            f'task.start, task.end: the box is up to {np.degrees(angle):.0f} deg out of the '
            f'sagittal plane of feet at forward {ankle:.3f} m, left {task.lateral:.3f} m; the '
            f'sagittal model allows {np.degrees(LATERAL_TOLERANCE):.0f} deg'
        )
    parameters = plan_parameters(person, task, ankle)
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
    built = LiftTask2D(task.name, 0.0, person, plane, None, parameters, bounds, pairs[0], ())
    return Plan(built, pairs)


def plan_parameters(person: Person, task: PlanTask, ankle: float) -> LiftParameters:
    """Numbers of the task for feet with the ankles at a place, forward [m]; the floor is at 0."""
    neutral = person.neutral
    edges = [neutral[name][0] - neutral['ankle_r'][0] for name in ('heel_r', 'toe_r')]
    return LiftParameters(
        body=person.body,
        strength_lower=person.strength_lower,
        strength_upper=person.strength_upper,
        circle=person.circle,
        ankle=np.array([ankle, person.ankle_height]),
        support=ankle + np.array(edges),
        ground_height=0.0,
        gravity=person.gravity,
        duration=task.duration,
        box_mass=0.0 if task.box_mass is None else task.box_mass,
        box_radius=0.5 * task.box_size[0],
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
