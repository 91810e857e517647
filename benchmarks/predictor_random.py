# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Two hundred random persons and sagittal tasks: how many are solved, and how well.

Each is a planned lift (no recording) that is solved as the predictor does it. The referee is the
best of twenty IPOPT runs from random control values within the joint limits, on the same
programme; what our own runs found counts as known too. Compared are the minima at the nodes, as
both solvers see the same there; the answers given are those with margins, which hold between the
nodes too and cost a little more. They are checked anew on a dense grid here.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from typing import Final

import numpy as np
from benchmarks.random_tasks import plan_random
from benchmarks.solved_lifts import EQUAL, random_starts

from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.sagittal.verify import verify
from lift_predictor.core.solvers.compiled import build_programme
from lift_predictor.core.solvers.ipopt import LiftSolver
from lift_predictor.core.solvers.optimum import best_objective

N_TASKS: Final = 200
N_REFEREE: Final = 20
SEED: Final = 2026
STARTS: Final = 4
CORES: Final = 2


@dataclass(frozen=True)
class Case:
    """One task: solved, violations on the dense grid, our and the best known effort [s]."""

    number: int
    solved: bool
    violations: int
    own: float
    known: float
    message: str


@cache
def _solvers() -> tuple[LiftPredictor, LiftSolver]:
    predictor = LiftPredictor()
    return predictor, LiftSolver(build_programme(predictor.programme.grid), 60.0)


def solve_case(number: int) -> Case:
    """Solve a task of a seed of its own with the predictor and with the referee."""
    predictor, referee = _solvers()
    grid = predictor.programme.grid
    subject, _, plan = plan_random(np.random.default_rng((SEED, number)))
    predictor.configure(subject)
    prediction = predictor.solve_task(plan.task, plan.starts(grid.spline, STARTS))
    violations = 0
    if prediction.report.ok:
        best = prediction.optima[0]
        parameters = replace(plan.task.parameters, box_mass=best.box_mass)
        report = predictor.programme.report
        check = verify(report, grid, best.control, parameters, plan.task.bounds)
        violations = len(check.failures().split(';')) if check.failures() else 0
    # Runs with a margin are other programmes: those without are the last of the tuple.
    at_nodes = [run for run in prediction.optima if run.converged]
    own = best_objective(at_nodes)
    vector, bounds = plan.task.parameters.pack(), plan.task.bounds
    starts = random_starts(bounds, grid, N_REFEREE, number)
    known = best_objective(referee.solve_all(vector, bounds, starts))
    known = float(np.nanmin([own, known])) if np.isfinite([own, known]).any() else float('nan')
    return Case(number, prediction.report.ok, violations, own, known, prediction.report.message)


def run(n_tasks: int = N_TASKS, cores: int = CORES) -> Mapping[str, float]:
    """Solve all tasks.

    Returns
    -------
    dict
        `random2d_solved`, `random2d_best_within_0_1pct`, `dense_grid_violations`,
        `random2d_tasks`.
    """
    with ProcessPoolExecutor(cores, multiprocessing.get_context('spawn')) as pool:
        cases = list(pool.map(solve_case, range(n_tasks)))
    for case in cases:
        if not case.solved:
            print(f'random lift {case.number}: {case.message}')
        elif case.own > EQUAL * case.known:
            print(f'random lift {case.number}: effort {case.own:.5f} s, known {case.known:.5f} s')
    return {
        'random2d_solved': sum(case.solved for case in cases),
        'random2d_best_within_0_1pct': sum(case.own <= EQUAL * case.known for case in cases),
        'dense_grid_violations': sum(case.violations for case in cases),
        'random2d_tasks': n_tasks,
    }


if __name__ == '__main__':
    print(dict(run()))
