# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Published ranges of motion in place of the model's."""

import numpy as np
import pytest

from human_model.exceptions import TableError
from human_model.tables import Row
from muscle_analyzer.core.subject import coordinate_ranges
from muscle_analyzer.core.subject.coordinate_ranges import with_published_ranges


def ranges(model):
    """Return all coordinates' ranges by name, degrees."""
    return {c.name: np.degrees(c.range) for joint in model.joints for c in joint.coordinates}


def test_forearm_turns_as_far_as_people_can_and_nothing_else_changes(lifting_model):
    own, published = ranges(lifting_model), ranges(with_published_ranges(lifting_model))
    changed = {name for name, range_ in own.items() if tuple(range_) != tuple(published[name])}
    assert changed == {'pro_sup_r', 'pro_sup_l'}
    for name in changed:
        # 90 degrees are thumb up: 80 degrees of pronation from there.
        assert published[name] == pytest.approx([0.0, 170.0], abs=1e-3)


def test_empty_range_is_named(lifting_model, monkeypatch):
    row = Row('ranges.csv', 2, {'coordinate': 'pro_sup_r', 'lower': '2.0', 'upper': '1.0'})
    monkeypatch.setattr(coordinate_ranges, 'read_table', lambda *table: (row,))
    with pytest.raises(TableError, match=r"ranges\.csv, line 2, column 'upper': .*'1.0'"):
        with_published_ranges(lifting_model)
