# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Build the interface package against the ROS wheels and install it into the environment."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from clean_environment import clean_environment

# The wheels' exported CMake files name the include directories of the machine that built them.
FOREIGN_PYTHON = re.compile(r'/opt/python/cp3\d+-cp3\d+/include/python3\.\d+')
FOREIGN_NUMPY = re.compile(
    r'/opt/python/cp3\d+-cp3\d+/lib/python3\.\d+/site-packages/numpy/_core/include'
)


class InterfaceBuildError(RuntimeError):
    """The interface package does not build; the message names the log file."""


def build_environment(venv: Path) -> dict[str, str]:
    """Return the process environment in which CMake and ament see only the wheels."""
    environment = clean_environment()
    environment['PATH'] = os.pathsep.join([str(venv / 'bin'), environment.get('PATH', '')])
    environment['AMENT_PREFIX_PATH'] = str(venv)
    environment['CMAKE_PREFIX_PATH'] = str(venv)
    return environment


def localise_cmake_files(venv: Path) -> int:
    """Point the wheels' CMake files to this environment's Python and NumPy headers.

    Returns
    -------
    int
        Number of files changed.
    """
    query = "import numpy, sysconfig; print(numpy.get_include(), sysconfig.get_path('include'))"
    answer = subprocess.run(
        [str(venv / 'bin' / 'python'), '-c', query],
        check=True,
        text=True,
        stdout=subprocess.PIPE,
        env=clean_environment(),
    ).stdout
    numpy_include, python_include = answer.split()
    changed = 0
    for path in (venv / 'share').glob('*/cmake/*.cmake'):
        text = path.read_text()
        local = FOREIGN_NUMPY.sub(numpy_include, text)
        local = FOREIGN_PYTHON.sub(python_include, local)
        if local != text:
            path.write_text(local)
            changed += 1
    return changed


def remove_installed(manifest: Path) -> None:
    """Remove the files a former installation put into the environment."""
    if manifest.exists():
        for line in manifest.read_text().splitlines():
            Path(line).unlink(missing_ok=True)


def build(source: Path, work: Path, venv: Path) -> None:
    """Configure, compile and install the interface package.

    Parameters
    ----------
    source : Path
        Folder of the ament_cmake package.
    work : Path
        Folder of the build; made anew.
    venv : Path
        Environment to build against and to install into.

    Raises
    ------
    InterfaceBuildError
        If a command fails; the log of all commands is ``work/build.log``.
    """
    manifest = venv / 'share' / source.name / 'install_manifest.txt'
    localise_cmake_files(venv)
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    jobs = os.environ.get('CMAKE_BUILD_PARALLEL_LEVEL', str(os.cpu_count() or 1))
    commands = [
        [
            'cmake',
            '-S',
            str(source),
            '-B',
            str(work),
            '-G',
            'Ninja',
            '-DCMAKE_BUILD_TYPE=',
            '-DCMAKE_C_FLAGS=-O1',
            '-DCMAKE_CXX_FLAGS=-O1',
            f'-DCMAKE_INSTALL_PREFIX={venv}',
            '-DCMAKE_INSTALL_LIBDIR=lib',
            f'-DPython3_EXECUTABLE={venv / "bin" / "python"}',
            '-DBUILD_TESTING=OFF',
        ],
        ['cmake', '--build', str(work), '--parallel', jobs],
        ['cmake', '--install', str(work)],
    ]
    log = work / 'build.log'
    with log.open('w') as output:
        for command in commands:
            if '--install' in command:
                remove_installed(manifest)
            output.write(f'$ {" ".join(command)}\n')
            output.flush()
            result = subprocess.run(
                command,
                stdout=output,
                stderr=subprocess.STDOUT,
                env=build_environment(venv),
                check=False,
            )
            if result.returncode:
                output.flush()
                sys.stderr.write(''.join(log.read_text().splitlines(keepends=True)[-40:]))
                message = f'{source.name} does not build ({" ".join(command[:2])}); see {log}'
                raise InterfaceBuildError(message)
    shutil.copy(work / 'install_manifest.txt', manifest)
