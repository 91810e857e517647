# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Markers at exactly 0, 0, 0, or with one coordinate only, are not seen."""

from pathlib import Path

import numpy as np
import pytest

from lifting_recordings.exceptions import FileFormatError
from lifting_recordings.raw_markers import without_zeros


def test_marker_at_the_origin_is_not_seen_and_named():
    positions = np.ones((4, 2, 3))
    positions[1:3, 1] = 0.0
    positions[3, 0, 1] = np.inf
    positions[0, 0, 2] = 0.0
    found, notes = without_zeros(Path('a.trc'), ('C7', 'LASI'), positions)
    assert np.isnan(found[1:3, 1]).all()
    assert np.isnan(found[3, 0]).all()
    assert np.isfinite(found).sum() == 24 - 9
    assert len(notes) == 1
    assert 'LASI (2)' in notes[0]


def test_recording_without_any_position_is_refused():
    with pytest.raises(FileFormatError, match='no marker is seen in any frame'):
        without_zeros(Path('a.trc'), ('C7',), np.zeros((3, 1, 3)))
