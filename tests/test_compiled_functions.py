# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The set-up knows which sources are compiled, and drops stale compilations."""

import importlib.util
from pathlib import Path

import pytest

from lifting_cli import warm_up

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope='module')
def script():
    path = ROOT / 'scripts' / 'compiled_functions.py'
    spec = importlib.util.spec_from_file_location('compiled_functions', path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_sources_of_compiled_functions_are_those_with_numba(script, tmp_path):
    core = tmp_path / 'package' / 'package' / 'core'
    core.mkdir(parents=True)
    (core / 'kernel.py').write_text('from numba import njit\n')
    (core / 'plain.py').write_text('"""Does without numba."""\n')
    assert script.numba_sources(tmp_path) == [core / 'kernel.py']


def test_only_compilations_of_numba_are_removed(script, tmp_path):
    cache = tmp_path / 'package' / 'package' / '__pycache__'
    cache.mkdir(parents=True)
    for name in ('kernel.f-1.py311.nbi', 'kernel.f-1.py311.1.nbc', 'kernel.cpython-311.pyc'):
        (cache / name).write_text('')
    assert script.remove_numba_caches(tmp_path) == 2
    assert [path.name for path in cache.iterdir()] == ['kernel.cpython-311.pyc']


def test_the_repository_has_compiled_sources_in_three_packages(script):
    packages = {
        path.relative_to(ROOT / 'ros_ws' / 'src').parts[0]
        for path in script.numba_sources(ROOT / 'ros_ws' / 'src')
    }
    assert packages == {'human_model', 'motion_tracker', 'muscle_analyzer'}


def test_an_unknown_pipeline_is_refused(capsys):
    assert warm_up.main(['no_such_pipeline']) == 2
    assert 'no_such_pipeline' in capsys.readouterr().err
