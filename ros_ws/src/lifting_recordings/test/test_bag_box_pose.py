# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Pose of the box: markers that do not fit it give none."""

import numpy as np
import pytest

from lifting_recordings.box_pose import box_poses
from lifting_recordings.exceptions import ConventionError

LAYOUT = {
    'B1': (0.1, 0.15, 0.05),
    'B2': (0.1, -0.15, 0.05),
    'B3': (-0.1, 0.15, 0.05),
    'B4': (-0.1, -0.15, 0.05),
}
CENTRE = np.array([0.4, 0.0, 0.3])


def markers(n: int = 20) -> np.ndarray:
    return np.tile(CENTRE + np.array(list(LAYOUT.values())), (n, 1, 1))


def test_stray_and_exchanged_markers_give_no_pose():
    seen = markers()
    seen[3, 0] += (0.3, 0.0, 0.0)
    seen[7, [0, 1]] = seen[7, [1, 0]]
    position, quaternion, misfits = box_poses(tuple(LAYOUT), seen, LAYOUT)
    assert misfits == 2
    assert np.flatnonzero(np.isnan(position[:, 0])).tolist() == [3, 7]
    good = np.isfinite(position[:, 0])
    np.testing.assert_allclose(position[good], np.tile(CENTRE, (18, 1)), atol=1e-12)
    np.testing.assert_allclose(np.abs(quaternion[good, 3]), 1.0, atol=1e-12)


def test_layout_that_does_not_fit_is_refused():
    wrong = {name: tuple(2.0 * x for x in place) for name, place in LAYOUT.items()}
    with pytest.raises(ConventionError, match=r'20 of 20 frames: write their positions in metres'):
        box_poses(tuple(LAYOUT), markers(), wrong)
