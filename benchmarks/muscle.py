# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Time and accuracy of one frame of the muscle analysis, beside the real OpenSim.

A frame is `LoadSolver.solve`: kinematics, inverse dynamics, muscle paths with wrapping,
force-length-velocity, static optimisation and the reactions of all joints, called as the live
analysis calls it, one sample after the other, in one process with one thread. Its times are those
of the clock. What OpenSim computes, and which of its time counts, stands in `muscle_opensim`.
Without OpenSim (`make opensim`) its figures are left out, and so are those of recordings that are
not there; both are said.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from benchmarks import muscle_motions as motions
from benchmarks.muscle_motions import BenchMotion
from benchmarks.muscle_opensim import OPTIONS, Referee, referee, seconds_a_frame, timed_rows

from human_model.typing import Array
from muscle_analyzer.core.exceptions import OpenSimError
from muscle_analyzer.core.loads.load_solver import LoadSolver
from muscle_analyzer.core.opensim_bridge.process import OpenSimPython, find_opensim

ROUNDS: Final = 10
"""How often a motion is computed; the first time, which loads compiled functions, is not timed."""


@dataclass(frozen=True, eq=False)
class OwnFrames:
    """Times and reports of the frames of a motion.

    Attributes
    ----------
    wall, processor : (ROUNDS, n) arrays
        Times of each frame [us].
    kkt : (n,) array
        Largest of the projected gradient of the optimisation and of the torque left over, the
        latter relative to the frame's largest torque.
    unsolved : int
        Frames whose optimisation did not converge.
    too_weak : int
        Frames solved with the help of reserves, as the model's muscles are too weak for them.
    """

    wall: Array
    processor: Array
    kkt: Array
    unsolved: int
    too_weak: int


def own_frames(given: BenchMotion) -> OwnFrames:
    """Compute all frames of a motion, over and over."""
    motion = given.motion
    n = motion.time.size
    solver = LoadSolver(motion.model, OPTIONS)
    external = [motion.external(k) for k in range(n)]
    wall, processor = np.zeros((ROUNDS + 1, n)), np.zeros((ROUNDS + 1, n))
    solutions: list[Any] = []
    for turn in range(ROUNDS + 1):
        solver.reset()
        solutions = []
        for k in range(n):
            state = motion.q[k], motion.qd[k], motion.qdd[k]
            clock, used = time.perf_counter_ns(), time.thread_time_ns()
            solution = solver.solve(*state, external[k])
            processor[turn, k] = 1e-3 * (time.thread_time_ns() - used)
            wall[turn, k] = 1e-3 * (time.perf_counter_ns() - clock)
            solutions.append(solution)
    reports = [solution.balance.report for solution in solutions]
    largest = [max(1.0, float(np.abs(solution.torque).max())) for solution in solutions]
    kkt = [
        max(report.dual_residual, report.primal_residual / torque)
        for report, torque in zip(reports, largest, strict=True)
    ]
    converged = [solution.balance.converged for solution in solutions]
    return OwnFrames(
        wall[1:],
        processor[1:],
        np.array(kkt),
        converged.count(False),
        sum(good and not r.ok for good, r in zip(converged, reports, strict=True)),
    )


def run() -> dict[str, float]:
    """Give the figures by name."""
    try:
        python = find_opensim()
    except OpenSimError as error:
        print(f'without OpenSim, its figures are left out: {error}')
        python = None
    lifts = []
    if motions.SQUATS.is_dir():
        lifts.append(motions.squats())
    else:
        print(f'without the real squats: {motions.SQUATS} is not there')
    lifts.append(motions.asymmetric())
    figures = _lifting_model(lifts, python)
    if motions.GAIT_MODEL.is_file():
        figures |= _gait_model(motions.gait(lifts[0].motion), python)
    else:
        print(f'without the gait model: {motions.GAIT_MODEL} is not there')
    return figures


def _lifting_model(lifts: list[BenchMotion], python: OpenSimPython | None) -> dict[str, float]:
    own = {lift.name: own_frames(lift) for lift in lifts}
    every = np.concatenate([frames.wall.ravel() for frames in own.values()])
    used = np.concatenate([frames.processor.ravel() for frames in own.values()])
    figures = {
        'frame_us_p50': float(np.percentile(every, 50)),
        'frame_us_p99': float(np.percentile(every, 99)),
        'frame_processor_us_p50': float(np.percentile(used, 50)),
        'kkt_residual_max': max(float(frames.kkt.max()) for frames in own.values()),
        'frames_analysed': float(sum(frames.kkt.size for frames in own.values())),
        'frames_unsolved': float(sum(frames.unsolved for frames in own.values())),
        'frames_muscles_too_weak': float(sum(frames.too_weak for frames in own.values())),
    }
    if python is None:
        return figures
    theirs = [seconds_a_frame(python, lift) for lift in lifts]
    ours = np.concatenate([_timed(lift, own[lift.name]).ravel() for lift in lifts])
    figures |= _against('', ours, np.mean(theirs, axis=0))
    return figures | _accuracy([referee(python, lift) for lift in lifts])


def _gait_model(lift: BenchMotion, python: OpenSimPython | None) -> dict[str, float]:
    own = own_frames(lift)
    figures = {
        'frame_us_p50_rajagopal': float(np.percentile(own.wall, 50)),
        'frame_us_p99_rajagopal': float(np.percentile(own.wall, 99)),
        'frames_unsolved_rajagopal': float(own.unsolved),
    }
    if python is None:
        return figures
    theirs = np.array(seconds_a_frame(python, lift))
    figures |= _against('_rajagopal', _timed(lift, own), theirs)
    arms = referee(python, lift).moment_arm
    return figures | {'moment_arm_mm_max_rajagopal': float(arms.max())}


def _timed(lift: BenchMotion, frames: OwnFrames) -> Array:
    """Give our times [us] of the frames of which OpenSim's are taken."""
    return frames.wall[:, timed_rows(lift.motion)]


def _against(label: str, ours: Array, theirs: Array) -> dict[str, float]:
    """Give OpenSim's wall and processor time [ms] of a frame, and how many of ours fit into it."""
    milliseconds = 1e3 * theirs
    return {
        f'opensim_so_jr_ms{label}': float(milliseconds[0]),
        f'opensim_so_jr_processor_ms{label}': float(milliseconds[1]),
        f'ratio_to_opensim{label}': float(1e3 * milliseconds[0] / np.median(ours)),
    }


def _accuracy(found: list[Referee]) -> dict[str, float]:
    arms = np.concatenate([one.moment_arm for one in found])
    comparisons = [one.comparison for one in found]
    costs = [i.cost_equal_torques for c in comparisons for i in c.instants]
    equal = [c.difference('force on L5-S1, equal muscle forces').largest for c in comparisons]
    return {
        'moment_arm_mm_p50': float(np.percentile(arms, 50)),
        'moment_arm_mm_p95': float(np.percentile(arms, 95)),
        'moment_arm_mm_max': float(arms.max()),
        'so_cost_over_opensim_max': max((ours - theirs) / theirs for ours, theirs in costs),
        'l5s1_diff_percent': max(float(one.l5_s1_percent.max()) for one in found),
        'l5s1_diff_percent_of_peak': max(
            c.difference('force on L5-S1').percent_of_peak for c in comparisons
        ),
        'l5s1_equal_forces_N': max(equal),
    }
