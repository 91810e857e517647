# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Solves a plan for feet at one place: given mass or the largest, in the technique asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.maximum_weight import Weighting, open_mass, solve_maximum_weight
from lift_predictor.core.planning.build import Plan, build_plan
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.technique import stoop_squat_index, technique
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.sagittal.prediction import PredictedLift2D
from lift_predictor.core.sagittal.task import POSTURE_TOLERANCE
from lift_predictor.core.solvers.solver_run import Start

WINDOW_HALVINGS: Final = 4
"""How often the posture window is halved where the optimum leaves the technique's range; the
posture in its middle is inside."""


@dataclass(frozen=True)
class PlanProgress:
    """How far a plan is.

    Attributes
    ----------
    stage : str
        'feet' while their place is searched, then 'lift'.
    done, total : int
        Places, or runs of the optimiser.
    best : float
        Objective of the best run so far; NaN: none yet.
    """

    stage: str
    done: int
    total: int
    best: float


Listener = Callable[[PlanProgress], None]
"""Told after each run of the optimiser. What it raises (`CancelledError`) ends the work there."""


@dataclass(frozen=True, eq=False)
class SolvedPlan:
    """Answer of the solver for feet at one place.

    Attributes
    ----------
    plan : Plan
        What was solved.
    prediction : PredictedLift2D
        The lift; its report says whether there is one.
    index : float
        Stoop-Squat-Index of the first posture; NaN without a lift, or where C7 is not lowered.
    binding : tuple of str
        Limits the lift touches, the one that costs most first.
    value : float
        Effort [s], or minus the mass [kg] where the largest was asked for; infinite: no lift.
    """

    plan: Plan
    prediction: PredictedLift2D
    index: float
    binding: tuple[str, ...]
    value: float

    def start(self) -> Start:
        """Use the motion as an initial guess."""
        best = self.prediction.optima[0]
        return Start('neighbour', best.control, best.box_mass)


def solve_plan(
    predictor: LiftPredictor,
    task: PlanTask,
    ankle: float,
    n_starts: int,
    weighting: Weighting,
    first: Sequence[Start] = (),
    listener: Listener | None = None,
) -> SolvedPlan:
    """Plan with the ankles at a place.

    Parameters
    ----------
    predictor : LiftPredictor
        With the subject configured.
    task : PlanTask
        What is lifted.
    ankle : float
        Middle of the ankles, forward [m].
    n_starts : int
        Made-up initial guesses at most.
    weighting : Weighting
        Of effort and weight, where the largest mass is asked for.
    first : sequence of Start
        Initial guesses tried before the made-up ones.
    listener : callable, optional
        Told after each run.

    Raises
    ------
    TaskError
        No subject was configured, or the task is not sagittal.
    UnreachableError
        A place of the box is out of reach.
    CancelledError
        The predictor's stop flag was set.
    """
    if predictor.person is None:
        raise TaskError('subject: none was configured before the first plan')

    def tell(done: int, total: int, best: float) -> None:
        if listener is not None:
            listener(PlanProgress('lift', done, total, best))

    style = technique(task.technique)
    tolerance = POSTURE_TOLERANCE
    for _ in range(WINDOW_HALVINGS + 1):
        plan = build_plan(predictor.person, task, ankle, tolerance, predictor.stop)
        made = plan.starts(predictor.programme.grid.spline, n_starts, predictor.stop)
        starts = (*first, *made)
        if task.box_mass is None:
            heaviest = solve_maximum_weight(
                predictor, open_mass(plan.task), starts, weighting, progress=tell
            )
            prediction, value = heaviest.prediction, -heaviest.mass
        else:
            prediction = predictor.solve_task(plan.task, starts, tell)
            value = prediction.report.objective
        if not prediction.report.ok:
            return SolvedPlan(plan, prediction, float('nan'), (), float('inf'))
        best = prediction.optima[0]
        posture = best.control[:1]
        index = float(stoop_squat_index(posture, predictor.person, plan.task.parameters)[0])
        if style.holds(index):
            break
        tolerance *= 0.5
    else:
        raise TaskError(
            f'task.technique: the best lift grasps the box with a Stoop-Squat-Index of '
            f'{index:.0f}; {style.name} is {style.lower:g} to {style.upper:g}'
        )
    binding = tuple(dict.fromkeys(name for name, _ in best.active_constraints))
    return SolvedPlan(plan, prediction, index, binding, value)


def finite_best(values: Sequence[float]) -> float:
    """Least finite value; NaN if there is none."""
    finite = [value for value in values if np.isfinite(value)]
    return min(finite, default=float('nan'))
