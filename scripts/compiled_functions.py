# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The functions that are compiled once per machine: their sources and stale compilations."""

from __future__ import annotations

import re
from pathlib import Path

IMPORTS_NUMBA = re.compile(r'^(?:import|from) numba\b', re.MULTILINE)


def package_files(sources: Path) -> list[Path]:
    """Return the Python files of all packages, without their tests."""
    return sorted(path for path in sources.glob('*/*/**/*.py') if path.parts[-2] != 'test')


def numba_sources(sources: Path) -> list[Path]:
    """Return the files that hold functions compiled by numba."""
    return [path for path in package_files(sources) if IMPORTS_NUMBA.search(path.read_text())]


def programme_sources(sources: Path) -> list[Path]:
    """Return the files that hold or call the predictor's compiled programme."""
    return sorted((sources / 'lift_predictor' / 'lift_predictor' / 'core').glob('*.py'))


def remove_numba_caches(sources: Path) -> int:
    """Remove all compilations of numba; return the number of files.

    Numba compiles a function anew when its own file changed, but not when a function that it
    calls changed in another file: after an edit it would go on with the old callee.
    """
    files = [
        path
        for pattern in ('*.nbi', '*.nbc')
        for path in sources.glob(f'**/__pycache__/{pattern}')
    ]
    for path in files:
        path.unlink(missing_ok=True)
    return len(files)
