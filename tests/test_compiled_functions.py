# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled functions follow their sources: an edited callee in another file gives new numbers."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from lift_predictor.core.solvers.cache import FROM_CACHE, find_compiler
from lifting_cli import warm_up

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / 'ros_ws' / 'src'

NUMBA = """
import numpy as np
from human_model.compiled_blocks import points_and_frames
from human_model.skeletons import Skeleton2D
from human_model.subject import Subject
tree = Skeleton2D.of(Subject('test', 'male', 75.0, 1.75, 30.0)).tree
one = np.zeros(1, dtype=np.int64)
points, _ = points_and_frames(tree, np.zeros((1, 10)), one, np.zeros((1, 3)), one)
print(points[0, 0, 2], sum(points_and_frames.stats.cache_misses.values()))
"""
C = """
import numpy as np
from lift_predictor.core.models.sagittal.grid import SagittalGrid
from lift_predictor.core.models.sagittal.assembly import sagittal_assembler, sagittal_library
library, grid = sagittal_library(), SagittalGrid(5, 5)
assembler = sagittal_assembler(library, grid)
assembler.set_parameters(np.linspace(0.5, 1.5, library.functions['hand'].n_parameters))
print(assembler.values(np.linspace(0.1, 0.6, grid.n_variables))[0], library.backend)
"""


@pytest.fixture
def run(tmp_path):
    """Return a function that runs a script with a copy of the packages and a cache of its own."""
    for package in ('human_model', 'lift_predictor'):
        shutil.copytree(
            SOURCES / package / package,
            tmp_path / package,
            ignore=shutil.ignore_patterns('__pycache__'),
        )

    def in_new_process(script):
        environment = os.environ | {
            'LIFT_CACHE': str(tmp_path / 'cache'),
            'PYTHONPATH': str(tmp_path),
            'PYTHONDONTWRITEBYTECODE': '1',
        }
        done = subprocess.run(
            [sys.executable, '-c', script],
            check=True,
            capture_output=True,
            text=True,
            timeout=200,
            env=environment,
            cwd=tmp_path,
        )
        return done.stdout.strip().split(maxsplit=1)

    return in_new_process


def edit(path, old, new):
    """Replace a text that a file holds once."""
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))


def test_edited_callee_in_another_file_is_compiled_again_by_numba(run, tmp_path):
    height, misses = run(NUMBA)
    assert int(misses) == 1
    assert run(NUMBA) == [height, '0'], 'unchanged sources are not compiled again'
    edit(
        tmp_path / 'human_model' / 'compiled.py',
        'def _add_turned(out: Array, matrix: Array, vector: Array) -> None:\n',
        'def _add_turned(out: Array, matrix: Array, vector: Array) -> None:\n    out[2] += 1.0\n',
    )
    higher, misses = run(NUMBA)
    assert int(misses) == 1
    assert float(higher) > float(height) + 0.5
    assert run(NUMBA) == [higher, '0']


@pytest.mark.skipif(find_compiler() is None, reason='no C compiler on this machine')
def test_edited_callee_in_another_file_is_compiled_again_to_c(run, tmp_path):
    effort, backend = run(C)
    assert backend.startswith('functions compiled with')
    assert run(C) == [effort, FROM_CACHE], 'unchanged sources are not compiled again'
    model = tmp_path / 'lift_predictor' / 'core' / 'models' / 'sagittal' / 'model.py'
    edit(model, 'return c1 + c2 * in_angle', 'return 2.0 * c1 + c2 * in_angle')
    changed, backend = run(C)
    assert backend.startswith('functions compiled with')
    assert changed != effort
    assert run(C) == [changed, FROM_CACHE]


@pytest.mark.parametrize('package', ['human_model', 'motion_tracker', 'muscle_analyzer'])
def test_packages_compile_with_the_cache_of_the_sources_only(package):
    files = list((SOURCES / package / package).rglob('*.py'))
    assert files
    for path in files:
        if path.name != 'compiled_cache.py':
            wrong = re.search(r'numba\.njit|numba import .*jit', path.read_text())
            assert not wrong, f'{path.relative_to(SOURCES)}: njit is that of human_model'


def test_an_unknown_pipeline_is_refused(capsys):
    assert warm_up.main(['no_such_pipeline']) == 2
    assert 'no_such_pipeline' in capsys.readouterr().err
