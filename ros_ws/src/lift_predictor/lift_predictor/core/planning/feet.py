# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Finds where to stand: the distance to the box from which the lift takes least effort."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.maximum_weight import Weighting
from lift_predictor.core.planning.plan_task import FARTHEST, NEAREST, PlanTask
from lift_predictor.core.planning.solve import (
    Listener,
    PlanProgress,
    SolvedPlan,
    finite_best,
    solve_plan,
)
from lift_predictor.core.predictor import LiftPredictor

DISTANCES: Final = 5
"""Distances that are tried first, evenly spread."""
HALVINGS: Final = 3
"""How often the spacing is halved round the best one: to 1.2 cm."""


@dataclass(frozen=True)
class Placement:
    """One place of the feet that was tried.

    Attributes
    ----------
    ankle : float
        Middle of the ankles, forward [m].
    value : float
        Effort [s], or minus the mass [kg] where it is maximised; infinite: no lift from there.
    message : str
        Of the solve, or why there was none.
    left : float
        Middle of the ankles, to the left [m].
    heading : float
        Direction of the feet, 0: forward [rad]; another one in space only.
    """

    ankle: float
    value: float
    message: str
    left: float = 0.0
    heading: float = 0.0


def place_feet(
    predictor: LiftPredictor,
    task: PlanTask,
    weighting: Weighting,
    listener: Listener | None = None,
) -> tuple[SolvedPlan, tuple[Placement, ...]]:
    """Search the place of the feet: even distances first, then closer and closer to the best.

    Every place is solved from one made-up start, and from the motion of the best place so far.

    Raises
    ------
    UnreachableError
        From no place can the box be held at both ends; carries the reason at the best distance.
    """
    near = task.nearer
    tried: dict[float, Placement] = {}
    best: SolvedPlan | None = None
    kept: SolvedPlan | None = None
    total = DISTANCES + 2 * HALVINGS
    reach_error: UnreachableError | None = None

    def attempt(distance: float) -> None:
        nonlocal best, kept, reach_error
        ankle = round(near - distance, 4)
        if ankle in tried:
            return
        try:
            first = () if best is None else (best.start(),)
            solved = solve_plan(predictor, task, ankle, 1, weighting, first)
            tried[ankle] = Placement(
                ankle, solved.value, solved.prediction.report.message, task.lateral
            )
            if np.isfinite(solved.value) and (best is None or solved.value < best.value):
                best = solved
            kept = best or solved
        except UnreachableError as error:
            reach_error = error
            tried[ankle] = Placement(ankle, float('inf'), str(error), task.lateral)
        if listener is not None:
            value = finite_best([p.value for p in tried.values()])
            listener(PlanProgress('feet', len(tried), total, value))

    for distance in np.linspace(NEAREST, FARTHEST, DISTANCES):
        attempt(float(distance))
    spacing = (FARTHEST - NEAREST) / (DISTANCES - 1)
    for _ in range(HALVINGS):
        if best is None:
            break
        spacing *= 0.5
        middle = near - float(best.plan.task.parameters.ankle[0])
        for distance in (middle - spacing, middle + spacing):
            if NEAREST <= distance <= FARTHEST:
                attempt(distance)
    if kept is None:
        raise UnreachableError(
            f'task.feet: from none of {len(tried)} places between {NEAREST:g} and {FARTHEST:g} m '
            f'behind the nearer place of the box can both be reached; from the last: {reach_error}'
        )
    return kept, tuple(sorted(tried.values(), key=lambda placement: placement.ankle))
