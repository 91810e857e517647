# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Command line of `lift study`: subjects x tasks x weightings, on this machine or a cluster."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from lifting_cli.graph_errors import SessionError


def add_to(commands: Any) -> None:
    """Add the command to the parsers of `lift`."""
    parser = commands.add_parser(
        'study', help='plan the lifts of a population; may be stopped and started again'
    )
    parser.add_argument('study', type=Path, help='study file (YAML); examples/ has one')
    parser.add_argument('--output', type=Path, help='folder (default: out/study/<name of file>)')
    parser.add_argument(
        '--processes', type=int, help='on this machine (default: one for each processor)'
    )
    parser.add_argument('--scheduler', metavar='ADDRESS', help='of a Dask cluster, in place of it')
    parser.add_argument(
        '--retry-crashed', action='store_true',
        help='solve again what ended with an exception or with its process',
    )  # fmt: skip
    parser.set_defaults(handler=_run)


def _run(options: argparse.Namespace) -> int:
    # Loads for long; the other commands need none of it.
    from lift_predictor.core.exceptions import LiftPredictorError
    from lift_predictor.core.study.runner import run_study
    from lift_predictor.core.study.study_file import read_study

    output = options.output or Path('out') / 'study' / options.study.stem
    if options.processes is not None and options.processes < 1:
        raise SessionError(f'--processes {options.processes}: at least 1 is needed')
    try:
        study = read_study(options.study)
        cases = study.cases()
        scheduler = _scheduler(options)
        print(
            f'{study.name}: {len(study.subjects)} subjects, {len(study.tasks)} tasks, '
            f'{len(study.weightings)} weightings: {len(cases)} cases on {scheduler.described}',
            flush=True,
        )
        report = _with_progress(
            lambda listen: run_study(cases, output, scheduler, listen, options.retry_crashed)
        )
    except LiftPredictorError as error:
        raise SessionError(str(error)) from error
    if report.earlier:
        print(f'{report.earlier} of {report.cases} cases were solved before')
    for name, count in sorted(report.statuses.items()):
        print(f'{count:8d}  {name}')
    print(f'written  {report.table}')
    return 0


def _scheduler(options: argparse.Namespace) -> Any:
    from lift_predictor.core.study.schedulers import DaskScheduler, LocalScheduler

    if options.scheduler is not None:
        return DaskScheduler(options.scheduler)
    return LocalScheduler(options.processes)


def _with_progress(work: Any) -> Any:
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn('{task.description}'), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(),
    )  # fmt: skip
    with Progress(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task('cases')
        failed = 0

        def listen(done: int, total: int, row: dict[str, Any] | None) -> None:
            nonlocal failed
            failed += row is not None and row['status'] != 0
            words = f'cases ({failed} without a lift)' if failed else 'cases'
            bar.update(task, completed=done, total=total, description=words)

        return work(listen)
