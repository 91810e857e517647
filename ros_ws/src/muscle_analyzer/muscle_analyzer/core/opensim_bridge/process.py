# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Finds a Python that has OpenSim, and runs the script in it.

OpenSim and CasADi cannot be loaded into one process: both wheels bring their own `libcasadi`. The
script is therefore always a process of its own.
"""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from human_model.typing import Array
from muscle_analyzer.core.exceptions import OpenSimError

#: Environment variable that names the Python with OpenSim.
VARIABLE = 'LIFT_OPENSIM_PYTHON'
#: The environment that `make opensim` makes, beside that of the project.
ENVIRONMENT = '.venv-opensim'
#: Oldest release whose wheel is on PyPI, and the one that was compared with.
VERSION = '4.6'
HOW = (
    f'`make opensim` installs the wheel opensim {VERSION} into {ENVIRONMENT}; or name a Python '
    f'that has it with --opensim-python or {VARIABLE}'
)
#: What this process has set for its own libraries and must not reach OpenSim's.
_OWN_VARIABLES = ('LD_LIBRARY_PATH', 'PYTHONPATH', 'PYTHONHOME')
#: Limits of time [s]: for the import; for the start and for each instant of a run (a machine
#: in use needs ten times the 4 s of an idle one).
_IMPORT_TIME, _START_TIME, _INSTANT_TIME = 120.0, 120.0, 180.0
_LOG_LINES = 24


@dataclass(frozen=True)
class OpenSimPython:
    """A Python that has OpenSim."""

    path: Path
    version: str


def find_opensim(
    given: Path | None = None, environment: Mapping[str, str] | None = None
) -> OpenSimPython:
    """Find a Python with OpenSim: the one given, else that of the variable, else `make opensim`'s.

    Parameters
    ----------
    given : Path, optional
    environment : mapping of str to str, optional
        In place of this process' environment.

    Raises
    ------
    OpenSimError
        If there is none, or the named one does not have OpenSim; the message has the command
        that installs it.
    """
    environment = os.environ if environment is None else environment
    named = given or (Path(environment[VARIABLE]) if environment.get(VARIABLE) else None)
    path = named or Path(sys.prefix).parent / ENVIRONMENT / 'bin' / 'python'
    if not path.is_file():
        raise OpenSimError(
            f'{path}: no such Python. {HOW}' if named else f'OpenSim is not installed. {HOW}'
        )
    # An environment's python is a link: the link itself, not its target, leads to the packages.
    path = path.absolute()
    query = 'import opensim; print(opensim.GetVersion())'
    try:
        answer = subprocess.run(
            [path, '-I', '-c', query],
            env=_clean(),
            capture_output=True,
            text=True,
            check=False,
            timeout=_IMPORT_TIME,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise OpenSimError(f'{path}: cannot be asked for OpenSim: {error}. {HOW}') from error
    if answer.returncode:
        last = (answer.stderr.strip().splitlines() or ['no message'])[-1]
        raise OpenSimError(f'{path}: does not have OpenSim: {last}. {HOW}')
    return OpenSimPython(path, answer.stdout.strip().splitlines()[-1])


def run_opensim(
    python: OpenSimPython,
    folder: Path,
    times: Array,
    report: Callable[[str], None],
    together: bool = False,
) -> None:
    """Run OpenSim's tools on an exported folder; everything that they print goes to a log there.

    Parameters
    ----------
    python : OpenSimPython
    folder : Path
        Of `export_motion`.
    times : (k,) array
        At which static optimisation and joint reactions are wanted, s.
    report : callable
        Takes a line when an instant is done.
    together : bool
        Whether each tool runs once from the first time to the last, which must be those of the
        samples whose numbers are multiples of the export's `samples_per_solution`; otherwise it
        runs at each time apart.

    Raises
    ------
    OpenSimError
        If a tool fails or takes too long; has the end of the log.
    """
    script = Path(__file__).with_name('script.py')
    log = folder / 'opensim.log'
    command = [str(python.path), '-I', str(script), str(folder.absolute()), '--at']
    command += [f'{time:.17g}' for time in times]
    command += ['--together'] if together else []
    limit = _START_TIME + _INSTANT_TIME * times.size
    with log.open('w', encoding='utf-8') as out:
        process = subprocess.Popen(
            command, env=_clean(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        late = threading.Event()

        def stop() -> None:
            late.set()
            process.kill()

        clock = threading.Timer(limit, stop)
        clock.start()
        try:
            assert process.stdout is not None
            for line in process.stdout:
                out.write(line)
                if line.rstrip().endswith('solved'):
                    report(line.rstrip())
            code = process.wait()
        finally:
            clock.cancel()
            process.kill()
    if late.is_set():
        raise OpenSimError(f'OpenSim took more than {limit:.0f} s; see {log}')
    if code:
        end = '\n'.join(log.read_text(encoding='utf-8').splitlines()[-_LOG_LINES:])
        raise OpenSimError(f'OpenSim ended with exit code {code}; {log} ends with\n{end}')


def _clean() -> dict[str, str]:
    return {key: value for key, value in os.environ.items() if key not in _OWN_VARIABLES}
