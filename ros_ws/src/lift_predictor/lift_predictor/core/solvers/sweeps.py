# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Node functions too large for written-out derivatives: sweeps of directional derivatives.

The inputs are divided into sets. Columns of the Jacobian and Hessian are directional derivatives
(of the function, and of the gradient of its Lagrangian), one code for all directions of a set that
runs once for each. Values that do not depend on the direction are computed once for all sweeps.
A set that touches little of the function (accelerations) has little code. A sweep of the Hessian
leaves out the rows of earlier sets, which follow by symmetry.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from string import Template
from typing import Final

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from lift_predictor.core.solvers.node_function import (
    Derivatives,
    Expression,
    Function,
    NodeFunction,
)
from lift_predictor.core.solvers.straight_line import passes

VALUE: Final = Template("""\
static void ${name}_value(const vec *in, const double *p, vec *out) {
    ${name}_value_base(in, p, NULL, NULL, NULL, out);
}""")

FIRST: Final = Template("""\
static void ${name}_first(const vec *in, const double *p, vec *out) {
    vec base[${name}_first_base_size], t[${n_out}];
    ${name}_first_base(in, p, NULL, NULL, base, out);
${sweeps}
}""")
"""Value, gradient and Jacobian: the base pass, then `FIRST_SWEEP` for each set."""

FIRST_SWEEP: Final = Template("""\
    {
        vec seed[${size}] = {{0}};
        for (int j = 0; j < ${size}; j++) {
            int column = ${name}_set_${k}[j];
            seed[j] = spread(1.0);
            ${name}_first_${k}(in, p, NULL, seed, base, t);
            seed[j] = spread(0.0);
            out[${n_out} + column] = t[0];
            for (int i = ${name}_column_begin[column]; i < ${name}_column_begin[column + 1]; i++) {
                int at = ${name}_by_column[i];
                out[${n_first} + at] = t[1 + ${name}_jacobian_row[at]];
            }
        }
    }""")

SECOND: Final = Template("""\
static void ${name}_second(const vec *in, const double *p, const vec *multiplier, vec *out) {
    vec base[${name}_second_base_size], t[${n_in}];
    ${name}_second_base(in, p, multiplier, NULL, base, NULL);
${sweeps}
}""")
"""Lower triangle of the Hessian: the base pass, then `SECOND_SWEEP` for each set."""

SECOND_SWEEP: Final = Template("""\
    {
        vec seed[${size}] = {{0}};
        for (int j = 0; j < ${size}; j++) {
            int column = ${name}_set_${k}[j];
            seed[j] = spread(1.0);
            ${name}_second_${k}(in, p, multiplier, seed, base, t);
            seed[j] = spread(0.0);
            for (int i = 0; i < ${n_ahead}; i++) {
                int row = ${name}_ahead_${k}[i];
                int at = ${name}_hessian_place[row > column ? row * ${n_in} + column
                                                           : column * ${n_in} + row];
                if (at >= 0) out[at] = t[i];
            }
        }
    }""")


@dataclass(frozen=True, eq=False)
class SweptFunction(NodeFunction):
    """A node function with derivatives by sweeps.

    Attributes
    ----------
    sets : tuple of tuple of int
        Partition of the inputs (z, s); sets whose directions touch most of the function first.
    """

    sets: tuple[tuple[int, ...], ...] = ()

    def derived(self) -> Derivatives:
        """Return the sweeps; CasADi's functions are made when first used."""
        return SweptDerivatives(self)


class SweptDerivatives:
    """`Derivatives` of a `SweptFunction`.

    Parameters
    ----------
    function : SweptFunction
        The function; all its inputs are in its sets.
    """

    def __init__(self, function: SweptFunction) -> None:
        self.function, self.name = function, function.name
        self._zs: Expression = ca.vertcat(function.z, function.s)
        self._out: Expression = ca.vertcat(ca.SX(function.cost), ca.SX(function.g))
        self.value = ca.Function('value', [self._zs, function.p], [self._out])
        self.n_in, self.n_parameters = int(self._zs.numel()), int(function.p.numel())
        self.n_g = int(self._out.numel()) - 1
        if sorted(i for part in function.sets for i in part) != list(range(self.n_in)):
            raise ValueError(f'{self.name}: the sets are no partition of {self.n_in} inputs')
        row, column = _triplet(self.value.jac_sparsity(0, 0))
        keep = row > 0
        order = np.lexsort((column[keep], row[keep]))
        self.jacobian_row = (row[keep] - 1)[order].astype(np.int32)
        self.jacobian_column = column[keep][order].astype(np.int32)
        self._multiplier = ca.SX.sym('multiplier', 1 + self.n_g)
        self._gradient: Expression = ca.gradient(ca.dot(self._multiplier, self._out), self._zs)
        gradient = ca.Function('g', [self._zs, function.p, self._multiplier], [self._gradient])
        row, column = _triplet(gradient.jac_sparsity(0, 0))
        keep = row >= column
        self.hessian_row = row[keep].astype(np.int32)
        self.hessian_column = column[keep].astype(np.int32)

    @cached_property
    def _written_out(self) -> Derivatives:
        f = self.function
        return NodeFunction(f.name, f.z, f.s, f.p, f.g, f.cost).derived()

    @property
    def first(self) -> Function:
        """Written out, for the virtual machine; its nonzeros are in the same order."""
        return self._written_out.first

    @property
    def second(self) -> Function:
        """Written out, for the virtual machine."""
        return self._written_out.second

    def source(self) -> str:
        """C code of the functions NAME_value, NAME_first and NAME_second."""
        sets = self.function.sets
        zs, p = self._zs, self.function.p
        value = passes(self.value, f'{self.name}_value', 2, has_values=True)
        seeds = [ca.SX.sym('seed', len(part)) for part in sets]
        sweeps = [
            ca.jtimes(self._out, ca.vertcat(*(zs[i] for i in part)), seed)
            for part, seed in zip(sets, seeds, strict=True)
        ]
        first = ca.Function('first', [zs, p, *seeds], [self._out, *sweeps])
        ahead = [[i for part in sets[k:] for i in part] for k in range(len(sets))]
        turns = [
            ca.jtimes(
                ca.vertcat(*(self._gradient[i] for i in ahead[k])),
                ca.vertcat(*(zs[i] for i in sets[k])),
                seeds[k],
            )
            for k in range(len(sets))
        ]
        second = ca.Function('second', [zs, p, self._multiplier, *seeds], turns)
        parts = [
            value,
            VALUE.substitute(name=self.name),
            passes(first, f'{self.name}_first', 2, has_values=True),
            self._call_first(),
            passes(second, f'{self.name}_second', 3, has_values=False),
            self._call_second(ahead),
        ]
        return '\n'.join(parts)

    def _call_first(self) -> str:
        name, sets = self.name, self.function.sets
        order = np.lexsort((self.jacobian_row, self.jacobian_column))
        begin = np.searchsorted(self.jacobian_column[order], np.arange(self.n_in + 1))
        sizes = {'name': name, 'n_out': 1 + self.n_g, 'n_first': 1 + self.n_g + self.n_in}
        sweeps = [
            FIRST_SWEEP.substitute(sizes, k=k, size=len(part)) for k, part in enumerate(sets)
        ]
        return '\n'.join(
            (
                _table(f'{name}_by_column', order),
                _table(f'{name}_column_begin', begin),
                *(_table(f'{name}_set_{k}', part) for k, part in enumerate(sets)),
                FIRST.substitute(sizes, sweeps='\n'.join(sweeps)),
            )
        )

    def _call_second(self, ahead: list[list[int]]) -> str:
        name, sets, n = self.name, self.function.sets, self.n_in
        place = np.full((n, n), -1)
        place[self.hessian_row, self.hessian_column] = np.arange(len(self.hessian_row))
        sweeps = [
            SECOND_SWEEP.substitute(name=name, k=k, size=len(part), n_ahead=len(ahead[k]), n_in=n)
            for k, part in enumerate(sets)
        ]
        return '\n'.join(
            (
                _table(f'{name}_hessian_place', place.ravel()),
                *(_table(f'{name}_ahead_{k}', part) for k, part in enumerate(ahead)),
                SECOND.substitute(name=name, n_in=n, sweeps='\n'.join(sweeps)),
            )
        )


def _triplet(sparsity: Expression) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    row, column = sparsity.get_triplet()
    return np.array(row), np.array(column)


def _table(name: str, values: Iterable[int]) -> str:
    numbers = ', '.join(str(int(i)) for i in values) or '0'
    return f'static const int {name}[] = {{{numbers}}};'
