# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The Pareto study of chapter II on a simulated group: 12 men, 21 weightings, 252 solves.

Nobody was measured: the men have the statures and masses of chapter II, their lifts come from
`bags.simulate`, all with the box of 233.73 N that chapter II reports. As in the dissertation each
man's strength percentile is found from his lift first.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from typing import Final

from bags.simulate.group import lifting_task, simulated_lift, study_group

from human_model.motion import Lift
from human_model.subject import Subject
from human_model.task import Box
from human_model.typing import Array
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.pareto import (
    ParetoCurve,
    TotalError,
    best_weighting,
    pareto_curve,
    total_error,
)
from lift_predictor.core.percentile import Percentile, percentile_by_root
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.maximum_weight import Weighting

TASK: Final = 'symmetric_max'
CORES: Final = 2


@dataclass(frozen=True, eq=False)
class Man:
    """One man of the group with his lift and the strength that it needs.

    Attributes
    ----------
    subject : Subject
        With the z-score that was found.
    lift : Lift
        Simulated.
    percentile : Percentile
        What was found.
    """

    subject: Subject
    lift: Lift
    percentile: Percentile


OPTIONS: Final = PredictorOptions(n_control=8, n_nodes=29)
"""With 7 control points two of the twelve men have no motion to the middle posture."""


@dataclass(frozen=True, eq=False)
class Case:
    """One man's 21 cases.

    Attributes
    ----------
    subject : Subject
        Who.
    criteria : array, shape (21, 2)
        Normalised.
    weight, effort : array, shape (21,)
        [N], [s].
    solved : int
        Cases with a solution that passed all checks.
    error : TotalError
        Against the simulated lift.
    """

    subject: Subject
    criteria: Array
    weight: Array
    effort: Array
    solved: int
    error: TotalError


@dataclass(frozen=True, eq=False)
class Study:
    """The whole group.

    Attributes
    ----------
    cases : tuple of Case
        One per man.
    best : Weighting
        With the least mean total error.
    mean_error : array, shape (21,)
        Mean total error.
    seconds : float
        Wall time of the solves on `CORES` processes [s].
    """

    cases: tuple[Case, ...]
    best: Weighting
    mean_error: Array
    seconds: float


@cache
def _worker() -> LiftPredictor:
    """Return this process's predictor."""
    return LiftPredictor(OPTIONS)


def task_box() -> Box:
    """Return the box of the task."""
    task = lifting_task(TASK)
    return Box(task.box_mass, task.box_size)


def find_man(subject: Subject, weighting: Weighting) -> Man:
    """Simulate a man's lift and find the strength with which it is his heaviest.

    Raises
    ------
    PercentileError
        There is none.
    """
    lift = simulated_lift(subject, lifting_task(TASK))
    found = percentile_by_root(_worker(), subject, lift, task_box(), weighting)
    fields = subject.to_dict() | {'strength_z': found.z_score}
    return Man(Subject.from_dict(fields), lift, found)


def curve_of(man: Man) -> ParetoCurve:
    """Solve a man's 21 weightings."""
    solver = _worker().sagittal
    task = solver.model.maximum_weight_task(man.subject, man.lift, task_box())
    return pareto_curve(solver, task, solver.model.starts(task))


def solve_man(man: Man) -> Case:
    """Solve a man's 21 weightings and compare them with his lift."""
    curve = curve_of(man)
    return Case(
        subject=man.subject,
        criteria=curve.criteria,
        weight=curve.weight,
        effort=curve.effort,
        solved=sum(result.report.ok for result in curve.results),
        error=total_error(curve, man.percentile.measured),
    )


def study(weighting: Weighting | None = None, cores: int = CORES) -> Study:
    """Find all men's strength, then solve and time all cases.

    Parameters
    ----------
    weighting : Weighting, optional
        With which the strength is found; (0.15, 0.85) if omitted.
    cores : int
        Processes.
    """
    group = study_group()
    weighting = weighting or Weighting()
    with ProcessPoolExecutor(cores, multiprocessing.get_context('spawn')) as pool:
        men = list(pool.map(find_man, group, [weighting] * len(group)))
        begin = time.perf_counter()
        cases = tuple(pool.map(solve_man, men))
        seconds = time.perf_counter() - begin
    best, mean = best_weighting([case.error for case in cases])
    return Study(cases, best, mean, seconds)


def run() -> Mapping[str, float]:
    """Run the study.

    Returns
    -------
    dict
        `pareto_252_solves_s`, wall time on two cores [s]; `pareto_solved`, how many of the 252;
        `pareto_best_effort_weight`, w1 of the best weighting.
    """
    result = study()
    return {
        'pareto_252_solves_s': result.seconds,
        'pareto_solved': sum(case.solved for case in result.cases),
        'pareto_best_effort_weight': result.best.effort,
    }


if __name__ == '__main__':
    print(dict(run()))
