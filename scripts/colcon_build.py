# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Build ros_ws with the colcon of PyPI against the wheels in .venv, into build/colcon."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from interfaces import build_environment

ROOT = Path(__file__).resolve().parents[1]
VENV = ROOT / '.venv'


def main() -> int:
    """Run colcon; return its exit code."""
    work = ROOT / 'build' / 'colcon'
    command = [
        str(VENV / 'bin' / 'colcon'),
        '--log-base',
        str(work / 'log'),
        'build',
        '--base-paths',
        str(ROOT / 'ros_ws'),
        '--build-base',
        str(work / 'build'),
        '--install-base',
        str(work / 'install'),
        '--cmake-args',
        '-G',
        'Ninja',
        '-DCMAKE_BUILD_TYPE=',
        '-DCMAKE_C_FLAGS=-O1',
        '-DCMAKE_CXX_FLAGS=-O1',
        f'-DPython3_EXECUTABLE={VENV / "bin" / "python"}',
        '-DBUILD_TESTING=OFF',
    ]
    return subprocess.run(command, env=build_environment(VENV), cwd=ROOT, check=False).returncode


if __name__ == '__main__':
    sys.exit(main())
