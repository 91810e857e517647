# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift import`: the axes of its help are accepted, options are refused in words."""

import pytest

from lifting_cli.cli import main
from lifting_cli.import_command import with_axes


@pytest.mark.parametrize('axis', ['-x', '-y', '-z', '+x'])
def test_axis_with_either_sign_reaches_the_import(axis, tmp_path, capsys):
    words = ['import', str(tmp_path / 'no.trc'), '--subject', str(tmp_path / 'no.yaml')]
    words += ['--output', str(tmp_path / 'bag'), '--facing', axis, '--vertical', axis]
    assert main(words) == 1
    assert 'no.yaml: cannot be read' in capsys.readouterr().err


def test_axis_is_joined_to_its_option_only():
    assert with_axes(['--facing', '-x', 'a.trc']) == ['--facing=-x', 'a.trc']
    assert with_axes(['a.trc', '-x']) == ['a.trc', '-x']
    assert with_axes(['--floor-height', '-0.5']) == ['--floor-height', '-0.5']


def test_unknown_axis_and_plate_are_refused_in_words(tmp_path, capsys):
    words = ['import', 'a.trc', '--subject', 's.yaml', '--output', str(tmp_path / 'bag')]
    assert main([*words, '--facing', 'x']) == 1
    assert "--facing x: 'x' is not one of +x" in capsys.readouterr().err
    assert main([*words, '--plate', 'right']) == 1
    assert '--plate right: write NAME=LOAD, for example 1=right' in capsys.readouterr().err
    assert main([*words, '--plate', '1=up']) == 1
    assert 'not one of right, left, both, box, none' in capsys.readouterr().err
