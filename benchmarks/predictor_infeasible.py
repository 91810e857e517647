# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Fifty lifts that nobody can do: whether they are found out, and answered with what can be done.

Feasible random lifts are made infeasible in three ways by turns: a box of more than the heaviest
that this person lifts so, a shelf above the reach of both arms, a place beyond it. A lift counts
as detected if it is reported as infeasible or out of reach, without data; as answered if a lift
that is solved and checked is offered instead.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from benchmarks.random_tasks import STRENGTH_Z, plan_random

from human_model.report import SolveStatus
from human_model.subject import Subject
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.problem.maximum_weight import heaviest_box, open_mass

N_TASKS: Final = 50
SEED: Final = 94110
WAYS: Final = ('too heavy', 'shelf too high', 'reach too far')
OVERLOAD: Final = 1.1
"""Mass against the heaviest box of the maximum-weight programme without posture windows."""
BEYOND: Final = (1.6, 1.0)
"""Height, and distance before the ankles, in statures: where no hand reaches."""
NOT_DONE: Final = (SolveStatus.PREDICTOR_INFEASIBLE, SolveStatus.PREDICTOR_UNREACHABLE)


def make_infeasible(
    planner: LiftPlanner, rng: np.random.Generator, way: str, name: str
) -> tuple[Subject, PlanTask]:
    """Draw feasible lifts until one can be made infeasible in this way."""
    while True:
        subject, task, plan = plan_random(rng, name)
        if way == 'shelf too high':
            return subject, replace(task, end=(*task.end[:2], BEYOND[0] * subject.stature))
        if way == 'reach too far':
            return subject, replace(task, end=(BEYOND[1] * subject.stature, *task.end[1:]))
        solver = planner.predictor.sagittal
        starts = solver.model.plan_starts(plan, solver.model.plan_starts_limit)
        heaviest = heaviest_box(solver, open_mass(plan.task), starts)
        if heaviest.report.ok:
            # The best of all runs at the nodes: the margin that follows only takes away.
            most = max(run.box_mass for run in heaviest.prediction.runs)
            return subject, replace(task, box_mass=OVERLOAD * most)


def run(n_tasks: int = N_TASKS) -> Mapping[str, float]:
    """Plan the infeasible lifts.

    Returns
    -------
    dict
        `infeasible_detected`, how many were; `infeasible_nearest`, for how many of them a lift was
        offered instead; `infeasible_tasks`, of how many.
    """
    planner = LiftPlanner()
    rng = np.random.default_rng(SEED)
    detected = offered = 0
    for number in range(n_tasks):
        way = WAYS[number % len(WAYS)]
        subject, task = make_infeasible(planner, rng, way, f'{way} {number}')
        prediction = planner.plan(subject, task).prediction
        report, nearest = prediction.report, prediction.nearest
        found = report.status in NOT_DONE and prediction.lift is None
        answered = nearest is not None and nearest.prediction.report.ok
        detected += found
        offered += found and answered
        if not (found and answered):
            print(f'{task.name}: {report.status.name}: {report.message}')
    return {
        'infeasible_detected': detected,
        'infeasible_nearest': offered,
        'infeasible_tasks': n_tasks,
    }


if __name__ == '__main__':
    print(f'strength_z = {STRENGTH_Z}', dict(run()))
