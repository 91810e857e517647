# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker frames in the order of the model: a marker at exactly 0, 0, 0 is not seen."""

from collections import Counter

import numpy as np

from motion_tracker.core.markers.marker_frames import MarkerFrames


def test_marker_at_the_origin_is_not_seen_and_counted():
    counts: Counter[str] = Counter()
    frames = MarkerFrames(('C7', 'CLAV'), (), counts)
    positions = [[0.0, 0.0, 0.0], [0.0, 0.1, 0.0]]
    array, unknown = frames.arrange(1.0, ('C7', 'CLAV'), positions)
    assert unknown == []
    assert np.isnan(array[0]).all()
    np.testing.assert_array_equal(array[1], positions[1])
    assert counts == {'markers: at 0, 0, 0, taken as not seen': 1}
