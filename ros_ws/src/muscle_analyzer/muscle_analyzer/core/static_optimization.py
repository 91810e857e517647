# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Static optimisation: which muscle forces balance the joint torques (equation 4.10).

The sum of squared activations is minimised, or another criterion of muscle recruitment; reserve
actuators make the balance possible in every frame, are paid for by their square in the same cost,
and name the coordinate when muscles are too weak.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from human_model.report import SolveReport, SolveStatus
from muscle_analyzer.core.dual_newton import solve_dual
from muscle_analyzer.core.exceptions import InputArrayError, OptionError
from muscle_analyzer.core.min_max import SQUARES_SHARE, solve_min_max
from muscle_analyzer.core.reserves import Reserve

Array = NDArray[np.float64]

#: Smallest activation OpenSim 4.6 allows a muscle in static optimisation (``min_control`` of
#: the muscles of the lifting full-body model).
MINIMUM_ACTIVATION = 0.01
#: A coordinate is not balanced by its muscles when the reserve takes more than this share of the
#: net moment of its joint, all coordinates of the joint together: half of what OpenSim's guide
#: allows (page "Reserves and Residuals": peak reserve below 10 % of the peak joint torque), and
#: the share of the external force that Hicks et al. 2015 (J Biomech Eng 137:020905, section
#: 3.1.3) allow residual forces ...
RESERVE_SHARE = 0.05
#: ... and more than its unit torque, below which a share means nothing.
RESERVE_CONTROL = 1.0
#: An activation nearer than this to its bound is at it: interior-point solutions come close.
AT_BOUND = 1e-8
#: So many coordinates or muscles are named in a report.
NAMED = 3


class Criterion(StrEnum):
    """
    What muscle recruitment minimises.

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
    """
    Settings of the static optimisation.

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
    """
    Solution of one frame.

    Attributes
    ----------
    activation : (n_m,)
    reserve : (n_c,)
        Torque the reserves take [N m].
    multiplier : (n_c,)
        Dual solution, the warm start of the next frame [1 / (N m)].
    at_lower, at_upper : (n_m,) bool
        Active sets.
    unbalanced : tuple of str
        Coordinates whose muscles are too weak.
    report : SolveReport
        Primal residual [N m], dual residual (KKT stationarity, dimensionless).
    """

    activation: Array
    reserve: Array
    multiplier: Array
    at_lower: NDArray[np.bool_]
    at_upper: NDArray[np.bool_]
    unbalanced: tuple[str, ...]
    report: SolveReport

    @property
    def converged(self) -> bool:
        """Whether the optimum was found, be the muscles strong enough or not."""
        return self.report.status is not SolveStatus.MUSCLE_NOT_CONVERGED


class StaticOptimization:
    """
    Solver of one model, warm-started from frame to frame.

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
        self._unit = np.array([reserve.torque for reserve in reserves])
        self._muscle_driven = np.array([reserve.muscle_driven for reserve in reserves], np.bool_)
        self._lower = np.full(len(muscle_names), low)
        if least_activation is not None:
            self._lower = np.maximum(self._lower, least_activation)
        if self._lower.size and not self._lower.max() < high:
            i = int(self._lower.argmax())
            raise OptionError(
                f'least activation of {muscle_names[i]}: {self._lower[i]} must be below '
                f'maximum_activation {high}'
            )
        self._upper = np.full(len(muscle_names), high)
        self._weight = np.ones(len(muscle_names)) if weight is None else np.array(weight, float)
        if not (np.isfinite(self._weight) & (self._weight > 0.0)).all():
            raise OptionError('weight: every muscle needs a positive weight in the cost')
        joints = np.array([reserve.joint for reserve in reserves])
        self._same_joint = (joints[:, None] == joints[None, :]).astype(np.float64)
        self._multiplier = np.zeros(len(reserves))

    def reset(self) -> None:
        """Forget the previous frame."""
        self._multiplier = np.zeros(len(self.coordinate_names))

    def solve(self, matrix: Array, torque: Array) -> MuscleBalance:
        """
        Share the torques of one frame among the muscles.

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
        unit = self._unit
        tolerance = self.options.tolerance * max(1.0, float(np.abs(torque).max(initial=0.0)))
        multiplier = self._multiplier.copy()
        built = time.perf_counter()
        activation, residual, iterations, converged, cap = self._run(
            matrix, torque, multiplier, tolerance
        )
        if not converged:
            # A start far from this frame's solution: once more from nothing.
            multiplier[:] = 0.0
            activation, residual, more, converged, cap = self._run(
                matrix, torque, multiplier, tolerance
            )
            iterations += more
        self._multiplier = multiplier if converged else np.zeros_like(multiplier)
        solved = time.perf_counter()

        control = 0.5 * unit * multiplier
        gradient = self._gradient(activation) - matrix.T @ multiplier
        upper = np.minimum(self._upper, cap)
        projected = np.clip(activation - gradient, self._lower, upper)
        reserve = unit * control
        joint_moment = np.sqrt(self._same_joint @ torque**2)
        weak = self._muscle_driven & (np.abs(reserve) > RESERVE_SHARE * joint_moment)
        weak &= np.abs(control) > RESERVE_CONTROL
        unbalanced = tuple(np.array(self.coordinate_names)[weak].tolist())
        at_upper = activation >= self._upper - AT_BOUND
        status, message = self._verdict(converged, residual, reserve, weak, at_upper)
        report = SolveReport(
            status=status,
            message=message,
            iterations=int(iterations),
            objective=self._cost(activation, cap) + float(control @ control),
            primal_residual=float(np.abs(residual).max(initial=0.0)),
            dual_residual=float(np.abs(projected - activation).max(initial=0.0)),
            build_time=built - began,
            solve_time=solved - built,
        )
        return MuscleBalance(
            activation=activation,
            reserve=reserve,
            multiplier=multiplier,
            at_lower=activation <= self._lower + AT_BOUND,
            at_upper=at_upper,
            unbalanced=unbalanced,
            report=report,
        )

    def _run(
        self, matrix: Array, torque: Array, multiplier: Array, tolerance: float
    ) -> tuple[Array, Array, int, bool, float]:
        """Give activations, residual, steps, success and the largest activation allowed."""
        fixed = (matrix, self._unit, torque, self._lower, self._upper, self._weight)
        limit = self.options.max_iterations
        if self.criterion is Criterion.MIN_MAX:
            # The small curvature of its cost magnifies the rounding of the multipliers.
            return solve_min_max(*fixed, multiplier, 8.0 * tolerance, limit)
        exponent = EXPONENTS[self.criterion]
        solution = solve_dual(*fixed, exponent, multiplier, tolerance, limit)
        return *solution, self.options.maximum_activation

    def _share(self) -> float:
        """Give the factor of the powers in the cost."""
        return SQUARES_SHARE if self.criterion is Criterion.MIN_MAX else 1.0

    def _gradient(self, activation: Array) -> Array:
        """Give the derivative of the powers in the cost by each activation (n_m,)."""
        exponent = EXPONENTS[self.criterion]
        return self._share() * exponent * self._weight * activation ** (exponent - 1.0)

    def _cost(self, activation: Array, cap: float) -> float:
        """Give the cost of the activations, without reserves."""
        powers = self._share() * float(self._weight @ activation ** EXPONENTS[self.criterion])
        return powers + (cap if self.criterion is Criterion.MIN_MAX else 0.0)

    def _checked(self, matrix: Array, torque: Array) -> tuple[Array, Array]:
        """Give the input as contiguous arrays of the right shape and finite numbers."""
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

    def _verdict(
        self,
        converged: bool,
        residual: Array,
        reserve: Array,
        weak: NDArray[np.bool_],
        at_upper: NDArray[np.bool_],
    ) -> tuple[SolveStatus, str]:
        """Say what happened, naming coordinates and muscles."""
        if not converged:
            j = int(np.abs(residual).argmax())
            return SolveStatus.MUSCLE_NOT_CONVERGED, (
                f'static optimisation not converged: {self.coordinate_names[j]} is off by '
                f'{residual[j]:.3g} N m'
            )
        full = [self.muscle_names[i] for i in np.flatnonzero(at_upper)]
        bound = f'at full activation: {_some(full)}' if full else ''
        if weak.any():
            order = sorted(np.flatnonzero(weak), key=lambda j: -abs(reserve[j]))
            parts = [f'{self.coordinate_names[j]} by {reserve[j]:.1f} N m' for j in order]
            text = f'muscles too weak, reserves help {_some(parts)}'
            return SolveStatus.MUSCLE_TOO_WEAK, f'{text}; {bound}' if bound else text
        return SolveStatus.OK, bound


def _some(names: list[str]) -> str:
    """Give the first names in words and the number of the others: a report is to be read."""
    more = f' and {len(names) - NAMED} more' if len(names) > NAMED else ''
    return ', '.join(names[:NAMED]) + more
