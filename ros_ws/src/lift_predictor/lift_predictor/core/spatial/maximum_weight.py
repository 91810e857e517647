# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The heaviest box a person could lift in space (chapter III, equation 3.9)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from lift_predictor.core.maximum_weight import LARGEST_WEIGHT, Normalisation, Weighting
from lift_predictor.core.nearest_lift import REGULARISATION
from lift_predictor.core.spatial.evaluation import evaluate, sample
from lift_predictor.core.spatial.grid import WEIGHT_OFFSET
from lift_predictor.core.spatial.multistart import Progress
from lift_predictor.core.spatial.prediction import PredictedLift3D
from lift_predictor.core.spatial.predictor import SpatialPredictor
from lift_predictor.core.spatial.starts import SpatialStart
from lift_predictor.core.spatial.task import SpatialTask

_DENSE: Final = 401
FAR: Final = 0.1
"""First barrier parameter of the starts that are to find other minima."""


@dataclass(frozen=True, eq=False)
class SpatialMaximum:
    """Result of one maximum-weight prediction; without a solution it holds the report only.

    Attributes
    ----------
    prediction : PredictedLift3D
        The lift and its report.
    weighting : Weighting
        Of effort and weight.
    mass, weight : float
        Of the box [kg], [N]; NaN without a solution.
    effort : float
        Dynamic effort [s].
    normalisation : Normalisation or None
        What the criteria were divided by; None if that lift was not found.
    """

    prediction: PredictedLift3D
    weighting: Weighting
    mass: float
    weight: float
    effort: float
    normalisation: Normalisation | None


def open_mass(task: SpatialTask) -> SpatialTask:
    """Make the mass of a task's box a variable, between 0 and `LARGEST_WEIGHT`."""
    largest = LARGEST_WEIGHT / task.parameters.gravity
    return replace(task, bounds=replace(task.bounds, box_mass=np.array([0.0, largest])))


def maximum_weight(
    predictor: SpatialPredictor,
    task: SpatialTask,
    starts: Sequence[SpatialStart],
    weighting: Weighting | None = None,
    progress: Progress | None = None,
) -> SpatialMaximum:
    """Find the largest weight with which a task can be done, and that lift.

    First for the weight alone, which gives the normalisation, then for the weighted sum.

    Parameters
    ----------
    predictor : SpatialPredictor
        Solves and checks.
    task : SpatialTask
        Of `open_mass`. Ground reaction windows (3.16) hold for the recorded weight and must be
        wide, or left out.
    starts : sequence of SpatialStart
        Initial guesses, the most promising first.
    weighting : Weighting, optional
        Of effort and weight; (0.15, 0.85) if omitted.
    progress : callable, optional
        Told after each run; what it raises ends the work there.
    """
    weighting = weighting or Weighting()
    pure = for_weight_alone(task)
    far = tuple(replace(start, name=f'{start.name}, far', barrier=FAR) for start in starts)
    heaviest = predictor.solve_task(pure, (*starts, *far), progress)
    first = _result(predictor, pure, Weighting(0.0, 1.0), heaviest, None)
    scale = first.normalisation
    if scale is None or weighting == first.weighting:
        return first
    weighted = _with_objective(
        task, (weighting.effort / scale.effort, weighting.box / scale.log_weight)
    )
    near = SpatialStart('heaviest box', heaviest.control, heaviest.box_mass, heaviest.duration)
    best = predictor.solve_task(weighted, (near, *far), progress, hops=predictor.options.hops)
    return _result(predictor, weighted, weighting, best, scale)


def total_effort(
    predictor: SpatialPredictor, task: SpatialTask, prediction: PredictedLift3D
) -> float:
    """First term of equation 3.9 [s]: integral of the squared normalised torques."""
    s = np.linspace(0.0, 1.0, _DENSE)
    motion = sample(predictor.grid, prediction.control, s, prediction.duration)
    loads = evaluate(predictor.library, *motion, prediction.box_mass, task.parameters)
    return float(np.trapezoid(loads.effort, s * prediction.duration))


def for_weight_alone(task: SpatialTask) -> SpatialTask:
    """Task with the largest weight as the only criterion but for a tie-break."""
    return _with_objective(task, (REGULARISATION, 1.0))


def _with_objective(task: SpatialTask, objective: tuple[float, float]) -> SpatialTask:
    return replace(task, parameters=replace(task.parameters, objective=np.array(objective)))


def _result(
    predictor: SpatialPredictor,
    task: SpatialTask,
    weighting: Weighting,
    prediction: PredictedLift3D,
    scale: Normalisation | None,
) -> SpatialMaximum:
    if not prediction.report.ok:
        return SpatialMaximum(prediction, weighting, math.nan, math.nan, math.nan, scale)
    weight = prediction.box_mass * task.parameters.gravity
    effort = total_effort(predictor, task, prediction)
    own = Normalisation(effort, abs(math.log(weight + WEIGHT_OFFSET)), prediction.box_mass)
    return SpatialMaximum(prediction, weighting, prediction.box_mass, weight, effort, scale or own)
