# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Pose of the frame of the L5-S1 disc in the laboratory, as in messages and /tf."""

from __future__ import annotations

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array


@njit(error_model='numpy')
def world_poses(poses: Array) -> tuple[Array, Array]:
    """Return the places (n, 3) [m] and orientations (n, 4) of a frame in the laboratory.

    Orientations are quaternions xyzw with w >= 0, world (REP-103) <- frame.  As in
    `human_model.frames.quaternion_from_matrix` the largest of the four squared components is the
    divisor (Shepperd 1978); that one takes ten times as long for a single sample.

    Parameters
    ----------
    poses : (n, 3, 4)
        Rotation ground <- frame, and in the last column the place [m]; ground in OpenSim's axes.
    """
    n = poses.shape[0]
    position, orientation = np.empty((n, 3)), np.empty((n, 4))
    r = np.empty((3, 4))
    for k in range(n):
        for i in range(4):
            # REP-103 is forward, left, up; OpenSim forward, up, right.
            r[0, i] = poses[k, 0, i]
            r[1, i] = -poses[k, 2, i]
            r[2, i] = poses[k, 1, i]
        for i in range(3):
            position[k, i] = r[i, 3]
        trace = r[0, 0] + r[1, 1] + r[2, 2]
        best, most = 3, trace
        for i in range(3):
            if r[i, i] > most:
                best, most = i, r[i, i]
        q = orientation[k]
        if best == 3:
            q[0], q[1], q[2] = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
            q[3] = 1.0 + trace
        else:
            i, j, m = best, (best + 1) % 3, (best + 2) % 3
            q[i] = 1.0 + 2.0 * r[i, i] - trace
            q[j], q[m] = r[j, i] + r[i, j], r[m, i] + r[i, m]
            q[3] = r[m, j] - r[j, m]
        size = np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        if q[3] < 0.0:
            size = -size
        for i in range(4):
            q[i] /= size
    return position, orientation
