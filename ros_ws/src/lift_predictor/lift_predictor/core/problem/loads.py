# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Loads of a motion by a model, from the report function of its compiled library."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.solvers.node_evaluation import evaluate_node

Coordinates = tuple[Array, Array, Array]
"""Splined coordinates (n, n_coordinates) and two derivatives by time."""


class Loads(Protocol):
    """Loads of n instants that every model has."""

    @property
    def torque(self) -> Array:
        """Joint torques (n, n_joints) [N m]."""
        ...

    @property
    def lower(self) -> Array:
        """Lower dynamic limits of the torques [N m]."""
        ...

    @property
    def upper(self) -> Array:
        """Upper dynamic limits of the torques [N m]."""
        ...

    @property
    def effort(self) -> Array:
        """Integrand of the effort (n,): sum of the squared normalised torques."""
        ...


def report_values(
    library: NodeLibrary, outputs: Sequence[tuple[str, int]], inputs: Array, parameters: Array
) -> dict[str, Array]:
    """Evaluate the function `report` of a library at n instants.

    Parameters
    ----------
    library : NodeLibrary
        Compiled or not.
    outputs : sequence of (str, int)
        Names and sizes of the outputs, in their order.
    inputs : ndarray, shape (n, n_in)
        Node variables of each instant.
    parameters : ndarray, shape (n_parameters,)
        Person and task.

    Returns
    -------
    dict of ndarray, shape (n, size)
        By name.
    """
    values = evaluate_node(library, 'report', inputs, parameters)
    stops = np.cumsum([size for _, size in outputs])[:-1]
    parts = np.split(values, stops, axis=1)
    return {name: part for (name, _), part in zip(outputs, parts, strict=True)}
