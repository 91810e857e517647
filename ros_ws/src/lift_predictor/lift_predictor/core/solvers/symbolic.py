# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A small dense programme from CasADi expressions: a reference for the solvers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

from human_model.typing import Array


class SymbolicProgramme:
    """Programme of f(x) and g(x), run in CasADi's virtual machine.

    Parameters
    ----------
    objective : callable
        Expression of f from a list of n symbols.
    rows : callable
        Expressions of the rows from the same.
    variables : pair of array, shape (n,)
        Lower and upper bounds of the variables.
    row_bounds : pair of array, shape (m,)
        Lower and upper bounds of the rows.
    """

    def __init__(
        self,
        objective: Callable[[list[Any]], Any],
        rows: Callable[[list[Any]], list[Any]],
        variables: tuple[Any, Any],
        row_bounds: tuple[Any, Any],
    ) -> None:
        self.lower, self.upper = (np.array(b, dtype=float) for b in variables)
        self.row_lower, self.row_upper = (np.array(b, dtype=float) for b in row_bounds)
        self.n = len(self.lower)
        x = ca.SX.sym('x', self.n)
        parts = [x[i] for i in range(self.n)]
        f, g = ca.SX(objective(parts)), ca.SX(ca.vertcat(*rows(parts)))
        sigma, y = ca.SX.sym('sigma'), ca.SX.sym('y', len(self.row_lower))
        lagrangian = sigma * f + ca.dot(y, g)
        self._values = ca.Function('values', [x], [f, g])
        self._first = ca.Function('first', [x], [f, g, ca.gradient(f, x), ca.jacobian(g, x)])
        self._second = ca.Function('second', [x, sigma, y], [ca.hessian(lagrangian, x)[0]])

    def row_name(self, index: int) -> str:
        """Row and its number."""
        return f'row {index}'

    def variable_name(self, index: int) -> str:
        """Letter and number."""
        return f'x{index}'

    def values(self, x: Array) -> tuple[float, Array]:
        """Objective and rows."""
        f, g = self._values(x)
        return float(f), np.asarray(g).ravel()

    def linearise(self, x: Array) -> SymbolicPoint:
        """First derivatives."""
        return SymbolicPoint(self, x)

    def hessian(self, x: Array, sigma: float, multiplier: Array) -> Array:
        """Hessian of the Lagrangian (n, n)."""
        return np.asarray(self._second(x, sigma, multiplier))


class SymbolicPoint:
    """Dense derivatives of a `SymbolicProgramme`."""

    def __init__(self, programme: SymbolicProgramme, x: Array) -> None:
        self._programme, self._x = programme, np.array(x)
        f, g, gradient, jacobian = programme._first(x)
        self.objective, self.rows = float(f), np.asarray(g).ravel()
        self.gradient, self.jacobian = np.asarray(gradient).ravel(), np.asarray(jacobian)
        self.equality = self.jacobian[programme.row_lower == programme.row_upper]

    def times(self, step: Array) -> Array:
        """Jacobian times a step."""
        return np.asarray(self.jacobian @ step)

    def transposed(self, multiplier: Array) -> Array:
        """Transposed Jacobian times multipliers."""
        return np.asarray(self.jacobian.T @ multiplier)

    def condensed(self, sigma: float, multiplier: Array, weight: Array) -> Array:
        """Hessian of the Lagrangian and weighted squares of the rows."""
        hessian = self._programme.hessian(self._x, sigma, multiplier)
        return np.asarray(hessian + (self.jacobian.T * weight) @ self.jacobian)
