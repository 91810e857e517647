# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Time OpenSim's static optimisation and joint reactions a frame.

A script for the Python that has the `opensim` wheel, like the referee; run in an exported folder::

    python opensim_timing.py FOLDER --start 1.3 --frames 6 --step 0.01

The set-ups in it solve every sample. Each AnalyzeTool runs over one frame and over FRAMES. The
difference, divided by FRAMES - 1, is the time of a frame: reading the model, the motion and the
forces, building the system and writing the results is in both and so in neither. Written to
`timing.json`.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import time
from pathlib import Path
from typing import Any

TOOLS = {
    'static_optimization': 'setup_static_optimization.xml',
    'joint_reaction': 'setup_joint_reaction.xml',
}
RESULTS = 'results'
ANSWER = 'timing.json'


def run(opensim: Any, setup: str, start: float, end: float) -> tuple[float, float]:
    """Run a tool over a window; return wall and processor time [s], without reading the model."""
    tool = opensim.AnalyzeTool(setup)
    tool.setInitialTime(start)
    tool.setFinalTime(end)
    tool.setResultsDir(RESULTS)
    wall, processor = time.perf_counter(), time.process_time()
    if not tool.run():
        raise RuntimeError(f'OpenSim: {setup} failed from {start:.6g} to {end:.6g} s')
    return time.perf_counter() - wall, time.process_time() - processor


def main() -> None:
    """Time both tools and write what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('folder', type=Path)
    parser.add_argument('--start', type=float, required=True)
    parser.add_argument('--frames', type=int, required=True)
    parser.add_argument('--step', type=float, required=True)
    arguments = parser.parse_args()
    opensim = importlib.import_module('opensim')
    opensim.Logger.setLevelString('Warn')
    opensim.Logger.removeFileSink()
    os.chdir(arguments.folder)
    more = arguments.frames - 1
    end = arguments.start + more * arguments.step
    answer: dict[str, dict[str, float]] = {}
    for name, setup in TOOLS.items():
        # Joint reactions read the forces of a window: the optimisation of the long one is last.
        one = run(opensim, setup, arguments.start, arguments.start)
        many = run(opensim, setup, arguments.start, end)
        wall, processor = ((b - a) / more for a, b in zip(one, many, strict=True))
        answer[name] = {'wall': wall, 'processor': processor}
    Path(ANSWER).write_text(json.dumps(answer), encoding='utf-8')


if __name__ == '__main__':
    main()
