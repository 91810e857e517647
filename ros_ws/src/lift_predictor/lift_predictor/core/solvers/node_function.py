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
from typing import Any, Protocol, TypeAlias

import casadi as ca
import numpy as np
from numpy.typing import NDArray

#: Expressions and functions of CasADi, which has no types.
Expression: TypeAlias = Any
Function: TypeAlias = Any


class Derivatives(Protocol):
    """Value and derivatives of a node function, for the C library and the virtual machine.

    Attributes
    ----------
    name : str
        C identifier.
    value : casadi.Function
        ((z, s), p) -> cost, g.
    jacobian_row, jacobian_column, hessian_row, hessian_column : ndarray of int
        Positions of the nonzeros; those of the Jacobian are sorted by row.
    """

    name: str
    value: Function
    jacobian_row: NDArray[np.int32]
    jacobian_column: NDArray[np.int32]
    hessian_row: NDArray[np.int32]
    hessian_column: NDArray[np.int32]

    @property
    def first(self) -> Function:
        """((z, s), p) -> cost, g, gradient of the cost, nonzeros of the Jacobian of g."""

    @property
    def second(self) -> Function:
        """((z, s), p, multipliers of cost and g) -> nonzeros of the Hessian's lower triangle."""

    @property
    def n_in(self) -> int:
        """Number of inputs in (z, s)."""

    @property
    def n_parameters(self) -> int:
        """Number of parameters."""

    @property
    def n_g(self) -> int:
        """Number of constraints."""

    def source(self) -> str | None:
        """C code of the functions NAME_value, NAME_first and NAME_second; None: written out."""


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
    z: Expression
    s: Expression
    p: Expression
    g: Expression
    cost: Expression = 0.0
    differentiable: bool = True

    def derived(self) -> Derivatives:
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


@dataclass(eq=False)
class DerivedFunction:
    """`Derivatives` as CasADi functions with all results in one column.

    `first` and `second` are None if the node function is not differentiable.
    """

    name: str
    value: Function
    first: Function
    second: Function
    jacobian_row: NDArray[np.int32]
    jacobian_column: NDArray[np.int32]
    hessian_row: NDArray[np.int32]
    hessian_column: NDArray[np.int32]

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

    def source(self) -> str | None:
        """Return None: the C code is written out."""
        return None


def _column(matrix: Expression) -> Expression:
    return ca.vertcat(*matrix.nonzeros()) if matrix.nnz() else ca.SX(0, 1)
