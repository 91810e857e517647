# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a planned task and feet at a place to the spatial programme's numbers and starts."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.postures import HIGH_GUESSES, LOW_GUESSES
from lift_predictor.core.planning.space.postures import first_good
from lift_predictor.core.planning.technique import FREE, Technique, technique
from lift_predictor.core.spatial.evaluation import evaluate
from lift_predictor.core.spatial.frame import StanceFrame
from lift_predictor.core.spatial.maximum_weight import open_mass
from lift_predictor.core.spatial.parameters import DEPENDENT, SPLINED
from lift_predictor.core.spatial.person import SpatialPerson
from lift_predictor.core.spatial.postures import GUESSES, PostureFinder
from lift_predictor.core.spatial.predictor import SpatialPredictor
from lift_predictor.core.spatial.starts import SpatialStart, through
from lift_predictor.core.spatial.task import (
    KEY_JOINTS,
    PlacedBox,
    SpatialTask,
    Windows,
    place_task,
)
from lift_predictor.core.spatial.windows import near_posture


@dataclass(frozen=True)
class Feet:
    """Where the feet stand: parallel, below the hips, as in the sagittal model.

    Attributes
    ----------
    forward, left : float
        Middle of both ankles in the laboratory [m].
    heading : float
        Direction of the feet about the vertical, 0: forward, positive to the left [rad].
    """

    forward: float
    left: float
    heading: float = 0.0


@dataclass(frozen=True, eq=False)
class SpacePlan:
    """A task ready to be solved in space.

    Attributes
    ----------
    feet : Feet
        Where they stand.
    task : SpatialTask
        Numbers and demands.
    ends : tuple of array, shape (26,)
        Postures that hold the box at start and end, near those in the windows.
    """

    feet: Feet
    task: SpatialTask
    ends: tuple[Array, Array]

    def starts(
        self, spatial: SpatialPredictor, guesses: int = GUESSES
    ) -> tuple[SpatialStart, ...]:
        """Return initial guesses: by least effort at rest, if the box can be held so, and by ends.

        Where the person is too weak to hold the box, the second alone is left to begin with. The
        postures at rest are searched from so many guesses.
        """
        mass = float(self.task.bounds.box_mass[0])
        first, last = self.ends
        own = through(self.task, spatial.grid, (first, None, last), 'between near postures', mass)
        try:
            found = PostureFinder(spatial.library).starts(self.task, spatial.grid, guesses)
        except UnreachableError:
            return (own,)
        return (*found, own)


def place_plan(
    spatial: SpatialPredictor, person: SpatialPerson, task: PlanTask, feet: Feet
) -> SpacePlan:
    """Build the programme's task for feet at a place.

    The box faces the person at both ends. A technique is a range of the Stoop-Squat-Index of the
    first posture; like an upright end it also holds the key joints within 10 degrees (equation
    3.15) of the posture nearest to a guess. Otherwise postures are free between the joint limits.

    Parameters
    ----------
    spatial : SpatialPredictor
        Of the same person.
    person : SpatialPerson
        Who lifts.
    task : PlanTask
        What is lifted.
    feet : Feet
        Where they stand.

    Raises
    ------
    UnreachableError
        A place of the box is out of reach of empty hands, or only out of balance, or only inside
        the body.
    TaskError
        The box would have to be carried round the person.
    """
    placed = _placed(spatial, person, task, feet)
    style = technique(task.technique)
    if style.lower is not None and style.upper is not None:
        parts = np.array([1.0 - style.upper / 100.0, 1.0 - style.lower / 100.0])
        placed = replace(
            placed,
            parameters=replace(placed.parameters, technique=parts),
            bounds=replace(placed.bounds, technique=True),
        )
    ends = _ends(spatial, placed, style)
    for row, end, demand in ((0, 0, task.technique), (-1, 1, task.end_posture)):
        if demand != FREE:
            angles = _key_angles(spatial, placed, ends[end])
            when = ('start', 'end')[end]
            bounds = near_posture(placed.bounds, row, angles, Windows().posture_ends, when)
            placed = replace(placed, bounds=bounds)
    return SpacePlan(feet, placed if task.box_mass is not None else open_mass(placed), ends)


def _placed(
    spatial: SpatialPredictor, person: SpatialPerson, task: PlanTask, feet: Feet
) -> SpatialTask:
    half, height = float(person.pelvis[0]), person.ankle_height
    frame = StanceFrame(
        feet.heading,
        np.array([feet.forward, feet.left, 0.0]),
        np.array([[0.0, -half, height], [0.0, half, height]]),
        np.zeros(2),
    )
    centres = frame.into(np.array([task.start, task.end]))
    turns = np.arctan2(centres[:, 1], centres[:, 0])
    away, up = task.box_from_grip
    offset = np.stack((away * np.cos(turns), away * np.sin(turns), np.full(2, up)), axis=1)
    mass = 0.0 if task.box_mass is None else task.box_mass
    box = PlacedBox(
        (mass, mass), task.box_size[0], task.box_size[1], centres - offset, turns,
        np.array([away, 0.0, up]),
    )  # fmt: skip
    duration = (task.duration, task.duration)
    return place_task(person, frame, box, duration, spatial.grid, task.name)


def _ends(spatial: SpatialPredictor, task: SpatialTask, style: Technique) -> tuple[Array, Array]:
    """Postures at both ends; who cannot balance the box is too weak for it, not too short."""
    low, high = (*LOW_GUESSES, *HIGH_GUESSES), (*HIGH_GUESSES, *LOW_GUESSES)
    library = spatial.library
    try:
        return (
            first_good('start', low, task, 0, library, style).q,
            first_good('end', high, task, 1, library).q,
        )
    except UnreachableError:
        if not task.bounds.box_mass[0] > 0.0:
            raise
    empty = replace(task, bounds=replace(task.bounds, box_mass=np.zeros(2)))
    return _ends(spatial, empty, style)


def _key_angles(spatial: SpatialPredictor, task: SpatialTask, q: Array) -> dict[str, float]:
    still = np.zeros((1, len(q)))
    mass = float(task.bounds.box_mass[0])
    legs = evaluate(spatial.library, q[None], still, still, mass, task.parameters).angles[0]
    known = dict(zip((*SPLINED, *DEPENDENT), (*q, *legs), strict=True))
    return {name: float(known[name]) for name in KEY_JOINTS}
