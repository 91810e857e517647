# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Make the library of solved lifts that the predictor starts planned lifts from.

`python -m benchmarks.solved_lifts`, by hand, in the repository's root. Random persons and tasks
(another seed than the benchmark's) are solved from the made-up starts and from random ones. Where
a random start finds less effort than the made-up ones, its solution is a candidate. Those
candidates are kept, one by one, from which most tasks reach their least known effort. The file
holds their free control values; it makes answers better, never worse, as the best run is kept.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Final

import numpy as np
from benchmarks.random_tasks import plan_random

from lift_predictor.core.models.sagittal.grid import LiftBounds, SagittalGrid
from lift_predictor.core.models.sagittal.lift_model import SagittalModel
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.problem.run import SolverRun, Start, best_objective
from lift_predictor.core.problem.task_solver import TaskSolver

SEED: Final = 7
N_TASKS: Final = 98
N_RANDOM: Final = 25
N_MADE: Final = 2
N_OTHERS: Final = 16
"""Further candidates: best solutions of tasks where the made-up starts find them."""
N_KEPT: Final = 4
EQUAL: Final = 1.001
"""Efforts that differ by 0.1 % are the same optimum."""
GRID: Final = SagittalGrid(7, 25)
FILE: Final = (
    Path(__file__).resolve().parents[1]
    / 'ros_ws/src/lift_predictor/lift_predictor/data/solved_lifts.csv'
)


def random_starts(bounds: LiftBounds, grid: SagittalGrid, count: int, seed: int) -> list[Start]:
    """Control values anywhere in the joint limits."""
    rng = np.random.default_rng(seed)
    shape = (grid.spline.n_free, len(JOINTS))
    low, high = bounds.angle_lower, bounds.angle_upper
    return [Start(f'random {i + 1}', rng.uniform(low, high, shape)) for i in range(count)]


def main() -> None:
    """Solve, choose, write."""
    solver = TaskSolver(SagittalModel(grid=GRID))
    rng = np.random.default_rng(SEED)
    tasks: list[SagittalTask] = []
    best: list[SolverRun] = []
    own: list[float] = []
    for number in range(N_TASKS):
        _, _, plan = plan_random(rng)
        made = solver.model.plan_starts(plan, N_MADE)
        starts = (*made, *random_starts(plan.task.bounds, GRID, N_RANDOM, 1000 + number))
        runs = [solver.run(plan.task, start) for start in starts]
        solved = [run for run in runs if run.converged]
        if solved:
            tasks.append(plan.task)
            best.append(min(solved, key=lambda run: run.objective))
            own.append(best_objective(runs[:N_MADE]))
    reached = np.nan_to_num(np.array(own), nan=np.inf)
    known = np.array([run.objective for run in best])
    missed = np.flatnonzero(reached > EQUAL * known)
    others = np.setdiff1d(np.arange(len(tasks)), missed)[:N_OTHERS]
    candidates = [*missed.tolist(), *others.tolist()]
    effort = np.full((len(tasks), len(candidates)), np.inf)
    for row, task in enumerate(tasks):
        for column, candidate in enumerate(candidates):
            run = solver.run(task, best[candidate].as_start())
            if run.converged:
                effort[row, column] = run.objective
    known = np.minimum(known, effort.min(axis=1))
    print(f'{len(tasks)} tasks; made-up starts reach {np.sum(reached <= EQUAL * known)}')
    with FILE.open('w', encoding='utf-8', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(('lift', 'control_point', *JOINTS, 'source'))
        for kept in range(N_KEPT):
            gain = (np.minimum(reached[:, None], effort) <= EQUAL * known[:, None]).sum(axis=0)
            chosen = int(np.argmax(gain))
            reached = np.minimum(reached, effort[:, chosen])
            print(f'with solved lift {kept + 1}: {gain[chosen]}')
            control = best[candidates[chosen]].control
            for point, values in enumerate(control):
                source = f'benchmarks/solved_lifts.py, seed {SEED}, task {candidates[chosen]}'
                numbers = (f'{value:.6f}' for value in values)
                writer.writerow((kept + 1, point + 1, *numbers, source))


if __name__ == '__main__':
    main()
