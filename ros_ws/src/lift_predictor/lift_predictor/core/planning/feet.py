# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Search of the place of the feet from which the lift takes least effort."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.planning.plan_task import FARTHEST, NEAREST, Feet, Placement, PlanTask
from lift_predictor.core.planning.planned_lift import PlannedLift
from lift_predictor.core.problem.model import LiftModel, T
from lift_predictor.core.problem.run import SolverRun, Start


@dataclass(frozen=True, eq=False)
class Trial:
    """A plan that was solved for feet at one place.

    Attributes
    ----------
    feet : Feet
        The place.
    value : float
        Effort [s], or minus the mass [kg] where it is maximised; infinite: no lift.
    message : str
        Of the solve.
    run : SolverRun
        Best run.
    planned : PlannedLift or None
        The whole lift, checked; None: one run at the nodes.
    """

    feet: Feet
    value: float
    message: str
    run: SolverRun
    planned: PlannedLift | None = None

    @property
    def start(self) -> Start | None:
        """Initial guess for neighbouring places; None: no solution."""
        start = replace(self.run.as_start('neighbour'), near=False)
        return start if np.isfinite(self.value) else None


class FeetTrials(Protocol[T]):
    """Planning as far as the search needs it."""

    @property
    def model(self) -> LiftModel[T]:
        """Model of the lifting person."""

    def trial(self, task: PlanTask, feet: Feet, neighbour: Trial | None) -> Trial:
        """Solve a plan fast to compare places of the feet, from the best place so far."""

    def report(self, stage: str, done: int, total: int, best: float) -> None:
        """Report the progress."""


def search_feet(planning: FeetTrials[T], task: PlanTask) -> tuple[Trial, tuple[Placement, ...]]:
    """Search the place of the feet: candidates, then steps from the best that become shorter.

    Each place is solved from the motion of the best place so far. It is a search for a good place
    near good candidates, not a proof.

    Raises
    ------
    UnreachableError
        From no place can the box be held at both ends; carries the last reason.
    """
    model = planning.model
    tried: dict[Feet, Placement] = {}
    best: Trial | None = None
    kept: Trial | None = None
    reason = ''
    first = model.first_feet(task)
    total = len(first) + model.feet_moves * len(model.feet_rounds())

    def attempt(feet: Feet) -> bool:
        """Try a place; return whether it is the best so far."""
        nonlocal best, kept, reason
        if feet in tried:
            return False
        better = False
        try:
            trial = planning.trial(task, feet, best)
            value, message = trial.value, trial.message
            if np.isfinite(value) and (best is None or value < best.value):
                best, better = trial, True
            kept = best or _nearer_to_feasible(kept, trial)
        except (UnreachableError, TaskError) as error:
            value, message = float('inf'), str(error)
            reason = message
        tried[feet] = Placement(feet, value, message)
        known = [p.value for p in tried.values() if np.isfinite(p.value)]
        least = min(known, default=float('nan'))
        planning.report('feet', len(tried), max(total, len(tried)), least)
        return better

    for feet in first:
        attempt(feet)
    for scale in model.feet_rounds():
        if best is None:
            break
        around = model.feet_around(task, best.feet, scale)
        if not model.probes:
            for feet in around:
                attempt(feet)
            continue
        while any(attempt(feet) for feet in around):
            around = model.feet_around(task, best.feet, scale)
    if kept is None:
        raise UnreachableError(
            f'task.feet: from none of {len(tried)} places between {NEAREST:g} and {FARTHEST:g} m '
            f'from the nearer place of the box can both be reached; from the last: {reason}'
        )
    return kept, tuple(sorted(tried.values(), key=lambda placement: placement.feet.forward))


def _nearer_to_feasible(kept: Trial | None, other: Trial) -> Trial:
    if kept is None:
        return other
    return min((kept, other), key=lambda trial: trial.run.solution.primal)
