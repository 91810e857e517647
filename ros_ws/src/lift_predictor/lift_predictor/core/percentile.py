# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Strength percentile of a person from a recorded maximum lift (Xiang et al. 2019).

The z-score of equations 2.15 and 2.18 is the one number of a person that no tape measures. It is
found by prediction: of all z-scores the one whose predicted maximum weight is the weight that the
person was seen to lift at most. The enumeration predicts for every z-score of a grid; as strength,
and with it the weight, grows with z, the same is found by a root search with a few predictions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from human_model.exceptions import HumanModelError
from human_model.motion import Lift
from human_model.report import SolveStatus
from human_model.subject import RANGES, Subject
from human_model.task import Box
from lift_predictor.core.exceptions import PercentileError
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.sagittal.task import SagittalTask
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.maximum_weight import (
    MaximumWeight,
    Weighting,
    maximum_weight,
)
from lift_predictor.core.problem.run import Start

Z_STEP: Final = 0.05
"""Step of the enumeration: the dissertation gives its z-score (1.05) to this step."""
WEIGHT_TOLERANCE: Final = 0.05
"""Distance of predicted and measured weight that ends the root search [N]."""
_Z_TOLERANCE: Final = 1e-4
_BRACKET_STEP: Final = 0.75
_MAX_PREDICTIONS: Final = 40


@dataclass(frozen=True, eq=False)
class Percentile:
    """A person's strength as found from one lift.

    Attributes
    ----------
    z_score : float
        Standard deviations from the mean strength (equations 2.15, 2.18).
    measured, predicted : float
        Weight that was lifted, and maximum weight predicted with this z-score [N].
    tried : tuple of (float, float)
        z-scores and predicted weights [N] on the way; NaN where even an empty lift was infeasible.
    prediction : MaximumWeight
        The lift with this z-score.
    """

    z_score: float
    measured: float
    predicted: float
    tried: tuple[tuple[float, float], ...]
    prediction: MaximumWeight

    @property
    def percentile(self) -> float:
        """Percent of the population that is weaker, for normally distributed strength."""
        return 50.0 * (1.0 + math.erf(self.z_score / math.sqrt(2.0)))


class StrengthSearch:
    """Maximum weight of one recorded lift as a function of the z-score.

    Parameters
    ----------
    predictor : LiftPredictor
        Its sagittal model predicts.
    subject : Subject
        Person; the own z-score does not matter.
    lift : Lift
        Recorded lift of the largest weight.
    box : Box
        What was lifted.
    weighting : Weighting, optional
        Of the predictions; (0.15, 0.85) if omitted.

    Raises
    ------
    TaskError, UnreachableError
        The lift cannot be turned into a task.
    """

    def __init__(
        self,
        predictor: LiftPredictor,
        subject: Subject,
        lift: Lift,
        box: Box,
        weighting: Weighting | None = None,
    ) -> None:
        self.solver = solver = predictor.sagittal
        self.weighting = weighting or Weighting()
        self.task = solver.model.maximum_weight_task(subject, lift, box)
        self.measured = box.mass * self.task.parameters.gravity
        self.tried: dict[float, MaximumWeight] = {}
        self._starts = solver.model.starts(self.task)
        self._weakest, self._stronger = (
            Person.of(replace(subject, strength_z=z), predictor.options.coefficient_set)
            for z in (0.0, 1.0)
        )
        self.range = self._plausible()

    def _plausible(self) -> tuple[float, float]:
        """Range of z that leaves every joint some strength, |z| CV < 1, and that subjects have."""
        mean, more = self._weakest, self._stronger
        spread = 0.0
        for side in ('strength_lower', 'strength_upper'):
            at_mean, at_one = getattr(mean, side), getattr(more, side)
            # Of each limit the largest coefficient: all are multiplied by 1 + z CV.
            column = np.argmax(np.abs(at_mean[:, [1, 7]]), axis=1)
            rows = np.arange(len(column))
            ratio = at_one[:, [1, 7]][rows, column] / at_mean[:, [1, 7]][rows, column]
            spread = max(spread, float(np.max(ratio - 1.0)))
        low, high, _ = RANGES['strength_z']
        limit = math.inf if spread == 0.0 else 1.0 / spread
        return max(low, -limit + Z_STEP), min(high, limit - Z_STEP)

    def task_of(self, z: float) -> SagittalTask:
        """Return the task with the strength of a z-score: limits are linear in z (2.15, 2.18)."""
        lower, upper = (
            getattr(self._weakest, side)
            + z * (getattr(self._stronger, side) - getattr(self._weakest, side))
            for side in ('strength_lower', 'strength_upper')
        )
        parameters = replace(self.task.parameters, strength_lower=lower, strength_upper=upper)
        return replace(self.task, parameters=parameters)

    def weight(self, z: float) -> float:
        """Predict the maximum weight [N] with a z-score; NaN: no lift, or none that passes.

        Raises
        ------
        PercentileError
            The prediction failed although the lift may be feasible.
        """
        if z not in self.tried:
            # From the starts that a later prediction with this z-score has, or it could differ.
            task, near = self.task_of(z), self._last()
            found = maximum_weight(self.solver, task, self._starts, self.weighting)
            if not found.report.ok and near is not None:
                found = maximum_weight(self.solver, task, (near,), self.weighting)
            self.tried[z] = found
        report = self.tried[z].report
        if not report.ok and not self._too_weak(self.tried[z]):
            raise PercentileError(
                f'strength_z = {z:g}: the maximum weight was not found '
                f'({report.status.name}: {report.message})'
            )
        return self.tried[z].weight

    def _too_weak(self, failed: MaximumWeight) -> bool:
        """Tell whether a failed prediction means that less than the measured weight is lifted.

        Next to infeasibility a lift may hold at the nodes and nowhere between: its weight at the
        nodes is more than any that passes all checks.
        """
        if failed.report.status is SolveStatus.PREDICTOR_VERIFICATION_FAILED:
            at_nodes = max(run.box_mass for run in failed.prediction.runs if run.converged)
            return bool(at_nodes * self.task.parameters.gravity < self.measured)
        return failed.report.status is SolveStatus.PREDICTOR_INFEASIBLE

    def _last(self) -> Start | None:
        """Return the lift that was solved last."""
        solved = [found for found in self.tried.values() if found.report.ok]
        return solved[-1].prediction.runs[0].as_start() if solved else None

    def result(self, z: float) -> Percentile:
        """Return what was found at a z-score that was tried."""
        tried = tuple((other, self.tried[other].weight) for other in sorted(self.tried))
        return Percentile(z, self.measured, self.tried[z].weight, tried, self.tried[z])

    def refuse(self) -> PercentileError:
        """Make the error that names what is possible in the plausible range."""
        weights = [w.weight for w in self.tried.values() if w.report.ok]
        span = f'{min(weights):.1f} to {max(weights):.1f} N' if weights else 'no lift at all'
        return PercentileError(
            f'box.mass = {self.measured / self.task.parameters.gravity:g} kg '
            f'({self.measured:.1f} N): strength_z from {self.range[0]:g} to {self.range[1]:g} '
            f'gives {span}; no plausible strength explains this lift'
        )


def percentile_by_enumeration(
    predictor: LiftPredictor,
    subject: Subject,
    lift: Lift,
    box: Box,
    weighting: Weighting | None = None,
    step: float = Z_STEP,
) -> Percentile:
    """Predict the maximum weight for every z-score of a grid; keep the nearest to the measured.

    Parameters
    ----------
    predictor : LiftPredictor
        Its sagittal model predicts.
    subject : Subject
        Person; the own z-score does not matter.
    lift : Lift
        Recorded lift of the largest weight.
    box : Box
        What was lifted.
    weighting : Weighting, optional
        Of the predictions; (0.15, 0.85) if omitted.
    step : float
        Of the grid.

    Raises
    ------
    PercentileError
        No z-score of the plausible range gives the weight to within the grid's own resolution.
    TaskError, UnreachableError
        The lift cannot be turned into a task.
    """
    search = _search(predictor, subject, lift, box, weighting)
    low, high = search.range
    grid = [step * k for k in range(math.ceil(low / step), math.floor(high / step) + 1)]
    weights = np.array([search.weight(z) for z in _from_the_middle(grid)])
    order = np.argsort(list(search.tried))
    z, weights = np.array(list(search.tried))[order], weights[order]
    good = np.isfinite(weights)
    if not good.any() or not weights[good].min() <= search.measured <= weights[good].max():
        raise search.refuse()
    return search.result(float(z[int(np.nanargmin(np.abs(weights - search.measured)))]))


def percentile_by_root(
    predictor: LiftPredictor,
    subject: Subject,
    lift: Lift,
    box: Box,
    weighting: Weighting | None = None,
) -> Percentile:
    """Find the z-score whose predicted maximum weight is the measured one, by a root search.

    Parameters and errors are those of `percentile_by_enumeration`.
    """
    search = _search(predictor, subject, lift, box, weighting)
    low, high = _bracket(search)
    while len(search.tried) < _MAX_PREDICTIONS:
        below, above = search.weight(low), search.weight(high)
        for z, weight in ((low, below), (high, above)):
            if abs(weight - search.measured) <= WEIGHT_TOLERANCE:
                return search.result(z)
        if high - low <= _Z_TOLERANCE:
            # Margins between the nodes come in steps, and with them the weight.
            return search.result(min((low, high), key=lambda z: _apart(search, z)))
        z = _between(low, high, below, above, search.measured)
        weight = search.weight(z)
        if math.isnan(weight) or weight < search.measured:
            low = z
        else:
            high = z
    return search.result(min(search.tried, key=lambda z: _apart(search, z)))


def _search(
    predictor: LiftPredictor, subject: Subject, lift: Lift, box: Box, weighting: Weighting | None
) -> StrengthSearch:
    try:
        return StrengthSearch(predictor, subject, lift, box, weighting)
    except HumanModelError as error:
        raise PercentileError(str(error)) from error


def _apart(search: StrengthSearch, z: float) -> float:
    weight = search.weight(z)
    return math.inf if math.isnan(weight) else abs(weight - search.measured)


def _from_the_middle(grid: list[float]) -> Iterable[float]:
    """Order a grid so that neighbours follow each other: up from the mean, then down."""
    return [*(z for z in grid if z >= 0.0), *(z for z in reversed(grid) if z < 0.0)]


def _bracket(search: StrengthSearch) -> tuple[float, float]:
    """Return z-scores with less and with more than the measured weight."""
    low, high = search.range
    z = min(max(0.0, low), high)
    heavy_enough = search.weight(z) >= search.measured
    while True:
        other = max(z - _BRACKET_STEP, low) if heavy_enough else min(z + _BRACKET_STEP, high)
        if other == z:
            raise search.refuse()
        weight = search.weight(other)
        if heavy_enough and not weight >= search.measured:
            return other, z
        if not heavy_enough and weight >= search.measured:
            return z, other
        z = other


def _between(low: float, high: float, below: float, above: float, wanted: float) -> float:
    """Secant point of a bracket, kept away from its ends; the middle without a weight below."""
    fraction = 0.5 if math.isnan(below) else (wanted - below) / (above - below)
    return low + min(max(fraction, 0.05), 0.95) * (high - low)
