# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The problem of the interior-point method: scaled, constraints sorted, no fixed variables."""

from __future__ import annotations

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.constants import (
    BOUND_RELAXATION,
)
from lift_predictor.core.solvers.problem import Linearisation, NlpProblem


class ScaledPoint:
    """Derivatives at one point of a `ScaledNlp`."""

    def __init__(self, problem: ScaledNlp, x: Array, raw: Linearisation) -> None:
        self._problem, self._raw, self.x = problem, raw, x
        self.objective = problem.objective_scale * raw.objective
        self.g = problem.g_scale * raw.g
        self.gradient = problem.objective_scale * raw.gradient[problem.free]
        scale = problem.g_scale[problem.equal]
        self.equality = scale[:, None] * raw.equality[:, problem.free]

    def times(self, step: Array) -> Array:
        """Scaled Jacobian times a step of the free variables."""
        full = np.zeros(self._problem.source.n)
        full[self._problem.free] = step
        return self._problem.g_scale * self._raw.times(full)

    def transposed(self, multiplier: Array) -> Array:
        """Transposed scaled Jacobian times multipliers."""
        return self._raw.transposed(self._problem.g_scale * multiplier)[self._problem.free]

    def condensed(self, sigma: float, multiplier: Array, weight: Array) -> Array:
        """Condensed matrix of the free variables."""
        p = self._problem
        matrix = self._raw.condensed(
            sigma * p.objective_scale, p.g_scale * multiplier, p.g_scale**2 * weight
        )
        return matrix if p.all_free else matrix[np.ix_(p.free, p.free)]


class ScaledNlp:
    """A problem without its fixed variables, objective and constraints scaled.

    Parameters
    ----------
    source : NlpProblem
        What is to be solved.
    x0 : array, shape (n,)
        Where the gradients for the scaling are taken; fixed variables get their values.
    gradient_limit : float
        Objective and constraints are scaled down to this largest gradient.

    Attributes
    ----------
    free : int array
        Indices of the variables that are not fixed.
    equal, unequal : int array
        Indices of equality and inequality constraints.
    lower, upper : array
        Relaxed bounds of the free variables and then of the inequality constraints' slacks.
    target : array
        Values of the equality constraints.
    """

    def __init__(self, source: NlpProblem, x0: Array, gradient_limit: float) -> None:
        self.source = source
        fixed = source.lower == source.upper
        self.free = np.flatnonzero(~fixed)
        self.all_free = not fixed.any()
        self._full = np.where(fixed, source.lower, x0)
        equal = source.g_lower == source.g_upper
        self.equal, self.unequal = np.flatnonzero(equal), np.flatnonzero(~equal)
        raw = source.linearise(self._full)
        self.objective_scale, self.g_scale = 1.0, np.ones(len(equal))
        largest = float(np.abs(raw.gradient[self.free]).max(initial=0.0))
        if largest > gradient_limit:
            self.objective_scale = gradient_limit / largest
        steep = np.abs(raw.equality[:, self.free]).max(axis=1, initial=0.0)
        self.g_scale[self.equal] = gradient_limit / np.maximum(steep, gradient_limit)
        self.n, self.m = len(self.free), len(equal)
        g_lower = (self.g_scale * source.g_lower)[self.unequal]
        g_upper = (self.g_scale * source.g_upper)[self.unequal]
        g_lower = g_lower - BOUND_RELAXATION * np.maximum(1.0, np.abs(g_lower))
        g_upper = g_upper + BOUND_RELAXATION * np.maximum(1.0, np.abs(g_upper))
        self.lower = np.concatenate((source.lower[self.free], g_lower))
        self.upper = np.concatenate((source.upper[self.free], g_upper))
        self.target = (self.g_scale * source.g_lower)[self.equal]

    def full(self, x: Array) -> Array:
        """All variables from the free ones."""
        full = self._full.copy()
        full[self.free] = x
        return full

    def values(self, x: Array) -> tuple[float, Array]:
        """Scaled objective and constraints."""
        f, g = self.source.values(self.full(x))
        return self.objective_scale * f, self.g_scale * g

    def linearise(self, x: Array) -> ScaledPoint:
        """Scaled derivatives."""
        return ScaledPoint(self, x, self.source.linearise(self.full(x)))
