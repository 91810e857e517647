# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Windows on the key joints (equation 3.15): bounds that hold one instant near a posture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.spatial.grid import (
    ANGLE_CONSTRAINTS,
    LIMITED,
    SpatialBounds,
    constraint_slice,
)
from lift_predictor.core.models.spatial.parameters import DEPENDENT


def near_posture(
    bounds: SpatialBounds, row: int, angles: Mapping[str, float], epsilon: float, when: str
) -> SpatialBounds:
    """Bounds that hold joints near given angles at one node.

    Parameters
    ----------
    bounds : SpatialBounds
        Of the task.
    row : int
        Node.
    angles : mapping
        Angles by joint coordinate [rad].
    epsilon : float
        Half width of the window [rad].
    when : str
        Name of the node, for messages.

    Raises
    ------
    TaskError
        A window lies outside of the joint's limits.
    """
    node = bounds.node_lower.copy(), bounds.node_upper.copy()
    own = bounds.angle_lower.copy(), bounds.angle_upper.copy()
    first = constraint_slice(ANGLE_CONSTRAINTS).start
    for name, value in angles.items():
        target, column = (
            (node, first + DEPENDENT.index(name)) if name in DEPENDENT
            else (own, LIMITED.index(name))
        )  # fmt: skip
        low = max(value - epsilon, target[0][row, column])
        high = min(value + epsilon, target[1][row, column])
        if low > high:
            limits = np.degrees((target[0][row, column], target[1][row, column]))
            raise TaskError(
                f'{name} at the {when} of the lift: {np.degrees(value):.1f} deg is outside '
                f'its limits of {limits[0]:.1f} to {limits[1]:.1f} deg'
            )
        target[0][row, column], target[1][row, column] = low, high
    return replace(
        bounds, node_lower=node[0], node_upper=node[1], angle_lower=own[0], angle_upper=own[1]
    )
