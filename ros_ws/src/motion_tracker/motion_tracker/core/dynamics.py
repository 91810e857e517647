# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What the motion of the body needs from outside."""

import numpy as np
import numpy.typing as npt

from human_model.compiled import GRAVITY, newton_euler
from human_model.skeleton import Skeleton

Array = npt.NDArray[np.float64]


def needed_force(skeleton: Skeleton, q: Array, qd: Array, qdd: Array) -> Array:
    """Sum of the outer forces (3,) [N] that carry and accelerate the body, world axes.

    Equal to mass times (acceleration of the centre of mass - gravity); taken from inverse
    dynamics without outer forces, whose forces along the pelvis' translations are this sum.
    """
    nothing = np.zeros((len(skeleton.segments), 6))
    tau = newton_euler(skeleton.tree, np.ascontiguousarray(q), np.ascontiguousarray(qd),
                       np.ascontiguousarray(qdd), nothing, GRAVITY)
    x, up, right = (float(tau[skeleton.index(name)])
                    for name in ('pelvis_tx', 'pelvis_ty', 'pelvis_tz'))
    return np.array([x, -right, up])
