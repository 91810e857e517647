# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift compare-opensim`: the muscle analysis of a recorded lift beside that of OpenSim."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from human_model.exceptions import HumanModelError
from lifting_cli.graph_errors import SessionError
from lifting_cli.recorded_lifts import recorded_lifts
from muscle_analyzer.core.exceptions import MuscleAnalyzerError
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.opensim_bridge.compare import DIFFERENT_PROBLEM, Comparison, compare
from muscle_analyzer.core.opensim_bridge.export import ExportOptions, export_motion
from muscle_analyzer.core.opensim_bridge.motion_on_model import motion_on_model
from muscle_analyzer.core.opensim_bridge.own_results import OwnSide
from muscle_analyzer.core.opensim_bridge.process import find_opensim, run_opensim
from muscle_analyzer.core.opensim_bridge.results import read_opensim
from muscle_analyzer.core.opensim_bridge.setup_files import RESULTS
from muscle_analyzer.core.recruitment.static_optimization import (
    Criterion,
    StaticOptimizationOptions,
)

#: So many instants, evenly over the lift, if none are asked for.
DEFAULT_INSTANTS = 5
REPORT = 'comparison.json'


@dataclass(frozen=True)
class CompareOptions:
    """What to compare.

    Attributes
    ----------
    bag : Path
        Recording.
    output : Path
        Folder of the exported files and results.
    lift : int
        Number of the lift in the recording, from 1.
    at : tuple of float
        Instants, in seconds from the start of the recording.
    every : float or None
        In place of `at`: an instant every so many seconds of the lift.
    opensim_python : Path or None
        Python that has OpenSim.
    physiology : bool
        Whether muscle force depends on the fibre's length and velocity, on both sides.
    export_only : bool
        Write the files for OpenSim and stop.
    criterion : str
        Of this side's muscle recruitment; OpenSim's is always the sum of squares.
    """

    bag: Path
    output: Path
    lift: int = 1
    at: tuple[float, ...] = ()
    every: float | None = None
    opensim_python: Path | None = None
    physiology: bool = False
    export_only: bool = False
    criterion: str = Criterion.SQUARES.value


def compare_opensim(options: CompareOptions, say: Callable[[str], None]) -> Comparison | None:
    """Export a lift, run OpenSim on it and compare; nothing is returned if only exported.

    Raises
    ------
    BagError
        If the recording cannot be read.
    SessionError
        If it has no such lift, OpenSim is not there or fails, or an instant cannot be compared.
    """
    try:
        # Before anything else: to say after a minute that OpenSim is not there helps nobody.
        python = None if options.export_only else find_opensim(options.opensim_python)
        if options.criterion != Criterion.SQUARES:
            say(
                f'criterion {options.criterion} here, sum of squares in OpenSim, which has only '
                f'sums of powers: {", ".join(DIFFERENT_PROBLEM)} are not compared'
            )
        recorded = recorded_lifts(options.bag)
        found = recorded.lift(options.lift)
        settings = MuscleAnalyzerOptions(
            force_length_velocity=options.physiology,
            static_optimization=StaticOptimizationOptions(criterion=options.criterion),
        )
        analyzer = MuscleAnalyzer(recorded.subject, settings)
        body = found.lift.motion
        motion = motion_on_model(analyzer.new_transfer(body.skeleton), body, recorded.start)
        splined = motion.with_splined_rates()
        rows = splined.rows(_instants(options, splined.time))
        # Results of other instants must not be taken for these.
        shutil.rmtree(options.output / RESULTS, ignore_errors=True)
        written = export_motion(
            options.output, motion, ExportOptions(physiology=options.physiology)
        )
        say(f'{found.lift.lift_id}: {len(written)} files for OpenSim in {options.output}')
        if python is None:
            return None
        say(f'OpenSim {python.version} solves {rows.size} instants, some seconds each')
        run_opensim(python, options.output, splined.time[rows], say)
        own = OwnSide(splined, settings)
        run = read_opensim(options.output, splined, own.muscle_names, own.coordinate_names, rows)
        result = compare(motion, splined, rows, run, settings)
    except (MuscleAnalyzerError, HumanModelError) as error:
        raise SessionError(str(error)) from error
    report = options.output / REPORT
    report.write_text(json.dumps(result.as_dict(), indent=1) + '\n', encoding='utf-8')
    return result


def _instants(options: CompareOptions, time: np.ndarray) -> np.ndarray:
    if options.at and options.every is not None:
        raise SessionError('--at and --every: only one of them can be meant')
    if options.at:
        return np.array(options.at)
    if options.every is None:
        # Not the very ends: a spline's accelerations there hang on its end conditions.
        return np.linspace(time[0], time[-1], DEFAULT_INSTANTS + 2)[1:-1]
    if not (np.isfinite(options.every) and options.every > 0.0):
        raise SessionError(f'--every {options.every}: a positive number of seconds is needed')
    return np.arange(time[0] + options.every, time[-1], options.every)


def table(result: Comparison) -> str:
    """Return the differences as text, one line a quantity and one an instant."""
    head = ('quantity', 'unit', 'count', 'ours', 'OpenSim', 'difference', '% of peak', 'rms', 'at')
    lines: list[tuple[str, ...]] = [head]
    for row in result.differences:
        lines.append(
            (
                row.quantity,
                row.unit,
                str(row.count),
                f'{row.ours:.5g}',
                f'{row.opensim:.5g}',
                f'{row.largest:.2g}',
                f'{row.percent_of_peak:.2g}',
                f'{row.rms:.2g}',
                row.where,
            )
        )
    loads: list[tuple[str, ...]] = [
        (
            'instant [s]', 'compression [N]', 'OpenSim', 'anterior shear [N]', 'OpenSim',
            'lateral shear [N]', 'OpenSim', 'cost', 'OpenSim',
        )
    ]  # fmt: skip
    for instant in result.instants:
        pairs = (instant.compression, instant.anterior_shear, instant.lateral_shear)
        numbers = [f'{value:.1f}' for pair in pairs for value in pair]
        costs = [f'{value:.6g}' for value in instant.cost_equal_torques]
        loads.append((f'{instant.time:.3f}', *numbers, *costs))
    note = (
        f'\nNot compared, because the criterion here is {result.criterion} and OpenSim minimises '
        f'the sum of squares: {", ".join(result.not_compared)}. The loads below are those of the '
        'two criteria; the cost is the sum of squares on both sides.\n'
        if result.not_compared else ''
    )  # fmt: skip
    return (
        f'Largest differences, OpenSim {result.version}\n{_columns(lines)}\n{note}\n'
        f'L5-S1 in the disc frame, and the cost at equal torques\n{_columns(loads)}'
    )


def _columns(lines: list[tuple[str, ...]]) -> str:
    widths = [max(len(line[k]) for line in lines) for k in range(len(lines[0]))]
    rows = []
    for line in lines:
        cells = [
            # The first and the last column are words.
            cell.ljust(width) if k in (0, len(line) - 1) else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(line, widths, strict=True))
        ]
        rows.append('  '.join(cells).rstrip())
    return '\n'.join(rows)
