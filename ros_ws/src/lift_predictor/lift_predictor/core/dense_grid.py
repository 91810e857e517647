# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The grid on which lifts are checked between their time nodes, in plane and space."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.typing import Array

DENSITY: Final = 10
"""Dense points per node interval."""


def near_nodes(excess: Array) -> Array:
    """Give how far limits are exceeded round the nodes.

    Parameters
    ----------
    excess : ((n_nodes - 1) * DENSITY + 1, n) array
        Beyond the limits on the dense grid; negative within them.

    Returns
    -------
    (n_nodes, n) array
        Largest positive excess within one interval of each node.
    """
    inside = np.maximum(excess[:-1].reshape(-1, DENSITY, excess.shape[1]).max(axis=1), 0.0)
    nodes = np.zeros((len(inside) + 1, excess.shape[1]))
    nodes[:-1] = inside
    nodes[1:] = np.maximum(nodes[1:], inside)
    return nodes
