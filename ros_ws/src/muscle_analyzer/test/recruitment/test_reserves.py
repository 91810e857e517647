# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The table of reserves and its errors."""

import pytest

from muscle_analyzer.core.exceptions import OptionError
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
    [('a,j,x,muscles,s', "a: torque 'x'"), ('a,j,1,wind,s', "a: driven_by 'wind'")],
)
def test_bad_rows_are_named(tmp_path, row, complaint):
    path = tmp_path / 'reserves.csv'
    path.write_text(f'coordinate,joint,torque,driven_by,source\n{row}\n')
    with pytest.raises(OptionError, match=complaint):
        read_reserves(('a',), path)
