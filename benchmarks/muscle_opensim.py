# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The real OpenSim on the motions of `muscle_motions`: its time a frame, and what it says.

Force-length-velocity is on, on both sides. OpenSim runs in its own process with one thread.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
from benchmarks import opensim_timing
from benchmarks.muscle_motions import BenchMotion
from numpy.typing import NDArray

from human_model.typing import Array
from muscle_analyzer.core.loads.joint_loads import lumbosacral_body
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.opensim_bridge import setup_files as files
from muscle_analyzer.core.opensim_bridge.compare import Comparison, compare
from muscle_analyzer.core.opensim_bridge.export import ExportOptions, export_motion
from muscle_analyzer.core.opensim_bridge.motion_on_model import MotionOnModel
from muscle_analyzer.core.opensim_bridge.own_results import OwnSide
from muscle_analyzer.core.opensim_bridge.process import OpenSimPython, run_opensim
from muscle_analyzer.core.opensim_bridge.results import OpenSimRun, read_opensim

OPTIONS: Final = MuscleAnalyzerOptions(force_length_velocity=True)
COMPARED: Final = 7
"""Instants of a motion at which all results are compared."""
SETTINGS: Final = ExportOptions(physiology=True, tolerance=1e-6, iterations=1000)
"""OpenSim's optimiser where its results count: at its own 1e-4 it stops 0.9 % above the smallest
cost in upright standing, which is 4 % of the force on L5-S1 there. Timed are its own settings."""
TIMED: Final = 7
"""Consecutive frames that are timed, one of them to be taken off."""
AROUND: Final = 15
"""Samples exported on either side of them: all of them would only be read."""
TIMING_LIMIT: Final = 240.0
"""Time [s] that the timing of a motion may take."""


@dataclass(frozen=True, eq=False)
class Referee:
    """What OpenSim says of a motion.

    Attributes
    ----------
    comparison
        All differences.
    moment_arm : (k,) array
        Absolute differences [mm] of the moment arms that are not zero on both sides.
    l5_s1_percent : (i,) array
        Difference of the forces on L5-S1 in per cent of OpenSim's, instant by instant.
    """

    comparison: Comparison
    moment_arm: Array
    l5_s1_percent: Array


def compared_rows(motion: MotionOnModel) -> NDArray[np.int64]:
    """Give the samples of a motion that are compared: at even distances, not its ends.

    Splines do not know what was outside.
    """
    step = motion.time.size // (COMPARED + 1)
    return step * np.arange(1, COMPARED + 1, dtype=np.int64)


def referee(python: OpenSimPython, given: BenchMotion) -> Referee:
    """Have OpenSim solve a motion at some instants and compare everything."""
    motion = given.motion
    rows = compared_rows(motion)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _export(folder, given, motion, replace(SETTINGS, samples_per_solution=int(rows[0])))
        run_opensim(python, folder, motion.time[rows], print, together=True)
        own = OwnSide(motion, OPTIONS)
        run = read_opensim(folder, motion, own.muscle_names, own.coordinate_names, rows)
    result = compare(motion, motion, rows, run, OPTIONS)
    return Referee(result, *_spread(own, run, rows))


def _spread(own: OwnSide, run: OpenSimRun, rows: NDArray[np.int64]) -> tuple[Array, Array]:
    """Give the differences of moment arms [mm] and of the forces on L5-S1 [%]."""
    mine, other = own.answer(rows), run.answer
    model = own.motion.model
    crossing = (np.abs(mine.moment_arm) > 1e-9) | (np.abs(other.moment_arm) > 1e-9)
    arms = 1e3 * np.abs(mine.moment_arm - other.moment_arm)[crossing]
    here = model.body_index(lumbosacral_body(model))
    ours, theirs = (np.linalg.norm(a.reaction[:, here, 3:], axis=1) for a in (mine, other))
    return arms, 100.0 * np.abs(ours - theirs) / theirs


def timed_rows(motion: MotionOnModel) -> NDArray[np.int64]:
    """Give the consecutive samples that are timed: in the middle of the motion."""
    first = (motion.time.size - TIMED) // 2
    return first + np.arange(TIMED, dtype=np.int64)


def seconds_a_frame(python: OpenSimPython, given: BenchMotion) -> tuple[float, float]:
    """Give the wall and processor time [s] that OpenSim takes for one frame of a motion.

    Static optimisation and joint reactions of consecutive frames, without reading the model and
    the motion: see `opensim_timing`.
    """
    rows = timed_rows(given.motion)
    motion = _part(given.motion, slice(rows[0] - AROUND, rows[-1] + AROUND + 1))
    step = float(motion.time[1] - motion.time[0])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _export(folder, given, motion, ExportOptions(physiology=True, samples_per_solution=1))
        script = Path(opensim_timing.__file__)
        command = [
            str(python.path), '-I', str(script), str(folder), '--frames', str(TIMED),
            '--start', f'{motion.time[AROUND]:.9f}', '--step', f'{step:.9f}',
        ]  # fmt: skip
        with (folder / 'log').open('w', encoding='utf-8') as log:
            subprocess.run(
                command, check=True, stdout=log, stderr=subprocess.STDOUT, timeout=TIMING_LIMIT
            )
        answer = json.loads((folder / opensim_timing.ANSWER).read_text(encoding='utf-8'))
    wall, processor = (sum(a[kind] for a in answer.values()) for kind in ('wall', 'processor'))
    return wall, processor


def _export(
    folder: Path, given: BenchMotion, motion: MotionOnModel, options: ExportOptions
) -> None:
    export_motion(folder, motion, options)
    if given.original is not None:
        shutil.copyfile(given.original, folder / files.MODEL)


def _part(motion: MotionOnModel, part: slice) -> MotionOnModel:
    """Give a part of a motion."""
    forces = tuple(
        replace(f, force=f.force[part], point=f.point[part], moment=f.moment[part])
        for f in motion.forces
    )
    arrays = {name: getattr(motion, name)[part] for name in ('time', 'q', 'qd', 'qdd')}
    return replace(motion, forces=forces, **arrays)
