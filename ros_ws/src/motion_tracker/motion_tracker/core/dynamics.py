# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""External force that the motion of the body requires."""

import numpy as np

from human_model.compiled_blocks import outer_force
from human_model.constants import GRAVITY
from human_model.skeleton import Skeleton
from human_model.typing import Array


def needed_force(skeleton: Skeleton, q: Array, qd: Array, qdd: Array) -> Array:
    """Return the sum of the external forces [N] that carry and accelerate the body, world axes.

    The mass of each segment times (acceleration of its centre of mass - gravity).

    Parameters
    ----------
    skeleton
        Of the person.
    q, qd, qdd
        Coordinates and their rates, (n_q,) or (n, n_q).

    Returns
    -------
    ndarray (3,) or (n, 3)
    """
    block = (-1, len(skeleton.coordinates))
    position, velocity, acceleration = (
        np.ascontiguousarray(rows).reshape(block) for rows in (q, qd, qdd)
    )
    force: Array = outer_force(skeleton.tree, position, velocity, acceleration, GRAVITY)
    return force.reshape((*np.shape(q)[:-1], 3))
