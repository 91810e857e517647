# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A function of one instant of a lift, with exact derivatives, as CasADi expressions.

The interface of the kernels. The problem of a lift is made of groups; a group is one node function
at many instants (`layout.Group`). A node function is

    (z, s, p) -> cost, g

z holds the values of the splines at the instant, channel by channel, order of differentiation by
order, component by component: [q, q', q'', u, ...] with derivatives by normalised time; s are
scalars that are variables (box mass, final time); p is the parameter vector of person and task,
which all functions of one library share. The problem's objective is the weighted sum of all
costs; its constraints are those of all groups, node by node. A function that is only evaluated
(forces of a report) has no derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np


@dataclass(frozen=True, eq=False)
class NodeFunction:
    """A node function in CasADi's SX symbols.

    Attributes
    ----------
    name : str
        C identifier.
    z, s, p : SX
        Symbols, column vectors; s may be empty.
    g : SX
        Constraints, a column; may be empty.
    cost : SX
        Scalar; 0 if omitted.
    differentiable : bool
        Whether derivatives are wanted.
    """

    name: str
    z: Any
    s: Any
    p: Any
    g: Any
    cost: Any = 0.0
    differentiable: bool = True

    def derived(self) -> DerivedFunction:
        """Value, first and second derivatives as functions of (z, s), p and multipliers."""
        zs = ca.vertcat(self.z, self.s)
        cost, g = ca.SX(self.cost), ca.SX(self.g)
        value = ca.Function('value', [zs, self.p], [ca.vertcat(cost, g)])
        none = np.zeros(0, dtype=np.int32)
        if not self.differentiable:
            return DerivedFunction(self.name, value, None, None, none, none, none, none)
        jacobian = ca.jacobian(g, zs)
        row, column = (np.array(i, dtype=np.int32) for i in jacobian.sparsity().get_triplet())
        order = np.lexsort((column, row))
        nonzeros = jacobian.nonzeros()
        slopes = ca.vertcat(*(nonzeros[i] for i in order)) if nonzeros else ca.SX(0, 1)
        first = ca.Function(
            'first', [zs, self.p], [ca.vertcat(cost, g, ca.gradient(cost, zs), slopes)]
        )
        multiplier = ca.SX.sym('multiplier', 1 + g.numel())
        lagrangian = ca.dot(multiplier, ca.vertcat(cost, g))
        hessian = ca.tril(ca.jacobian(ca.gradient(lagrangian, zs), zs))
        second = ca.Function('second', [zs, self.p, multiplier], [_column(hessian)])
        h_row, h_column = (np.array(i, dtype=np.int32) for i in hessian.sparsity().get_triplet())
        return DerivedFunction(
            self.name, value, first, second, row[order], column[order], h_row, h_column
        )


@dataclass(frozen=True, eq=False)
class DerivedFunction:
    """A node function as CasADi functions with all results in one column.

    Attributes
    ----------
    name : str
        C identifier.
    value : casadi.Function
        ((z, s), p) -> cost, g.
    first : casadi.Function or None
        ((z, s), p) -> cost, g, gradient of the cost, nonzeros of the Jacobian of g.
    second : casadi.Function or None
        ((z, s), p, multipliers of cost and g) -> nonzeros of the Hessian's lower triangle.
    jacobian_row, jacobian_column, hessian_row, hessian_column : int array
        Positions of the nonzeros; those of the Jacobian are sorted by row.
    """

    name: str
    value: Any
    first: Any
    second: Any
    jacobian_row: Any
    jacobian_column: Any
    hessian_row: Any
    hessian_column: Any

    @property
    def n_in(self) -> int:
        """Number of inputs in (z, s)."""
        return int(self.value.numel_in(0))

    @property
    def n_parameters(self) -> int:
        """Number of parameters."""
        return int(self.value.numel_in(1))

    @property
    def n_g(self) -> int:
        """Number of constraints."""
        return int(self.value.numel_out(0)) - 1


def _column(matrix: Any) -> Any:
    return ca.vertcat(*matrix.nonzeros()) if matrix.nnz() else ca.SX(0, 1)
