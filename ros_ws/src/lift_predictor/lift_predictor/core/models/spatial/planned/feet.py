# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Places of the feet in space: first candidates, and steps of place and heading."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.planning.plan_task import FARTHEST, NEAREST, Feet, PlanTask

MIDDLE: Final = 0.5 * (NEAREST + FARTHEST)
"""Distance of the nearer place in the first candidates [m]."""
STEP: Final = 0.08
TURN: Final = float(np.radians(20.0))
"""First steps of the search, forward and aside [m] and about the vertical [rad]: our choice."""
HALVINGS: Final = 2
"""Halvings of the steps round the best place: to 2 cm and 5 degrees."""
LARGEST_HEADING: Final = 0.5 * float(np.pi)
"""The person faces forward, turned by a right angle at most [rad]: what stands behind the places
of the box is not known."""


def candidates(task: PlanTask) -> tuple[Feet, ...]:
    """Return places to begin with, the plainest first.

    Facing forward behind the nearer place, behind the start, and behind the end; then, where the
    places lie apart, on the line through both (a lift in a vertical plane) and across it half way.
    """
    start, end = (np.array(place[:2]) for place in (task.start, task.end))
    nearer = min(start[0], end[0])
    found = [
        Feet(nearer - MIDDLE, 0.5 * (start[1] + end[1])),
        Feet(start[0] - MIDDLE, start[1]),
        Feet(end[0] - MIDDLE, end[1]),
    ]
    apart = float(np.linalg.norm(end - start))
    if apart > STEP:
        along = (end - start) / apart
        # Both directions of each, as far as the person faces forward.
        for sign, nearest in ((1.0, start), (-1.0, end)):
            found.append(_behind(nearest, sign * along, MIDDLE))
        across = np.array([-along[1], along[0]])
        away = max(np.sqrt(max(MIDDLE**2 - 0.25 * apart**2, 0.0)), NEAREST)
        for sign in (1.0, -1.0):
            found.append(_behind(0.5 * (start + end), sign * across, away))
    kept: dict[Feet, None] = {}
    for feet in found:
        rounded = Feet(*(round(float(v), 4) for v in (feet.forward, feet.left, feet.heading)))
        if allowed(rounded, task):
            kept[rounded] = None
    return tuple(kept)


def allowed(feet: Feet, task: PlanTask) -> bool:
    """Whether the nearer place is at a distance of the lifting equation, and the heading."""
    if abs(feet.heading) > LARGEST_HEADING + 1e-9:
        return False
    away = [np.hypot(x - feet.forward, y - feet.left) for x, y, _ in (task.start, task.end)]
    nearer = min(away) - task.box_from_grip[0]
    return bool(NEAREST - 1e-4 <= nearer <= FARTHEST + 1e-4)


def _behind(place: Array, direction: Array, distance: float) -> Feet:
    x, y = place - distance * direction
    return Feet(float(x), float(y), float(np.arctan2(direction[1], direction[0])))


def around(task: PlanTask, feet: Feet, scale: float) -> tuple[Feet, ...]:
    """Return the allowed places one step from the best, whose steps are scaled."""
    step, turn = scale * STEP, scale * TURN
    c, s = np.cos(feet.heading), np.sin(feet.heading)
    moves = [(step, 0.0, 0.0), (0.0, step, 0.0), (0.0, 0.0, turn)]
    found = [
        Feet(
            round(float(feet.forward + sign * (c * along - s * aside)), 4),
            round(float(feet.left + sign * (s * along + c * aside)), 4),
            round(float(feet.heading + sign * about), 4),
        )
        for along, aside, about in moves
        for sign in (1.0, -1.0)
    ]
    return tuple(place for place in found if allowed(place, task))
