# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Infeasible tasks: which limit breaks first, and the nearest lift that can be done.

A task can ask for too heavy a box or for places that are out of reach, balance or strength. Two
ways lead back, tried in this order: the same lift with the largest mass that can be lifted so (the
programme of the maximum weight, the given mass as its upper bound), and the same mass carried
between places on the way from where it was recorded to where it was asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.nearest_lift import REGULARISATION, NearestLift, lighter
from lift_predictor.core.sagittal.prediction import PredictedLift2D
from lift_predictor.core.sagittal.task import INSTANTS, Box, LiftTask2D
from lift_predictor.core.solvers.solver_run import Start

Solve = Callable[[LiftTask2D, Sequence[Start]], PredictedLift2D]


def largest_mass(
    solve: Solve, task: LiftTask2D, starts: Sequence[Start]
) -> PredictedLift2D | None:
    """Solve the same lift with the largest mass up to the task's.

    Parameters
    ----------
    solve : callable
        Solves a task and checks the solution.
    task : LiftTask2D
        Without a solution for its mass.
    starts : sequence of Start
        Initial guesses.

    Returns
    -------
    PredictedLift2D or None
        None: the mass is 0 or not given, and there is nothing to take away.
    """
    least, asked = task.bounds.box_mass
    if asked == 0.0 or least < asked:
        return None
    parameters = replace(task.parameters, objective=np.array([REGULARISATION, 1.0]))
    bounds = replace(task.bounds, box_mass=np.array([0.0, asked]))
    # Half the mass asked for is nearer to what is possible than all of it.
    begun = [replace(start, box_mass=0.5 * asked) for start in starts]
    return solve(replace(task, parameters=parameters, bounds=bounds), begun)


def as_nearest(found: PredictedLift2D, task: LiftTask2D) -> NearestLift[PredictedLift2D] | None:
    """Return what `largest_mass` found as the nearest lift.

    None: not even empty hands can move so, or all of the mass can be lifted.
    """
    limits = [name for name, _ in found.optima[0].active_constraints]
    return lighter(found, float(task.bounds.box_mass[1]), limits)


def way_to(task: LiftTask2D, box: Box) -> Array:
    """Return the way (2, 2) of the grip at start and end, recorded to asked for [m].

    Parameters
    ----------
    task : LiftTask2D
        With the recorded places.
    box : Box
        With the places asked for.
    """
    way = np.zeros((2, 2))
    for row, place in enumerate((box.start, box.end)):
        if place is not None:
            grip = task.plane.into(np.asarray(place, dtype=float)) - task.parameters.box_from_hand
            way[row] = grip - task.bounds.hand[row]
    return way


def missing_way(way: Array, share: float) -> str:
    """Say how far the places of a share of the way are from those asked for."""
    words = []
    for row, when in enumerate((INSTANTS[0], INSTANTS[-1])):
        forward, up = (share - 1.0) * way[row]
        parts = [
            f'{1e3 * abs(amount):.0f} mm {more if amount > 0.0 else less}'
            for amount, more, less in (
                (forward, 'farther forward', 'nearer'),
                (up, 'higher', 'lower'),
            )
            if abs(amount) >= 5e-4
        ]
        if parts:
            words.append(f'the {when} {" and ".join(parts)} than asked for')
    if not words:
        raise TaskError('the places asked for are those of the recorded lift')
    return ', '.join(words)
