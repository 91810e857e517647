# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Time of single solves in space: our interior-point method and IPOPT, same problem and start.

The lift is the simulated asymmetric one of `bags/` (section 5.2: 7 kg to a table at the left),
with the windows of chapter V for the given weight; for the maximum weight with those of the
posture only, and the objective normalised by the heaviest box. The start is the recorded motion.
Each solve begins with bounds and start and nothing else; functions are compiled and loaded. IPOPT
gets the same compiled functions, and the sparsity of the Jacobian, through CasADi. `*_cpu_s` is
processor time.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import casadi as ca
import numpy as np
from benchmarks.random_tasks import random_case

from human_model.errors import HumanModelError
from human_model.motion import BodyMotion, Lift
from human_model.named_subjects import named_subject
from human_model.report import SolveReport
from lift_predictor.core.exceptions import LiftPredictorError
from lift_predictor.core.maximum_weight import Weighting
from lift_predictor.core.sagittal.task import Box
from lift_predictor.core.solvers.solution import Solution
from lift_predictor.core.solvers.solve import solve
from lift_predictor.core.spatial.frame import StanceFrame
from lift_predictor.core.spatial.maximum_weight import FAR, maximum_weight, open_mass
from lift_predictor.core.spatial.person import SpatialPerson
from lift_predictor.core.spatial.postures import PostureFinder
from lift_predictor.core.spatial.predictor import SpatialPredictor
from lift_predictor.core.spatial.programme import spatial_assembler, spatial_programme
from lift_predictor.core.spatial.starts import recorded_starts
from lift_predictor.core.spatial.task import PlacedBox, SpatialTask, place_task
from lift_predictor.core.spatial.verify import TOLERANCE

ROOT: Final = Path(__file__).resolve().parents[1]
REPEATS: Final = 20
IPOPT_REPEATS: Final = 1
WARM_STEPS: Final = 30
WARM_MASS: Final = 0.05
WARM_SHIFT: Final = 0.002
"""From one warm solve to the next the mass changes by at most 50 g, the end place by 2 mm."""
RANDOM_TASKS: Final = 100
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
                    'ground_force', 'cop', 'free_moment', 'hand_force', 'box_position')
    }  # fmt: skip
    names = {key: tuple(truth[key]) for key in ('coordinates', 'point_names', 'frame_names')}
    motion = BodyMotion(skeleton='3d_40dof', **arrays, **names)
    return Lift(
        name, 'measured', float(truth['lift_start']), float(truth['lift_end']),
        float(truth['box_mass']), motion, SolveReport(),
    )  # fmt: skip


class _Call(ca.Callback):
    """A NumPy function of (x) or (x, p, multipliers) as CasADi function with given sparsity."""

    def __init__(self, name: str, sizes: list[int], outputs: list[Any], function: Any) -> None:
        ca.Callback.__init__(self)
        self.sizes, self.outputs, self.function = sizes, outputs, function
        self.construct(name, {})

    def get_n_in(self) -> int:
        return len(self.sizes)

    def get_n_out(self) -> int:
        return len(self.outputs)

    def get_sparsity_in(self, i: int) -> Any:
        return ca.Sparsity.dense(self.sizes[i], 1)

    def get_sparsity_out(self, i: int) -> Any:
        return self.outputs[i]

    def eval(self, arguments: list[Any]) -> list[Any]:
        return self.function(*(np.asarray(a).ravel() for a in arguments))


class Referee:
    """IPOPT on the programme of a task, with exact derivatives."""

    def __init__(self, predictor: SpatialPredictor, task: SpatialTask) -> None:
        self.programme = p = spatial_programme(
            spatial_assembler(predictor.library, predictor.grid), predictor.grid,
            task.parameters, task.bounds,
        )  # fmt: skip
        a, n, m = p.assembler, p.n, len(p.row_lower)
        everything = np.arange(m, dtype=np.int32)
        rng = np.random.default_rng(0)
        x0 = recorded_starts(task, predictor.grid)[0].variables()
        used = np.zeros((m, n), dtype=bool)
        for _ in range(3):
            a.first(x0 + 0.01 * rng.normal(size=n))
            used |= a.dense_rows(everything) != 0.0
        pattern = ca.sparsify(ca.DM(used.astype(float))).sparsity()
        row, column = (np.array(part) for part in pattern.get_triplet())
        upper = ca.Sparsity.upper(n)
        up_row, up_column = (np.array(part) for part in upper.get_triplet())
        one, dense_g = ca.Sparsity.dense(1, 1), ca.Sparsity.dense(m, 1)

        def values(x: Any) -> list[Any]:
            f, g = a.values(x)
            return [f, g]

        def slope(x: Any, _: Any) -> list[Any]:
            f, _, gradient = a.first(x)
            return [f, gradient]

        def jacobian(x: Any, _: Any) -> list[Any]:
            _, g, _ = a.first(x)
            return [g, ca.DM(pattern, a.dense_rows(everything)[row, column])]

        def hessian(x: Any, _: Any, sigma: Any, multiplier: Any) -> list[Any]:
            a.first(x)
            matrix = a.condensed(float(sigma[0]), multiplier, np.zeros(m))
            return [ca.DM(upper, matrix[up_row, up_column])]

        self._calls = (
            _Call('both', [n], [one, dense_g], values),
            _Call('nlp_grad_f', [n, 0], [one, ca.Sparsity.dense(n, 1)], slope),
            _Call('nlp_jac_g', [n, 0], [dense_g, pattern], jacobian),
            _Call('nlp_hess_l', [n, 0, 1, m], [upper], hessian),
        )
        both, grad_f, jac_g, hess_lag = self._calls
        x = ca.MX.sym('x', n)
        f, g = both(x)
        options = {
            'grad_f': grad_f, 'jac_g': jac_g, 'hess_lag': hess_lag, 'no_nlp_grad': True,
            'print_time': False, 'error_on_fail': False, 'calc_lam_p': False,
            'ipopt.print_level': 0, 'ipopt.sb': 'yes',
            'ipopt.tol': 1e-8, 'ipopt.max_iter': 400, 'ipopt.mu_init': 1e-3,
        }  # fmt: skip
        self._ipopt = ca.nlpsol('referee', 'ipopt', {'x': x, 'f': f, 'g': g}, options)

    def solve(self, x0: Any) -> tuple[float, bool, int]:
        """Return objective, success, iterations."""
        p = self.programme
        result = self._ipopt(
            x0=np.clip(x0, p.lower, p.upper), lbx=p.lower, ubx=p.upper, lbg=p.row_lower,
            ubg=p.row_upper,
        )  # fmt: skip
        stats = self._ipopt.stats()
        return float(result['f']), bool(stats['success']), int(stats['iter_count'])


def single(
    predictor: SpatialPredictor, task: SpatialTask, x0: Any, warm: Solution | None = None
) -> Solution:
    """One solve, without the check between the nodes."""
    programme = spatial_programme(
        predictor.assembler, predictor.grid, task.parameters, task.bounds
    )
    x0 = np.clip(x0, programme.lower, programme.upper)
    return solve(programme, x0, predictor.options.interior_point(), warm)


def pair(key: str, predictor: SpatialPredictor, task: SpatialTask, x0: Any) -> dict[str, float]:
    """Time both solvers on one task."""
    wall, cpu = [], []
    for _ in range(REPEATS):
        begin, begin_cpu = time.perf_counter(), time.process_time()
        mine = single(predictor, task, x0)
        cpu.append(time.process_time() - begin_cpu)
        wall.append(time.perf_counter() - begin)
    if not mine.ok:
        raise RuntimeError(f'{key}: {mine.status} {mine.violated}')
    referee, other_wall = Referee(predictor, task), []
    for _ in range(IPOPT_REPEATS):
        begin = time.perf_counter()
        objective, solved, iterations = referee.solve(x0)
        other_wall.append(time.perf_counter() - begin)
    if not solved:
        print(f'{key}: IPOPT did not converge')
    elif abs(mine.objective - objective) > 1e-3 * abs(objective):
        print(f'{key}: another minimum: {mine.objective:.6f}, IPOPT {objective:.6f}')
    return {
        f'{key}_s': float(np.median(wall)), f'{key}_cpu_s': float(np.median(cpu)),
        f'{key}_iterations': mine.iterations, f'{key}_objective': mine.objective,
        f'ipopt_{key}_s': float(np.median(other_wall)), f'ipopt_{key}_iterations': iterations,
        f'ipopt_{key}_objective': objective if solved else float('nan'),
    }  # fmt: skip


def warm(predictor: SpatialPredictor, task: SpatialTask, x0: Any) -> dict[str, float]:
    """Rate of solves that begin with the solution of the task before."""
    rng, solution = np.random.default_rng(1), single(predictor, task, x0)
    wall, cpu, failed = [], [], 0
    for _ in range(WARM_STEPS):
        hand = task.bounds.hand.copy()
        # Both hands move together, so that the box stays level and as wide.
        hand[1] += WARM_SHIFT * np.tile(rng.uniform(-1.0, 1.0, 3), 2)
        mass = task.bounds.box_mass + WARM_MASS * rng.uniform(-1.0, 1.0)
        task = replace(task, bounds=replace(task.bounds, hand=hand, box_mass=mass))
        begin, begin_cpu = time.perf_counter(), time.process_time()
        solution = single(predictor, task, solution.x, solution)
        cpu.append(time.process_time() - begin_cpu)
        wall.append(time.perf_counter() - begin)
        failed += not solution.ok
    if failed:
        raise RuntimeError(f'{failed} of {WARM_STEPS} warm solves did not converge')
    return {
        '3d_warm_hz': 1.0 / float(np.median(wall)), '3d_warm_cpu_hz': 1.0 / float(np.median(cpu)),
    }  # fmt: skip


def random_task(
    rng: np.random.Generator, finder: PostureFinder, predictor: SpatialPredictor, name: str
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
            depth, width, _ = plan.box_size
            end = plan.end
            places = np.array([plan.start, (c * end[0], s * end[0], end[2])])
            box = PlacedBox((plan.box_mass,) * 2, depth, width, places, np.array([0.0, turn]))
            task = place_task(person, frame, box, (DURATION,) * 2, predictor.grid, name)
            return task, finder.starts(task, predictor.grid)
        except (HumanModelError, LiftPredictorError):
            continue


def random_lifts(predictor: SpatialPredictor, count: int) -> dict[str, float]:
    """Solve and check random tasks."""
    rng, finder = np.random.default_rng(3), PostureFinder(predictor.library)
    solved, violations, wall = 0, 0, []
    for k in range(count):
        task, starts = random_task(rng, finder, predictor, f'random {k}')
        begin = time.perf_counter()
        far = tuple(replace(start, barrier=FAR) for start in starts)
        for attempt in (starts[:1], starts[1:], far):
            prediction = predictor.solve_task(task, attempt)
            if prediction.report.ok:
                break
        wall.append(time.perf_counter() - begin)
        if prediction.report.ok:
            solved += 1
            check = prediction.verification
            violations += any(check.violation[name] > most for name, most in TOLERANCE.items())
        else:
            print(f'random {k}: {prediction.report.message}')
    return {
        'random3d_solved': solved, 'random3d_tasks': count, 'dense_grid_violations': violations,
        'random3d_s': float(np.median(wall)),
    }  # fmt: skip


def run(random_tasks: int = RANDOM_TASKS) -> Mapping[str, float]:
    """Time all solves in space.

    Returns
    -------
    dict
        `3d_fixed_s`, `3d_max_s`, `3d_warm_hz`, `random3d_solved`, `dense_grid_violations`, and
        `ipopt_*`, `*_cpu_s`, `*_iterations` beside them.
    """
    lift = recorded_lift('asymmetric_7kg')
    predictor = SpatialPredictor()
    predictor.configure(named_subject('thesis_ch4'))
    box = Box(lift.box_mass, 0.238)
    task = predictor.task(lift, box)
    x0 = recorded_starts(task, predictor.grid)[0].variables()
    result = pair('3d_fixed', predictor, task, x0) | warm(predictor, task, x0)

    heavy = open_mass(predictor.task(lift, box, ground_windows=False))
    starts = recorded_starts(heavy, predictor.grid)[:1]
    found = maximum_weight(predictor, heavy, starts)
    if found.normalisation is not None:
        scale, share = found.normalisation, Weighting()
        objective = np.array([share.effort / scale.effort, share.box / scale.log_weight])
        weighted = replace(heavy, parameters=replace(heavy.parameters, objective=objective))
        begin = replace(starts[0], box_mass=lift.box_mass).variables()
        result |= pair('3d_max', predictor, weighted, begin)
        result['3d_max_weight_n'] = found.weight
    return result | random_lifts(predictor, random_tasks)
