# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Postures in which the hands hold the box at a place, by inverse kinematics alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.least_squares import minimise

GUESSES: Final[dict[str, tuple[float, ...]]] = {
    'semi-squat': (-20.0, 60.0, 10.0, 80.0, 70.0, 20.0),
    'squat': (-10.0, 60.0, 10.0, 110.0, 120.0, 30.0),
    'stoop': (-50.0, 80.0, 5.0, 70.0, 10.0, 0.0),
    'upright, elbow bent': (0.0, 20.0, 80.0, 5.0, 5.0, 0.0),
    'upright, arm forward': (0.0, 70.0, 20.0, 5.0, 5.0, 0.0),
}
"""First postures of the search, in the order of the sagittal `JOINTS` [deg]: guesses."""
LOW_GUESSES: Final = ('semi-squat', 'squat', 'stoop')
HIGH_GUESSES: Final = ('upright, elbow bent', 'upright, arm forward')

REACHED: Final = 1e-4
"""Distance of the grip from its target that counts as reached [m]."""
CLOSE: Final = 1e-3
"""Depth of the box in the body, or distance of the centre of mass from the feet, that passes [m]:
the tolerance of the dense check."""
POSTURE_WEIGHT: Final = 1e-3
"""Weight of the distance from the guess [m/rad]: it only decides between equal postures."""


@dataclass(frozen=True, eq=False)
class Posture:
    """One posture and its errors; all zero: it holds the box, clear of it and in balance.

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
        """Sum of the errors [m]."""
        return self.distance + self.depth + self.unbalanced + self.off_technique

    def problems(self, depth: str, balance: str, technique: str) -> str:
        """Describe the errors; the words for depth, balance and technique are given."""
        words = (
            (self.distance > REACHED, f'the hands stay {1e3 * self.distance:.0f} mm away'),
            (self.depth > CLOSE, f'the box is {1e3 * self.depth:.0f} mm deep in {depth}'),
            (self.unbalanced > CLOSE, balance),
            (self.off_technique > CLOSE,
             f'the hips are {1e3 * self.off_technique:.0f} mm from a {technique}'),
        )  # fmt: skip
        return ' and '.join(word for wrong, word in words if wrong)


def nearest_posture(
    residuals: Callable[[Array], Array], guess: Array, lower: Array, upper: Array
) -> tuple[Array, Array]:
    """Find the posture nearest to a guess with the least residuals; return it with them.

    Parameters
    ----------
    residuals : callable
        Takes postures (k, n), returns errors (k, m) [m].
    guess : ndarray, shape (n,)
        Clipped to the bounds.
    lower, upper : ndarray, shape (n,)
        Bounds.
    """
    reference = np.clip(guess, lower, upper)

    def pulled(q: Array) -> Array:
        return np.hstack((residuals(q), POSTURE_WEIGHT * (q - reference)))

    # Once more without the pull to the guess, which keeps a fraction of a millimetre open.
    q = minimise(residuals, minimise(pulled, reference, lower, upper), lower, upper)
    return q, residuals(q[None])[0]
