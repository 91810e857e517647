# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Time of single solves in the plane: our interior-point method and IPOPT, same problem and start.

The lifts of a given weight are the dissertation's (section 4.3: its subject, box and shelf),
simulated; the maximum weight is that of the first man of the simulated group of chapter II, with
the strength found from his lift and the objective normalised. The start is the smooth step between
the end postures. Both solvers have IPOPT's default tolerance and compiled
functions that are loaded already; each solve begins with bounds and start and nothing else.
`*_cpu_ms` is processor time: what wall time is on a machine that does nothing else.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from bags.simulate.group import lifting_task, simulated_lift, study_group
from benchmarks.predictor_pareto import find_man, task_box

from human_model.named_subjects import named_subject
from human_model.task import Box
from lift_predictor.core.models.sagittal.grid import LiftBounds
from lift_predictor.core.models.sagittal.lift_model import COLD, SagittalModel
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.maximum_weight import Weighting, heaviest_box
from lift_predictor.core.problem.run import Start
from lift_predictor.core.problem.task_solver import TaskSolver
from lift_predictor.core.solvers.ipopt import IpoptSolver
from lift_predictor.core.solvers.solution import Solution
from lift_predictor.core.solvers.solve import solve

REPEATS: Final = 25
SUBJECT: Final = 'thesis_ch4'
LIFTS: Final = {'2d_fixed_7kg': 'symmetric_7kg', '2d_fixed_12kg': 'symmetric_12kg'}
SMOOTH_STEP: Final = 'smooth step'
SAME: Final = 1e-3
"""Relative difference of the objectives above which two answers are not the same."""
WARM_STEPS: Final = 60
WARM_MASS: Final = 0.05
WARM_SHIFT: Final = 0.002
"""From one warm solve to the next the mass changes by at most 50 g, the end place by 2 mm."""


def timed(run: Callable[[], Solution], repeats: int) -> tuple[Solution, float, float]:
    """Median wall and processor time [ms] of repeated solves, and the last result."""
    wall, processor = [], []
    for _ in range(repeats):
        begin, begin_cpu = time.perf_counter(), time.process_time()
        result = run()
        wall.append(time.perf_counter() - begin)
        processor.append(time.process_time() - begin_cpu)
    if not result.ok:
        raise RuntimeError(f'the solve that is timed did not converge: {result.status}')
    return result, 1e3 * float(np.median(wall)), 1e3 * float(np.median(processor))


def pair(
    key: str,
    own: TaskSolver[SagittalTask],
    task: SagittalTask,
    start: Start,
) -> dict[str, float]:
    """Time both solvers on one task."""
    nlp, x0 = own.model.nlp(task), own.model.variables(task, start)
    reference = IpoptSolver(nlp, x0)
    mine, wall, cpu = timed(lambda: own.run(task, start).solution, REPEATS)
    other, ipopt_wall, ipopt_cpu = timed(lambda: reference.solve(nlp, x0), REPEATS)
    if abs(mine.objective - other.objective) > SAME * abs(other.objective):
        print(f'{key}: another minimum: {mine.objective:.6f}, IPOPT {other.objective:.6f}')
    return {
        f'{key}_ms': wall, f'{key}_cpu_ms': cpu, f'{key}_iterations': mine.iterations,
        f'ipopt_{key}_ms': ipopt_wall, f'ipopt_{key}_cpu_ms': ipopt_cpu,
        f'ipopt_{key}_iterations': other.iterations,
    }  # fmt: skip


def changed(bounds: LiftBounds, step: int, rng: np.random.Generator) -> LiftBounds:
    """Bounds of a task that differs a little from the one before."""
    mass = bounds.box_mass + WARM_MASS * rng.uniform(-1.0, 1.0)
    hand = bounds.hand.copy()
    hand[1] += WARM_SHIFT * rng.uniform(-1.0, 1.0, 2)
    return replace(bounds, box_mass=mass, hand=hand)


def warm(own: TaskSolver[SagittalTask], task: SagittalTask, start: Start) -> dict[str, float]:
    """Rate of solves that begin with the solution of the task before."""
    rng, bounds = np.random.default_rng(1), task.bounds
    x0 = np.append(start.control, start.box_mass)
    solution = solve(own.model.nlp(task), x0, COLD)
    wall, cpu, other, failed = [], [], [], 0
    reference = IpoptSolver(own.model.nlp(task), x0)
    last = reference.solve(own.model.nlp(task), x0)
    for step in range(WARM_STEPS):
        bounds = changed(bounds, step, rng)
        task = replace(task, bounds=bounds)
        begin, begin_cpu = time.perf_counter(), time.process_time()
        solution = solve(own.model.nlp(task), solution.x, COLD, solution)
        cpu.append(time.process_time() - begin_cpu)
        wall.append(time.perf_counter() - begin)
        begin = time.perf_counter()
        last = reference.solve(own.model.nlp(task), last.x)
        other.append(time.perf_counter() - begin)
        failed += not (solution.ok and last.ok)
    if failed:
        raise RuntimeError(f'{failed} of {WARM_STEPS} warm solves did not converge')
    return {
        '2d_warm_hz': 1.0 / float(np.median(wall)),
        '2d_warm_cpu_hz': 1.0 / float(np.median(cpu)),
        'ipopt_2d_warm_hz': 1.0 / float(np.median(other)),
    }


def run() -> Mapping[str, float]:
    """Time all solves in the plane.

    Returns
    -------
    dict
        `2d_fixed_7kg_ms`, `2d_fixed_12kg_ms`, `2d_max_ms`, `2d_warm_hz`, the same with `ipopt_`
        before, with `_cpu_ms` for processor time and `_iterations`.
    """
    subject = named_subject(SUBJECT)
    predictor = LiftPredictor()
    own = predictor.sagittal
    model = SagittalModel()
    result: dict[str, float] = {}
    for key, name in LIFTS.items():
        described = lifting_task(name)
        box = Box(described.box_mass, described.box_size)
        task = model.recorded_task(subject, simulated_lift(subject, described), box)
        start = smooth_step(task, model)
        result |= pair(key, own, task, start)
    result |= warm(own, task, start)
    man = find_man(study_group()[0], Weighting())
    task = model.maximum_weight_task(man.subject, man.lift, task_box())
    scale = heaviest_box(own, task, model.starts(task)).normalisation
    if scale is None:
        raise RuntimeError('no heaviest box: the objective cannot be normalised')
    weighting = Weighting()
    objective = np.array([weighting.effort / scale.effort, weighting.box / scale.log_weight])
    task = replace(task, parameters=replace(task.parameters, objective=objective))
    start = replace(smooth_step(task, model), box_mass=task_box().mass)
    result |= pair('2d_max', own, task, start)
    return result


def smooth_step(task: SagittalTask, model: SagittalModel) -> Start:
    """Start that owes nothing to the recorded motion but its end postures."""
    starts = {start.name: start for start in model.starts(task)}
    return replace(starts[SMOOTH_STEP], box_mass=float(task.bounds.box_mass[0]))


if __name__ == '__main__':
    for name, value in run().items():
        print(f'{name}: {value:.3g}')
