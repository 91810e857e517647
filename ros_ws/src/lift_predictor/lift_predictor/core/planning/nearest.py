# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The nearest feasible lift of a plan that cannot be done.

A plan has no recorded places to come back to. Instead the way leads to the standard location of
the revised NIOSH lifting equation, where its multipliers are 1 (Waters 1994, NIOSH 94-110): hands
0.75 m high, and before the ankles as near as the box allows, 0.20 m and half its depth.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from lift_predictor.core.nearest_lift import NearestLift, closer_lift
from lift_predictor.core.planning.plan_task import PlanTask, Point
from lift_predictor.core.sagittal.feasibility import missing_way
from lift_predictor.core.sagittal.prediction import PredictedLift2D

STANDARD_HEIGHT: Final = 0.75
STANDARD_DISTANCE: Final = 0.20
"""Of the hands over the floor and, beside half the depth of the box, before the ankles [m]."""

ENDS: Final = (('end',), ('start',), ('start', 'end'))
"""Places that are moved, in the order in which they are tried."""

PlanPrediction = Callable[[PlanTask], PredictedLift2D]


def nearest_plan(
    plan: PlanPrediction, task: PlanTask, failed: PredictedLift2D
) -> NearestLift[PredictedLift2D] | None:
    """Move the places of a task towards the standard location until it can be done.

    Parameters
    ----------
    plan : callable
        Plans a task.
    task : PlanTask
        That cannot be done.
    failed : PredictedLift2D
        What became of it.

    Returns
    -------
    NearestLift or None
        None: not even at the standard location.
    """
    for moved in ENDS:
        way = np.zeros((2, 2))
        for row, name in enumerate(('start', 'end')):
            if name in moved:
                asked, near = (np.array(p) for p in (getattr(task, name), standard(task, name)))
                way[row] = (asked - near)[[0, 2]]
        length = float(np.linalg.norm(way, axis=1).max())
        if length == 0.0:
            continue
        found = closer_lift(
            partial(_planned_on_the_way, plan, task, moved),
            failed,
            length,
            partial(missing_way, way),
        )
        if found is not None:
            return found
    return None


def standard(task: PlanTask, name: str) -> Point:
    """Centre of the box at the standard location; feet that are free can come as near as it needs.

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


def _planned_on_the_way(
    plan: PlanPrediction, task: PlanTask, moved: tuple[str, ...], share: float
) -> PredictedLift2D:
    return plan(_on_the_way(task, moved, share))


def _on_the_way(task: PlanTask, moved: tuple[str, ...], share: float) -> PlanTask:
    places = {'start': task.start, 'end': task.end}
    for name in moved:
        near, asked = np.array(standard(task, name)), np.array(getattr(task, name))
        x, y, z = near + share * (asked - near)
        places[name] = (float(x), float(y), float(z))
    return replace(task, start=places['start'], end=places['end'])
