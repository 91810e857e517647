# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""TRC, MOT and STO: round trips, and every kind of damage named with line and field."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from human_model.opensim_storage import Storage, write_storage
from lifting_recordings.exceptions import FileFormatError
from lifting_recordings.opensim_files import MarkerTable, read_storage, read_trc, write_trc
from lifting_recordings.opensim_forces import plates_from_storage

NAMES = ('C7', 'R.Heel', 'L toe')


def table() -> MarkerTable:
    positions = np.arange(45, dtype=float).reshape(5, 3, 3) / 7.0
    positions[2, 1] = np.nan
    return MarkerTable(NAMES, np.arange(5) / 100.0, positions, 'm', 100.0)


def damage(path: Path, line: int, old: str, new: str) -> None:
    lines = path.read_text().splitlines()
    assert old in lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(old, new, 1)
    path.write_text('\n'.join(lines) + '\n')


@given(arrays(np.float64, (4, 2, 3), elements=st.floats(-1e3, 1e3)))
def test_trc_round_trip_keeps_nine_digits(tmp_path_factory, positions):
    path = tmp_path_factory.mktemp('trc') / 'a.trc'
    write_trc(path, MarkerTable(('a', 'b'), np.arange(4.0), positions, 'mm', 1.0))
    back = read_trc(path)
    assert back.names == ('a', 'b')
    assert back.units == 'mm'
    np.testing.assert_allclose(back.positions, positions, rtol=1e-8, atol=1e-12)


def test_trc_blank_cells_are_missing_markers(tmp_path):
    write_trc(tmp_path / 'a.trc', table())
    back = read_trc(tmp_path / 'a.trc')
    assert np.all(np.isnan(back.positions[2, 1]))
    assert np.count_nonzero(np.isnan(back.positions)) == 3


def test_trc_word_in_place_of_a_number_names_line_and_marker(tmp_path):
    path = tmp_path / 'a.trc'
    write_trc(path, table())
    damage(path, 8, '0.01', 'ten')
    with pytest.raises(FileFormatError, match=r"a.trc, line 8, field 'Time'.*'ten'"):
        read_trc(path)


def test_trc_unsorted_and_duplicated_stamps_name_the_line(tmp_path):
    path = tmp_path / 'a.trc'
    time = np.array([0.0, 0.01, 0.03, 0.02, 0.05])
    write_trc(path, MarkerTable(NAMES, time, table().positions, 'm', 100.0))
    with pytest.raises(FileFormatError, match=r"line 10, field 'time': unsorted stamp 0.02"):
        read_trc(path)
    time[3] = 0.03
    write_trc(path, MarkerTable(NAMES, time, table().positions, 'm', 100.0))
    with pytest.raises(FileFormatError, match=r'duplicated stamp 0.03'):
        read_trc(path)


def test_trc_header_that_counts_otherwise_is_noted(tmp_path):
    path = tmp_path / 'a.trc'
    write_trc(path, table())
    text = path.read_text()
    path.write_text('\n'.join(text.splitlines()[:-2]) + '\n')
    back = read_trc(path)
    np.testing.assert_allclose(back.positions, table().positions[:3], rtol=1e-8)
    assert any('NumFrames in the header is 5, the file holds 3' in note for note in back.notes)
    path.write_text(text.replace('\t5\t3\t', '\t\t7\t'))
    back = read_trc(path)
    assert back.positions.shape == (5, 3, 3)
    assert any('NumMarkers in the header is 7, the file holds 3' in note for note in back.notes)


def test_trc_cut_off_within_a_row_is_refused(tmp_path):
    path = tmp_path / 'a.trc'
    write_trc(path, table())
    path.write_text(path.read_text()[:-30])
    with pytest.raises(FileFormatError, match=r'line 11: .* cells where 11 belong'):
        read_trc(path)


def test_trc_blanks_cut_off_at_the_end_of_lines(tmp_path):
    path = tmp_path / 'a.trc'
    positions = table().positions
    positions[1:4, 2] = np.nan
    write_trc(path, MarkerTable(NAMES, table().time, positions, 'm', 100.0))
    path.write_text('\n'.join(line.rstrip() for line in path.read_text().splitlines()) + '\n')
    np.testing.assert_allclose(read_trc(path).positions, positions, rtol=1e-8)


def test_trc_in_latin_1_and_with_words_for_nan(tmp_path):
    path = tmp_path / 'a.trc'
    write_trc(path, table())
    damage(path, 7, '0.142857143', '-nan(ind)')
    path.write_bytes(path.read_text().replace('a.trc', 'C:\\Übung\\a.trc').encode('latin-1'))
    back = read_trc(path)
    assert np.isnan(back.positions[0, 0, 1])
    np.testing.assert_allclose(back.positions[1], table().positions[1], rtol=1e-8)


def test_trc_columns_without_a_label_are_left_out(tmp_path):
    path = tmp_path / 'a.trc'
    write_trc(path, table())
    damage(path, 4, 'R.Heel', '')
    back = read_trc(path)
    assert back.names == ('C7', 'L toe')
    np.testing.assert_allclose(back.positions, table().positions[:, [0, 2]], rtol=1e-8)
    assert any('1 unlabelled' in note for note in back.notes)


def test_trc_labels_one_tab_apart(tmp_path):
    path = tmp_path / 'a.trc'
    write_trc(path, table())
    damage(path, 4, 'C7\t\t\tR.Heel\t\t\tL toe\t\t', 'C7\tR.Heel\tL toe')
    back = read_trc(path)
    assert back.names == NAMES
    np.testing.assert_allclose(back.positions, table().positions, rtol=1e-8)


def test_trc_prefix_chooses_the_subject(tmp_path):
    path = tmp_path / 'a.trc'
    names = ('A:C7', 'B:C7', 'B:BOX')
    write_trc(path, MarkerTable(names, table().time, table().positions, 'm', 100.0))
    with pytest.raises(FileFormatError, match=r"'C7' appears twice .*--label-prefix, one of A, B"):
        read_trc(path)
    assert read_trc(path, 'A').names == ('C7', 'B:C7', 'BOX')
    assert read_trc(path, 'B').names == ('A:C7', 'C7', 'BOX')
    with pytest.raises(FileFormatError, match=r"no label has the prefix 'X'.*one of A, B"):
        read_trc(path, 'X')


@pytest.mark.parametrize('content', [b'', b'hello\nworld\n', b'\xff\xfe\x00PathFileType'])
def test_foreign_files_are_refused(tmp_path, content):
    path = tmp_path / 'a.trc'
    path.write_bytes(content)
    with pytest.raises(FileFormatError, match=r'a\.trc'):
        read_trc(path)
    with pytest.raises(FileFormatError, match=r'a\.trc'):
        read_storage(path)


def test_trc_marker_named_twice_is_refused(tmp_path):
    path = tmp_path / 'a.trc'
    write_trc(path, table())
    damage(path, 4, 'R.Heel', 'C7')
    with pytest.raises(FileFormatError, match=r"line 4, field 'labels': 'C7' appears twice"):
        read_trc(path)


def storage() -> Storage:
    columns = tuple(
        f'ground_force_{i}_{what}{axis}' for i in (1, 2) for what in 'vpm' for axis in 'xyz'
    )
    values = np.zeros((3, 18))
    values[:, 1] = 700.0
    values[:, 3:6] = (0.1, 0.0, 0.2)
    values[:, 7] = 1.5
    return Storage('grf.mot', columns, np.arange(3) / 10.0, values)


def test_storage_round_trip(tmp_path):
    write_storage(tmp_path / 'a.mot', storage())
    back = read_storage(tmp_path / 'a.mot')
    assert back.columns == storage().columns
    np.testing.assert_array_equal(back.values, storage().values)


def test_storage_in_degrees_flag(tmp_path):
    path = tmp_path / 'a.sto'
    write_storage(path, Storage('q', ('knee',), np.arange(2.0), np.ones((2, 1)), True))
    assert read_storage(path).in_degrees is True


def test_storage_row_count_is_checked(tmp_path):
    path = tmp_path / 'a.mot'
    write_storage(path, storage())
    path.write_text('\n'.join(path.read_text().splitlines()[:-1]))
    with pytest.raises(FileFormatError, match='says nrows=3, the file holds 2 rows'):
        read_storage(path)


def test_plates_hold_moment_about_the_origin():
    plates = plates_from_storage('grf.mot', storage())
    assert [p.name for p in plates] == ['ground_force_1']
    # (0.1, 0, 0.2) x (0, 700, 0) = (-140, 0, 70), and 1.5 N m about the vertical.
    np.testing.assert_allclose(plates[0].moment[0], (-140.0, 1.5, 70.0))


def test_nan_in_forces_is_named():
    bad = storage()
    bad.values[1, 1] = np.nan
    with pytest.raises(FileFormatError, match=r"field 'ground_force_1_vy': value is nan at 0.1 s"):
        plates_from_storage('grf.mot', bad)


def test_missing_force_column_is_named():
    whole = storage()
    keep = [i for i, c in enumerate(whole.columns) if c != 'ground_force_1_pz']
    part = Storage('x', tuple(whole.columns[i] for i in keep), whole.time, whole.values[:, keep])
    with pytest.raises(FileFormatError, match='ground_force_1_pz'):
        plates_from_storage('grf.mot', part)


@pytest.mark.parametrize('before', ['1_ground_', 'ground_'])
def test_torque_columns_of_the_older_naming(before):
    columns = [f'{before}force_{w}{a}' for w in 'vp' for a in 'xyz']
    columns += [f'{before}torque_{a}' for a in 'xyz']
    values = np.tile([0.0, 10.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0], (2, 1))
    plates = plates_from_storage('x.mot', Storage('x', tuple(columns), np.arange(2.0), values))
    np.testing.assert_allclose(plates[0].moment[0], (0.0, 2.0, 10.0))
