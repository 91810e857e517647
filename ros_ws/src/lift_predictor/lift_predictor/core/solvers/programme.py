# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What a nonlinear programme must offer to the solvers of this package.

Minimise f(x) with lower <= x <= upper and row_lower <= g(x) <= row_upper. Equal bounds fix a
variable or make an equality row; infinite ones are allowed.
"""

from __future__ import annotations

from typing import Protocol

from human_model.typing import Array


class Linearisation(Protocol):
    """Derivatives of a programme at one point x.

    Attributes
    ----------
    objective : float
        f(x).
    rows : array, shape (m,)
        g(x).
    gradient : array, shape (n,)
        Gradient of f.
    equality : array, shape (n_equalities, n)
        Dense Jacobian of the equality rows, in their order.
    """

    objective: float
    rows: Array
    gradient: Array
    equality: Array

    def times(self, step: Array) -> Array:
        """Jacobian of all rows times a step (n,): shape (m,)."""
        ...

    def transposed(self, multiplier: Array) -> Array:
        """Transposed Jacobian of all rows times multipliers (m,): shape (n,)."""
        ...

    def condensed(self, sigma: float, multiplier: Array, weight: Array) -> Array:
        """Hessian of the Lagrangian and weighted outer products of the rows' gradients.

        Parameters
        ----------
        sigma : float
            Factor of the objective.
        multiplier : array, shape (m,)
            Factors of the rows' Hessians.
        weight : array, shape (m,)
            Factors of J_i' J_i; also of equality rows, where the solver may put one.

        Returns
        -------
        array, shape (n, n)
            sigma Hess f + sum_i multiplier_i Hess g_i + sum_i weight_i J_i' J_i, symmetric.
        """
        ...


class Programme(Protocol):
    """A nonlinear programme.

    Attributes
    ----------
    n : int
        Number of variables.
    lower, upper : array, shape (n,)
        Bounds of the variables.
    row_lower, row_upper : array, shape (m,)
        Bounds of the rows.
    """

    n: int
    lower: Array
    upper: Array
    row_lower: Array
    row_upper: Array

    def row_name(self, index: int) -> str:
        """Name of a row, for messages."""
        ...

    def variable_name(self, index: int) -> str:
        """Name of a variable, for messages."""
        ...

    def values(self, x: Array) -> tuple[float, Array]:
        """Objective and rows (m,) at x; not finite where the functions are not defined."""
        ...

    def linearise(self, x: Array) -> Linearisation:
        """First derivatives at x, and the means to get the second ones."""
        ...
