# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Facts of the machine that a measurement depends on."""

from __future__ import annotations

import os
import platform
from importlib.metadata import version
from pathlib import Path

from lift_predictor.core.solvers import cache

PACKAGES = ('numpy', 'casadi', 'numba', 'scipy')


def machine_facts() -> dict[str, object]:
    """Processor, cores, load, compiler, versions."""
    return {
        'processor': _processor(),
        'cores': os.cpu_count(),
        'load_average': os.getloadavg()[0],
        'system': platform.platform(),
        'python': platform.python_version(),
        'compiler': _compiler(),
        **{name: version(name) for name in PACKAGES},
    }


def _processor() -> str:
    try:
        lines = Path('/proc/cpuinfo').read_text(encoding='utf-8').splitlines()
    except OSError:
        return platform.processor()
    names = [line.partition(':')[2].strip() for line in lines if line.startswith('model name')]
    return names[0] if names else platform.machine()


def _compiler() -> str:
    compiler = cache.find_compiler()
    return cache.compiler_version(compiler).splitlines()[0] if compiler else 'none'
