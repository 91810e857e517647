# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What can be done instead of an infeasible lift, and the limit that keeps it from more."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from human_model.report import SolveStatus
from lift_predictor.core.sagittal.feasibility import TIE_BREAK
from lift_predictor.core.solvers.solution import Solution
from lift_predictor.core.spatial.grid import SpatialGrid
from lift_predictor.core.spatial.prediction import PredictedLift3D
from lift_predictor.core.spatial.starts import SpatialStart
from lift_predictor.core.spatial.task import SpatialTask

Solve = Callable[[SpatialTask, Sequence[SpatialStart]], PredictedLift3D]


def binding_limit(solution: Solution, grid: SpatialGrid) -> str:
    """Name of the row with the largest multiplier; rows are scaled to the range of their limit.

    The hands' places (3.13) are left out: they are the task, not a limit.
    """
    inequalities = len(grid.row_names) - 12
    return grid.row_names[int(np.argmax(np.abs(solution.row_multiplier[:inequalities])))]


def with_lighter_lift(
    failed: PredictedLift3D,
    task: SpatialTask,
    starts: Sequence[SpatialStart],
    solve: Solve,
    grid: SpatialGrid,
) -> PredictedLift3D:
    """Add the heaviest feasible lift, and what limits it, to an infeasible one.

    Parameters
    ----------
    failed : PredictedLift3D
        Infeasible.
    task : SpatialTask
        Its task.
    starts : sequence of SpatialStart
        Initial guesses.
    solve : callable
        Solves and checks a task.
    grid : SpatialGrid
        Sizes of the programme.
    """
    mass = float(task.bounds.box_mass[1])
    if failed.report.status is not SolveStatus.PREDICTOR_INFEASIBLE or mass == 0.0:
        return failed
    lighter = replace(
        task,
        bounds=replace(task.bounds, box_mass=np.array([0.0, mass])),
        parameters=replace(task.parameters, objective=np.array([TIE_BREAK, 1.0])),
    )
    nearest = solve(lighter, [replace(start, box_mass=0.0) for start in starts])
    if not nearest.report.ok:
        return failed
    limit = binding_limit(nearest.optima[0].solution, grid)
    words = (
        f'{failed.report.message}; nearest feasible lift: with {nearest.box_mass:.1f} kg instead '
        f'of {mass:.1f} kg; the limit that breaks first: {limit}'
    )
    return replace(failed, report=replace(failed.report, message=words), nearest=nearest)
