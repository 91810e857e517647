# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Static optimisation: which muscle forces balance the joint torques (equation 4.10).

The sum of squared activations is minimised, or another criterion of muscle recruitment; reserve
actuators make the balance possible in every sample, their squares are part of the same cost,
and they identify the coordinates whose muscles are too weak.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from human_model.report import SolveReport, SolveStatus
from human_model.typing import Array
from muscle_analyzer.core.exceptions import InputArrayError, OptionError
from muscle_analyzer.core.recruitment.dual_newton import columns_of
from muscle_analyzer.core.recruitment.muscle_recruitment import Actuators, Recruitment, recruit
from muscle_analyzer.core.recruitment.reserves import Reserve

#: Smallest activation OpenSim 4.6 allows a muscle in static optimisation (``min_control`` of
#: the muscles of the lifting full-body model).
MINIMUM_ACTIVATION = 0.01
#: An activation nearer than this to its bound is at it: interior-point solutions only approach it.
AT_BOUND = 1e-8
#: Largest number of coordinates or muscles named in a report.
NAMED = 3


class Criterion(StrEnum):
    """What muscle recruitment minimises.

    The sums of squares and of cubes are equation 4.10 with the exponents 2 (the thesis, OpenSim's
    default) and 3 (Crowninshield and Brand 1981, J Biomech 14:793); the largest activation is the
    min/max criterion of Rasmussen et al. 2001 (J Biomech 34:409).
    """

    SQUARES = 'squares'
    CUBES = 'cubes'
    MIN_MAX = 'min_max'


EXPONENTS = {Criterion.SQUARES: 2.0, Criterion.CUBES: 3.0, Criterion.MIN_MAX: 2.0}


@dataclass(frozen=True)
class StaticOptimizationOptions:
    """Settings of the static optimisation.

    Attributes
    ----------
    criterion
        What is minimised, one of `Criterion`.
    minimum_activation, maximum_activation
        Bounds of every activation.
    tolerance
        Largest balance residual of a solution, relative to the largest torque (or 1 N m).
    max_iterations
        Limit of Newton steps.
    """

    criterion: str = Criterion.SQUARES
    minimum_activation: float = MINIMUM_ACTIVATION
    maximum_activation: float = 1.0
    tolerance: float = 1e-10
    max_iterations: int = 100


@dataclass(frozen=True)
class MuscleBalance:
    """Solution of one sample.

    Attributes
    ----------
    activation : (n_m,)
    reserve : (n_c,)
        Torque the reserves take [N m].
    multiplier : (n_c,)
        Dual solution, the warm start of the next sample [1 / (N m)].
    residual : (n_c,)
        What is not balanced [N m].
    low, full : (n_m,)
        Activations up to and from which a muscle is at its lower and upper bound.
    unbalanced : tuple of str
        Coordinates whose muscles are too weak.
    report : SolveReport
        Primal residual [N m], dual residual (KKT stationarity, dimensionless).
    """

    activation: Array
    reserve: Array
    multiplier: Array
    residual: Array
    low: Array
    full: Array
    unbalanced: tuple[str, ...]
    report: SolveReport

    @property
    def at_lower(self) -> NDArray[np.bool_]:
        """Muscles at their lower bound (n_m,)."""
        return self.activation <= self.low

    @property
    def at_upper(self) -> NDArray[np.bool_]:
        """Muscles at their upper bound (n_m,)."""
        return self.activation >= self.full

    @property
    def converged(self) -> bool:
        """Whether the solver converged (even if the muscles were too weak)."""
        return self.report.status is not SolveStatus.MUSCLE_NOT_CONVERGED


class StaticOptimization:
    """Solver of one model, warm-started from sample to sample.

    Parameters
    ----------
    muscle_names
        Names of the columns of the torque matrix.
    reserves
        Reserve of each row of the torque matrix.
    options
        Settings.
    weight : (n_m,)
        Of each muscle in the cost, all positive; 1 if omitted.
    least_activation : (n_m,)
        Lower bounds in place of ``options.minimum_activation`` where they are higher.

    Raises
    ------
    OptionError
        A setting that cannot be used, by name and value.
    """

    def __init__(
        self,
        muscle_names: tuple[str, ...],
        reserves: tuple[Reserve, ...],
        options: StaticOptimizationOptions | None = None,
        weight: Array | None = None,
        least_activation: Array | None = None,
    ) -> None:
        self.options = options or StaticOptimizationOptions()
        try:
            self.criterion = Criterion(self.options.criterion)
        except ValueError:
            known = ', '.join(Criterion)
            raise OptionError(
                f'criterion {self.options.criterion!r} is not known; options: {known}'
            ) from None
        self.muscle_names = muscle_names
        self.coordinate_names = tuple(reserve.coordinate for reserve in reserves)
        low, high = self.options.minimum_activation, self.options.maximum_activation
        if not 0.0 <= low < high:
            raise OptionError(
                f'minimum_activation {low} must be in [0, maximum_activation {high})'
            )
        for reserve in reserves:
            if not reserve.torque > 0.0:
                raise OptionError(
                    f'reserve of {reserve.coordinate}: torque {reserve.torque} N m must be '
                    'positive: without it a weak muscle leaves no solution'
                )
        lower = np.full(len(muscle_names), low)
        if least_activation is not None:
            lower = np.maximum(lower, least_activation)
        if lower.size and not lower.max() < high:
            i = int(lower.argmax())
            raise OptionError(
                f'least activation of {muscle_names[i]}: {lower[i]} must be below '
                f'maximum_activation {high}'
            )
        weight = np.ones(len(muscle_names)) if weight is None else np.array(weight, np.float64)
        if not (np.isfinite(weight) & (weight > 0.0)).all():
            raise OptionError('weight: every muscle needs a positive weight in the cost')
        joints = list(dict.fromkeys(reserve.joint for reserve in reserves))
        self.actuators = Actuators(
            unit=np.array([reserve.torque for reserve in reserves], np.float64),
            muscle_driven=np.array([reserve.muscle_driven for reserve in reserves], np.bool_),
            limit=np.array(
                [r.torque if r.limit is None else r.limit for r in reserves], np.float64
            ),
            joint=np.array([joints.index(reserve.joint) for reserve in reserves], np.int64),
            lower=lower,
            upper=np.full(len(muscle_names), high, np.float64),
            weight=weight,
            min_max=self.criterion is Criterion.MIN_MAX,
            exponent=EXPONENTS[self.criterion],
            tolerance=float(self.options.tolerance),
            max_iterations=int(self.options.max_iterations),
        )
        self.warm_start = np.zeros((2, len(reserves)))
        # Activations from which a muscle counts as at its bounds, computed once.
        self._low = self.actuators.lower + AT_BOUND
        self._full = self.actuators.upper - AT_BOUND

    def reset(self) -> None:
        """Clear the warm start."""
        self.warm_start = np.zeros((2, len(self.coordinate_names)))

    def solve(self, matrix: Array, torque: Array) -> MuscleBalance:
        """Distribute the torques of one sample over the muscles.

        Parameters
        ----------
        matrix : (n_c, n_m)
            Torque of each muscle at full activation about each coordinate [N m].
        torque : (n_c,)
            Torque to balance [N m].

        Raises
        ------
        InputArrayError
            If a shape is wrong or a number is not finite, naming the first such coordinate.
        """
        began = time.perf_counter()
        matrix, torque = self._checked(matrix, torque)
        built = time.perf_counter()
        solution = recruit(self.actuators, columns_of(matrix), torque, self.warm_start)
        return self.balance(solution, built - began, time.perf_counter() - built)

    def balance(
        self, solution: Recruitment, build_time: float, solve_time: float
    ) -> MuscleBalance:
        """Return a solution with its report and the names of what is not balanced.

        Parameters
        ----------
        solution
            Of `recruit`.
        build_time, solve_time
            To build and to solve the problem [s].
        """
        return MuscleBalance(
            activation=solution.activation,
            reserve=solution.reserve,
            multiplier=solution.multiplier,
            residual=solution.imbalance,
            low=self._low,
            full=self._full,
            unbalanced=tuple([self.coordinate_names[j] for j in _places(solution.weak)]),
            report=self.report(solution, build_time, solve_time),
        )

    def report(self, solution: Recruitment, build_time: float, solve_time: float) -> SolveReport:
        """Return the report of a solution alone; parameters as in `balance`."""
        status, message = self._status(solution)
        return SolveReport(
            status=status,
            message=message,
            iterations=int(solution.iterations),
            objective=float(solution.residuals.objective),
            primal_residual=float(solution.residuals.primal),
            dual_residual=float(solution.residuals.dual),
            build_time=build_time,
            solve_time=solve_time,
        )

    def _checked(self, matrix: Array, torque: Array) -> tuple[Array, Array]:
        """Return the input as contiguous arrays of the right shape and finite numbers."""
        matrix = np.ascontiguousarray(matrix, dtype=np.float64)
        torque = np.ascontiguousarray(torque, dtype=np.float64)
        shape = (len(self.coordinate_names), len(self.muscle_names))
        if matrix.shape != shape or torque.shape != shape[:1]:
            raise InputArrayError(
                f'matrix {matrix.shape} and torque {torque.shape}: expected {shape} and '
                f'{shape[:1]}'
            )
        bad = ~(np.isfinite(torque) & np.isfinite(matrix).all(axis=1))
        if bad.any():
            j = int(bad.argmax())
            raise InputArrayError(
                f'coordinate {self.coordinate_names[j]}: torque {torque[j]} or moment arms '
                'are not finite'
            )
        return matrix, torque

    def _status(self, solution: Recruitment) -> tuple[SolveStatus, str]:
        """Return status and message, with the names of coordinates and muscles."""
        if not solution.converged:
            j = int(np.abs(solution.imbalance).argmax())
            return SolveStatus.MUSCLE_NOT_CONVERGED, (
                f'static optimisation not converged: {self.coordinate_names[j]} is off by '
                f'{solution.imbalance[j]:.3g} N m'
            )
        full, weak = _places(solution.activation >= self._full), _places(solution.weak)
        bound = ''
        if full:
            names = [self.muscle_names[i] for i in full[:NAMED]]
            bound = f'at full activation: {_some(names, len(full))}'
        if not weak:
            return SolveStatus.OK, bound
        reserve = solution.reserve.tolist()
        weak.sort(key=lambda j: -abs(reserve[j]))
        parts = [f'{self.coordinate_names[j]} by {reserve[j]:.1f} N m' for j in weak[:NAMED]]
        text = f'muscles too weak, reserves help {_some(parts, len(weak))}'
        return SolveStatus.MUSCLE_TOO_WEAK, f'{text}; {bound}' if bound else text


def _places(condition: NDArray[np.bool_]) -> list[int]:
    """Return the indices at which a condition holds."""
    places: list[int] = condition.nonzero()[0].tolist()
    return places


def _some(first: list[str], count: int) -> str:
    """Return the first names, and the number of the others, for a report."""
    more = f' and {count - NAMED} more' if count > NAMED else ''
    return ', '.join(first) + more
