# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Check of a solution between the nodes, on a dense time grid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from human_model.typing import Array

DENSITY: Final = 10
"""Dense points per node interval."""


class Family(NamedTuple):
    """Constraints of one kind.

    Attributes
    ----------
    excess : ndarray, shape (k, m)
        Beyond the limits at k instants; negative within them.
    labels : sequence of str
        Names of the m constraints.
    times : ndarray, shape (k,)
        Normalised times.
    """

    excess: Array
    labels: Sequence[str]
    times: Array


@dataclass(frozen=True, eq=False)
class Verification:
    """Largest violation of each constraint family on the dense grid.

    Attributes
    ----------
    n_points : int
        Points of the dense grid.
    violation : dict of float
        By family, whose unit is in brackets; 0: none.
    worst : dict of str
        Most violated constraint of each family, and its time; empty: none.
    tolerance : mapping of float
        Largest violation of each family that passes.
    excess : ndarray, shape (2, n_nodes, m)
        Largest excess over the lower and upper bounds of the node constraints and joint angles in
        the intervals on both sides of each node; 0: none.
    """

    n_points: int
    violation: dict[str, float]
    worst: dict[str, str]
    tolerance: Mapping[str, float]
    excess: Array

    @classmethod
    def of(
        cls, families: Mapping[str, Family], tolerance: Mapping[str, float], excess: Array
    ) -> Verification:
        """Reduce families of constraints to their largest violations."""
        violation, worst = {}, {}
        for name, (over, labels, times) in families.items():
            # A value that is not a number is no solution.
            known = np.where(np.isnan(over), np.inf, over)
            row, column = np.unravel_index(int(np.argmax(known)), known.shape)
            value = max(float(known[row, column]), 0.0)
            violation[name] = value
            worst[name] = (
                f'{labels[int(column)]} at {100.0 * times[row]:.0f} %' if value > 0.0 else ''
            )
        n_points = DENSITY * (excess.shape[1] - 1) + 1
        return cls(n_points, violation, worst, tolerance, excess)

    @property
    def passed(self) -> bool:
        """Whether every family is within its tolerance."""
        return not self.failures()

    def failures(self) -> str:
        """Families beyond their tolerance, in words."""
        return '; '.join(
            f'{name}: {self.violation[name]:.3g} ({self.worst[name]})'
            for name, limit in self.tolerance.items()
            if not self.violation[name] <= limit
        )


def dense_times(n_nodes: int) -> Array:
    """Normalised times of the dense grid, shape ((n_nodes - 1) * DENSITY + 1,)."""
    return np.linspace(0.0, 1.0, DENSITY * (n_nodes - 1) + 1)


def near_nodes(excess: Array) -> Array:
    """Return the largest positive excess within one interval of each node.

    Parameters
    ----------
    excess : ndarray, shape ((n_nodes - 1) * DENSITY + 1, m)
        Beyond the limits on the dense grid; negative within them.

    Returns
    -------
    ndarray, shape (n_nodes, m)
    """
    inside = np.maximum(excess[:-1].reshape(-1, DENSITY, excess.shape[1]).max(axis=1), 0.0)
    nodes = np.zeros((len(inside) + 1, excess.shape[1]))
    nodes[:-1] = inside
    nodes[1:] = np.maximum(nodes[1:], inside)
    return nodes
