# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Loads of the L5-S1 disc with the places that they act at."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.typing import Array


class SpineLoads(NamedTuple):
    """Loads of n samples.

    Attributes
    ----------
    time : ndarray (n,)
        Stamps [s].
    compression : ndarray (n,)
        [N]; NaN in samples that are not good data.
    position : ndarray (n, 3)
        Of the disc [m].
    orientation : ndarray (n, 4)
        Quaternion xyzw, world <- disc frame; with the position NaN where it is not known.
    """

    time: Array
    compression: Array
    position: Array
    orientation: Array

    @property
    def normal(self) -> Array:
        """Unit vectors (n, 3) along the disc's normal, towards the head."""
        x, y, z, w = self.orientation.T
        return np.stack(
            [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)], axis=1
        )
