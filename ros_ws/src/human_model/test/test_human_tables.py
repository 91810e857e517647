# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Tables: comments, header, sources, and cells as checked values."""

import pytest

from human_model.exceptions import HumanModelError, TableError
from human_model.tables import Row, parse_table, read_file, read_table

TEXT = """# SPDX-License-Identifier: Apache-2.0
name,value,up_to,count,side,latching,source

# the first kind
one, 1.5,,3,left,yes,"Zaman (2022), table 2.3"
two,-2e3,7,4,right,no,engineering choice: none
"""


def test_rows_give_text_and_checked_values():
    one, two = parse_table('t.csv', TEXT, 'name value', sourced=True)
    assert one['source'] == 'Zaman (2022), table 2.3'
    assert (one.line, two.line) == (5, 6)
    assert (one.number('value'), two.number('value')) == (1.5, -2000.0)
    assert (one.number('up_to', 9.0), two.number('up_to', 9.0)) == (9.0, 7.0)
    assert two.numbers('value', 'up_to') == (-2000.0, 7.0)
    assert one.within('count', 3.0, 4.0) == one.whole('count') == 3
    assert two.choice('side', {'left': 0, 'right': 1}) == 1
    assert one.flag('latching')
    assert not two.flag('latching')
    assert dict(two)['name'] == 'two'


@pytest.mark.parametrize(
    ('read', 'words'),
    [
        (lambda row: row.number('a'), "'a': a number is needed, found 'x'"),
        (lambda row: row.number('b'), "'b': a finite number is needed, found 'inf'"),
        (lambda row: row.number('c'), "'c': a number is needed, found ''"),
        (lambda row: row.within('d', 0, 1), "'d': a number from 0 to 1 is needed, found '1.5'"),
        (lambda row: row.whole('d'), "'d': a whole number is needed, found '1.5'"),
        (lambda row: row.choice('a', {'y': 1, 'z': 2}), "'a': one of y, z is needed, found 'x'"),
        (lambda row: row.flag('a'), "'a': one of yes, no is needed, found 'x'"),
    ],
)
def test_a_wrong_cell_is_named_with_file_line_column_and_value(read, words):
    (row,) = parse_table('t.csv', '# comment\na,b,c,d\nx,inf,,1.5\n', 'a b c d')
    with pytest.raises(TableError, match=f'^t.csv, line 3, column {words}$') as caught:
        read(row)
    error = caught.value
    assert (error.file, error.line, error.value) == ('t.csv', 3, row[error.column])


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('', 'the table is empty'),
        ('a,source\n', 'the table is empty'),
        ('b,source\n1,s\n', "line 1, column 'a': the column is missing"),
        ('#\na,b\n1,2\n', "line 2, column 'source': the column is missing"),
        ('a,a,source\n1,2,s\n', 'line 1: a column occurs twice'),
        ('a,source\n1,s\n2,x,y\n', 'line 3: 2 cells are needed'),
        ('a,source\n1\n', 'line 2: 2 cells are needed'),
        ('a,source\n1,"s\n', 'line 2: unexpected end of data'),
        ('a,source\n1,\n', "line 2, column 'source': the source of the row is needed"),
        ('a,source\n1,  \n', "line 2, column 'source': the source of the row is needed"),
    ],
)
def test_damaged_tables_are_refused(text, words):
    with pytest.raises(TableError, match=words):
        parse_table('t.csv', text, 'a', sourced=True)


def test_a_table_of_a_user_needs_no_source(tmp_path):
    path = tmp_path / 'own.csv'
    path.write_text('\ufeffname,mass\nP1,70\n', encoding='utf-8')
    (row,) = read_file(path, 'name mass')
    assert row.number('mass') == 70.0
    with pytest.raises(TableError, match=r"own\.csv, line 1, column 'age'"):
        read_file(path, 'name age')
    with pytest.raises(TableError, match=r'none\.csv: cannot be read'):
        read_file(tmp_path / 'none.csv', 'name')
    path.write_bytes(b'name\n\xff\n')
    with pytest.raises(TableError, match=r'own\.csv: cannot be read'):
        read_file(path, 'name')


def test_tables_of_packages_are_read_once():
    rows = read_table('human_model', 'subjects.csv', 'name mass')
    assert rows is read_table('human_model', 'subjects.csv', 'name mass')
    assert isinstance(rows[0], Row)
    with pytest.raises(HumanModelError, match=r'nothing\.csv: cannot be read'):
        read_table('human_model', 'nothing.csv', 'name')
