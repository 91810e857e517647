# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Weight on the plates against the person's mass, watched whenever the person stands still."""

from dataclasses import dataclass

import numpy as np

from human_model.compiled_cache import njit
from human_model.constants import GRAVITY
from human_model.typing import Array
from motion_tracker.core.exceptions import ForcePlateError


@dataclass(frozen=True)
class MassCheck:
    """Comparison of the plates' weight in quiet standing with the masses as entered.

    Attributes
    ----------
    plate_mass : float
        Mean vertical force over standard gravity [kg].
    subject_mass : float
        Body mass as entered [kg].
    box_mass : float
        Mass of the box in the hands as entered [kg]; 0 while the hands are empty.
    tolerance : float
        Share of the masses entered that the plates may deviate.
    """

    plate_mass: float
    subject_mass: float
    box_mass: float
    tolerance: float

    @property
    def deviation(self) -> float:
        """Return (plates - entered) / entered."""
        return self.plate_mass / (self.subject_mass + self.box_mass) - 1.0

    @property
    def ok(self) -> bool:
        """Whether the plates agree with the masses."""
        return abs(self.deviation) <= self.tolerance

    def __str__(self) -> str:
        """One line for a log, with the fields and their values."""
        box = f' and task.box_mass: {self.box_mass:.1f} kg' if self.box_mass else ''
        return (
            f'force plates: {self.plate_mass:.1f} kg in quiet standing, subject.mass: '
            f'{self.subject_mass:.1f} kg{box}, deviation {100 * self.deviation:+.1f} %'
        )


class MassWatch:
    """Comparison of the plates with the masses in each stretch of quiet standing.

    Quiet is a stretch of `WINDOW` in which the force on the plates hardly changes and the body
    by its motion needs no more and no less than its weight: a slow squat can keep the force even
    for as long, but not without moving its mass.

    Parameters
    ----------
    subject_mass
        kg.
    tolerance
        Accepted relative deviation: 5 % (requirement of the project).

    Attributes
    ----------
    check : MassCheck or None
        Of the last quiet stretch; None before the first.
    """

    #: Length of quiet standing that is averaged [s].
    WINDOW = 0.5
    #: Largest standard deviation of the force, and deviation of the body's mean need from its
    #: weight, in quiet standing, as shares of the weight.
    QUIET = 0.02

    def __init__(self, subject_mass: float, tolerance: float) -> None:
        if not (subject_mass > 0 and tolerance > 0):
            raise ForcePlateError(
                f'mass watch: {subject_mass} kg and a tolerance of {tolerance} must be positive'
            )
        self.check: MassCheck | None = None
        self._mass = subject_mass
        self._tolerance = tolerance
        self._box_mass: float | None = None
        # Force and need of the latest samples, in a ring; how many of them are one stretch.
        self._recent = np.empty((0, 2))
        self._count = 0

    @property
    def agrees(self) -> bool:
        """Whether nothing speaks against the masses: no quiet stretch yet, or a good last one."""
        return self.check is None or self.check.ok

    def push(
        self, vertical: float, need: float, box_mass: float | None, rate: float
    ) -> MassCheck | None:
        """Take one sample; return the check when it is the first or its result changes.

        Parameters
        ----------
        vertical
            Total vertical force of the ground [N].
        need
            Vertical force that the motion of the body needs, weight included [N].
        box_mass
            Mass in the hands [kg]; None: not known, the sample is no part of a quiet stretch.
        rate
            Samples per second [Hz].
        """
        window = max(2, round(self.WINDOW * rate))
        if len(self._recent) != window:
            self._recent, self._count = np.empty((window, 2)), 0
        if box_mass is None or box_mass != self._box_mass:
            self._count = 0
            self._box_mass = box_mass
        if box_mass is None:
            return None
        self._recent[self._count % window] = vertical, need
        self._count += 1
        if self._count < window:
            return None
        force, deviation, needed = _steadiness(self._recent)
        weight = self._mass * GRAVITY
        if (
            force <= 0
            or deviation > self.QUIET * force
            or abs(needed - weight) > self.QUIET * weight
        ):
            return None
        # The next stretch shares no sample with this one.
        self._count = 0
        before = self.check
        self.check = MassCheck(force / GRAVITY, self._mass, box_mass, self._tolerance)
        return self.check if before is None or before.ok is not self.check.ok else None


@njit
def _steadiness(rows: Array) -> tuple[float, float, float]:
    """Mean and standard deviation of the first column (n, 2), and mean of the second."""
    force, need, square = 0.0, 0.0, 0.0
    for k in range(rows.shape[0]):
        force += rows[k, 0]
        need += rows[k, 1]
    force /= rows.shape[0]
    for k in range(rows.shape[0]):
        square += (rows[k, 0] - force) ** 2
    return force, np.sqrt(square / rows.shape[0]), need / rows.shape[0]
