# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Solves a plan in space for feet at one place: given mass or the largest, in a technique."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from lift_predictor.core.exceptions import PlanError
from lift_predictor.core.maximum_weight import Weighting
from lift_predictor.core.nearest_lift import NearestLift
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.solve import Listener, PlanProgress
from lift_predictor.core.planning.space.task import Feet, SpacePlan, place_plan
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.spatial.evaluation import lowering
from lift_predictor.core.spatial.feasibility import binding_limits, lighter_lift
from lift_predictor.core.spatial.maximum_weight import (
    for_weight_alone,
    maximum_weight,
    total_effort,
)
from lift_predictor.core.spatial.person import SpatialPerson
from lift_predictor.core.spatial.postures import GUESSES
from lift_predictor.core.spatial.prediction import PredictedLift3D, SpatialOptimum
from lift_predictor.core.spatial.predictor import SpatialPredictor
from lift_predictor.core.spatial.refine import as_start
from lift_predictor.core.spatial.starts import SpatialStart


@dataclass(frozen=True, eq=False)
class SolvedInSpace:
    """Answer of the spatial programme for feet at one place.

    Attributes
    ----------
    plan : SpacePlan
        What was solved.
    prediction : PredictedLift3D
        The lift; its report says whether there is one.
    effort : float
        First term of equation 3.9 [s]; NaN without a lift.
    index : float
        Stoop-Squat-Index of the first posture; NaN without a lift, or where C7 is not lowered.
    binding : tuple of str
        Limits the lift touches, the one that costs most first.
    value : float
        Effort [s], or minus the mass [kg] where the largest was asked for; infinite: no lift.
    """

    plan: SpacePlan
    prediction: PredictedLift3D
    effort: float
    index: float
    binding: tuple[str, ...]
    value: float


def solve_in_space(
    predictor: LiftPredictor,
    task: PlanTask,
    feet: Feet,
    weighting: Weighting,
    first: Sequence[SpatialStart] = (),
    n_starts: int | None = None,
    listener: Listener | None = None,
) -> SolvedInSpace:
    """Plan with the feet at a place.

    Parameters
    ----------
    predictor : LiftPredictor
        With the subject configured.
    task : PlanTask
        What is lifted.
    feet : Feet
        Where they stand.
    weighting : Weighting
        Of effort and weight, where the largest mass is asked for.
    first : sequence of SpatialStart
        Initial guesses tried before the made-up ones.
    n_starts : int, optional
        Made-up initial guesses at most; all if omitted.
    listener : callable, optional
        Told after each run.

    Raises
    ------
    PlanError
        No subject was configured.
    TaskError
        The box would have to be carried round the person.
    UnreachableError
        A place of the box is out of reach.
    """

    def tell(done: int, total: int, best: float) -> None:
        if listener is not None:
            listener(PlanProgress('lift', done, total, best))

    spatial, person = _configured(predictor)
    plan = place_plan(spatial, person, task, feet)
    guesses = GUESSES if n_starts is None else 1
    starts = (*first, *plan.starts(spatial, guesses)[:n_starts])
    if task.box_mass is None:
        prediction = maximum_weight(spatial, plan.task, starts, weighting, tell).prediction
    else:
        # Who limits the starts wants a lift, not the best one.
        hops = spatial.options.hops if n_starts is None else 0
        prediction = spatial.solve_task(plan.task, starts, tell, hops=hops)
    return _solved(spatial, plan, prediction)


@dataclass(frozen=True, eq=False)
class Probe:
    """A plan solved once at the nodes, to compare places of the feet.

    Attributes
    ----------
    feet : Feet
        Where they stand.
    run : SpatialOptimum
        What the solver found.
    value : float
        Effort [s], or minus the mass [kg] where the largest was asked for (without weighting);
        infinite: no lift.
    """

    feet: Feet
    run: SpatialOptimum
    value: float


def probe_in_space(
    predictor: LiftPredictor, task: PlanTask, feet: Feet, neighbour: Probe | None = None
) -> Probe:
    """Solve a plan once, fast.

    Parameters
    ----------
    predictor, task, feet
        As in `solve_in_space`.
    neighbour : Probe, optional
        From feet near by: its motion is the start, and only if that fails the first of the made-up
        ones.

    Raises
    ------
    TaskError, UnreachableError
        As in `solve_in_space`.
    """
    spatial, person = _configured(predictor)
    plan = place_plan(spatial, person, task, feet)
    if task.box_mass is None:
        plan = replace(plan, task=for_weight_alone(plan.task))
    run: SpatialOptimum | None = None
    if neighbour is not None:
        start = as_start(neighbour.run, spatial.grid)
        run = spatial.run(plan.task, start, neighbour.run.solution)
    if run is None or not run.converged:
        run = spatial.run(plan.task, plan.starts(spatial, guesses=1)[0])
    if not run.converged:
        return Probe(feet, run, float('inf'))
    mass = float(run.solution.x[-2])
    return Probe(feet, run, -mass if task.box_mass is None else run.solution.objective)


def _configured(predictor: LiftPredictor) -> tuple[SpatialPredictor, SpatialPerson]:
    spatial = predictor.spatial()
    if spatial.person is None:
        raise PlanError('subject: none was configured before the first plan')
    return spatial, spatial.person


def _solved(
    spatial: SpatialPredictor, plan: SpacePlan, prediction: PredictedLift3D
) -> SolvedInSpace:
    if not prediction.report.ok:
        nan = float('nan')
        return SolvedInSpace(plan, prediction, nan, nan, (), float('inf'))
    effort = total_effort(spatial, plan.task, prediction)
    mass_is_given = np.ptp(plan.task.bounds.box_mass) == 0.0
    value = effort if mass_is_given else -prediction.box_mass
    limits = binding_limits(plan.task, spatial.grid, prediction.optima[0].solution)
    return SolvedInSpace(
        plan,
        prediction,
        effort,
        first_index(spatial, plan, prediction),
        tuple(name for name, _ in limits),
        value,
    )


def first_index(spatial: SpatialPredictor, plan: SpacePlan, prediction: PredictedLift3D) -> float:
    """Stoop-Squat-Index of the first posture; NaN where C7 is not lowered."""
    hips, c7 = lowering(spatial.library, prediction.control[:1], plan.task.parameters)
    return 100.0 * (1.0 - float(hips[0] / c7[0])) if c7[0] > 0.0 else float('nan')


def lighter_in_space(
    predictor: LiftPredictor, task: PlanTask, feet: Feet
) -> NearestLift[PredictedLift3D] | None:
    """Find the plan's lift with the largest mass up to the one asked for; None: none."""
    spatial, person = _configured(predictor)
    plan = place_plan(spatial, person, task, feet)
    # What is too heavy to be held gives no start; empty hands do.
    empty = np.zeros(2)
    bounds = replace(plan.task.bounds, box_mass=empty)
    light = replace(plan, task=replace(plan.task, bounds=bounds))
    return lighter_lift(spatial.solve_task, plan.task, light.starts(spatial), spatial.grid)
