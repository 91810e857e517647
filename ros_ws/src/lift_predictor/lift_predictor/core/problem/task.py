# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The task of one lift, as far as it does not depend on the model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol, Self

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError

WEIGHT_OFFSET: Final = 10.0
"""Added to the box's weight in the logarithm of equations 2.11 and 3.9 [N]."""


@dataclass(frozen=True)
class Box:
    """The box of a recorded lift.

    Attributes
    ----------
    mass : float
        [kg]; 0: nothing is lifted.
    depth : float
        Extent forward [m] (twice r2 of equation 4.5).
    start, end : ndarray, shape (3,), or None
        Centre before and after the lift in the laboratory [m]; None: as recorded.
    """

    mass: float
    depth: float = 0.0
    start: Array | None = None
    end: Array | None = None

    def __post_init__(self) -> None:
        """Check every field."""
        if not (np.isfinite(self.mass) and self.mass >= 0.0):
            raise TaskError(f'box.mass = {self.mass} kg: a mass of at least 0 is needed')
        if not (np.isfinite(self.depth) and self.depth >= 0.0):
            raise TaskError(f'box.depth = {self.depth} m: a length of at least 0 is needed')
        for name in ('start', 'end'):
            place = getattr(self, name)
            if place is not None and not np.all(np.isfinite(place)):
                raise TaskError(f'box.{name} = {np.asarray(place).tolist()}: not finite')


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
