# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The nearest feasible lift of a plan in space that cannot be done.

As in the plane the way leads to the standard location of the revised NIOSH lifting equation
(Waters 1994): hands 0.75 m high and as near as the box allows. The direction in which the box lies
is kept if that is enough; if not, it is turned to the front as well, where the equation's
asymmetry multiplier is 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from lift_predictor.core.nearest_lift import NearestLift, closer_lift
from lift_predictor.core.planning.nearest import ENDS, STANDARD_DISTANCE, STANDARD_HEIGHT
from lift_predictor.core.planning.plan_task import PlanTask, Point
from lift_predictor.core.planning.space.task import Feet
from lift_predictor.core.spatial.prediction import PredictedLift3D


@dataclass(frozen=True)
class Way:
    """From an easy place of the box to the one asked for, seen from between the ankles.

    Attributes
    ----------
    near, asked : tuple of float
        Angle to the left [rad], distance, height [m].
    """

    near: Point
    asked: Point

    @property
    def _whole(self) -> list[float]:
        return [b - a for a, b in zip(self.near, self.asked, strict=True)]

    def at(self, share: float, feet: Feet) -> Point:
        """Return the place (laboratory) at a share of the way: 0 easy, 1 asked for."""
        pairs = zip(self.near, self._whole, strict=True)
        angle, distance, up = (a + share * whole for a, whole in pairs)
        direction = feet.heading + angle
        return (
            feet.forward + distance * float(np.cos(direction)),
            feet.left + distance * float(np.sin(direction)),
            up,
        )

    @property
    def length(self) -> float:
        """Length of the way [m]; turns count by the arc."""
        turn, away, up = self._whole
        return float(np.hypot(max(self.asked[1], self.near[1]) * turn, np.hypot(away, up)))

    def missing(self, share: float) -> str:
        """Say how far the place at a share of the way is from the one asked for."""
        turn, away, up = ((share - 1.0) * whole for whole in self._whole)
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


def nearest_in_space(
    plan: Callable[[PlanTask], PredictedLift3D],
    task: PlanTask,
    feet: Feet,
    failed: PredictedLift3D,
) -> NearestLift[PredictedLift3D] | None:
    """Move the places of a task towards the standard location until it can be done.

    Parameters
    ----------
    plan : callable
        Plans a task with the feet where they are.
    task : PlanTask
        That cannot be done.
    feet : Feet
        Where they stand.
    failed : PredictedLift3D
        What became of it.

    Returns
    -------
    NearestLift or None
        None: not even at the standard location.
    """
    for turned, moved in product((False, True), ENDS):
        ways = {name: way_of(task, name, feet, turned) for name in moved}
        if turned and all(way.asked[0] == 0.0 for way in ways.values()):
            continue
        reach = max(way.length for way in ways.values())
        if reach == 0.0:
            continue

        def attempt(share: float, ways: dict[str, Way] = ways) -> PredictedLift3D:
            there = {name: way.at(share, feet) for name, way in ways.items()}
            start, end = (there.get(name, getattr(task, name)) for name in ('start', 'end'))
            return plan(replace(task, start=start, end=end))

        def change(share: float, ways: dict[str, Way] = ways) -> str:
            parts = [(name, way.missing(share)) for name, way in ways.items()]
            words = [f'the {name} {missing} than asked for' for name, missing in parts if missing]
            return ', '.join(words) or 'the same places to half a millimetre'

        found = closer_lift(attempt, failed, reach, change)
        if found is not None:
            return found
    return None


def way_of(task: PlanTask, name: str, feet: Feet, turned: bool) -> Way:
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
    return Way(near, (angle, float(np.hypot(across, along)), up))
