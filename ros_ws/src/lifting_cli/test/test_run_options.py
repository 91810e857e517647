# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Options of `lift run` that exclude each other."""

import pytest

from lifting_cli.cli import main


@pytest.mark.parametrize('option', ['--visualize', '--record-visualization'])
def test_there_is_nothing_to_see_offline(capsys, option):
    assert main(['run', 'no_such_bag', '--offline', option]) == 1
    assert '--offline starts no node' in capsys.readouterr().err
