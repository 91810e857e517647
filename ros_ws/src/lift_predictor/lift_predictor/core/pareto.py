# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which weighting of effort and weight predicts best (sections 2.5 and 2.7).

For each person 21 weightings of equation 2.11 are solved, w1 = 0, 0.05, ..., 1. Their results
make the Pareto curve of figure 2.4; their distance from the recorded lift is the total error 2.24,
whose mean over a group of people chooses the weighting.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.problem.maximum_weight import (
    MaximumWeight,
    Weighting,
    heaviest_box,
    maximum_weight,
)
from lift_predictor.core.problem.model import T
from lift_predictor.core.problem.run import Start
from lift_predictor.core.problem.task_solver import TaskSolver

N_CASES: Final = 21
"""Pareto cases of section 2.5: w1 grows by 0.05."""
CaseProgress = Callable[[int, MaximumWeight], None]


def weightings() -> tuple[Weighting, ...]:
    """Return the weightings of the cases 0 to 20 (section 2.5)."""
    shares = np.linspace(0.0, 1.0, N_CASES)
    return tuple(Weighting(float(w), float(1.0 - w)) for w in shares)


@dataclass(frozen=True, eq=False)
class ParetoCurve:
    """All weightings of one person's task.

    Attributes
    ----------
    results : tuple of MaximumWeight
        In the order of `weightings`; failed ones carry their report.
    """

    results: tuple[MaximumWeight, ...]

    @property
    def criteria(self) -> Array:
        """Normalised effort and negative logarithm of the weight (21, 2); NaN where failed."""
        return np.array([result.criteria for result in self.results])

    @property
    def weight(self) -> Array:
        """Predicted weight (21,) [N]."""
        return np.array([result.weight for result in self.results])

    @property
    def effort(self) -> Array:
        """Dynamic effort (21,) [s]."""
        return np.array([result.effort for result in self.results])


@dataclass(frozen=True)
class TotalError:
    """Total error of equation 2.24 and its parts, one value per case; NaN where a case failed.

    Attributes
    ----------
    angle : array, shape (21,)
        Sum of the RMSE of the six joints [deg] (RMSE Q of table 2.4).
    vertical_force, horizontal_force : array, shape (21,)
        RMSE of the ground reaction [N].
    weight : array, shape (21,)
        Error of the box's weight [N].
    total : array, shape (21,)
        Sum of the four, each divided by its largest value among the cases.
    """

    angle: Array
    vertical_force: Array
    horizontal_force: Array
    weight: Array
    total: Array


def pareto_curve(
    solver: TaskSolver[T],
    task: T,
    starts: Sequence[Start],
    progress: CaseProgress | None = None,
) -> ParetoCurve:
    """Solve all weightings of one task, each from its neighbour's lift.

    Where the neighbour's lift leads to none, all starts are tried.

    Parameters
    ----------
    solver : TaskSolver
        Solves and checks.
    task : LiftTask
        Of `LiftModel.maximum_weight_task`.
    starts : sequence of Start
        Initial guesses of the first case, the heaviest box.
    progress : callable, optional
        Called with the case and its result.
    """
    heaviest = heaviest_box(solver, task, starts)
    results = [heaviest]
    if progress is not None:
        progress(0, heaviest)
    previous = heaviest
    for case, weighting in enumerate(weightings()[1:], 1):
        if heaviest.report.ok:
            near = (previous.prediction.runs[0].as_start(),)
            result = maximum_weight(solver, task, near, weighting, heaviest)
            if not result.report.ok:
                result = maximum_weight(solver, task, starts, weighting, heaviest)
        else:
            result = heaviest
        if result.report.ok:
            previous = result
        results.append(result)
        if progress is not None:
            progress(case, result)
    return ParetoCurve(tuple(results))


def total_error(curve: ParetoCurve, measured_weight: float) -> TotalError:
    """Compare all cases with the recorded lift (equation 2.24).

    Parameters
    ----------
    curve : ParetoCurve
        Of a recorded lift.
    measured_weight : float
        Weight of the box that was lifted [N].

    Raises
    ------
    TaskError
        A solved case has no recorded lift to compare with.
    """
    parts = np.full((4, len(curve.results)), np.nan)
    for case, result in enumerate(curve.results):
        if not result.report.ok:
            continue
        if result.comparison is None:
            raise TaskError(f'{result.prediction.lift_id}: nothing was recorded to compare with')
        apart = result.comparison
        parts[:, case] = (
            apart.joint_rmse.sum(),
            apart.vertical_force_rmse,
            apart.horizontal_force_rmse,
            abs(result.weight - measured_weight),
        )
    solved = np.isfinite(parts[0])
    largest = parts[:, solved].max(axis=1, initial=0.0)
    total = np.full(len(curve.results), np.nan)
    total[solved] = (parts[:, solved] / np.where(largest > 0.0, largest, 1.0)[:, None]).sum(axis=0)
    return TotalError(parts[0], parts[1], parts[2], parts[3], total)


def best_weighting(errors: Sequence[TotalError]) -> tuple[Weighting, Array]:
    """Choose the weighting with the least mean total error over a group.

    Parameters
    ----------
    errors : sequence of TotalError
        One per person.

    Returns
    -------
    weighting : Weighting
        The best.
    mean : array, shape (21,)
        Mean total error of each case; NaN where a person's case failed.

    Raises
    ------
    TaskError
        No person, or no case that was solved for all.
    """
    mean = np.full(N_CASES, np.nan)
    if errors:
        mean = np.array([error.total for error in errors]).mean(axis=0)
    if not np.isfinite(mean).any():
        raise TaskError(f'total error of {len(errors)} people: no case was solved for all')
    return weightings()[int(np.nanargmin(mean))], mean
