# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Time from the start of a fresh process to the answer, with compiled functions in the cache.

The process reads the person and the task, plans the lift without a recording, solves it, checks
it on the dense grid and prints the effort. Interpreter and imports are included.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Mapping
from typing import Final

REPEATS: Final = 20
CODE: Final = """
from human_model.named_subjects import named_subject
from lift_predictor.core.planning.plan_task import Feet, PlanTask
from lift_predictor.core.predictor import LiftPredictor

solver = LiftPredictor().sagittal
task = PlanTask(
    'cold', 7.0, (0.238, 0.305, 0.127), (0.369, 0.0, 0.25), (0.5, 0.0, 0.9), feet=(0.0, 0.0)
)
plan = solver.model.plan(named_subject('thesis_ch4'), task, Feet(0.0, 0.0))
prediction = solver.solve(plan.task, solver.model.plan_starts(plan, 2))
if not prediction.report.ok:
    raise SystemExit(prediction.report.message)
print(prediction.report.objective)
"""
"""Box of the dissertation (section 4.3) from the nearest place to a shelf of 0.9 m."""


def once() -> float:
    """Run the process once; return its wall time [s]."""
    begin = time.perf_counter()
    subprocess.run([sys.executable, '-c', CODE], check=True, capture_output=True, timeout=120)
    return time.perf_counter() - begin


def run() -> Mapping[str, float]:
    """Return `cold_process_s`, the median wall time of fresh processes [s]."""
    once()
    return {'cold_process_s': statistics.median(once() for _ in range(REPEATS))}


if __name__ == '__main__':
    print(dict(run()))
