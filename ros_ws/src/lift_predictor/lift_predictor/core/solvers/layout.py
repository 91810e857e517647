# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Where the node functions of a problem sit on the splines: constant tables, NumPy only."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from human_model.typing import Array

Indices = NDArray[np.int32]

GROUPING_LIMIT = 1.34
"""Nodes of one spline piece share a batch if that does not need more batches by this factor: their
matrices can then be summed before they are added to the problem's."""


@dataclass(frozen=True, eq=False)
class Channel:
    """Splines (or free values) that all depend on time in the same way.

    Attributes
    ----------
    first : int
        Index of the first variable; values are stored control point by control point.
    width : int
        Components.
    basis : array, shape (orders, n_points, n_control)
        Weights of the control points at each instant, for value and derivatives by normalised
        time. An identity matrix makes values that are free at every instant.
    """

    first: int
    width: int
    basis: Array

    @cached_property
    def span(self) -> tuple[Indices, int]:
        """First active control point of each instant, and how many there are at most."""
        used = np.any(self.basis != 0.0, axis=0)
        n_control = used.shape[1]
        first = np.where(used.any(axis=1), used.argmax(axis=1), 0)
        last = np.where(used.any(axis=1), n_control - used[:, ::-1].argmax(axis=1), 1)
        active = int((last - first).max())
        return np.minimum(first, n_control - active).astype(np.int32), active


@dataclass(frozen=True, eq=False)
class Group:
    """One node function at many instants.

    Attributes
    ----------
    function : str
        Its name in the library.
    channels : tuple of Channel
        In the order of the function's inputs.
    scalars : int array
        Indices of the variables that are its inputs s.
    n_g : int
        Rows of the function.
    cost_weight : array, shape (n_points,)
        Weight of its cost at each instant (quadrature); zeros: no cost.
    """

    function: str
    channels: tuple[Channel, ...]
    scalars: tuple[int, ...]
    n_g: int
    cost_weight: Array

    @property
    def n_points(self) -> int:
        """Number of instants."""
        return len(self.cost_weight)

    def inputs(self, x: Array) -> Array:
        """Node inputs (n_points, n_in) of variables x."""
        parts: list[Array] = []
        for channel in self.channels:
            orders, _, n_control = channel.basis.shape
            values = x[channel.first : channel.first + n_control * channel.width]
            values = values.reshape(n_control, channel.width)
            parts.extend(channel.basis[order] @ values for order in range(orders))
        scalars = np.broadcast_to(x[list(self.scalars)], (self.n_points, len(self.scalars)))
        return np.hstack((*parts, scalars))

    @cached_property
    def local(self) -> Indices:
        """Variables each instant depends on, (n_points, n_locals)."""
        parts: list[NDArray[np.int64]] = []
        for channel in self.channels:
            first, active = channel.span
            offsets = np.arange(active * channel.width)
            parts.append(channel.first + first[:, None] * channel.width + offsets)
        scalars = np.broadcast_to(self.scalars, (self.n_points, len(self.scalars)))
        return np.hstack((*parts, scalars)).astype(np.int32)

    @cached_property
    def weights(self) -> Array:
        """Weights of the active control points, (n_points, sum of orders * active)."""
        parts: list[Array] = []
        for channel in self.channels:
            first, active = channel.span
            index = first[:, None] + np.arange(active)
            for order in channel.basis:
                parts.append(np.take_along_axis(order, index, axis=1))
        return np.hstack(parts)

    def batches(self, lanes: int) -> Indices:
        """Instants of each batch, (n_batches, lanes); -1 fills up."""
        starts = np.stack([channel.span[0] for channel in self.channels])
        edges = np.flatnonzero(np.any(np.diff(starts, axis=1) != 0, axis=0)) + 1
        pieces = [list(range(a, b)) for a, b in pairwise((0, *edges.tolist(), self.n_points))]
        grouped = sum(-(-len(piece) // lanes) for piece in pieces)
        if grouped > GROUPING_LIMIT * -(-self.n_points // lanes):
            pieces = [list(range(self.n_points))]
        rows = [piece[i : i + lanes] for piece in pieces for i in range(0, len(piece), lanes)]
        return np.array([row + [-1] * (lanes - len(row)) for row in rows], dtype=np.int32)
