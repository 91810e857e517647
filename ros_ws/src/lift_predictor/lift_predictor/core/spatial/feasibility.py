# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Limits that hold a lift in space back, and the heaviest that can be done instead."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from lift_predictor.core.nearest_lift import REGULARISATION, NearestLift, lighter
from lift_predictor.core.solvers.solution import Solution
from lift_predictor.core.solvers.solver_run import ACTIVE_MULTIPLIER
from lift_predictor.core.spatial.grid import (
    HAND_ROWS,
    LIMITED,
    NODE_ROWS,
    SpatialBounds,
    SpatialGrid,
    plain_bounds,
    row_slice,
)
from lift_predictor.core.spatial.parameters import DEPENDENT
from lift_predictor.core.spatial.prediction import PredictedLift3D
from lift_predictor.core.spatial.starts import SpatialStart
from lift_predictor.core.spatial.task import SpatialTask

Solve = Callable[[SpatialTask, Sequence[SpatialStart]], PredictedLift3D]


def binding_limits(
    task: SpatialTask, grid: SpatialGrid, solution: Solution
) -> tuple[tuple[str, float], ...]:
    """Inequalities with a multiplier above `ACTIVE_MULTIPLIER`, in the order of its size.

    Rows are scaled to the range of their limit. Where hands and box have to be (3.11 to 3.13) is
    left out: that is the task, not a limit. Where a recording or a technique narrows a limit, the
    name says that it is a window.

    Parameters
    ----------
    task : SpatialTask
        That was solved.
    grid : SpatialGrid
        Sizes of the programme.
    solution : Solution
        Of the task, or of the task with margins.
    """
    low, high = task.bounds.rows()
    size = np.where(low < high, np.abs(solution.lam_g), 0.0)
    node = size[: grid.n_nodes * len(NODE_ROWS)].reshape(grid.n_nodes, -1)
    node[:, row_slice(HAND_ROWS)] = 0.0
    person = task.person
    limits = plain_bounds(grid.n_nodes, person.limits(DEPENDENT), person.limits(LIMITED))
    plain = replace(
        task.bounds, node_lower=limits[0], node_upper=limits[1], angle_lower=limits[2],
        angle_upper=limits[3],
    ).rows()  # fmt: skip
    narrowed = np.where(solution.lam_g > 0.0, high < plain[1], low > plain[0])
    order = np.argsort(-size, kind='stable')[: np.count_nonzero(size > ACTIVE_MULTIPLIER)]
    return tuple(
        (f'{"window on " if narrowed[i] else ""}{grid.row_names[i]}', float(size[i]))
        for i in order
    )


def lighter_lift(
    solve: Solve, task: SpatialTask, starts: Sequence[SpatialStart], grid: SpatialGrid
) -> NearestLift[PredictedLift3D] | None:
    """Find the same lift with the largest mass up to the task's.

    Parameters
    ----------
    solve : callable
        Solves and checks a task.
    task : SpatialTask
        Without a solution for its mass.
    starts : sequence of SpatialStart
        Initial guesses.
    grid : SpatialGrid
        Sizes of the programme.

    Returns
    -------
    NearestLift or None
        None: not even empty hands can move so, or all of the mass can be lifted.
    """
    asked = float(task.bounds.box_mass[1])
    if asked == 0.0:
        return None
    bounds: SpatialBounds = replace(task.bounds, box_mass=np.array([0.0, asked]))
    parameters = replace(task.parameters, objective=np.array([REGULARISATION, 1.0]))
    open_task = replace(task, bounds=bounds, parameters=parameters)
    found = solve(open_task, [replace(start, box_mass=0.0) for start in starts])
    if not found.report.ok:
        return None
    names = [name for name, _ in binding_limits(open_task, grid, found.optima[0].solution)]
    return lighter(found, asked, names)
