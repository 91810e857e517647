# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""OpenSim's tables: exact round trip, degrees, and damaged files by file, line and column."""

import re

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from human_model.exceptions import StorageError
from human_model.opensim_storage import Storage, read_storage, write_storage

GOOD = """Coordinates
version=1
nRows=2
nColumns=3
inDegrees=yes

Units are S.I. units
endheader
time\thip\tpelvis_tx
0.0\t90\t1.5
0.1\t45\t2.5
"""

finite = st.floats(allow_nan=False, allow_infinity=False)


@pytest.fixture
def write(tmp_path):
    """Return a function that writes a good file, some text in it replaced."""

    def written(*replaced):
        text = GOOD
        for old, new in replaced:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / 'motion.mot'
        path.write_text(text, encoding='utf-8')
        return path

    return written


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=30)
@given(
    time=st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=6, unique=True),
    data=st.data(),
    degrees=st.booleans(),
)
def test_every_number_comes_back_exactly(tmp_path, time, data, degrees):
    values = data.draw(
        st.lists(st.lists(finite, min_size=2, max_size=2), min_size=len(time), max_size=len(time))
    )
    table = Storage('Numbers', ('a', 'b'), np.sort(time), np.array(values), degrees)
    path = tmp_path / 'numbers.sto'
    write_storage(path, table)
    again = read_storage(path)
    assert (again.name, again.columns, again.in_degrees) == ('Numbers', ('a', 'b'), degrees)
    np.testing.assert_array_equal(again.time, table.time)
    np.testing.assert_array_equal(again.values, table.values)


def test_only_angles_turn_into_radians(write):
    table = read_storage(write()).in_radians(['hip', 'knee'])
    assert not table.in_degrees
    np.testing.assert_allclose(table.column('hip'), [np.pi / 2, np.pi / 4])
    np.testing.assert_array_equal(table.column('pelvis_tx'), [1.5, 2.5])
    # In radians already: nothing happens a second time.
    assert table.in_radians(['hip']) is table


def test_values_between_rows_lie_on_a_line_and_none_outside(write):
    table = read_storage(write())
    np.testing.assert_allclose(table.at(np.array([0.0, 0.025])), [[90.0, 1.5], [78.75, 1.75]])
    with pytest.raises(StorageError, match=r'0\.2 s is outside the table, 0 to 0\.1 s'):
        table.at(np.array([0.05, 0.2]))


@pytest.mark.parametrize(
    ('old', 'new', 'message'),
    [
        ('endheader\n', '', 'no line endheader'),
        ('time\thip', 'frame\thip', r"line 9: first column is 'frame'"),
        ('\tpelvis_tx', '\thip', r"line 9, column 'hip': is there twice"),
        ('0.1\t45', '0.1\tx45', r"line 11, column 'hip': 'x45' is not a number"),
        ('0.1\t45\t2.5', '0.1\t45', r'line 11: 2 values where 3 belong'),
        ('0.1\t45', '0.0\t45', r"line 11, column 'time': 0 s after 0 s does not increase"),
        ('0.1\t45', 'nan\t45', r"line 11, column 'time': nan is not finite"),
        ('nRows=2', 'nRows=3', 'header says nrows=3, the file holds 2 rows'),
        ('nColumns=3', 'nColumns=4', 'header says ncolumns=4, the file holds 3 columns'),
        ('inDegrees=yes', 'inDegrees=maybe', "inDegrees='maybe'"),
        ('0.0\t90\t1.5\n0.1\t45\t2.5\n', '', 'holds no rows'),
    ],
)
def test_damaged_files_are_refused(write, old, new, message):
    path = write((old, new))
    with pytest.raises(StorageError, match=f'{re.escape(str(path))}.*{message}'):
        read_storage(path)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(StorageError, match=r'nothing\.mot: cannot be read'):
        read_storage(tmp_path / 'nothing.mot')


@pytest.mark.parametrize(
    ('time', 'values', 'columns', 'message'),
    [
        ([0.0, 0.0], np.zeros((2, 1)), ('a',), 'does not increase'),
        ([0.0, 1.0], np.array([[0.0], [np.nan]]), ('a',), "column 'a': nan at 1 s is not finite"),
        ([0.0, 1.0], np.zeros((2, 2)), ('a',), 'do not fit values of shape'),
        ([0.0, 1.0], np.zeros((2, 2)), ('a', 'a'), 'must be unique words'),
        ([0.0, 1.0], np.zeros((2, 1)), ('a b',), 'must be unique words'),
        ([], np.zeros((0, 1)), ('a',), 'do not fit'),
    ],
)
def test_tables_that_opensim_could_not_read_are_not_written(
    tmp_path, time, values, columns, message
):
    path = tmp_path / 'bad.mot'
    with pytest.raises(StorageError, match=message):
        write_storage(path, Storage('Bad', columns, np.array(time), values))
    assert not path.exists()


def test_a_column_that_is_not_there_is_named(write):
    with pytest.raises(StorageError, match="Coordinates: there is no column 'knee'"):
        read_storage(write()).select(['hip', 'knee'])
