# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Finds where to stand for a lift in space: place and heading of the feet of least effort."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.planning.feet import Placement
from lift_predictor.core.planning.plan_task import FARTHEST, NEAREST, PlanTask
from lift_predictor.core.planning.solve import Listener, PlanProgress, finite_best
from lift_predictor.core.planning.space.solve import Probe, probe_in_space
from lift_predictor.core.planning.space.task import Feet
from lift_predictor.core.predictor import LiftPredictor

MIDDLE: Final = 0.5 * (NEAREST + FARTHEST)
"""Distance of the nearer place in the first candidates [m]."""
STEP: Final = 0.08
TURN: Final = float(np.radians(20.0))
"""First steps of the search, forward and aside [m] and about the vertical [rad]: our choice."""
HALVINGS: Final = 2
"""How often the steps are halved round the best place: to 2 cm and 5 degrees."""
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
    """Tell whether the nearer place is at a distance of the lifting equation, and the heading."""
    if abs(feet.heading) > LARGEST_HEADING + 1e-9:
        return False
    away = [np.hypot(x - feet.forward, y - feet.left) for x, y, _ in (task.start, task.end)]
    nearer = min(away) - task.box_from_grip[0]
    return bool(NEAREST - 1e-4 <= nearer <= FARTHEST + 1e-4)


def place_feet_in_space(
    predictor: LiftPredictor, task: PlanTask, listener: Listener | None = None
) -> tuple[Probe, tuple[Placement, ...]]:
    """Search place and heading: candidates first, then steps from the best that become shorter.

    Each is solved from the motion of the best place so far, and only if that fails from a made-up
    start. It is a search for a good place near good candidates, not a proof.

    Raises
    ------
    UnreachableError
        From no place can the box be held at both ends; carries the last reason.
    """
    tried: dict[Feet, Placement] = {}
    best: Probe | None = None
    kept: Probe | None = None
    reason = ''
    first = candidates(task)
    total = len(first) + 6 * (HALVINGS + 1)

    def attempt(feet: Feet) -> bool:
        nonlocal best, kept, reason
        better = False
        if feet in tried or not allowed(feet, task):
            return False
        try:
            probe = probe_in_space(predictor, task, feet, best)
            value, message = probe.value, str(probe.run.solution.status)
            if np.isfinite(value) and (best is None or value < best.value):
                best, better = probe, True
            kept = best or _nearer_to_feasible(kept, probe)
        except (UnreachableError, TaskError) as error:
            value, message = float('inf'), str(error)
            reason = message
        tried[feet] = Placement(feet.forward, value, message, feet.left, feet.heading)
        if listener is not None:
            known = finite_best([placement.value for placement in tried.values()])
            listener(PlanProgress('feet', len(tried), max(total, len(tried)), known))
        return better

    for feet in first:
        attempt(feet)
    step, turn = STEP, TURN
    for _ in range(HALVINGS + 1):
        while best is not None and any(attempt(feet) for feet in _around(best, step, turn)):
            pass
        step, turn = 0.5 * step, 0.5 * turn
    if kept is None:
        raise UnreachableError(
            f'task.feet: from none of {len(tried)} places between {NEAREST:g} and {FARTHEST:g} m '
            f'from the nearer place of the box can both be reached; from the last: {reason}'
        )
    return kept, tuple(tried.values())


def _behind(place: Array, direction: Array, distance: float) -> Feet:
    x, y = place - distance * direction
    return Feet(float(x), float(y), float(np.arctan2(direction[1], direction[0])))


def _around(best: Probe, step: float, turn: float) -> list[Feet]:
    feet = best.feet
    c, s = np.cos(feet.heading), np.sin(feet.heading)
    moves = [(step, 0.0, 0.0), (0.0, step, 0.0), (0.0, 0.0, turn)]
    return [
        Feet(
            round(float(feet.forward + sign * (c * along - s * aside)), 4),
            round(float(feet.left + sign * (s * along + c * aside)), 4),
            round(float(feet.heading + sign * about), 4),
        )
        for along, aside, about in moves
        for sign in (1.0, -1.0)
    ]


def _nearer_to_feasible(kept: Probe | None, other: Probe) -> Probe:
    if kept is None:
        return other
    return min((kept, other), key=lambda probe: probe.run.solution.primal)
