# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift compare`: two lifts side by side, from recordings or results of runs.

Chapter V of the thesis compares a symmetric with an asymmetric lift of the same box so.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from lifting_cli.graph_errors import SessionError
from lifting_cli.offline import run_offline
from lifting_report.compared import (
    COMPONENTS,
    SIDES,
    SOURCES,
    ComparedLift,
    MuscleCourse,
    Two,
    muscle_course,
    peak,
)
from lifting_report.compared_page import build_comparison
from lifting_report.figures.loads import muscle_groups
from lifting_report.report_data import Missing
from lifting_report.results import RunFacts, report_data
from lifting_report.results_file import read_results

NUMBERS, PAGE = 'comparison.json', 'comparison.html'
RESULTS = 'results.mcap'
"""What `lift run` calls its results."""


@dataclass(frozen=True)
class CompareLiftsOptions:
    """What to compare.

    Attributes
    ----------
    inputs : two of Path
        Recordings, or results of `lift run` (file or folder).
    output : Path
        Folder of the page; recordings are run into folders in it.
    lifts : two of int
        Number of the lift in each, from 1.
    """

    inputs: tuple[Path, Path]
    output: Path
    lifts: tuple[int, int] = (1, 1)


def compare_lifts(options: CompareLiftsOptions, say: Callable[[str], None]) -> Two:
    """Compare two lifts; write page and numbers.

    Raises
    ------
    BagError
        If a recording or results file cannot be read.
    SessionError
        If there is no such lift, or a recording cannot be tracked.
    """
    found = []
    for path, number, word in zip(options.inputs, options.lifts, ('first', 'second'), strict=True):
        results = _results(path, options.output / word, say)
        found.append(_lift(results, recording_name(path), number))
    first, second = _named_apart(found[0], found[1])
    created = datetime.now(UTC).strftime('%Y-%m-%d %H:%M UTC')
    build_comparison((first, second), created, options.output / PAGE)
    plain = json.dumps([numbers(first), numbers(second)], indent=1)
    (options.output / NUMBERS).write_text(plain + '\n', encoding='utf-8')
    return first, second


def _results(path: Path, folder: Path, say: Callable[[str], None]) -> Path:
    """Return the results file of a run, running a recording first."""
    if not path.exists():
        raise SessionError(f'{path}: is not there')
    if path.name == RESULTS:
        return path
    if (path / RESULTS).is_file():
        return path / RESULTS
    say(f'{path}: a recording, run offline into {folder}')
    return run_offline(path, folder)


def recording_name(path: Path) -> str:
    """Return the name of a recording, or of the folder of the results of its run."""
    return path.parent.name if path.name == RESULTS else path.stem


def _lift(path: Path, recording: str, number: int) -> ComparedLift:
    data = report_data(read_results(path), RunFacts('compared', recording))
    found = () if isinstance(data.lifts, Missing) else data.lifts
    if not 1 <= number <= len(found):
        raise SessionError(f'{path}: lift {number} is not there: it has {len(found)}')
    return ComparedLift(data.header.task, data.header, found[number - 1])


def _named_apart(first: ComparedLift, second: ComparedLift) -> Two:
    """Return both with different names: the task's, else with person, recording or lift."""
    for more in (
        lambda lift: lift.header.task,
        lambda lift: f'{lift.header.task}, {lift.header.subject}',
        lambda lift: f'{lift.header.task}, {lift.header.recording}',
        lambda lift: f'{lift.header.task}, {lift.lift.lift_id}',
    ):
        if more(first) != more(second):
            return replace(first, name=more(first)), replace(second, name=more(second))
    raise SessionError(f'{first.header.recording}, {first.lift.lift_id}: compared with itself')


def numbers(compared: ComparedLift) -> dict[str, Any]:
    """Return the peaks of a lift as plain data; what is missing is null."""
    spine = {
        source: {
            component: _plain(peak(getattr(compared.lift.spine, source), component)[0])
            for component in COMPONENTS
        }
        for source in SOURCES
    }
    muscles = {
        source: {
            f'{group.name}, {side}': _muscle(muscle_course(compared, source, group, side))
            for group in muscle_groups()
            for side in SIDES
        }
        for source in SOURCES
    }
    return {
        'name': compared.name,
        'recording': compared.header.recording,
        'lift_id': compared.lift.lift_id,
        'simulated': compared.header.simulated,
        'body_mass': compared.header.mass,
        'box_mass': compared.header.box_mass,
        'peak_force': spine,
        'peak_activation': muscles,
    }


def _muscle(course: MuscleCourse | Missing) -> float | None:
    return None if isinstance(course, Missing) else _plain(course.peak)


def _plain(value: float) -> float | None:
    return None if math.isnan(value) else value


def table(first: dict[str, Any], second: dict[str, Any]) -> str:
    """Return the peaks of the L5-S1 load of both lifts as text."""
    names = first['name'], second['name']
    width = max(12, *(len(name) for name in names))
    lines = [f'{"peak at L5-S1 [N]":32}' + ''.join(f'{name:>{width + 2}}' for name in names)]
    for component, title in COMPONENTS.items():
        for source, word in SOURCES.items():
            values = [lift['peak_force'][source][component] for lift in (first, second)]
            cells = ['-' if value is None else f'{value:.0f}' for value in values]
            lines.append(
                f'{f"{title}, {word}":32}' + ''.join(f'{cell:>{width + 2}}' for cell in cells)
            )
    return '\n'.join(lines)
