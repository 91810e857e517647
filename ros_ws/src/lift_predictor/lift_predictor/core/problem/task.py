# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The task of one lift, as far as it does not depend on the model."""

from __future__ import annotations

from typing import Final, Protocol, Self

import numpy as np

from human_model.typing import Array

WEIGHT_OFFSET: Final = 10.0
"""Added to the box's weight in the logarithm of equations 2.11 and 3.9 [N]."""

SMOOTH_PEAK: Final = 10.0 / 3.0**0.5
ACCELERATION_ROOM: Final = 1.5
LEAST_ACCELERATION: Final = 4.0
"""Our choice [m/s^2]: the recorded lifts have 2 to 3."""
NO_BOX: Final = 1e3
"""Bound of the acceleration of the hands where nothing is lifted [m/s^2]."""


def largest_acceleration(places: Array, duration: float) -> float:
    """Return the bound of the box's acceleration in a lift [m/s^2].

    A movement from rest to rest along a straight way has a peak of `SMOOTH_PEAK` distance /
    duration^2 where its jerk is least (Flash and Hogan 1985 J Neurosci 5:1688). The way round the
    body is longer, and hands are not as smooth: `ACCELERATION_ROOM` times as much is allowed, and
    `LEAST_ACCELERATION` in any lift.

    Parameters
    ----------
    places : ndarray, shape (2, k)
        Of the box at start and end [m].
    duration : float
        [s].
    """
    smooth = SMOOTH_PEAK * float(np.linalg.norm(places[1] - places[0])) / duration**2
    return max(ACCELERATION_ROOM * smooth, LEAST_ACCELERATION)


class LiftTask(Protocol):
    """One lift to solve, in the numbers of a model."""

    @property
    def lift_id(self) -> str:
        """Name of the lift."""
        ...

    @property
    def start(self) -> float:
        """Start of the lift on the recording's clock [s]."""
        ...

    @property
    def notes(self) -> tuple[str, ...]:
        """Adaptations of the task, in words."""
        ...

    @property
    def is_recorded(self) -> bool:
        """Whether there is a recorded lift to compare with."""
        ...

    @property
    def gravity(self) -> float:
        """[m/s^2]."""
        ...

    @property
    def mass(self) -> tuple[float, float]:
        """Least and largest mass of the box [kg]; equal: given."""
        ...

    def with_mass(self, least: float, largest: float) -> Self:
        """Return the task with other bounds of the box's mass [kg]."""
        ...

    def with_objective(self, effort: float, weight: float) -> Self:
        """Return the task with other factors of effort and log-weight (equations 2.11, 3.9)."""
        ...
