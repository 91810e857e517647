# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Postures of the sagittal model that hold the box at a place, near several guesses."""

from __future__ import annotations

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.models.sagittal.kinematics import chain_positions
from lift_predictor.core.models.sagittal.lowering import lowering
from lift_predictor.core.models.sagittal.parameters import JOINTS, LiftParameters
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.planning.postures import GUESSES, Posture, nearest_posture
from lift_predictor.core.planning.technique import Technique, off_technique, technique_range
from lift_predictor.core.solvers.stop import StopFlag


def find_posture(
    guess: str,
    grip: Array,
    person: Person,
    parameters: LiftParameters,
    technique: Technique | None = None,
) -> Posture:
    """Find the posture nearest to a guess that holds the box, clear of it and in balance.

    Parameters
    ----------
    guess : str
        Key of `GUESSES`.
    grip : array, shape (2,)
        Middle of the hands (forward, up) [m].
    person, parameters
        Who, and feet and box.
    technique : Technique, optional
        Range of the Stoop-Squat-Index to be in.
    """
    lower, upper = person.angle_lower, person.angle_upper
    rear, front = parameters.support
    index = technique_range(technique)

    def errors(q: Array) -> Array:
        state = chain_positions(q, parameters)
        forward = state.centre_of_mass
        outside = np.maximum(np.maximum(rear - forward, forward - front), 0.0)
        style = np.zeros_like(outside)
        if index is not None:
            style = off_technique(*lowering(q, person, parameters), index)
        return np.column_stack(
            (
                state.joints['hand'] - grip,
                np.minimum(state.gaps, 0.0),
                np.minimum(state.hamstrings, 0.0),
                outside,
                style,
            )
        )

    q, rest = nearest_posture(errors, np.radians(GUESSES[guess]), lower, upper)
    return Posture(
        guess,
        q,
        distance=float(np.linalg.norm(rest[:2])),
        depth=float(-rest[2:-3].min(initial=0.0)),
        unbalanced=float(max(rest[-2], -rest[-3])),
        off_technique=float(rest[-1]),
    )


def find_postures(
    field: str,
    guesses: tuple[str, ...],
    grip: Array,
    person: Person,
    parameters: LiftParameters,
    technique: Technique | None = None,
    stop: StopFlag | None = None,
) -> tuple[Posture, ...]:
    """Find the good postures from several guesses; `stop` may end the work between two.

    Raises
    ------
    UnreachableError
        There is none: names field, place, what is missing and the joints at their limits.
    """
    found = []
    for guess in guesses:
        if stop is not None:
            stop.check()
        found.append(find_posture(guess, grip, person, parameters, technique))
    good = tuple(posture for posture in found if posture.good)
    if good:
        return good
    best = min(found, key=lambda posture: posture.miss)
    span = person.angle_upper - person.angle_lower
    at_limit = (best.q - person.angle_lower < 0.01 * span) | (
        person.angle_upper - best.q < 0.01 * span
    )
    joints = ', '.join(np.array(JOINTS)[at_limit]) or 'none'
    balance = f'{1e3 * best.unbalanced:.0f} mm are missing to balance'
    problems = best.problems('the body', balance, technique.name if technique else 'technique')
    raise UnreachableError(
        f'task.{field}: with the hands at forward {grip[0]:.3f} m, up {grip[1]:.3f} m, '
        f'{problems}; joints at the end of their range: {joints}'
    )
