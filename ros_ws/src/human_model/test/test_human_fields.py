# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Fields of a file: taken by kind, and named with file and value if they are wrong."""

import pytest

from human_model.exceptions import FieldError, LiftingError
from human_model.fields import Fields


def fields(**data):
    return Fields('task.yaml', 'task', data)


def test_fields_are_taken_by_kind_and_only_once():
    found = fields(mass=3, name=' box ', sides=[1, 2], fast=True, n=4, inner={'x': 1.5}, c='a')
    assert found.names() == ['mass', 'name', 'sides', 'fast', 'n', 'inner', 'c']
    assert found.within('mass', (0.0, 5.0, 'kg')) == 3.0
    assert found.text('name') == 'box'
    assert found.numbers('sides', 2) == (1.0, 2.0)
    assert found.flag('fast', False) is True
    assert found.whole('n') == 4
    assert found.section('inner').number('x') == 1.5
    assert found.choice('c', {'a': 7}) == 7
    assert found.number('missing', 2.0) == 2.0
    found.finish()
    with pytest.raises(FieldError, match=r'task\.yaml: task\.mass: is missing'):
        found.number('mass')


@pytest.mark.parametrize(
    ('take', 'value', 'problem'),
    [
        (lambda f: f.number('x'), True, 'a number is needed, found True'),
        (lambda f: f.number('x'), float('inf'), 'a finite number is needed, found inf'),
        (lambda f: f.within('x', (1.2, 2.2, 'm')), 168, r'168 m is outside of 1\.2 to 2\.2 m'),
        (lambda f: f.at_least_zero('x'), -1.0, '-1 is negative'),
        (lambda f: f.whole('x'), 1.5, 'a whole number is needed, found 1.5'),
        (lambda f: f.numbers('x', 3), [1, 2], r'3 numbers are needed, found \[1, 2\]'),
        (lambda f: f.text('x'), 1, 'a text is needed, found 1'),
        (lambda f: f.flag('x', False), 'no', "true or false is needed, found 'no'"),
        (lambda f: f.choice('x', {'a': 1}), 'b', "'b' is not one of a"),
        (lambda f: f.mapping('x'), [], r'a mapping is needed, found \[\]'),
        (lambda f: f.section('x'), None, 'a mapping is needed, found None'),
        (lambda f: f.entries('x'), [], r'a list is needed, found \[\]'),
        (lambda f: f.finish(), 1, 'is not a known field'),
    ],
)
def test_error_names_file_field_and_value(take, value, problem):
    with pytest.raises(FieldError, match=rf'^task\.yaml: task\.x: {problem}$'):
        take(fields(x=value))


def test_error_class_is_that_of_the_reader():
    class PlanError(LiftingError):
        pass

    class PlanFields(Fields):
        ERROR = PlanError

    with pytest.raises(PlanError, match='is missing'):
        PlanFields('plan.yaml', '', {'a': {}}).section('a').number('b')


def test_unreadable_file_is_named(tmp_path):
    with pytest.raises(FieldError, match=r'none\.yaml: cannot be read'):
        Fields.read(tmp_path / 'none.yaml')
