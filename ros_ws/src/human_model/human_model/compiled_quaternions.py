# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled conversion of rotation matrices, for code that runs at 100 Hz."""

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array


@njit
def quaternions(rotation: Array) -> Array:
    """Quaternions (n, 4) xyzw with w >= 0 of rotation matrices (n, 3, 3).

    As `frames.quaternion_from_matrix` (Shepperd 1978), without its checks.
    """
    out = np.empty((rotation.shape[0], 4))
    squared = np.empty(4)
    for n in range(rotation.shape[0]):
        r = rotation[n]
        q = out[n]
        trace = r[0, 0] + r[1, 1] + r[2, 2]
        for i in range(3):
            squared[i] = 1.0 + 2.0 * r[i, i] - trace
        squared[3] = 1.0 + trace
        best = np.argmax(squared)
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            difference = r[k, j] - r[j, k]
            if best == 3:
                q[i] = difference
            elif best == i:
                q[i] = squared[i]
                q[3] = difference
            else:
                q[i] = r[best, i] + r[i, best]
        if best == 3:
            q[3] = squared[3]
        size = np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
        q /= -size if q[3] < 0.0 else size
    return out
