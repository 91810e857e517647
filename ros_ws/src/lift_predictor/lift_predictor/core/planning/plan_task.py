# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A lifting task in numbers that can be measured with a tape: no recording."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.task import Point
from lift_predictor.core.exceptions import PlanError
from lift_predictor.core.planning.technique import FREE, technique

DEFAULT_DURATION: Final = 1.32
"""Time from start to end of the lift where none is given [s]: the optimal lifting time of the
source dissertation (section 3.5), the only one it publishes."""

UPRIGHT: Final = 'upright'

LATERAL_TOLERANCE: Final = 0.15
"""How far a place of the box may lie beside the sagittal plane, seen from the ankles [rad]: the
same 0.15 rad up to which a recorded lift counts as sagittal (epsilon of equation 4.8)."""

NEAREST: Final = 0.25
FARTHEST: Final = 0.63
"""Distances of the hands from the middle of the ankles between which free feet are placed, at the
nearer end of the lift [m]: the range of H in the revised NIOSH lifting equation (Waters 1993)."""

STANDARD_HEIGHT: Final = 0.75
STANDARD_DISTANCE: Final = 0.20
"""Standard location of the revised NIOSH lifting equation, where its multipliers are 1 (Waters
1994, NIOSH 94-110): height of the hands over the floor and, beside half the depth of the box,
distance before the ankles [m]."""

MOVED_ENDS: Final = (('end',), ('start',), ('start', 'end'))
"""Places that are moved to find the nearest feasible lift, in the order of the trials."""


@dataclass(frozen=True)
class Feet:
    """Place of the feet: parallel, below the hips, as in the sagittal model.

    Attributes
    ----------
    forward, left : float
        Middle of both ankles in the laboratory [m].
    heading : float
        Direction of the feet about the vertical, 0: forward, positive to the left [rad].
    """

    forward: float
    left: float
    heading: float = 0.0


@dataclass(frozen=True)
class Placement:
    """One place of the feet that was tried.

    Attributes
    ----------
    feet : Feet
        The place.
    value : float
        Effort [s], or minus the mass [kg] where it is maximised; infinite: no lift from there.
    message : str
        Of the solve, or the reason why there was none.
    """

    feet: Feet
    value: float
    message: str


@dataclass(frozen=True)
class PlanTask:
    """What is to be lifted, from where to where.

    The laboratory's axes are x forward (the person faces x), y left, z up, the floor at z = 0.

    Attributes
    ----------
    name : str
        Short name.
    box_mass : float or None
        [kg], 0: nothing is lifted; None: the largest that this person can lift.
    box_size : tuple of float
        Depth (forward), width (between the hands), height [m].
    start, end : tuple of float
        Centre of the box before and after the lift [m].
    feet : tuple of float or None
        Middle of both ankles (forward, left) [m]; None: placed where the lift takes least effort.
    duration : float
        Time of the lift [s].
    technique : str
        How the box is grasped, a name of `data/techniques.csv`: free, squat, semi_squat or stoop.
    end_posture : str
        free, or upright: near the posture that holds the box at its end and differs least from
        standing with bent elbows.
    box_from_grip : tuple of float
        Centre of the box minus middle of the hands (forward, up) [m]; the box stays level.

    Raises
    ------
    PlanError
        Naming field and value.
    """

    name: str
    box_mass: float | None
    box_size: Point
    start: Point
    end: Point
    feet: tuple[float, float] | None = None
    duration: float = DEFAULT_DURATION
    technique: str = FREE
    end_posture: str = FREE
    box_from_grip: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        """Check every field."""
        if not isinstance(self.name, str) or not self.name.strip():
            raise PlanError(f'task.name: a name is needed, got {self.name!r}')
        if self.box_mass is not None:
            mass = self._real('box_mass', self.box_mass)
            if mass < 0.0:
                raise PlanError(f'task.box_mass: {mass:g} kg is negative')
        for field, count in (('box_size', 3), ('start', 3), ('end', 3), ('box_from_grip', 2)):
            self._tuple(field, count)
        if self.feet is not None:
            self._tuple('feet', 2)
        if min(self.box_size) <= 0.0:
            raise PlanError(f'task.box_size: {self.box_size} m: every length must be above 0')
        for field in ('start', 'end'):
            height = getattr(self, field)[2]
            if height < 0.5 * self.box_size[2] - 1e-9:
                raise PlanError(
                    f'task.{field}: the centre of the box at {height:g} m puts its bottom '
                    f'{0.5 * self.box_size[2] - height:.3f} m under the floor'
                )
        if self._real('duration', self.duration) <= 0.0:
            raise PlanError(f'task.duration: {self.duration:g} s: a time above 0 is needed')
        technique(self.technique)
        if self.end_posture not in (FREE, UPRIGHT):
            raise PlanError(
                f'task.end_posture: {self.end_posture!r} is not one of {FREE}, {UPRIGHT}'
            )

    def _real(self, field: str, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float | np.floating):
            raise PlanError(f'task.{field}: a number is needed, got {value!r}')
        if not np.isfinite(value):
            raise PlanError(f'task.{field}: a finite number is needed, got {value}')
        return float(value)

    def _tuple(self, field: str, count: int) -> None:
        value = getattr(self, field)
        if not isinstance(value, list | tuple | np.ndarray) or len(value) != count:
            raise PlanError(f'task.{field}: {count} numbers are needed, got {value!r}')
        object.__setattr__(self, field, tuple(self._real(field, v) for v in value))

    @property
    def lateral(self) -> float:
        """How far the sagittal plane lies to the left of the laboratory's origin [m]."""
        return self.start[1] if self.feet is None else self.feet[1]

    @property
    def asymmetry(self) -> str:
        """Reason why the task does not fit the sagittal model; empty: it fits.

        Where the feet are free: of feet that face forward behind the start, as near as they may.
        """
        return self.asymmetry_from(self.nearer - NEAREST if self.feet is None else self.feet[0])

    def asymmetry_from(self, ankle: float) -> str:
        """Return the same for ankles at a place, forward [m].

        The angle is the asymmetry angle A of the revised NIOSH lifting equation.
        """
        places = (self.start, self.end)
        angle = max(abs(float(np.arctan2(y - self.lateral, x - ankle))) for x, y, _ in places)
        if angle <= LATERAL_TOLERANCE:
            return ''
        return (
            f'task.start, task.end: the box is up to {np.degrees(angle):.0f} deg out of the '
            f'sagittal plane of feet at forward {ankle:.3f} m, left {self.lateral:.3f} m; the '
            f'sagittal model allows {np.degrees(LATERAL_TOLERANCE):.0f} deg'
        )

    @property
    def nearer(self) -> float:
        """How far forward the hands are at the nearer place [m]."""
        return min(self.start[0], self.end[0]) - self.box_from_grip[0]
