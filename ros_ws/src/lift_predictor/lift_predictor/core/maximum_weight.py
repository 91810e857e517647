# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The heaviest box a person could lift as recorded (chapter II, equations 2.11 and 2.23)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from human_model.exceptions import HumanModelError
from human_model.motion import Lift
from human_model.report import SolveReport, SolveStatus
from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.nearest_lift import REGULARISATION
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.sagittal.comparison import LiftComparison
from lift_predictor.core.sagittal.evaluation import total_effort
from lift_predictor.core.sagittal.grid import WEIGHT_OFFSET
from lift_predictor.core.sagittal.prediction import PredictedLift2D
from lift_predictor.core.sagittal.starts import make_starts
from lift_predictor.core.sagittal.task import Box, LiftTask2D, build_task
from lift_predictor.core.solvers.solver_run import Progress, Start

POSTURE_TOLERANCES: Final = (0.1, 0.15, 0.1)
"""Epsilon of equation 2.23 at 0, T/2 and T [rad]."""
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
        both = (self.effort, self.box)
        if not (min(both) >= 0.0 and math.isclose(sum(both), 1.0, abs_tol=1e-9)):
            raise TaskError(f'weighting {both}: two coefficients >= 0 with the sum 1 are needed')


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
    prediction : PredictedLift2D
        The lift and its report.
    weighting : Weighting
        Of the two criteria.
    mass, weight : float
        Of the box [kg], [N]; NaN without a solution.
    effort : float
        Dynamic effort [s].
    normalisation : Normalisation or None
        What the criteria were divided by; None if that lift was not found.
    binding : tuple of str
        Limits that keep the weight down, the strongest first.
    comparison : LiftComparison or None
        With the recorded lift.
    """

    prediction: PredictedLift2D
    weighting: Weighting
    mass: float
    weight: float
    effort: float
    normalisation: Normalisation | None
    binding: tuple[str, ...]
    comparison: LiftComparison | None

    @property
    def report(self) -> SolveReport:
        """Report of the solve; status 0: good data."""
        return self.prediction.report

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


def maximum_weight_task(
    predictor: LiftPredictor,
    lift: Lift,
    box: Box,
    tolerances: Sequence[float] = POSTURE_TOLERANCES,
) -> LiftTask2D:
    """Build the task of a recorded lift with the box's mass left open.

    Parameters
    ----------
    predictor : LiftPredictor
        With the subject configured.
    lift : Lift
        The recorded lift.
    box : Box
        What was lifted.
    tolerances : sequence of 3 floats
        Epsilon of equation 2.23 at 0, T/2 and T [rad].

    Raises
    ------
    TaskError, UnreachableError
        As `build_task`.
    """
    if predictor.person is None:
        raise TaskError('subject: none was configured before the first lift')
    return open_mass(build_task(predictor.person, lift, box, tolerances))


def open_mass(task: LiftTask2D) -> LiftTask2D:
    """Make the mass of a task's box a variable, between 0 and `LARGEST_WEIGHT`."""
    largest = LARGEST_WEIGHT / task.parameters.gravity
    return replace(task, bounds=replace(task.bounds, box_mass=np.array([0.0, largest])))


def predict_maximum_weight(
    predictor: LiftPredictor,
    lift: Lift,
    box: Box,
    weighting: Weighting | None = None,
    progress: Progress | None = None,
) -> MaximumWeight:
    """Find the largest weight with which a recorded lift can be done, and that lift.

    Parameters
    ----------
    predictor : LiftPredictor
        With the subject configured.
    lift : Lift
        The recorded lift: postures, hand places, time.
    box : Box
        Its size; its mass is where the search begins.
    weighting : Weighting, optional
        Of effort and weight; (0.15, 0.85) if omitted.
    progress : callable, optional
        Told after each start.

    Returns
    -------
    MaximumWeight
        Its report says whether there is a solution.
    """
    weighting = weighting or Weighting()
    try:
        task = maximum_weight_task(predictor, lift, box)
    except UnreachableError as error:
        return _refused(lift, box, weighting, SolveStatus.PREDICTOR_UNREACHABLE, str(error))
    except (TaskError, HumanModelError) as error:
        return _refused(lift, box, weighting, SolveStatus.PREDICTOR_BAD_INPUT, str(error))
    starts = make_starts(task, predictor.programme.grid.spline)
    return solve_maximum_weight(predictor, task, starts, weighting, progress=progress)


def solve_maximum_weight(
    predictor: LiftPredictor,
    task: LiftTask2D,
    starts: Sequence[Start],
    weighting: Weighting,
    heaviest: MaximumWeight | None = None,
    progress: Progress | None = None,
) -> MaximumWeight:
    """Solve a task whose mass is open; first for the weight alone, which gives the normalisation.

    Parameters
    ----------
    predictor : LiftPredictor
        Solves and checks.
    task : LiftTask2D
        Of `maximum_weight_task` or `open_mass`.
    starts : sequence of Start
        Initial guesses, the most promising first.
    weighting : Weighting
        Of effort and weight.
    heaviest : MaximumWeight, optional
        Result of `heaviest_box` for the same task, if it is known already; otherwise it is sought
        from the same starts, and then is the first of them.
    progress : callable, optional
        Told after each start.
    """
    if heaviest is None:
        heaviest = heaviest_box(predictor, task, starts, progress)
        if heaviest.report.ok:
            # The heaviest lift is a neighbour on the Pareto curve.
            starts = (heaviest.prediction.optima[0].as_start(), *starts)
    scale = heaviest.normalisation
    if scale is None or weighting == heaviest.weighting:
        return heaviest
    objective = (weighting.effort / scale.effort, weighting.box / scale.log_weight)
    weighted = _with_objective(task, objective)
    return _result(
        predictor, weighted, weighting, scale,
        *predictor.solve_and_compare(weighted, starts, progress),
    )  # fmt: skip


def heaviest_box(
    predictor: LiftPredictor,
    task: LiftTask2D,
    starts: Sequence[Start],
    progress: Progress | None = None,
) -> MaximumWeight:
    """Maximise the weight alone (w1 = 0, w2 = 1); the effort only breaks ties.

    Parameters are those of `solve_maximum_weight`.
    """
    weighting = Weighting(0.0, 1.0)
    pure = _with_objective(task, (REGULARISATION, 1.0))
    begun = [_with_mass(start, task.parameters.box_mass) for start in starts]
    prediction, comparison = predictor.solve_and_compare(pure, begun, progress)
    return _result(predictor, pure, weighting, None, prediction, comparison)


def _with_objective(task: LiftTask2D, objective: tuple[float, float]) -> LiftTask2D:
    return replace(task, parameters=replace(task.parameters, objective=np.array(objective)))


def _with_mass(start: Start, mass: float) -> Start:
    return start if start.box_mass > 0.0 else replace(start, box_mass=mass)


def _result(
    predictor: LiftPredictor,
    task: LiftTask2D,
    weighting: Weighting,
    scale: Normalisation | None,
    prediction: PredictedLift2D,
    comparison: LiftComparison | None,
) -> MaximumWeight:
    if not prediction.report.ok:
        nan = math.nan
        return MaximumWeight(prediction, weighting, nan, nan, nan, scale, (), None)
    best = prediction.optima[0]
    weight = best.box_mass * task.parameters.gravity
    programme = predictor.programme
    parameters = replace(task.parameters, box_mass=best.box_mass)
    effort = total_effort(programme.report, programme.grid, best.control, parameters)
    own = Normalisation(effort, abs(math.log(weight + WEIGHT_OFFSET)), best.box_mass)
    return MaximumWeight(
        prediction=prediction,
        weighting=weighting,
        mass=best.box_mass,
        weight=weight,
        effort=effort,
        normalisation=scale or own,
        binding=tuple(name for name, _ in best.active_constraints),
        comparison=comparison,
    )


def _refused(
    lift: Lift, box: Box, weighting: Weighting, status: SolveStatus, message: str
) -> MaximumWeight:
    report = SolveReport(status, message)
    failed = PredictedLift2D.failed(lift.lift_id, box.mass, lift.end - lift.start, report)
    return MaximumWeight(failed, weighting, math.nan, math.nan, math.nan, None, (), None)
