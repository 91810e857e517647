# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The task of one lift, as far as it does not depend on the model."""

from __future__ import annotations

from typing import Final, Protocol, Self

WEIGHT_OFFSET: Final = 10.0
"""Added to the box's weight in the logarithm of equations 2.11 and 3.9 [N]."""


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
