# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Names of the limits that hold the objective of a spatial lift back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lift_predictor.core.models.spatial.grid import (
    HAND_CONSTRAINTS,
    LIMITED,
    NODE_CONSTRAINTS,
    SpatialGrid,
    constraint_slice,
    plain_bounds,
)
from lift_predictor.core.models.spatial.parameters import DEPENDENT
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.problem.run import ACTIVE_MULTIPLIER
from lift_predictor.core.solvers.solution import Solution


def active_limits(task: SpatialTask, grid: SpatialGrid, solution: Solution) -> tuple[str, ...]:
    """Names of inequalities with a multiplier above `ACTIVE_MULTIPLIER`, the strongest first.

    Constraints are scaled to the range of their limit. The places of hands and box (3.11 to 3.13)
    are left out: they are the task, not a limit. Where a recording or a technique narrows a limit,
    the name says that it is a window.

    Parameters
    ----------
    task : SpatialTask
        Task, without margins.
    grid : SpatialGrid
        Sizes of the NLP.
    solution : Solution
        Of the task, or of the task with margins.
    """
    low, high = task.bounds.constraints()
    size = np.where(low < high, np.abs(solution.lam_g), 0.0)
    node = size[: grid.n_nodes * len(NODE_CONSTRAINTS)].reshape(grid.n_nodes, -1)
    node[:, constraint_slice(HAND_CONSTRAINTS)] = 0.0
    person = task.person
    limits = plain_bounds(grid.n_nodes, person.limits(DEPENDENT), person.limits(LIMITED))
    plain = replace(
        task.bounds, node_lower=limits[0], node_upper=limits[1], angle_lower=limits[2],
        angle_upper=limits[3],
    ).constraints()  # fmt: skip
    narrowed = np.where(solution.lam_g > 0.0, high < plain[1], low > plain[0])
    order = np.argsort(-size, kind='stable')[: np.count_nonzero(size > ACTIVE_MULTIPLIER)]
    return tuple(f'{"window on " if narrowed[i] else ""}{grid.constraint_names[i]}' for i in order)
