# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Ways of the box in space, from easy places to those asked for.

As in the sagittal plane they begin at the standard location of the revised NIOSH lifting equation
(Waters 1994): hands 0.75 m high and as near as the box allows. The direction in which the box lies
is kept at first, and then turned to the front as well, where the equation's asymmetry multiplier
is 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from human_model.task import Point
from lift_predictor.core.planning.plan_task import (
    MOVED_ENDS,
    STANDARD_DISTANCE,
    STANDARD_HEIGHT,
    Feet,
    PlanTask,
)


@dataclass(frozen=True)
class TurnedWay:
    """From an easy place of the box to the one asked for, seen from between the ankles.

    Attributes
    ----------
    feet : Feet
        Place of the feet.
    near, asked : tuple of float
        Angle to the left [rad], distance, height [m].
    """

    feet: Feet
    near: Point
    asked: Point

    @property
    def _whole(self) -> list[float]:
        return [b - a for a, b in zip(self.near, self.asked, strict=True)]

    def at(self, fraction: float) -> Point:
        """Return the place (laboratory) at a fraction of the way: 0 easy, 1 asked for."""
        pairs = zip(self.near, self._whole, strict=True)
        angle, distance, up = (a + fraction * whole for a, whole in pairs)
        direction = self.feet.heading + angle
        return (
            self.feet.forward + distance * float(np.cos(direction)),
            self.feet.left + distance * float(np.sin(direction)),
            up,
        )

    @property
    def length(self) -> float:
        """Length of the way [m]; turns count by the arc."""
        turn, away, up = self._whole
        return float(np.hypot(max(self.asked[1], self.near[1]) * turn, np.hypot(away, up)))

    def missing(self, fraction: float) -> str:
        """Describe the rest of the way from a fraction on; empty: less than half a millimetre."""
        turn, away, up = ((fraction - 1.0) * whole for whole in self._whole)
        # A turn towards the front is the other way on the other side.
        towards_side = turn * np.sign(self.asked[0])
        words = [
            f'{abs(amount):.0f} {unit} {more if amount > 0.0 else less}'
            for amount, unit, more, less in (
                (1e3 * away, 'mm', 'farther away', 'nearer'),
                (1e3 * up, 'mm', 'higher', 'lower'),
                (np.degrees(towards_side), 'deg', 'more to the side', 'less to the side'),
            )
            if abs(amount) >= 0.5
        ]
        return ' and '.join(words)


def standard_ways(task: PlanTask, feet: Feet) -> Iterator[dict[str, TurnedWay]]:
    """Yield the ways from the standard location to the places of a task, one place at first."""
    for turned, moved in product((False, True), MOVED_ENDS):
        ways = {name: way_of(task, name, feet, turned) for name in moved}
        if not turned or any(way.asked[0] != 0.0 for way in ways.values()):
            yield ways


def way_of(task: PlanTask, name: str, feet: Feet, turned: bool) -> TurnedWay:
    """Return the way to one place, start or end; `turned`: from the front."""
    x, y, up = getattr(task, name)
    across, along = y - feet.left, x - feet.forward
    angle = float(np.arctan2(across, along)) - feet.heading
    angle = float(np.arctan2(np.sin(angle), np.cos(angle)))
    away, above = task.box_from_grip
    near = (
        0.0 if turned else angle,
        STANDARD_DISTANCE + 0.5 * task.box_size[0] + away,
        max(STANDARD_HEIGHT + above, 0.5 * task.box_size[2]),
    )
    return TurnedWay(feet, near, (angle, float(np.hypot(across, along)), up))
