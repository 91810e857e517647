# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Assembly of a problem in NumPy with CasADi's virtual machine: no compiler, the reference."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from human_model.typing import Array
from lift_predictor.core.solvers.layout import Group
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.solvers.node_function import Derivatives


class _VirtualGroup:
    """One group: node functions mapped over its instants, and the matrix of its splines."""

    def __init__(self, group: Group, function: Derivatives, n: int, first_row: int) -> None:
        self.group, self.function = group, function
        points = group.n_points
        self.g = slice(first_row, first_row + points * group.n_g)
        self.value = function.value.map(points)
        self.first, self.second = function.first.map(points), function.second.map(points)
        unit = np.eye(n)
        self.gather = np.stack([group.inputs(unit[i]) for i in range(n)], axis=2)
        self.jacobian = np.zeros((points, group.n_g, n))
        self.inputs = np.zeros((points, function.n_in))

    def linearise(self, x: Array, p: Array) -> tuple[float, Array, Array]:
        f = self.function
        self.inputs = self.group.inputs(x)
        out = np.asarray(self.first(self.inputs.T, p)).T
        cost, g = out[:, 0], out[:, 1 : 1 + f.n_g]
        slope = out[:, 1 + f.n_g : 1 + f.n_g + f.n_in]
        local = np.zeros((len(out), f.n_g, f.n_in))
        local[:, f.jacobian_row, f.jacobian_column] = out[:, 1 + f.n_g + f.n_in :]
        self.jacobian = local @ self.gather
        weight = self.group.cost_weight
        gradient = np.einsum('b,bi,bin->n', weight, slope, self.gather)
        return float(weight @ cost), g.ravel(), gradient

    def hessian(self, p: Array, sigma: float, multiplier: Array) -> Array:
        f, points = self.function, self.group.n_points
        factors = np.vstack((sigma * self.group.cost_weight, multiplier.reshape(points, -1).T))
        out = np.asarray(self.second(self.inputs.T, p, factors)).T
        local = np.zeros((points, f.n_in, f.n_in))
        local[:, f.hessian_row, f.hessian_column] = out
        local[:, f.hessian_column, f.hessian_row] = out
        n = self.gather.shape[2]
        half = (local @ self.gather).reshape(-1, n)
        return np.asarray(self.gather.reshape(-1, n).T @ half)


class VirtualAssembler:
    """The same calls as `CompiledAssembler`.

    Parameters
    ----------
    library : NodeLibrary
        Functions that are not compiled.
    groups : sequence of Group
        The problem.
    n : int
        Variables.
    """

    def __init__(self, library: NodeLibrary, groups: Sequence[Group], n: int) -> None:
        self.n, self.m = n, sum(group.n_points * group.n_g for group in groups)
        self._groups, self._p = [], np.zeros(0)
        first_row = 0
        for group in groups:
            part = _VirtualGroup(group, library.virtual[group.function], n, first_row)
            self._groups.append(part)
            first_row += group.n_points * group.n_g

    def set_parameters(self, parameters: Array) -> None:
        """Person and task of all following calls."""
        self._p = np.array(parameters, dtype=float)

    def values(self, x: Array) -> tuple[float, Array]:
        """Objective and constraints."""
        objective, g = 0.0, np.empty(self.m)
        for part in self._groups:
            out = np.asarray(part.value(part.group.inputs(x).T, self._p)).T
            objective += float(part.group.cost_weight @ out[:, 0])
            g[part.g] = out[:, 1:].ravel()
        return objective, g

    def first(self, x: Array) -> tuple[float, Array, Array]:
        """Objective, constraints, gradient; the point of the following calls."""
        objective, g, gradient = 0.0, np.empty(self.m), np.zeros(self.n)
        for part in self._groups:
            f, g[part.g], slope = part.linearise(x, self._p)
            objective += f
            gradient += slope
        return objective, g, gradient

    def _jacobian(self) -> Array:
        return np.vstack([part.jacobian.reshape(-1, self.n) for part in self._groups])

    def times(self, step: Array) -> Array:
        """Jacobian times a step."""
        return np.asarray(self._jacobian() @ step)

    def transposed(self, multiplier: Array) -> Array:
        """Transposed Jacobian times multipliers."""
        return np.asarray(self._jacobian().T @ multiplier)

    def dense_rows(self, wanted: NDArray[np.int32]) -> Array:
        """Dense Jacobian of some constraints."""
        return self._jacobian()[wanted]

    def condensed(self, sigma: float, multiplier: Array, weight: Array) -> Array:
        """Hessian of the Lagrangian and weighted squares of the constraints' gradients."""
        jacobian = self._jacobian()
        matrix = (jacobian.T * weight) @ jacobian
        for part in self._groups:
            if len(part.function.hessian_row):
                matrix = matrix + part.hessian(self._p, sigma, multiplier[part.g])
        return np.asarray(matrix)
