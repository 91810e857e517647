# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Time of single solves in space: our interior-point method and IPOPT, same problem and start.

The lift is the simulated asymmetric one of `bags/` (section 5.2: 7 kg to a table at the left),
with the windows of chapter V for the given weight; for the maximum weight with those of the
posture only, the objective normalised by the heaviest box and a large first barrier parameter, as
one of the predictor's own starts has. The start is the recorded motion.
Each solve begins with bounds and start and nothing else; functions are compiled and loaded.
`*_cpu_s` is processor time.

Random lifts are predicted as by default, from several starts. `random3d_best_within_1pct` counts
those whose objective is at most 1 % above the best of it and `OTHER_STARTS` runs from elsewhere.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from benchmarks.random_tasks import random_case

from human_model.exceptions import HumanModelError
from human_model.motion import BodyMotion, Lift
from human_model.named_subjects import named_subject
from human_model.report import SolveReport
from human_model.task import Box
from human_model.typing import Array
from lift_predictor.core.exceptions import LiftPredictorError
from lift_predictor.core.models.spatial.frame import StanceFrame
from lift_predictor.core.models.spatial.lift_model import FAR, SOLVER_OPTIONS, SpatialModel
from lift_predictor.core.models.spatial.person import SpatialPerson
from lift_predictor.core.models.spatial.postures import PostureFinder
from lift_predictor.core.models.spatial.task import PlacedBox, SpatialTask, place_task
from lift_predictor.core.models.spatial.verify import TOLERANCE
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.maximum_weight import Weighting, maximum_weight
from lift_predictor.core.problem.run import Start
from lift_predictor.core.problem.task_solver import HOP_SPREAD, TaskSolver
from lift_predictor.core.solvers.ipopt import IpoptSolver
from lift_predictor.core.solvers.solution import Solution
from lift_predictor.core.solvers.solve import solve

ROOT: Final = Path(__file__).resolve().parents[1]
REPEATS: Final = 20
IPOPT_REPEATS: Final = 1
IPOPT_ITERATIONS: Final = 400
WARM_STEPS: Final = 30
WARM_MASS: Final = 0.05
WARM_SHIFT: Final = 0.002
"""From one warm solve to the next the mass changes by at most 50 g, the end place by 2 mm."""
IPOPT_WARM_STEPS: Final = 5
RANDOM_TASKS: Final = 100
OTHER_STARTS: Final = 5
OTHER_BARRIER: Final = 1e-2
"""First barrier parameter of the runs to compare with: large enough to leave the start."""
REFEREED_TASKS: Final = 10
LARGEST_TURN: Final = np.radians(90.0)
"""Random tasks end up to this angle to either side."""
STANCE: Final = 0.15
TOE_OUT: Final = np.radians(8.0)
DURATION: Final = 1.4
"""Feet [m], [rad] and time [s] of the random tasks: those of the simulated recordings."""


def recorded_lift(name: str) -> Lift:
    """Read the stored truth of a simulated recording."""
    truth = np.load(ROOT / 'bags' / name / 'truth.npz')
    arrays = {
        key: truth[key]
        for key in ('time', 'position', 'velocity', 'acceleration', 'points', 'frames',
                    'ground_force', 'centre_of_pressure', 'free_moment', 'hand_force',
                    'box_position')
    }  # fmt: skip
    names: dict[str, Any] = {
        key: tuple(truth[key]) for key in ('coordinates', 'point_names', 'frame_names')
    }
    motion = BodyMotion(skeleton='3d_40dof', **arrays, **names)
    return Lift(
        name, 'measured', float(truth['lift_start']), float(truth['lift_end']),
        float(truth['box_mass']), motion, SolveReport(),
    )  # fmt: skip


def single(
    model: SpatialModel, task: SpatialTask, x0: Any, warm: Solution | None = None,
    barrier: float | None = None,
) -> Solution:  # fmt: skip
    """One solve, without the check between the nodes."""
    nlp = model.nlp(task)
    x0 = np.clip(x0, nlp.lower, nlp.upper)
    options = replace(SOLVER_OPTIONS, barrier=barrier or SOLVER_OPTIONS.barrier)
    return solve(nlp, x0, options, warm)


def reference(
    model: SpatialModel, task: SpatialTask, x0: Array, barrier: float | None = None,
    warm: bool = False,
) -> IpoptSolver:  # fmt: skip
    """Return IPOPT for a task with the first barrier parameter of our method.

    Warm: it starts from multipliers, as near to the bounds as our method does.
    """
    settings: dict[str, Any] = {
        'max_iter': IPOPT_ITERATIONS, 'mu_init': barrier or SOLVER_OPTIONS.barrier,
    }  # fmt: skip
    if warm:
        push = SOLVER_OPTIONS.warm_bound_push
        settings |= {'warm_start_init_point': 'yes', 'mu_init': SOLVER_OPTIONS.warm_barrier}
        settings |= {
            f'warm_start_{name}_push': push for name in ('bound', 'slack_bound', 'mult_bound')
        }
    return IpoptSolver(model.nlp(task), x0, settings)


def pair(key: str, model: SpatialModel, task: SpatialTask, start: Start) -> dict[str, float]:
    """Time both solvers on one task."""
    wall, cpu, x0 = [], [], model.variables(task, start)
    for _ in range(REPEATS):
        begin, begin_cpu = time.perf_counter(), time.process_time()
        mine = single(model, task, x0, barrier=start.barrier)
        cpu.append(time.process_time() - begin_cpu)
        wall.append(time.perf_counter() - begin)
    if not mine.ok:
        raise RuntimeError(f'{key}: {mine.status} {mine.violated}')
    nlp, ipopt, other_wall = model.nlp(task), reference(model, task, x0, start.barrier), []
    for _ in range(IPOPT_REPEATS):
        begin = time.perf_counter()
        other = ipopt.solve(nlp, x0)
        other_wall.append(time.perf_counter() - begin)
    if not other.ok:
        print(f'{key}: IPOPT did not converge')
    elif abs(mine.objective - other.objective) > 1e-3 * abs(other.objective):
        print(f'{key}: another minimum: {mine.objective:.6f}, IPOPT {other.objective:.6f}')
    return {
        f'{key}_s': float(np.median(wall)), f'{key}_cpu_s': float(np.median(cpu)),
        f'{key}_iterations': mine.iterations, f'{key}_objective': mine.objective,
        f'ipopt_{key}_s': float(np.median(other_wall)),
        f'ipopt_{key}_iterations': other.iterations,
        f'ipopt_{key}_objective': other.objective if other.ok else float('nan'),
    }  # fmt: skip


def changed(task: SpatialTask, rng: np.random.Generator) -> SpatialTask:
    """Return the task with a little more or less mass, and its end a little elsewhere."""
    hand = task.bounds.hand.copy()
    # Both hands move together, so that the box stays level and as wide.
    hand[1] += WARM_SHIFT * np.tile(rng.uniform(-1.0, 1.0, 3), 2)
    mass = task.bounds.box_mass + WARM_MASS * rng.uniform(-1.0, 1.0)
    return replace(task, bounds=replace(task.bounds, hand=hand, box_mass=mass))


def warm(model: SpatialModel, task: SpatialTask, x0: Any) -> dict[str, float]:
    """Rates of solves that begin with the solution of the task before, ours and IPOPT's."""
    rng, solution = np.random.default_rng(1), single(model, task, x0)
    wall, cpu, steps = [], [], []
    first, first_x, tasks = task, solution.x, []
    for _ in range(WARM_STEPS):
        task = changed(task, rng)
        tasks.append(task)
        begin, begin_cpu = time.perf_counter(), time.process_time()
        solution = single(model, task, solution.x, solution)
        cpu.append(time.process_time() - begin_cpu)
        wall.append(time.perf_counter() - begin)
        steps.append(solution.iterations)
        if not solution.ok:
            raise RuntimeError(f'warm solve {len(wall)} of {WARM_STEPS}: {solution.status}')
    # From the same solution of the same task on, with IPOPT's own multipliers of it.
    ipopt = reference(model, first, first_x, warm=True)
    other = reference(model, first, first_x).solve(model.nlp(first), first_x)
    other_wall = []
    for task in tasks[:IPOPT_WARM_STEPS]:
        begin = time.perf_counter()
        other = ipopt.solve(model.nlp(task), other.x, other)
        other_wall.append(time.perf_counter() - begin)
        if not other.ok:
            raise RuntimeError(f'IPOPT: warm solve {len(other_wall)} did not converge')
    return {
        '3d_warm_hz': 1.0 / float(np.median(wall)), '3d_warm_cpu_hz': 1.0 / float(np.median(cpu)),
        '3d_warm_iterations': float(np.median(steps)),
        'ipopt_3d_warm_hz': 1.0 / float(np.median(other_wall)),
        'ipopt_3d_warm_iterations': other.iterations,
    }  # fmt: skip


def random_task(
    rng: np.random.Generator, finder: PostureFinder, model: SpatialModel, name: str
) -> tuple[SpatialTask, Any]:
    """Draw person and task until start and end can be held at rest; return the starts with it."""
    while True:
        subject, plan = random_case(rng, name)
        turn = rng.uniform(-LARGEST_TURN, LARGEST_TURN)
        c, s = np.cos(turn), np.sin(turn)
        try:
            person = SpatialPerson.of(subject)
            height = person.ankle_height
            frame = StanceFrame(
                0.0, np.zeros(3), np.array([[0.0, -STANCE, height], [0.0, STANCE, height]]),
                np.array([-TOE_OUT, TOE_OUT]),
            )  # fmt: skip
            width = plan.box_size[1]
            end, mass = plan.end, plan.box_mass
            assert mass is not None
            places = np.array([plan.start, (c * end[0], s * end[0], end[2])])
            box = PlacedBox((mass, mass), plan.box_size, width, places, np.array([0.0, turn]))
            task = place_task(person, frame, box, (DURATION,) * 2, model.grid, name)
            return task, finder.starts(task, model.grid)
        except (HumanModelError, LiftPredictorError):
            continue


def displaced(start: Start, number: int, rng: np.random.Generator) -> Start:
    """Displace a start as the basin hops do, to either side."""
    rows = start.control.shape[0] if number % 2 else 1
    shift = HOP_SPREAD * rng.normal(size=(rows, start.control.shape[1]))
    return replace(start, control=start.control + shift)


def others(
    solver: TaskSolver[SpatialTask], task: SpatialTask, start: Start, seed: int
) -> list[float]:
    """Objectives of runs from elsewhere than those of the prediction, where they converge."""
    rng = np.random.default_rng(seed)
    runs = [
        solver.run(task, replace(displaced(start, number, rng), barrier=OTHER_BARRIER))
        for number in range(OTHER_STARTS)
    ]
    return [run.objective for run in runs if run.converged]


def random_lifts(
    solver: TaskSolver[SpatialTask],
    model: SpatialModel,
    count: int,
    refereed: int = REFEREED_TASKS,
) -> dict[str, float]:
    """Solve and check random tasks; compare with runs from elsewhere, and some with IPOPT."""
    rng, finder = np.random.default_rng(3), PostureFinder(model.library)
    solved, violations, wall, excess, excess_ipopt = 0, 0, [], [], []
    for k in range(count):
        task, starts = random_task(rng, finder, model, f'random {k}')
        begin = time.perf_counter()
        prediction = solver.solve(task, starts, basin_hops=model.method.basin_hops)
        if not prediction.report.ok:
            far = [replace(start, barrier=FAR) for start in starts]
            prediction = solver.solve(task, far)
        wall.append(time.perf_counter() - begin)
        if not prediction.report.ok:
            print(f'random {k}: {prediction.report.message}')
            continue
        solved += 1
        check = prediction.verification
        assert check is not None
        violations += any(check.violation[name] > most for name, most in TOLERANCE.items())
        # Before margins for the time between the nodes, which the other answers have not.
        mine = min(run.objective for run in prediction.runs if run.converged)
        best = min((mine, *others(solver, task, starts[0], k)))
        excess.append(mine / best - 1.0)
        if k < refereed:
            x0 = model.variables(task, starts[0])
            answer = reference(model, task, x0).solve(model.nlp(task), x0)
            excess_ipopt.append(mine / answer.objective - 1.0 if answer.ok else float('nan'))
    return {
        'random3d_solved': solved, 'random3d_tasks': count, 'dense_grid_violations': violations,
        'random3d_s': float(np.median(wall)),
        'random3d_best_within_1pct': int(np.sum(np.array(excess) <= 0.01)),
        'random3d_excess_mean': float(np.mean(excess)),
        'random3d_excess_most': float(np.max(excess)),
        'ipopt_random3d_tasks': int(np.isfinite(excess_ipopt).sum()),
        'ipopt_random3d_we_are_1pct_worse': int(np.sum(np.array(excess_ipopt) > 0.01)),
        'ipopt_random3d_it_is_1pct_worse': int(np.sum(np.array(excess_ipopt) < -0.01)),
    }  # fmt: skip


def run(random_tasks: int = RANDOM_TASKS) -> Mapping[str, float]:
    """Time all solves in space.

    Returns
    -------
    dict
        `3d_fixed_s`, `3d_max_s`, `3d_warm_hz`, `random3d_solved`, `dense_grid_violations`, and
        `ipopt_*`, `*_cpu_s`, `*_iterations` beside them; `*_whole_*`: all starts, check, margins.
    """
    lift = recorded_lift('asymmetric_7kg')
    predictor = LiftPredictor(PredictorOptions(dimension='3d', refinements=5))
    solver, model = predictor.spatial, SpatialModel(predictor.options)
    subject = named_subject('thesis_ch4')
    box = Box(lift.box_mass, (0.238, 0.305, 0.127))
    task = model.recorded_task(subject, lift, box)
    start = model.starts(task)[0]
    result = pair('3d_fixed', model, task, start)
    result |= warm(model, task, model.variables(task, start))
    begin = time.perf_counter()
    prediction = predictor.predict(subject, lift, box)
    result['3d_fixed_whole_s'] = time.perf_counter() - begin
    result['3d_fixed_whole_objective'] = prediction.report.objective

    heavy = model.maximum_weight_task(subject, lift, box)
    starts = model.starts(heavy)[:1]
    begin = time.perf_counter()
    found = maximum_weight(solver, heavy, starts)
    result['3d_max_whole_s'] = time.perf_counter() - begin
    if found.normalisation is not None:
        scale, share = found.normalisation, Weighting()
        objective = np.array([share.effort / scale.effort, share.box / scale.log_weight])
        weighted = replace(heavy, parameters=replace(heavy.parameters, objective=objective))
        # The start that leads furthest in `maximum_weight`.
        result |= pair('3d_max', model, weighted, replace(starts[0], barrier=FAR))
        result['3d_max_weight_n'] = found.weight
        result['3d_max_whole_objective'] = found.prediction.report.objective
    return result | random_lifts(solver, model, random_tasks)
