# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Postures in which the hands hold the box at a place, by inverse kinematics alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.least_squares import minimise
from lift_predictor.core.planning.technique import Technique, lowering, technique_range
from lift_predictor.core.sagittal.kinematics import REACHED, chain_positions
from lift_predictor.core.sagittal.parameters import JOINTS, LiftParameters
from lift_predictor.core.sagittal.person import Person
from lift_predictor.core.solvers.stop import StopFlag

GUESSES: Final[dict[str, tuple[float, ...]]] = {
    'semi-squat': (-20.0, 60.0, 10.0, 80.0, 70.0, 20.0),
    'squat': (-10.0, 60.0, 10.0, 110.0, 120.0, 30.0),
    'stoop': (-50.0, 80.0, 5.0, 70.0, 10.0, 0.0),
    'upright, elbow bent': (0.0, 20.0, 80.0, 5.0, 5.0, 0.0),
    'upright, arm forward': (0.0, 70.0, 20.0, 5.0, 5.0, 0.0),
}
"""Where the search for a posture begins, in the order of `JOINTS` [deg]: guesses."""
LOW_GUESSES: Final = ('semi-squat', 'squat', 'stoop')
HIGH_GUESSES: Final = ('upright, elbow bent', 'upright, arm forward')

CLOSE: Final = 1e-3
"""Depth of the box in the body, or distance of the centre of mass from the feet, that passes [m]:
the tolerance of the dense check."""
_POSTURE_WEIGHT: Final = 1e-3
"""Weight of the distance from the guess [m/rad]: it only breaks ties."""


@dataclass(frozen=True, eq=False)
class Posture:
    """One posture and what keeps it from being right; all zero: it is.

    Attributes
    ----------
    guess : str
        Key of `GUESSES`.
    q : array, shape (6,)
        [rad].
    distance, depth, unbalanced, off_technique : float
        Grip from its place, box in the body, centre of mass outside of the feet, hips from where
        the technique has them [m].
    """

    guess: str
    q: Array
    distance: float
    depth: float
    unbalanced: float
    off_technique: float

    @property
    def good(self) -> bool:
        """Whether the hands are there, the box clear and the person in balance."""
        rest = max(self.depth, self.unbalanced, self.off_technique)
        return self.distance <= REACHED and rest <= CLOSE

    @property
    def miss(self) -> float:
        """Sum of what is wrong [m]."""
        return self.distance + self.depth + self.unbalanced + self.off_technique


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
    reference = np.clip(np.radians(GUESSES[guess]), lower, upper)
    rear, front = parameters.support
    index = None if technique is None else technique_range(technique)

    def wrong(q: Array) -> Array:
        state = chain_positions(q, parameters)
        forward = state.centre_of_mass
        outside = np.maximum(np.maximum(rear - forward, forward - front), 0.0)
        style = np.zeros_like(outside)
        if index is not None:
            hips, c7 = lowering(q, person, parameters)
            low, high = ((1.0 - limit / 100.0) * c7 for limit in index)
            style = np.maximum(np.maximum(hips - low, high - hips), 0.0)
        return np.column_stack(
            (state.joints['hand'] - grip, np.minimum(state.gaps, 0.0), outside, style)
        )

    def pulled(q: Array) -> Array:
        return np.hstack((wrong(q), _POSTURE_WEIGHT * (q - reference)))

    # Once more without the pull to the guess, which keeps a fraction of a millimetre open.
    q = minimise(wrong, minimise(pulled, reference, lower, upper), lower, upper)
    (rest,) = wrong(q[None])
    return Posture(
        guess,
        q,
        distance=float(np.linalg.norm(rest[:2])),
        depth=float(-rest[2:-2].min(initial=0.0)),
        unbalanced=float(rest[-2]),
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
    raise UnreachableError(f'task.{field}: {_what_is_wrong(best, grip, person, technique)}')


def _what_is_wrong(best: Posture, grip: Array, person: Person, technique: Technique | None) -> str:
    problems = []
    if best.distance > REACHED:
        problems.append(f'the hands stay {1e3 * best.distance:.0f} mm away')
    if best.depth > CLOSE:
        problems.append(f'the box is {1e3 * best.depth:.0f} mm deep in the body')
    if best.unbalanced > CLOSE:
        problems.append(f'{1e3 * best.unbalanced:.0f} mm are missing to balance')
    if best.off_technique > CLOSE and technique is not None:
        problems.append(f'the hips are {1e3 * best.off_technique:.0f} mm from a {technique.name}')
    span = person.angle_upper - person.angle_lower
    at_limit = (best.q - person.angle_lower < 0.01 * span) | (
        person.angle_upper - best.q < 0.01 * span
    )
    joints = ', '.join(np.array(JOINTS)[at_limit]) or 'none'
    return (
        f'with the hands at forward {grip[0]:.3f} m, up {grip[1]:.3f} m, '
        f'{" and ".join(problems)}; joints at the end of their range: {joints}'
    )
