# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Interface of a nonlinear problem (NLP) for the solvers of this package.

Minimise f(x) with lower <= x <= upper and g_lower <= g(x) <= g_upper. Equal bounds fix a
variable or make an equality constraint; infinite ones are allowed.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from human_model.typing import Array


class Linearisation(Protocol):
    """Derivatives of a problem at one point x.

    Attributes
    ----------
    objective : float
        f(x).
    g : array, shape (m,)
        g(x).
    gradient : array, shape (n,)
        Gradient of f.
    equality : array, shape (n_equalities, n)
        Dense Jacobian of the equality constraints, in their order.
    """

    objective: float
    g: Array
    gradient: Array
    equality: Array

    def times(self, step: Array) -> Array:
        """Jacobian of all constraints times a step (n,): shape (m,)."""
        ...

    def transposed(self, multiplier: Array) -> Array:
        """Transposed Jacobian of all constraints times multipliers (m,): shape (n,)."""
        ...

    def jacobian(self) -> Array:
        """Dense Jacobian of all constraints, shape (m, n), for the reference solver."""
        ...

    def condensed(self, sigma: float, multiplier: Array, weight: Array) -> Array:
        """Hessian of the Lagrangian and weighted outer products of the constraints' gradients.

        Parameters
        ----------
        sigma : float
            Factor of the objective.
        multiplier : array, shape (m,)
            Factors of the constraints' Hessians.
        weight : array, shape (m,)
            Factors of J_i' J_i; also of equality constraints, where the solver may put one.

        Returns
        -------
        array, shape (n, n)
            sigma Hess f + sum_i multiplier_i Hess g_i + sum_i weight_i J_i' J_i, symmetric.
        """
        ...


class NlpProblem(Protocol):
    """A nonlinear problem.

    Attributes
    ----------
    n : int
        Number of variables.
    lower, upper : array, shape (n,)
        Bounds of the variables.
    g_lower, g_upper : array, shape (m,)
        Bounds of the constraints.
    """

    n: int
    lower: Array
    upper: Array
    g_lower: Array
    g_upper: Array

    def constraint_name(self, index: int) -> str:
        """Name of a constraint, for messages."""
        ...

    def variable_name(self, index: int) -> str:
        """Name of a variable, for messages."""
        ...

    def values(self, x: Array) -> tuple[float, Array]:
        """Objective and constraints (m,) at x; not finite where the functions are not defined."""
        ...

    def linearise(self, x: Array) -> Linearisation:
        """First derivatives at x, and the means to get the second ones."""
        ...


def violated_constraints(
    problem: NlpProblem, g: Array, least: float
) -> tuple[tuple[str, float], ...]:
    """Return names and violations of the three most violated constraints.

    Parameters
    ----------
    problem : NlpProblem
        Problem with the bounds.
    g : ndarray, shape (m,)
        Values of the constraints.
    least : float
        Violations up to this one are left out.
    """
    excess = np.maximum(problem.g_lower - g, g - problem.g_upper)
    worst = np.argsort(-excess)[:3]
    return tuple(
        (problem.constraint_name(int(i)), float(excess[i])) for i in worst if excess[i] > least
    )
