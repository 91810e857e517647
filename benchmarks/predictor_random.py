# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Two hundred random persons and sagittal tasks: how many are solved, and how well.

Each is a planned lift (no recording) that is solved as the predictor does it. The referee is the
best of twenty IPOPT runs from random control values within the joint limits, on the same
programme; what our own runs found counts as known too. Compared are the minima at the nodes, as
both solvers see the same there; the answers given are those with margins, which hold between the
nodes too and cost a little more. They are checked anew on a dense grid here.

The referee takes most of the time. Its records are kept (`random_referee.py`), so that a run that
was ended goes on where it was.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, replace
from functools import cache
from typing import Final

import numpy as np
from benchmarks.random_referee import N_STARTS, RefereeStore
from benchmarks.random_tasks import plan_random
from benchmarks.solved_lifts import EQUAL

from lift_predictor.core.models.sagittal.lift_model import SagittalModel
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.models.sagittal.verify import verify
from lift_predictor.core.problem.run import best_objective
from lift_predictor.core.problem.task_solver import TaskSolver

N_TASKS: Final = 200
SEED: Final = 2026
STARTS: Final = 4
CORES: Final = 2
EVERY: Final = 10
"""Tasks between two lines of progress."""


@dataclass(frozen=True)
class Case:
    """One task.

    Attributes
    ----------
    number : int
        Its seed.
    solved : bool
        Whether the predictor has an answer that holds on the dense grid.
    violations : int
        Families of constraints that the answer violates there.
    own, given, referee : float
        Least effort at the nodes that we found, effort of the answer, and the referee's best [s].
    converged : int
        Referee's runs that ended in a minimum.
    message : str
        Of the predictor.
    """

    number: int
    solved: bool
    violations: int
    own: float
    given: float
    referee: float
    converged: int
    message: str

    @property
    def known(self) -> float:
        """Least effort that anyone found [s]; NaN: none."""
        return float(np.fmin(self.own, self.referee))

    @property
    def reached(self) -> bool:
        """Whether ours is the least known effort, to 0.1 %."""
        return bool(self.own <= EQUAL * self.known)


@cache
def _tools() -> tuple[TaskSolver[SagittalTask], SagittalModel, RefereeStore]:
    model = SagittalModel()
    return TaskSolver(model), model, RefereeStore(model)


def solve_case(number: int) -> Case:
    """Solve a task of a seed of its own with the predictor and with the referee."""
    solver, model, store = _tools()
    _, _, plan = plan_random(np.random.default_rng((SEED, number)))
    prediction = solver.solve(plan.task, model.plan_starts(plan, STARTS))
    violations, given = 0, float('nan')
    if prediction.report.ok:
        best = prediction.runs[0]
        given = best.objective
        parameters = replace(plan.task.parameters, box_mass=best.box_mass)
        check = verify(model.library, model.grid, best.control, parameters, plan.task.bounds)
        violations = len(check.failures().split(';')) if check.failures() else 0
    # A margin only takes motions away: a run with one is a motion of the task too.
    own = best_objective(prediction.runs)
    referee = store.find(number, plan.task)
    return Case(
        number, prediction.report.ok, violations, own, given, referee.best,
        len(referee.objective), prediction.report.message,
    )  # fmt: skip


def run(n_tasks: int = N_TASKS, cores: int = CORES) -> Mapping[str, float]:
    """Solve all tasks.

    Returns
    -------
    dict
        `random2d_solved`, `random2d_best_within_0_1pct`, `dense_grid_violations`,
        `random2d_tasks`, share of the referee's starts that converge, and the distribution of our
        effort by the referee's best (below 1: ours is less).
    """
    begin = time.perf_counter()
    cases: list[Case] = []
    with ProcessPoolExecutor(cores, multiprocessing.get_context('spawn')) as pool:
        for done in as_completed([pool.submit(solve_case, number) for number in range(n_tasks)]):
            case = done.result()
            cases.append(case)
            if not case.solved:
                print(f'random lift {case.number}: {case.message}', flush=True)
            elif not case.reached:
                print(
                    f'random lift {case.number}: effort {case.own:.5f} s, known '
                    f'{case.known:.5f} s', flush=True,
                )  # fmt: skip
            if len(cases) % EVERY == 0 or len(cases) == n_tasks:
                elapsed = time.perf_counter() - begin
                print(
                    f'{len(cases)} of {n_tasks} random lifts, {elapsed:.0f} s: '
                    f'{sum(c.solved for c in cases)} solved, {sum(c.reached for c in cases)} '
                    f'within 0.1 %', flush=True,
                )  # fmt: skip
    return figures(cases)


def figures(cases: Sequence[Case]) -> dict[str, float]:
    """Sum the tasks up."""
    measured = {
        'random2d_solved': float(sum(case.solved for case in cases)),
        'random2d_best_within_0_1pct': float(sum(case.reached for case in cases)),
        'dense_grid_violations': float(sum(case.violations for case in cases)),
        'random2d_tasks': float(len(cases)),
        'random2d_ipopt_starts_converged': sum(case.converged for case in cases)
        / (N_STARTS * len(cases)),
        'random2d_ipopt_none_converged': float(sum(case.converged == 0 for case in cases)),
    }
    for name in ('own', 'given'):
        ratio = np.array([getattr(case, name) / case.referee for case in cases])
        ratio = ratio[np.isfinite(ratio)]
        if len(ratio):
            key = 'at_nodes' if name == 'own' else 'answer'
            for quantile, value in zip((0, 5, 50, 95, 100), np.percentile(
                ratio, (0, 5, 50, 95, 100)), strict=True):  # fmt: skip
                measured[f'random2d_{key}_by_ipopt_p{quantile}'] = float(value)
    return measured


if __name__ == '__main__':
    for name, value in run().items():
        print(f'{name:40}{value:12.6g}')
