# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Run OpenSim's tools on an exported folder.

A script for the Python that has the `opensim` wheel; it needs nothing of this project, and runs in
a process of its own because OpenSim and CasADi ship different libraries of one name::

    python script.py FOLDER --at 0.5 0.8

The set-ups in the folder are run as they are: inverse dynamics of the whole motion, static
optimisation and joint reactions at the given times only, each in a run of its own or, with
`--together`, in one run from the first to the last. Results go to the folder's `results`, path
lengths and moment arms to `results/opensim.json`.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

#: As in the names that the exporter gives; this script cannot import them.
INVERSE_DYNAMICS = 'setup_inverse_dynamics.xml'
STATIC_OPTIMIZATION = 'setup_static_optimization.xml'
JOINT_REACTION = 'setup_joint_reaction.xml'
MODEL, COORDINATES, RESULTS = 'model.osim', 'coordinates.mot', 'results'
ANSWER = 'opensim.json'
FORCES, ACTIVATIONS, REACTIONS = (
    'lift_StaticOptimization_force.sto',
    'lift_StaticOptimization_activation.sto',
    'lift_JointReaction_ReactionLoads.sto',
)
#: A table of one row gets a second one so much later [s]: OpenSim interpolates.
SECOND_ROW = 1e-6


def rows_of(path: Path) -> tuple[list[str], list[str]]:
    """Return the lines up to the labels, and the rows."""
    lines = path.read_text(encoding='utf-8').splitlines()
    end = next(i for i, line in enumerate(lines) if line.strip() == 'endheader')
    return lines[: end + 2], [line for line in lines[end + 2 :] if line.strip()]


def joined(parts: list[Path], path: Path) -> None:
    """Write the rows of several tables with the same columns as one table."""
    header: list[str] = []
    rows: list[str] = []
    for part in parts:
        header, more = rows_of(part)
        rows += more
    if len(rows) == 1:
        stamp, rest = rows[0].split(None, 1)
        rows.append(f'{float(stamp) + SECOND_ROW:.9f}\t{rest}')
    header = [f'nRows={len(rows)}' if line.startswith('nRows=') else line for line in header]
    path.write_text('\n'.join(header + rows) + '\n', encoding='utf-8')


def run(tool: Any, what: str) -> None:
    """Run a tool; raise RuntimeError if it fails."""
    if not tool.run():
        raise RuntimeError(f'OpenSim: {what} failed')


def analyze(opensim: Any, setup: str, start: float, end: float, place: Path) -> float:
    """Run an AnalyzeTool from start to end into a folder; return the seconds it took."""
    tool = opensim.AnalyzeTool(setup)
    tool.setInitialTime(start)
    tool.setFinalTime(end)
    tool.setResultsDir(str(place))
    began = time.perf_counter()
    run(tool, f'{setup} from {start:.6g} to {end:.6g} s')
    return time.perf_counter() - began


def solve_apart(opensim: Any, times: list[float], results: Path) -> dict[str, list[float]]:
    """Run both tools at each time apart; return the seconds of each run."""
    seconds: dict[str, list[float]] = {'static_optimization': [], 'joint_reaction': []}
    places = [results / f'instant_{k}' for k in range(len(times))]
    for at, place in zip(times, places, strict=True):
        seconds['static_optimization'].append(analyze(opensim, STATIC_OPTIMIZATION, at, at, place))
        print(f'{at:.3f} s solved', flush=True)
    for name in (FORCES, ACTIVATIONS):
        joined([place / name for place in places], results / name)
    for at, place in zip(times, places, strict=True):
        seconds['joint_reaction'].append(analyze(opensim, JOINT_REACTION, at, at, place))
    joined([place / REACTIONS for place in places], results / REACTIONS)
    return seconds


def solve_together(opensim: Any, times: list[float], results: Path) -> dict[str, list[float]]:
    """Run both tools once over all times, to which the set-ups' step leads."""
    window = (times[0], times[-1], results)
    seconds = {'static_optimization': [analyze(opensim, STATIC_OPTIMIZATION, *window)]}
    print(f'{times[0]:.3f} to {times[-1]:.3f} s solved', flush=True)
    return seconds | {'joint_reaction': [analyze(opensim, JOINT_REACTION, *window)]}


def coupled(opensim: Any, model: Any) -> set[str]:
    """Return the coordinates that others drive."""
    constraints = model.getConstraintSet()
    found = set()
    for i in range(constraints.getSize()):
        coupler = opensim.CoordinateCouplerConstraint.safeDownCast(constraints.get(i))
        if coupler is not None:
            found.add(coupler.getDependentCoordinateName())
    return found


def geometry(opensim: Any, times: list[float]) -> dict[str, Any]:
    """Return path lengths and moment arms of all muscles at the given times."""
    model = opensim.Model(MODEL)
    state = model.initSystem()
    coordinates, muscles = model.getCoordinateSet(), model.getMuscles()
    every = [coordinates.get(i).getName() for i in range(coordinates.getSize())]
    driven = coupled(opensim, model)
    about = [n for n in every if n not in driven and not coordinates.get(n).get_locked()]
    table = opensim.TimeSeriesTable(COORDINATES)
    stamps = list(table.getIndependentColumn())
    columns = {name: table.getDependentColumn(name) for name in every}
    lengths, arms = [], []
    for at in times:
        row = min(range(len(stamps)), key=lambda k: abs(stamps[k] - at))
        for name in every:
            if not coordinates.get(name).get_locked():
                coordinates.get(name).setValue(state, columns[name][row], False)
        model.realizePosition(state)
        paths = [muscles.get(i).getPath() for i in range(muscles.getSize())]
        lengths.append([path.getLength(state) for path in paths])
        arms.append(
            [[path.computeMomentArm(state, coordinates.get(n)) for n in about] for path in paths]
        )
    return {
        'muscles': [muscles.get(i).getName() for i in range(muscles.getSize())],
        'coordinates': about,
        'length': lengths,
        'moment_arm': arms,
    }


def main() -> int:
    """Run the tools and write their results; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('folder', type=Path)
    parser.add_argument('--at', type=float, nargs='+', required=True, metavar='SECONDS')
    parser.add_argument('--together', action='store_true')
    arguments = parser.parse_args()
    opensim = importlib.import_module('opensim')
    opensim.Logger.setLevelString('Warn')
    opensim.Logger.removeFileSink()
    os.chdir(arguments.folder)
    results = Path(RESULTS)
    results.mkdir(exist_ok=True)

    began = time.perf_counter()
    run(opensim.InverseDynamicsTool(INVERSE_DYNAMICS), 'inverse dynamics')
    seconds = {'inverse_dynamics': [time.perf_counter() - began]}
    solve = solve_together if arguments.together else solve_apart
    seconds |= solve(opensim, arguments.at, results)
    answer = {
        'opensim': opensim.GetVersion(),
        'times': arguments.at,
        'seconds': seconds,
        **geometry(opensim, arguments.at),
    }
    (results / ANSWER).write_text(json.dumps(answer), encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main())
