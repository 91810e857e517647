# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint centres from landmarks."""

import numpy as np
import pytest

from human_model.exceptions import TableError
from motion_tracker.core.exceptions import CalibrationError
from motion_tracker.core.markers.joint_centres import (
    SEGMENT_OF_JOINT,
    harrington_hip,
    joint_centres,
    load_joint_definitions,
)
from motion_tracker.core.markers.marker_set import load_marker_set

#: Pelvis 250 mm wide, 150 mm deep, leg of 900 mm; x forward, y left, z up, origin at mid-ASIS.
ASIS = {'r': np.array([0.0, -0.125, 0.0]), 'l': np.array([0.0, 0.125, 0.0])}
PSIS = {'r': np.array([-0.15, -0.05, 0.0]), 'l': np.array([-0.15, 0.05, 0.0])}


@pytest.mark.parametrize('side', ['r', 'l'])
@pytest.mark.parametrize('turned', [False, True])
def test_hip_centre_by_hand(side, turned):
    """-0.24 * 150 - 9.9 = -45.9; -0.16 * 250 - 0.04 * 900 - 7.1 = -83.1; 42 + 40 + 7.9 = 89.9."""
    malleolus = ASIS[side] - [0.0, 0.0, 0.9]
    sign = 1.0 if side == 'l' else -1.0
    expected = np.array([-0.0459, sign * 0.0899, -0.0831])
    turn, shift = np.eye(3), np.zeros(3)
    if turned:
        turn = np.array([[0.0, -1.0, 0.0], [0.6, 0.0, -0.8], [0.8, 0.0, 0.6]])
        shift = np.array([1.0, -2.0, 0.5])
    points = [turn @ p + shift for p in (ASIS['r'], ASIS['l'], PSIS['r'], PSIS['l'], malleolus)]
    assert harrington_hip(*points, side) == pytest.approx(turn @ expected + shift, abs=1e-9)


def test_missing_landmark_is_named_with_its_joint():
    definitions = load_joint_definitions(load_marker_set('plug_in_gait_58'))
    with pytest.raises(CalibrationError, match=r"'RASI'.*hip_r.*Harrington"):
        joint_centres(definitions, {'LASI': ASIS['l']}, {})


SET = 'marker,segment,x,y,z,scale_with,weight,tracking\n' + '\n'.join(
    f'{name},pelvis,,,,,1,yes' for name in 'ABCDEFGHIJKL'
)


def own_set(folder):
    (folder / 'mine.csv').write_text(SET)
    return load_marker_set(folder / 'mine.csv')


def test_own_set_without_definitions_says_what_to_write(tmp_path):
    with pytest.raises(CalibrationError, match=r'mine_joint_centres\.csv: no joint centre hip_r'):
        load_joint_definitions(own_set(tmp_path))


def test_own_set_with_definitions_beside_it(tmp_path):
    rows = [
        f'{joint},marker,{n}' for joint, n in zip(SEGMENT_OF_JOINT, 'ABCDEFGHIJKL', strict=True)
    ]
    table = tmp_path / 'mine_joint_centres.csv'
    table.write_text('\n'.join(['joint,method,markers', *rows]))
    found = load_joint_definitions(own_set(tmp_path))
    assert [d.joint for d in found] == list(SEGMENT_OF_JOINT)
    table.write_text('\n'.join(['joint,method,markers', *rows]).replace('marker,A', 'marker,X'))
    with pytest.raises(TableError, match=r'mine_joint_centres\.csv.*mine has no marker X'):
        load_joint_definitions(own_set(tmp_path))
    table.write_text('\n'.join(['joint,method,markers', *rows[1:]]))
    with pytest.raises(CalibrationError, match='no joint centre hip_r for'):
        load_joint_definitions(own_set(tmp_path))
