# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The cache of compiled functions, and the machine without a compiler."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lift_predictor.core.models.sagittal.assembly import sagittal_library
from lift_predictor.core.models.sagittal.evaluation import evaluate
from lift_predictor.core.models.sagittal.parameters import LiftParameters
from lift_predictor.core.solvers.cache import find_compiler

BUILD = """
from lift_predictor.core.models.sagittal.assembly import sagittal_library
print(sagittal_library().backend)
"""


@pytest.mark.skipif(find_compiler() is None, reason='no C compiler on this machine')
def test_two_processes_build_one_library_with_the_numbers_of_the_virtual_machine(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, parameters: LiftParameters
) -> None:
    monkeypatch.setenv('LIFT_CACHE', str(tmp_path))
    monkeypatch.setenv('PYTHONPATH', os.pathsep.join(sys.path))
    jobs = [
        subprocess.Popen([sys.executable, '-c', BUILD], stdout=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    how = sorted(job.communicate(timeout=120)[0].strip() for job in jobs)
    assert how[0] == 'compiled functions from the cache'
    assert how[1].startswith('functions compiled with')
    assert len(list(tmp_path.glob('*.so'))) == 1
    assert not [path for path in tmp_path.iterdir() if path.is_dir()], 'scratch folder left behind'

    fast = sagittal_library()
    assert fast.backend == 'compiled functions from the cache'
    assert fast.compiled is not None
    monkeypatch.setenv('CC', str(tmp_path / 'no-such-compiler'))
    slow = sagittal_library()
    motion = np.random.default_rng(1).uniform(0.1, 0.6, (3, 4, 6))
    one, two = (evaluate(library, *motion, parameters) for library in (fast, slow))
    for name in ('torque', 'constraints', 'effort'):
        np.testing.assert_allclose(getattr(one, name), getattr(two, name), rtol=1e-9, atol=1e-9)


def test_machine_without_compiler_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('CC', '/no/such/compiler')
    library = sagittal_library()
    assert library.compiled is None
    assert library.backend == (
        "functions run in CasADi's virtual machine: no C compiler was found"
    )


def test_compiler_that_fails_is_quoted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    broken = tmp_path / 'broken-cc'
    broken.write_text(
        '#!/bin/sh\n[ "$1" = --version ] && exit 0\necho "disk quota exceeded" >&2\nexit 1\n'
    )
    broken.chmod(broken.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv('CC', str(broken))
    monkeypatch.setenv('LIFT_CACHE', str(tmp_path / 'cache'))
    library = sagittal_library()
    assert library.compiled is None
    assert 'compiling failed: disk quota exceeded' in library.backend
    assert not list((tmp_path / 'cache').glob('*.so'))


def test_cache_that_cannot_be_written_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / 'file').write_text('')
    monkeypatch.setenv('LIFT_CACHE', str(tmp_path / 'file' / 'below'))
    if find_compiler() is None:
        pytest.skip('no C compiler on this machine')
    library = sagittal_library()
    assert library.compiled is None
    assert str(tmp_path / 'file') in library.backend
