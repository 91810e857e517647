# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The table of reserves and its errors."""

import pytest

from human_model.exceptions import TableError
from human_model.tables import parse_table
from muscle_analyzer.core.exceptions import OptionError
from muscle_analyzer.core.recruitment import reserves
from muscle_analyzer.core.recruitment.reserves import Reserve, read_reserves


def test_table_of_the_package():
    knee, wrist = read_reserves(('knee_angle_r', 'wrist_flex_l'))
    assert knee == Reserve('knee_angle_r', 'knee_r', 1.0, True)
    assert wrist == Reserve('wrist_flex_l', 'wrist_l', 100.0, False)


def test_unknown_coordinate_is_named():
    with pytest.raises(OptionError, match='tail_flexion'):
        read_reserves(('knee_angle_r', 'tail_flexion'))


@pytest.mark.parametrize(
    ('row', 'complaint'),
    [('a,j,x,muscles,s', "'torque': .*'x'"), ('a,j,1,wind,s', "'driven_by': .*'wind'")],
)
def test_bad_rows_are_named(monkeypatch, row, complaint):
    text = f'coordinate,joint,torque,driven_by,source\n{row}\n'
    monkeypatch.setattr(
        reserves, 'read_table', lambda _, name, columns: parse_table(name, text, columns)
    )
    with pytest.raises(TableError, match=rf'reserves\.csv, line 2, column {complaint}'):
        read_reserves(('a',))
