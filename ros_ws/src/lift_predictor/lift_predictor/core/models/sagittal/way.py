# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Ways of the box in the sagittal plane, from easy places to those asked for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from human_model.task import Point
from lift_predictor.core.planning.plan_task import (
    MOVED_ENDS,
    STANDARD_DISTANCE,
    STANDARD_HEIGHT,
    PlanTask,
)


@dataclass(frozen=True)
class StraightWay:
    """Straight way in the sagittal plane; `near` and `asked` are places in the laboratory [m]."""

    near: Point
    asked: Point

    @property
    def length(self) -> float:
        """Length [m]."""
        return float(np.hypot(self.asked[0] - self.near[0], self.asked[2] - self.near[2]))

    def at(self, fraction: float) -> Point:
        """Return the place at a fraction of the way: 0 easy, 1 asked for."""
        near, asked = np.array(self.near), np.array(self.asked)
        x, y, z = near + fraction * (asked - near)
        return float(x), float(y), float(z)

    def missing(self, fraction: float) -> str:
        """Describe the rest of the way from a fraction on; empty: less than half a millimetre."""
        forward, up = ((fraction - 1.0) * (self.asked[axis] - self.near[axis]) for axis in (0, 2))
        return ' and '.join(
            f'{1e3 * abs(amount):.0f} mm {more if amount > 0.0 else less}'
            for amount, more, less in (
                (forward, 'farther forward', 'nearer'),
                (up, 'higher', 'lower'),
            )
            if abs(amount) >= 5e-4
        )


def standard(task: PlanTask, name: str) -> Point:
    """Centre of the box at the standard location of the revised NIOSH lifting equation.

    Free feet can come as near as it needs.

    Parameters
    ----------
    task : PlanTask
        With the box and the feet.
    name : str
        start or end.
    """
    x, y, _ = getattr(task, name)
    if task.feet is not None:
        x = task.feet[0] + STANDARD_DISTANCE + 0.5 * task.box_size[0] + task.box_from_grip[0]
    return (x, y, max(STANDARD_HEIGHT + task.box_from_grip[1], 0.5 * task.box_size[2]))


def standard_ways(task: PlanTask) -> Iterator[dict[str, StraightWay]]:
    """Yield the ways from the standard location to the places of a task, one place at first."""
    for moved in MOVED_ENDS:
        yield {name: StraightWay(standard(task, name), getattr(task, name)) for name in moved}
