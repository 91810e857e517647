# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A nonlinear problem made of node functions on splines, for any backend."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from human_model.typing import Array
from lift_predictor.core.solvers.compiled_assembler import CompiledAssembler
from lift_predictor.core.solvers.layout import Group
from lift_predictor.core.solvers.library import NodeLibrary


class Assembler(Protocol):
    """What computes objective, constraints and derivatives; see `CompiledAssembler`."""

    n: int
    m: int

    def set_parameters(self, parameters: Array) -> None:
        """Person and task of all following calls."""
        ...

    def values(self, x: Array) -> tuple[float, Array]:
        """Objective and constraints."""
        ...

    def first(self, x: Array) -> tuple[float, Array, Array]:
        """Objective, constraints, gradient; the point of the following calls."""
        ...

    def times(self, step: Array) -> Array:
        """Jacobian times a step."""
        ...

    def transposed(self, multiplier: Array) -> Array:
        """Transposed Jacobian times multipliers."""
        ...

    def dense_rows(self, wanted: NDArray[np.int32]) -> Array:
        """Dense Jacobian of some constraints (sorted indices)."""
        ...

    def condensed(self, sigma: float, multiplier: Array, weight: Array) -> Array:
        """Hessian of the Lagrangian and weighted squares of the constraints."""
        ...


def make_assembler(library: NodeLibrary, groups: Sequence[Group], n: int) -> Assembler:
    """Assembler of compiled functions, or of those in the virtual machine."""
    if library.compiled is not None:
        return CompiledAssembler(library, groups, n)
    # Imports CasADi.
    from lift_predictor.core.solvers.virtual_assembler import VirtualAssembler

    return VirtualAssembler(library, groups, n)


class SplineNlp:
    """A problem of groups of node functions, with bounds and parameters.

    Parameters
    ----------
    assembler : Assembler
        From `make_assembler`; several problems may share one, used one after the other.
    parameters : array
        Person and task.
    lower, upper : array, shape (n,)
        Bounds of the variables.
    g_lower, g_upper : array, shape (m,)
        Bounds of the constraints, group by group, instant by instant.
    constraint_name, variable_name : callable
        Names by index.
    """

    def __init__(
        self,
        assembler: Assembler,
        parameters: Array,
        variables: tuple[Array, Array],
        g: tuple[Array, Array],
        constraint_name: Callable[[int], str],
        variable_name: Callable[[int], str],
    ) -> None:
        self.assembler, self.parameters = assembler, np.array(parameters, dtype=float)
        self.n = assembler.n
        self.lower, self.upper = (np.array(bound, dtype=float) for bound in variables)
        self.g_lower, self.g_upper = (np.array(bound, dtype=float) for bound in g)
        self.constraint_name, self.variable_name = constraint_name, variable_name
        self.equal = np.flatnonzero(self.g_lower == self.g_upper).astype(np.int32)
        if self.lower.shape != (self.n,) or self.g_lower.shape != (assembler.m,):
            raise ValueError(
                f'bounds of {len(self.lower)} variables and {len(self.g_lower)} constraints for a '
                f'problem of {self.n} and {assembler.m}'
            )
        assembler.set_parameters(self.parameters)

    def values(self, x: Array) -> tuple[float, Array]:
        """Objective and constraints."""
        return self.assembler.values(x)

    def linearise(self, x: Array) -> SplinePoint:
        """First derivatives at x; the last point is the only one that can be used."""
        return SplinePoint(self, x)


class SplinePoint:
    """Derivatives of a `SplineNlp` at its last point."""

    def __init__(self, problem: SplineNlp, x: Array) -> None:
        self._assembler, self._m = problem.assembler, len(problem.g_lower)
        self.objective, self.g, self.gradient = self._assembler.first(x)
        self.equality = self._assembler.dense_rows(problem.equal)
        self.times = self._assembler.times
        self.transposed = self._assembler.transposed
        self.condensed = self._assembler.condensed

    def jacobian(self) -> Array:
        """Dense Jacobian of all constraints (m, n)."""
        return self._assembler.dense_rows(np.arange(self._m, dtype=np.int32))
