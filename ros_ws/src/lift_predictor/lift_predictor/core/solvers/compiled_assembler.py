# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Assembly of a problem by the compiled kernel (data/kernel/assembly.c)."""

from __future__ import annotations

import ctypes
import weakref
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from human_model.typing import Array
from lift_predictor.core.solvers.layout import Group
from lift_predictor.core.solvers.library import NodeLibrary

_INT = ctypes.POINTER(ctypes.c_int)
_DOUBLE = ctypes.POINTER(ctypes.c_double)
_VECTOR_BYTES = 64


class _CGroup(ctypes.Structure):
    """`struct group` of assembly.c; the last six pointers belong to C."""

    _fields_ = (
        *((name, ctypes.c_int) for name in (
            'function', 'n_batches', 'n_channels', 'n_locals', 'n_scalars', 'costless',
        )),
        *((name, _INT) for name in ('width', 'orders', 'active', 'variables', 'uniform')),
        ('basis', _DOUBLE),
        ('cost_weight', _DOUBLE),
        ('row', _INT),
        *((name, ctypes.c_void_p) for name in (
            'input', 'out', 'multiplier', 'weight', 'second', 'shares',
        )),
    )  # fmt: skip


class CompiledAssembler:
    """Objective, constraints and derivatives of groups of node functions.

    Parameters
    ----------
    library : NodeLibrary
        Compiled functions.
    groups : sequence of Group
        The problem.
    n : int
        Variables.
    """

    def __init__(self, library: NodeLibrary, groups: Sequence[Group], n: int) -> None:
        if library.compiled is None:
            raise ValueError('the library is not compiled')
        self.library = library.compiled
        self._lanes = library.lanes
        self.n, self.m = n, sum(group.n_points * group.n_g for group in groups)
        self._keep: list[NDArray[np.generic]] = []
        structures = (_CGroup * len(groups))()
        first_row = 0
        for structure, group in zip(structures, groups, strict=True):
            self._describe(structure, group, library.functions[group.function].index, first_row)
            first_row += group.n_points * group.n_g
        self.library.lift_open.restype = ctypes.c_void_p
        handle = self.library.lift_open(self.n, self.m, len(groups), structures)
        if not handle:
            raise MemoryError(f'no memory for a problem of {n} variables and {self.m} constraints')
        self.handle = ctypes.c_void_p(handle)
        weakref.finalize(self, self.library.lift_close, self.handle)
        self.library.lift_values.restype = self.library.lift_first.restype = ctypes.c_double

    def _describe(self, structure: _CGroup, group: Group, function: int, first_row: int) -> None:
        batches = group.batches(self._lanes)
        filled = np.where(batches >= 0, batches, batches[:, :1])
        local = group.local[filled]
        structure.function, structure.n_batches = function, len(batches)
        structure.n_channels, structure.n_locals = len(group.channels), local.shape[2]
        structure.n_scalars = len(group.scalars)
        structure.costless = int(not group.cost_weight.any())
        structure.width = self._ints([channel.width for channel in group.channels])
        structure.orders = self._ints([len(channel.basis) for channel in group.channels])
        structure.active = self._ints([channel.span[1] for channel in group.channels])
        structure.variables = self._ints(local.transpose(0, 2, 1))
        structure.uniform = self._ints(np.all(local == local[:, :1], axis=(1, 2)))
        structure.basis = self._doubles(group.weights[filled].transpose(0, 2, 1))
        structure.cost_weight = self._doubles(
            np.where(batches >= 0, group.cost_weight[filled], 0.0)
        )
        structure.row = self._ints(np.where(batches >= 0, first_row + batches * group.n_g, -1))

    def _ints(self, values: object) -> ctypes._Pointer[ctypes.c_int]:
        array = np.ascontiguousarray(values, dtype=np.int32)
        self._keep.append(array)
        return array.ctypes.data_as(_INT)

    def _doubles(self, values: Array) -> ctypes._Pointer[ctypes.c_double]:
        """Copy that begins where the processor's vectors may begin."""
        room = np.empty(values.size + _VECTOR_BYTES // 8)
        skip = (-room.ctypes.data % _VECTOR_BYTES) // 8
        aligned = room[skip : skip + values.size]
        aligned[:] = values.ravel()
        self._keep.append(room)
        return aligned.ctypes.data_as(_DOUBLE)

    def set_parameters(self, parameters: Array) -> None:
        """Person and task of all following calls."""
        self._parameters = np.ascontiguousarray(parameters, dtype=float)
        self.library.lift_parameters(self.handle, _pointer(self._parameters))

    def values(self, x: Array) -> tuple[float, Array]:
        """Objective and constraints."""
        x, g = np.ascontiguousarray(x), np.empty(self.m)
        return self.library.lift_values(self.handle, _pointer(x), _pointer(g)), g

    def first(self, x: Array) -> tuple[float, Array, Array]:
        """Objective, constraints, gradient; the point of the following calls."""
        x, g, gradient = np.ascontiguousarray(x), np.empty(self.m), np.empty(self.n)
        objective = self.library.lift_first(
            self.handle, _pointer(x), _pointer(g), _pointer(gradient)
        )
        return objective, g, gradient

    def times(self, step: Array) -> Array:
        """Jacobian times a step."""
        step, g = np.ascontiguousarray(step), np.empty(self.m)
        self.library.lift_times(self.handle, _pointer(step), _pointer(g))
        return g

    def transposed(self, multiplier: Array) -> Array:
        """Transposed Jacobian times multipliers."""
        multiplier, out = np.ascontiguousarray(multiplier), np.empty(self.n)
        self.library.lift_transposed(self.handle, _pointer(multiplier), _pointer(out))
        return out

    def dense_rows(self, wanted: NDArray[np.int32]) -> Array:
        """Dense Jacobian of some constraints (sorted indices)."""
        out = np.empty((len(wanted), self.n))
        wanted = np.ascontiguousarray(wanted, dtype=np.int32)
        self.library.lift_dense_rows(self.handle, _pointer(wanted), len(wanted), _pointer(out))
        return out

    def condensed(self, sigma: float, multiplier: Array, weight: Array) -> Array:
        """Hessian of the Lagrangian and weighted squares of the constraints' gradients."""
        multiplier, weight = np.ascontiguousarray(multiplier), np.ascontiguousarray(weight)
        out = np.empty((self.n, self.n))
        self.library.lift_condensed(
            self.handle, ctypes.c_double(sigma), _pointer(multiplier), _pointer(weight),
            _pointer(out),
        )  # fmt: skip
        return out


def _pointer(array: NDArray[np.generic]) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
