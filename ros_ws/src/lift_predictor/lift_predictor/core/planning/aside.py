# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Plans with a box at the side: the task of the spatial programme, without a recording."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lift_predictor.core.exceptions import PlanError
from lift_predictor.core.maximum_weight import Weighting
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.solve import Listener, PlanProgress
from lift_predictor.core.planning.technique import FREE
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.spatial.frame import StanceFrame
from lift_predictor.core.spatial.maximum_weight import maximum_weight, open_mass, total_effort
from lift_predictor.core.spatial.person import SpatialPerson
from lift_predictor.core.spatial.postures import PostureFinder
from lift_predictor.core.spatial.prediction import PredictedLift3D
from lift_predictor.core.spatial.task import PlacedBox, SpatialTask, place_task


@dataclass(frozen=True, eq=False)
class SolvedAside:
    """Answer of the spatial programme.

    Attributes
    ----------
    prediction : PredictedLift3D
        The lift; its report says whether there is one.
    effort : float
        First term of equation 3.9 [s]; NaN without a lift.
    """

    prediction: PredictedLift3D
    effort: float


def solve_aside(
    predictor: LiftPredictor,
    task: PlanTask,
    weighting: Weighting,
    listener: Listener | None = None,
) -> SolvedAside:
    """Plan a lift to or from the side.

    The feet are parallel below the hips, as in the sagittal model; the box faces the person at
    both ends. Postures are free between the joint limits.

    Parameters
    ----------
    predictor : LiftPredictor
        With the subject configured.
    task : PlanTask
        With given feet.
    weighting : Weighting
        Of effort and weight, where the largest mass is asked for.
    listener : callable, optional
        Told after each run where the mass is given.

    Raises
    ------
    PlanError
        A technique or an upright end is asked for, which only sagittal plans know.
    UnreachableError
        The box cannot be held at one of its places.
    """
    for name in ('technique', 'end_posture'):
        demand = getattr(task, name)
        if demand != FREE:
            raise PlanError(
                f'task.{name}: {demand!r} is known for lifts in the sagittal plane only, and the '
                f'box is up to {np.degrees(task.asymmetry(_feet(task)[0])):.0f} deg beside it'
            )

    def tell(done: int, total: int, best: float) -> None:
        if listener is not None:
            listener(PlanProgress('lift', done, total, best))

    spatial = predictor.spatial()
    if spatial.person is None:
        raise PlanError('subject: none was configured before the first plan')
    placed = spatial_task(spatial.person, task, predictor)
    if task.box_mass is None:
        placed = open_mass(placed)
    starts = PostureFinder(spatial.library).starts(placed, spatial.grid)
    if task.box_mass is None:
        heaviest = maximum_weight(spatial, placed, starts, weighting)
        return SolvedAside(heaviest.prediction, heaviest.effort)
    prediction = spatial.solve_task(placed, starts, tell)
    effort = float('nan')
    if prediction.report.ok:
        effort = total_effort(spatial, placed, prediction)
    return SolvedAside(prediction, effort)


def spatial_task(person: SpatialPerson, task: PlanTask, predictor: LiftPredictor) -> SpatialTask:
    """Task of the spatial programme for feet that are given."""
    forward, left = _feet(task)
    half, height = float(person.pelvis[0]), person.ankle_height
    frame = StanceFrame(
        0.0,
        np.array([forward, left, 0.0]),
        np.array([[0.0, -half, height], [0.0, half, height]]),
        np.zeros(2),
    )
    centres = np.array([task.start, task.end]) - frame.origin
    turns = np.arctan2(centres[:, 1], centres[:, 0])
    away, up = task.box_from_grip
    offset = np.stack((away * np.cos(turns), away * np.sin(turns), np.full(2, up)), axis=1)
    mass = 0.0 if task.box_mass is None else task.box_mass
    box = PlacedBox(
        (mass, mass), task.box_size[0], task.box_size[1], centres - offset, turns,
        np.array([away, 0.0, up]),
    )  # fmt: skip
    duration = (task.duration, task.duration)
    return place_task(person, frame, box, duration, predictor.spatial().grid, task.name)


def _feet(task: PlanTask) -> tuple[float, float]:
    if task.feet is None:
        raise PlanError('task.feet: for a box at the side the feet must be given')
    return task.feet
