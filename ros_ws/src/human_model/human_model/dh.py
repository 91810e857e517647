# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Denavit-Hartenberg chains: the tables of the skeletons, and their link transformations.

A row turns its parent's frame into its own by ``Rz(theta) Tz(d) Tx(a) Rx(alpha)`` (thesis 2.2).
The coordinate of a revolute row is added to theta, that of a prismatic row to d, times the row's
sign; rows without a coordinate are fixed. Branches are rows that name the same parent.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

import numpy as np
import numpy.typing as npt

from human_model.exceptions import ChainError
from human_model.tables import length_sum, read_table
from human_model.typing import Array

_ANGLES = {'0': 0.0, 'pi': pi, 'pi/2': pi / 2, '-pi/2': -pi / 2, '-pi': -pi}
_KINDS = {kind: kind for kind in ('fixed', 'revolute', 'prismatic')}
_SIGNS = {'1': 1, '-1': -1}
_COLUMNS = 'row coordinate kind parent sign theta d a alpha segment branch'


def dh_transform(theta: float, d: float, a: float, alpha: float) -> Array:
    """Homogeneous transformation (4, 4) of one row: theta, d, a, alpha in this sequence."""
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array(
        [
            [ct, -st * ca, st * sa, a * ct],
            [st, ct * ca, -ct * sa, a * st],
            [0.0, sa, ca, d],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


@dataclass(frozen=True)
class DHRow:
    """One row of a chain table; ``d`` and ``a`` in m, angles in rad.

    ``parent`` is the index of the parent row, -1 for the world. ``coordinate`` is empty for a
    fixed row. ``segment`` names the body segment that moves with the row, if one does.
    """

    coordinate: str
    kind: str
    parent: int
    sign: int
    theta: float
    d: float
    a: float
    alpha: float
    segment: str
    branch: str

    def transform(self, q: float) -> Array:
        """Return T (4, 4) from the parent's frame at coordinate value q [rad or m]."""
        theta = self.theta + self.sign * q if self.kind == 'revolute' else self.theta
        d = self.d + self.sign * q if self.kind == 'prismatic' else self.d
        return dh_transform(theta, d, self.a, self.alpha)

    def derivatives(self, q: float) -> tuple[Array, Array]:
        """First and second derivative (4, 4) of T with respect to the coordinate."""
        zero = np.zeros((4, 4))
        if self.kind == 'fixed':
            return zero, zero
        transform = self.transform(q)
        generator = np.zeros((4, 4))
        if self.kind == 'revolute':
            generator[0, 1], generator[1, 0] = -self.sign, self.sign
        else:
            generator[2, 3] = self.sign
        return generator @ transform, generator @ generator @ transform


@dataclass(frozen=True)
class Chain:
    """A tree of rows, parents before children, for one set of lengths."""

    name: str
    rows: tuple[DHRow, ...]

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Coordinates in the order of their rows."""
        return tuple(row.coordinate for row in self.rows if row.coordinate)

    @property
    def segments(self) -> tuple[str, ...]:
        """Segments in the order of their rows."""
        return tuple(row.segment for row in self.rows if row.segment)

    def expand(self, q: npt.ArrayLike) -> Array:
        """Coordinate value of every row (0 where fixed) from q (n_q,)."""
        values = np.asarray(q, dtype=np.float64)
        if values.shape != (len(self.coordinates),):
            raise ChainError(
                f'{self.name}: {len(self.coordinates)} coordinates are needed, '
                f'got shape {values.shape}'
            )
        expanded = np.zeros(len(self.rows))
        expanded[[i for i, row in enumerate(self.rows) if row.coordinate]] = values
        return expanded

    def frames(self, q: npt.ArrayLike) -> Array:
        """World frames A (n_rows, 4, 4) of all rows (equation 2.1)."""
        values = self.expand(q)
        frames = np.empty((len(self.rows), 4, 4))
        for i, row in enumerate(self.rows):
            parent = np.eye(4) if row.parent < 0 else frames[row.parent]
            frames[i] = parent @ row.transform(float(values[i]))
        return frames


def load_chain(name: str, lengths: Mapping[str, float]) -> Chain:
    """Read ``data/dh_<name>.csv`` and put the lengths [m] in.

    Raises
    ------
    TableError
        If a kind, sign or angle is not valid, or a row's parent comes after it.
    ChainError
        If a coordinate or segment occurs twice.
    """
    rows: list[DHRow] = []
    for i, line in enumerate(read_table('human_model', f'dh_{name}.csv', _COLUMNS)):
        parent = line.whole('parent') - 1
        if line.whole('row') != i + 1 or not -1 <= parent < i:
            raise line.error('parent', 'rows must be numbered and follow their parents')
        kind, coordinate = line.choice('kind', _KINDS), line['coordinate']
        if (kind == 'fixed') == bool(coordinate):
            raise line.error('coordinate', f'a row of kind {kind} cannot have this coordinate')
        rows.append(
            DHRow(
                coordinate=coordinate,
                kind=kind,
                parent=parent,
                sign=line.choice('sign', _SIGNS),
                theta=line.choice('theta', _ANGLES),
                d=length_sum(line['d'], lengths),
                a=length_sum(line['a'], lengths),
                alpha=line.choice('alpha', _ANGLES),
                segment=line['segment'],
                branch=line['branch'],
            )
        )
    chain = Chain(name, tuple(rows))
    for names in (chain.coordinates, chain.segments):
        if len(set(names)) != len(names):
            raise ChainError(f'dh_{name}.csv: a coordinate or segment occurs twice')
    return chain
