# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The programme as the interior-point method sees it: no fixed variables, scaled, rows sorted."""

from __future__ import annotations

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.programme import Linearisation, Programme

BOUND_RELAXATION = 1e-8
"""Bounds of rows are relaxed by this, relative to their size, as IPOPT does with all bounds: there
is always an inside. Those of variables are kept, so that a solution can be used as it is."""


class ScaledPoint:
    """Derivatives at one point of a `ScaledProgramme`."""

    def __init__(self, programme: ScaledProgramme, x: Array, raw: Linearisation) -> None:
        self._programme, self._raw, self.x = programme, raw, x
        self.objective = programme.objective_scale * raw.objective
        self.rows = programme.row_scale * raw.rows
        self.gradient = programme.objective_scale * raw.gradient[programme.free]
        scale = programme.row_scale[programme.equal]
        self.equality = scale[:, None] * raw.equality[:, programme.free]

    def times(self, step: Array) -> Array:
        """Scaled Jacobian times a step of the free variables."""
        full = np.zeros(self._programme.source.n)
        full[self._programme.free] = step
        return self._programme.row_scale * self._raw.times(full)

    def transposed(self, multiplier: Array) -> Array:
        """Transposed scaled Jacobian times multipliers."""
        return self._raw.transposed(self._programme.row_scale * multiplier)[self._programme.free]

    def condensed(self, sigma: float, multiplier: Array, weight: Array) -> Array:
        """Condensed matrix of the free variables."""
        p = self._programme
        matrix = self._raw.condensed(
            sigma * p.objective_scale, p.row_scale * multiplier, p.row_scale**2 * weight
        )
        return matrix if p.all_free else matrix[np.ix_(p.free, p.free)]


class ScaledProgramme:
    """A programme without its fixed variables, objective and rows scaled.

    Parameters
    ----------
    source : Programme
        What is to be solved.
    x0 : array, shape (n,)
        Where the gradients for the scaling are taken; fixed variables get their values.
    gradient_limit : float
        Objective and rows are scaled down to this largest gradient.

    Attributes
    ----------
    free : int array
        Indices of the variables that are not fixed.
    equal, unequal : int array
        Indices of equality and inequality rows.
    lower, upper : array
        Relaxed bounds of the free variables and then of the inequality rows' slacks.
    target : array
        Values of the equality rows.
    """

    def __init__(self, source: Programme, x0: Array, gradient_limit: float) -> None:
        self.source = source
        fixed = source.lower == source.upper
        self.free = np.flatnonzero(~fixed)
        self.all_free = not fixed.any()
        self._full = np.where(fixed, source.lower, x0)
        equal = source.row_lower == source.row_upper
        self.equal, self.unequal = np.flatnonzero(equal), np.flatnonzero(~equal)
        raw = source.linearise(self._full)
        self.objective_scale, self.row_scale = 1.0, np.ones(len(equal))
        largest = float(np.abs(raw.gradient[self.free]).max(initial=0.0))
        if largest > gradient_limit:
            self.objective_scale = gradient_limit / largest
        steep = np.abs(raw.equality[:, self.free]).max(axis=1, initial=0.0)
        self.row_scale[self.equal] = gradient_limit / np.maximum(steep, gradient_limit)
        self.n, self.m = len(self.free), len(equal)
        row_lower = (self.row_scale * source.row_lower)[self.unequal]
        row_upper = (self.row_scale * source.row_upper)[self.unequal]
        row_lower = row_lower - BOUND_RELAXATION * np.maximum(1.0, np.abs(row_lower))
        row_upper = row_upper + BOUND_RELAXATION * np.maximum(1.0, np.abs(row_upper))
        self.lower = np.concatenate((source.lower[self.free], row_lower))
        self.upper = np.concatenate((source.upper[self.free], row_upper))
        self.target = (self.row_scale * source.row_lower)[self.equal]

    def full(self, x: Array) -> Array:
        """All variables from the free ones."""
        full = self._full.copy()
        full[self.free] = x
        return full

    def values(self, x: Array) -> tuple[float, Array]:
        """Scaled objective and rows."""
        f, g = self.source.values(self.full(x))
        return self.objective_scale * f, self.row_scale * g

    def linearise(self, x: Array) -> ScaledPoint:
        """Scaled derivatives."""
        return ScaledPoint(self, x, self.source.linearise(self.full(x)))
