# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Functions of one variable as `.osim` files define them, all held as piecewise polynomials.

A constant, a line, a polynomial and a spline differ only in the number of pieces and of
coefficients, so one representation and one compiled evaluation serve every function of a model.

References
----------
Forsythe, Malcolm and Moler (1977), Computer Methods for Mathematical Computations, chapter 4.4:
the cubic spline whose third derivative at each end is that of the cubic through the four end
points. OpenSim's `SimmSpline` is this spline, continued by a straight line outside its first and
last knot; files that call it `NaturalCubicSpline` or `natCubicSpline` mean the same function
(OpenSim renames them).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from human_model.compiled_cache import njit
from human_model.typing import Array
from muscle_analyzer.core.exceptions import OsimFormatError


@dataclass(frozen=True, eq=False)
class PiecewisePolynomial:
    """A function of one variable, polynomial between switching points.

    Attributes
    ----------
    switches : (k - 1,) array
        Increasing arguments at which the next piece takes over.
    anchors : (k,) array
        Argument at which each piece's polynomial is centred.
    coefficients : (k, order) array
        Coefficients of rising powers of (x - anchor).
    """

    switches: Array
    anchors: Array
    coefficients: Array

    def scaled(self, factor: float) -> PiecewisePolynomial:
        """Return the function multiplied by a constant factor."""
        return PiecewisePolynomial(self.switches, self.anchors, self.coefficients * factor)

    def shifted(self, offset: float) -> PiecewisePolynomial:
        """Return the function with a constant added."""
        coefficients = self.coefficients.copy()
        coefficients[:, 0] += offset
        return PiecewisePolynomial(self.switches, self.anchors, coefficients)

    def derivatives(self, x: float) -> tuple[float, float, float]:
        """Return value, first and second derivative at `x`."""
        piece = int(np.searchsorted(self.switches, x, side='right'))
        polynomial = np.polynomial.Polynomial(self.coefficients[piece])
        dx = x - self.anchors[piece]
        return (
            float(polynomial(dx)),
            float(polynomial.deriv(1)(dx)),
            float(polynomial.deriv(2)(dx)),
        )

    def is_line(self) -> bool:
        """Tell whether the function is a straight line that is not level."""
        return (
            self.anchors.size == 1
            and self.coefficients.shape[1] > 1
            and self.coefficients[0, 1] != 0.0
            and not np.any(self.coefficients[0, 2:])
        )

    def is_constant(self) -> bool:
        """Tell whether the function has the same value everywhere."""
        return self.anchors.size == 1 and not np.any(self.coefficients[0, 1:])


def constant(value: float) -> PiecewisePolynomial:
    """Return the function that is `value` everywhere."""
    return polynomial([value])


def linear(slope: float, intercept: float) -> PiecewisePolynomial:
    """Return the line slope * x + intercept."""
    return polynomial([intercept, slope])


def polynomial(coefficients: ArrayLike) -> PiecewisePolynomial:
    """Return a polynomial from coefficients of rising powers."""
    rising = np.atleast_2d(np.asarray(coefficients, dtype=np.float64))
    return PiecewisePolynomial(np.empty(0), np.zeros(1), rising)


def piecewise_linear(x: ArrayLike, y: ArrayLike) -> PiecewisePolynomial:
    """Return straight lines through the points, the outer ones continued.

    Raises
    ------
    OsimFormatError
        If there are fewer than two points or the arguments do not increase.
    """
    knots, values = _checked_points(x, y)
    slopes = np.diff(values) / np.diff(knots)
    return PiecewisePolynomial(knots[1:-1], knots[:-1], np.column_stack([values[:-1], slopes]))


def smooth_step(start: float, end: float, low: float, high: float) -> PiecewisePolynomial:
    """Return a step from `low` at `start` to `high` at `end`, level outside.

    Between them it is the polynomial of fifth degree whose first and second derivatives vanish at
    both ends, as OpenSim's `StepFunction` has it.

    Raises
    ------
    OsimFormatError
        If the end is not after the start.
    """
    width, rise = end - start, high - low
    if not width > 0.0:
        raise OsimFormatError(f'a step ends at {end}, not after its start at {start}')
    inner = [low, 0.0, 0.0, 10.0 * rise / width**3, -15.0 * rise / width**4, 6.0 * rise / width**5]
    level = [0.0] * 5
    return PiecewisePolynomial(
        np.array([start, end]),
        np.array([start, start, end]),
        np.array([[low, *level], inner, [high, *level]]),
    )


def simm_spline(x: ArrayLike, y: ArrayLike) -> PiecewisePolynomial:
    """Return the interpolating cubic spline of the module's header, lines outside its knots.

    Raises
    ------
    OsimFormatError
        If there are fewer than two points or the arguments do not increase.
    """
    knots, values = _checked_points(x, y)
    n = knots.size
    h = np.diff(knots)
    slope = np.diff(values) / h
    if n == 2:
        return piecewise_linear(knots, values)
    system = np.zeros((n, n))
    right = np.zeros(n)
    for i in range(1, n - 1):
        system[i, i - 1 : i + 2] = h[i - 1], 2.0 * (h[i - 1] + h[i]), h[i]
        right[i] = 6.0 * (slope[i] - slope[i - 1])
    system[0, :2] = -1.0 / h[0], 1.0 / h[0]
    system[-1, -2:] = -1.0 / h[-1], 1.0 / h[-1]
    if n > 3:
        right[0] = 6.0 * _third_divided_difference(knots[:4], values[:4])
        right[-1] = 6.0 * _third_divided_difference(knots[-4:], values[-4:])
    second = np.linalg.solve(system, right)
    first = slope - h * (2.0 * second[:-1] + second[1:]) / 6.0
    inner = np.column_stack([values[:-1], first, second[:-1] / 2.0, np.diff(second) / (6.0 * h)])
    last_slope = slope[-1] + h[-1] * (second[-2] + 2.0 * second[-1]) / 6.0
    before = [values[0], first[0], 0.0, 0.0]
    after = [values[-1], last_slope, 0.0, 0.0]
    return PiecewisePolynomial(
        knots, np.concatenate([knots[:1], knots]), np.vstack([before, inner, after])
    )


def _checked_points(x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    knots = np.asarray(x, dtype=np.float64)
    values = np.asarray(y, dtype=np.float64)
    if knots.ndim != 1 or knots.size < 2 or knots.shape != values.shape:
        raise OsimFormatError(
            f'a function needs at least two x and as many y, got {knots.size} x, {values.size} y'
        )
    if not (np.all(np.isfinite(knots)) and np.all(np.isfinite(values))):
        raise OsimFormatError('a function has points that are not finite numbers')
    if np.any(np.diff(knots) <= 0.0):
        at = int(np.argmax(np.diff(knots) <= 0.0))
        raise OsimFormatError(f'the x of a function must increase: {knots[at]}, {knots[at + 1]}')
    return knots, values


def _third_divided_difference(x: Array, y: Array) -> float:
    table = y
    for order in range(1, 4):
        table = np.diff(table) / (x[order:] - x[:-order])
    return float(table[0])


class FunctionTable(NamedTuple):
    """Many piecewise polynomials in flat arrays, for the compiled functions.

    Attributes
    ----------
    first_piece : (n + 1,) int array
        Pieces of function f are first_piece[f] to first_piece[f + 1] - 1.
    lower : (n_pieces,) array
        Argument from which a piece is valid (-inf for a function's first piece).
    anchor : (n_pieces,) array
    coefficient : (n_pieces, order) array
    """

    first_piece: NDArray[np.int64]
    lower: Array
    anchor: Array
    coefficient: Array


def function_table(functions: Sequence[PiecewisePolynomial]) -> FunctionTable:
    """Pack functions into flat arrays, in their order."""
    order = max((f.coefficients.shape[1] for f in functions), default=1)
    counts = [f.anchors.size for f in functions]
    first = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    coefficient = np.zeros((int(first[-1]), order))
    lower = np.empty(int(first[-1]))
    anchor = np.empty(int(first[-1]))
    for f, start, stop in zip(functions, first[:-1], first[1:], strict=True):
        lower[start] = -np.inf
        lower[start + 1 : stop] = f.switches
        anchor[start:stop] = f.anchors
        coefficient[start:stop, : f.coefficients.shape[1]] = f.coefficients
    return FunctionTable(first, lower, anchor, coefficient)


@njit(error_model='numpy')
def evaluated(
    first_piece: NDArray[np.int64],
    lower: Array,
    anchor: Array,
    coefficient: Array,
    f: int,
    x: float,
) -> tuple[float, float, float]:
    """Return value, first and second derivative of function number `f` of a table at `x`.

    The arrays are those of `FunctionTable`.
    """
    piece = first_piece[f + 1] - 1
    while x < lower[piece]:
        piece -= 1
    dx = x - anchor[piece]
    value = 0.0
    first = 0.0
    second = 0.0
    for power in range(coefficient.shape[1] - 1, -1, -1):
        second = second * dx + 2.0 * first
        first = first * dx + value
        value = value * dx + coefficient[piece, power]
    return value, first, second


@njit(error_model='numpy')
def evaluate(table: FunctionTable, f: int, x: float) -> tuple[float, float, float]:
    """Return value, first and second derivative of function number `f` at `x`."""
    return evaluated(table.first_piece, table.lower, table.anchor, table.coefficient, f, x)
