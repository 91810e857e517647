# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The heaviest box a person could lift (equations 2.11, 2.23 and 3.9)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from human_model.report import SolveReport
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.problem.comparison import LiftComparison
from lift_predictor.core.problem.model import T
from lift_predictor.core.problem.nearest_lift import REGULARISATION
from lift_predictor.core.problem.prediction import Prediction
from lift_predictor.core.problem.run import Progress, Start
from lift_predictor.core.problem.task import WEIGHT_OFFSET
from lift_predictor.core.problem.task_solver import TaskSolver

LARGEST_WEIGHT: Final = 1000.0
"""Upper bound of the box's weight (section 2.3) [N]."""


@dataclass(frozen=True)
class Weighting:
    """Weighting coefficients w1 and w2 of equation 2.11; the default is the best of chapter II.

    Raises
    ------
    TaskError
        A negative coefficient, or a sum that is not 1.
    """

    effort: float = 0.15
    box: float = 0.85

    def __post_init__(self) -> None:
        """Refuse coefficients that do not fit."""
        both = (self.effort, self.box)
        if not (min(both) >= 0.0 and math.isclose(sum(both), 1.0, abs_tol=1e-9)):
            raise TaskError(f'weighting {both}: two coefficients >= 0 with the sum 1 are needed')


WEIGHT_ALONE: Final = Weighting(0.0, 1.0)


@dataclass(frozen=True)
class Normalisation:
    """Largest absolute values of both criteria, reached where only the weight counts.

    Attributes
    ----------
    effort : float
        Dynamic effort there [s].
    log_weight : float
        log(W + 10) there, W in N.
    mass : float
        Largest mass of the box there [kg].
    """

    effort: float
    log_weight: float
    mass: float


@dataclass(frozen=True, eq=False)
class MaximumWeight:
    """Result of one maximum-weight prediction; without a solution it holds the report only.

    Attributes
    ----------
    prediction : Prediction
        The lift, its report, the limits that keep the weight down, the comparison.
    weighting : Weighting
        Of the two criteria.
    weight : float
        Of the box [N]; NaN without a solution.
    normalisation : Normalisation or None
        Divisors of the criteria; None if that lift was not found.
    """

    prediction: Prediction
    weighting: Weighting
    weight: float = math.nan
    normalisation: Normalisation | None = None

    @property
    def report(self) -> SolveReport:
        """Report of the solve; status 0: good data."""
        return self.prediction.report

    @property
    def mass(self) -> float:
        """Mass of the box [kg]; NaN without a solution."""
        return self.prediction.box_mass if self.report.ok else math.nan

    @property
    def effort(self) -> float:
        """Dynamic effort [s]; NaN without a solution."""
        return self.prediction.effort

    @property
    def active_constraints(self) -> tuple[str, ...]:
        """Limits that keep the weight down, the strongest first."""
        return self.prediction.active_constraints

    @property
    def comparison(self) -> LiftComparison | None:
        """Comparison with the recorded lift, where there is one."""
        return self.prediction.comparison

    @property
    def criteria(self) -> tuple[float, float]:
        """Normalised effort, and normalised negative logarithm of the weight (figure 2.4)."""
        if self.normalisation is None or not self.report.ok:
            return math.nan, math.nan
        log_weight = math.log(self.weight + WEIGHT_OFFSET)
        return (
            self.effort / self.normalisation.effort,
            -log_weight / self.normalisation.log_weight,
        )


def open_mass(task: T) -> T:
    """Make the mass of a task's box a variable, between 0 and `LARGEST_WEIGHT`."""
    return task.with_mass(0.0, LARGEST_WEIGHT / task.gravity)


def maximum_weight(
    solver: TaskSolver[T],
    task: T,
    starts: Sequence[Start],
    weighting: Weighting | None = None,
    heaviest: MaximumWeight | None = None,
    progress: Progress | None = None,
) -> MaximumWeight:
    """Find the largest weight with which a task is feasible, and that lift.

    First for the weight alone, which gives the normalisation, then for the weighted sum.

    Parameters
    ----------
    solver : TaskSolver
        Solves and checks.
    task : LiftTask
        Of `open_mass` or `LiftModel.maximum_weight_task`.
    starts : sequence of Start
        Initial guesses, the most promising first.
    weighting : Weighting, optional
        Of effort and weight; (0.15, 0.85) if omitted.
    heaviest : MaximumWeight, optional
        Result of `heaviest_box` for the same task, if it is known already. Otherwise it is
        determined from the same starts, and is then the first start of the weighted problem.
    progress : callable, optional
        Called after each run.
    """
    weighting = weighting or Weighting()
    near: tuple[Start, ...] = ()
    if heaviest is None:
        heaviest = heaviest_box(solver, task, starts, progress)
        if heaviest.report.ok:
            # The heaviest lift is a neighbour on the Pareto curve.
            near = (heaviest.prediction.runs[0].as_start('heaviest box'),)
    scale = heaviest.normalisation
    if scale is None or weighting == heaviest.weighting:
        return heaviest
    weighted = task.with_objective(
        weighting.effort / scale.effort, weighting.box / scale.log_weight
    )
    begun = (*near, *solver.model.weighted_starts(task, starts))
    hops = solver.model.method.basin_hops
    best = solver.solve(weighted, begun, progress, basin_hops=hops)
    return _result(task, best, weighting, scale)


def heaviest_box(
    solver: TaskSolver[T], task: T, starts: Sequence[Start], progress: Progress | None = None
) -> MaximumWeight:
    """Maximise the weight alone (w1 = 0, w2 = 1); the effort only decides between equal weights.

    Parameters are those of `maximum_weight`.
    """
    begun = solver.model.heaviest_starts(task, starts)
    found = solver.solve(task.with_objective(REGULARISATION, 1.0), begun, progress)
    return _result(task, found, WEIGHT_ALONE, None)


def _result(
    task: T, prediction: Prediction, weighting: Weighting, scale: Normalisation | None
) -> MaximumWeight:
    if not prediction.report.ok:
        return MaximumWeight(prediction, weighting, normalisation=scale)
    weight = prediction.box_mass * task.gravity
    log_weight = abs(math.log(weight + WEIGHT_OFFSET))
    own = Normalisation(prediction.effort, log_weight, prediction.box_mass)
    return MaximumWeight(prediction, weighting, weight, scale or own)
