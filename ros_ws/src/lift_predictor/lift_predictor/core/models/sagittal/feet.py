# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Places of the feet in the sagittal plane: distances from the box."""

from __future__ import annotations

from typing import Final

import numpy as np

from lift_predictor.core.planning.plan_task import FARTHEST, NEAREST, Feet, PlanTask

DISTANCES: Final = 5
"""Distances that are tried first, evenly spread."""
HALVINGS: Final = 3
"""Halvings of the spacing round the best one: to 1.2 cm."""


def first_feet(task: PlanTask) -> tuple[Feet, ...]:
    """Return the first places: even distances from the nearer place of the box."""
    distances = np.linspace(NEAREST, FARTHEST, DISTANCES)
    return tuple(_at(task, float(distance)) for distance in distances)


def rounds() -> tuple[float, ...]:
    """Spacings [m] of the rounds that follow."""
    spacing = (FARTHEST - NEAREST) / (DISTANCES - 1)
    return tuple(0.5**number * spacing for number in range(1, HALVINGS + 1))


def feet_around(task: PlanTask, feet: Feet, spacing: float) -> tuple[Feet, ...]:
    """Return the places one spacing nearer and farther, as far as they are allowed."""
    middle = task.nearer - feet.forward
    distances = (middle - spacing, middle + spacing)
    return tuple(_at(task, d) for d in distances if NEAREST <= d <= FARTHEST)


def _at(task: PlanTask, distance: float) -> Feet:
    return Feet(round(task.nearer - distance, 4), task.lateral)
