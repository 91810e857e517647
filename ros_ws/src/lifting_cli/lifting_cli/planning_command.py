# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Command line of `lift predict`: plan a lift from a task file, without a recording."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lifting_cli.graph_errors import SessionError

if TYPE_CHECKING:
    from lift_predictor.core.planning.planned_lift import PlannedLift
    from lifting_report.planned_results import PlanFiles, SpinePeak


SHOWN = 8
"""Joints that are printed; all are in plan.json."""


def add_to(commands: Any) -> None:
    """Add the command to the parsers of `lift`."""
    parser = commands.add_parser(
        'predict', help='plan a lift from a task file (YAML), without a recording'
    )
    parser.add_argument('task', type=Path, help='task file; examples/ has some')
    parser.add_argument('--output', type=Path, help='folder (default: out/predict/<name of file>)')
    parser.add_argument(
        '--weights', type=float, nargs=2, metavar=('EFFORT', 'BOX'), default=(0.15, 0.85),
        help='weighting where the largest mass is asked for (default: 0.15 0.85)',
    )  # fmt: skip
    parser.add_argument(
        '--no-report', action='store_true', help='do not write report.html into the folder'
    )
    parser.set_defaults(handler=_run)


def _run(options: argparse.Namespace) -> int:
    # Loads for long; the other commands need none of it.
    from human_model.exceptions import HumanModelError
    from lift_predictor.core.exceptions import LiftPredictorError
    from lift_predictor.core.planning.planner import LiftPlanner
    from lift_predictor.core.planning.task_file import read_task_file
    from lift_predictor.core.problem.maximum_weight import Weighting
    from lifting_report.planned_results import write_plan
    from muscle_analyzer.core.exceptions import MuscleAnalyzerError

    output = options.output or Path('out') / 'predict' / options.task.stem
    try:
        entry = read_task_file(options.task)
        planner = LiftPlanner(weighting=Weighting(*options.weights))
        planned = _with_progress(planner, entry)
        files = write_plan(planned, entry, output)
    except (LiftPredictorError, HumanModelError, MuscleAnalyzerError) as error:
        raise SessionError(str(error)) from error
    print('\n'.join(described(planned, files)))
    if not options.no_report:
        # Loads Matplotlib.
        from lifting_report.planned_report import write_planned_report

        page = write_planned_report(planned, entry, files, output / 'report.html')
        print(f'report   {page}')
    return 0 if planned.report.ok else 1


def _with_progress(planner: Any, entry: Any) -> PlannedLift:
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        tasks: dict[str, Any] = {}

        def listen(progress: Any) -> None:
            name = f'{progress.stage}, best {progress.best:.4g}'
            if progress.stage not in tasks:
                tasks[progress.stage] = bar.add_task(name)
            bar.update(
                tasks[progress.stage],
                description=name,
                completed=progress.done,
                total=progress.total,
            )

        planned: PlannedLift = planner.plan(entry.subject, entry.task, listen)
        return planned


def described(planned: PlannedLift, files: PlanFiles) -> list[str]:
    """Return a plan in words, line by line."""
    report, task, summary = planned.report, planned.task, files.summary
    lines = [
        f'{task.name}: {report.status.name}: {report.message}',
        f'  {report.iterations} iterations in {len(planned.prediction.runs)} runs, '
        f'{report.solve_time:.2f} s; residuals {report.primal_residual:.1e} (constraints), '
        f'{report.dual_residual:.1e} (optimality)',
    ]
    if summary is None:
        return [*lines, f'written  {files.json}']
    heaviest = ' (the largest)' if task.box_mass is None else ''
    spatial = planned.prediction.model == 'spatial'
    feet = ' (searched)' if task.feet is None else ''
    lines += [
        f'box      {summary.box_mass:.2f} kg{heaviest}, in {summary.duration:.2f} s',
        f'feet     ankles at forward {summary.ankle:.3f} m, left {summary.left:.3f} m, facing '
        f'{math.degrees(summary.heading):.0f} deg to the left{feet}',
        f'effort   {summary.effort:.4f} s' + (' (in space: each limb counts)' if spatial else ''),
        f'posture  Stoop-Squat-Index {summary.technique_index:.0f} at the start '
        f'(asked for: {task.technique})',
        'joint torques nearest to their limits [N m]' + (':' if spatial else '; both limbs:'),
    ]
    lines += [
        f'  {peak.joint:<17} {peak.torque:8.1f} of {peak.limit:8.1f}  {100 * peak.share:5.1f} %  '
        f'at {peak.time:.2f} s'
        for peak in sorted(summary.peaks, key=lambda peak: -peak.share)[:SHOWN]
    ]
    lines += [
        f'limits touched: {"; ".join(_grouped(summary.active_constraints)) or "none"}',
        f'ground reaction: up to {summary.peak_vertical_force:.0f} N vertical, '
        f'{summary.largest_horizontal_force:.0f} N horizontal',
        'box path (s: forward, left, up m): '
        + ', '.join(f'{t:.2f}: {x:.2f} {y:.2f} {z:.2f}' for t, x, y, z in summary.box_path[::2]),
    ]
    if files.spine is not None:
        lines += _spine(files.spine)
    written = [str(path) for path in (files.results, files.json) if path is not None]
    return [*lines, f'written  {", ".join(written)}']


def _grouped(names: tuple[str, ...]) -> list[str]:
    """Put together what is touched at several instants."""
    instants: dict[str, list[str]] = {}
    for name in names:
        what, _, when = name.rpartition(' at ')
        instants.setdefault(what or name, []).append(when.removesuffix(' of the lift'))
    return [f'{what} ({", ".join(when)})' for what, when in instants.items()]


def _spine(spine: SpinePeak) -> list[str]:
    if math.isnan(spine.compression):
        return [f'L5-S1: no sample of the muscle analysis is good data: {spine.zone}']
    action, largest, shear = (f'{name} {value:.0f} N' for name, (value, _) in spine.limits.items())
    return [
        f'L5-S1 compression up to {spine.compression:.0f} N ({action}, {largest}: NIOSH 1981)',
        f'  {spine.zone}',
        f'L5-S1 anterior shear up to {spine.anterior_shear:.0f} N ({shear})',
        f'  {spine.solved} of {spine.samples} samples of the muscle analysis are good data',
    ]
