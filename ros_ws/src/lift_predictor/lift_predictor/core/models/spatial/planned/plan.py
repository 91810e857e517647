# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a planned task and feet at a place to the numbers of the spatial problem."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.models.spatial.evaluation import evaluate
from lift_predictor.core.models.spatial.frame import StanceFrame
from lift_predictor.core.models.spatial.grid import SpatialGrid
from lift_predictor.core.models.spatial.parameters import DEPENDENT, SPLINED
from lift_predictor.core.models.spatial.person import SpatialPerson
from lift_predictor.core.models.spatial.planned.plan_postures import first_good
from lift_predictor.core.models.spatial.task import (
    KEY_JOINTS,
    PlacedBox,
    SpatialTask,
    place_task,
)
from lift_predictor.core.models.spatial.windows import near_posture
from lift_predictor.core.options import Windows
from lift_predictor.core.planning.plan_task import Feet, PlanTask
from lift_predictor.core.planning.postures import HIGH_GUESSES, LOW_GUESSES
from lift_predictor.core.planning.technique import FREE, Technique, technique
from lift_predictor.core.problem.model import Plan
from lift_predictor.core.solvers.library import NodeLibrary


def place_plan(
    library: NodeLibrary, grid: SpatialGrid, person: SpatialPerson, task: PlanTask, feet: Feet
) -> Plan[SpatialTask]:
    """Build the task of the NLP for feet at a place.

    The box faces the person at both ends. A technique is a range of the Stoop-Squat-Index of the
    first posture; like an upright end it also holds the key joints within 10 degrees (equation
    3.15) of the posture nearest to a guess. Otherwise postures are free between the joint limits.

    Parameters
    ----------
    library : NodeLibrary
        `assembly.spatial_library`.
    grid : SpatialGrid
        Sizes of the NLP.
    person : SpatialPerson
        Person.
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
    placed = _placed(grid, person, task, feet)
    style = technique(task.technique)
    if style.lower is not None and style.upper is not None:
        parts = np.array([1.0 - style.upper / 100.0, 1.0 - style.lower / 100.0])
        placed = replace(
            placed,
            parameters=replace(placed.parameters, technique=parts),
            bounds=replace(placed.bounds, technique=True),
        )
    ends = _ends(library, placed, style)
    for row, end, demand in ((0, 0, task.technique), (-1, 1, task.end_posture)):
        if demand != FREE:
            angles = _key_angles(library, placed, ends[end])
            when = ('start', 'end')[end]
            bounds = near_posture(placed.bounds, row, angles, Windows().posture_ends, when)
            placed = replace(placed, bounds=bounds)
    return Plan(feet, placed, (np.stack(ends),))


def _placed(grid: SpatialGrid, person: SpatialPerson, task: PlanTask, feet: Feet) -> SpatialTask:
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
        (mass, mass), task.box_size, task.box_size[1], centres - offset, turns,
        np.array([away, 0.0, up]),
    )  # fmt: skip
    duration = (task.duration, task.duration)
    return place_task(person, frame, box, duration, grid, task.name)


def _ends(library: NodeLibrary, task: SpatialTask, style: Technique) -> tuple[Array, Array]:
    """Postures at both ends; who cannot balance the box is too weak for it, not too short."""
    low, high = (*LOW_GUESSES, *HIGH_GUESSES), (*HIGH_GUESSES, *LOW_GUESSES)
    try:
        return (
            first_good('start', low, task, 0, library, style).q,
            first_good('end', high, task, 1, library).q,
        )
    except UnreachableError:
        if not task.bounds.box_mass[0] > 0.0:
            raise
    return _ends(library, task.with_mass(0.0, 0.0), style)


def _key_angles(library: NodeLibrary, task: SpatialTask, q: Array) -> dict[str, float]:
    still = np.zeros((1, len(q)))
    mass = float(task.bounds.box_mass[0])
    legs = evaluate(library, q[None], still, still, mass, task.parameters).angles[0]
    known = dict(zip((*SPLINED, *DEPENDENT), (*q, *legs), strict=True))
    return {name: float(known[name]) for name in KEY_JOINTS}
