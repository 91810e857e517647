# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Make the environment in .venv-opensim, with the locked wheel of OpenSim and nothing else.

It is apart from .venv because OpenSim and CasADi bring libraries of one name. Only
``lift compare-opensim`` and the tests that compare with OpenSim use it.
"""

from __future__ import annotations

import platform
import shutil
import subprocess
import sys
from pathlib import Path

from clean_environment import clean_environment
from stamps import Stamp, digest

ROOT = Path(__file__).resolve().parents[1]
VENV = ROOT / '.venv-opensim'
LOCKS = [ROOT / 'requirements' / name for name in ('opensim.txt', 'runtime.txt')]
QUERY = 'import opensim; print(opensim.GetVersion())'


def run(*command: str | Path) -> str:
    """Run a command in the clean environment; return its output."""
    words = [str(word) for word in command]
    return subprocess.run(
        words, env=clean_environment(), check=True, stdout=subprocess.PIPE, text=True
    ).stdout


def main() -> int:
    """Make the environment with the running Python unless it is there; return the exit code."""
    version = platform.python_version()
    stamp = Stamp(VENV / 'stamp', digest(LOCKS, version, str(ROOT)))
    if stamp.is_current():
        print(f'{VENV.name} is up to date')
        return 0
    wheel, versions = LOCKS
    try:
        shutil.rmtree(VENV, ignore_errors=True)
        run(sys.executable, '-m', 'venv', VENV)
        python = VENV / 'bin' / 'python'
        run(
            python,
            '-m',
            'pip',
            'install',
            '--quiet',
            '--no-input',
            '--only-binary=:all:',
            '--disable-pip-version-check',
            '--requirement',
            wheel,
            '--constraint',
            versions,
        )
        found = run(python, '-I', '-c', QUERY).split()[-1]
    except subprocess.CalledProcessError:
        shutil.rmtree(VENV, ignore_errors=True)
        print(
            f'OpenSim could not be installed for Python {version} on {platform.platform()} (see '
            'above). PyPI has wheels for Python 3.11, 3.12 and 3.13 on x86-64 Linux; or name a '
            'Python that has OpenSim 4.6 in LIFT_OPENSIM_PYTHON.',
            file=sys.stderr,
        )
        return 1
    stamp.write()
    print(f'OpenSim {found} in {VENV.name}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
