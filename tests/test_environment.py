# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The environment is the locked one, set up once, and closed to a sourced ROS 2 installation."""

from __future__ import annotations

import importlib
import importlib.metadata
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SCRIPTS = ROOT / 'scripts'
REQUIREMENTS = ROOT / 'requirements'
CLEAN = [sys.executable, '-E', '-s', '-S', str(SCRIPTS / 'clean_environment.py')]


def pins(name: str) -> dict[str, str]:
    lines = (REQUIREMENTS / f'{name}.txt').read_text().splitlines()
    return dict(line.split('==') for line in lines if line and not line.startswith('#'))


def sourced_environment(prefix: Path) -> dict[str, str]:
    """Return an environment as /opt/ros/jazzy/setup.bash would leave it, with prefix for it."""
    site_packages = prefix / 'lib' / 'python3' / 'site-packages'
    (site_packages / 'rclpy').mkdir(parents=True)
    (site_packages / 'rclpy' / '__init__.py').write_text('FOREIGN = True\n')
    library_path = os.pathsep.join([f'{prefix}/lib', '/opt/vendor/lib'])
    foreign = {
        'AMENT_PREFIX_PATH': str(prefix),
        'CMAKE_PREFIX_PATH': str(prefix),
        'PYTHONPATH': str(site_packages),
        'LD_LIBRARY_PATH': library_path,
        'ROS_DISTRO': 'jazzy',
        'ROS_DOMAIN_ID': '7',
        'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp',
        'PATH': f'{prefix}/bin{os.pathsep}{os.environ["PATH"]}',
    }
    return {**os.environ, **foreign}


@pytest.mark.parametrize('name', ['runtime', 'build', 'dev', 'model'])
def test_installed_versions_are_the_locked_ones(name: str) -> None:
    locked = pins(name)
    assert locked
    installed = {key: importlib.metadata.version(key) for key in locked}
    assert installed == locked


@pytest.mark.parametrize('name', ['runtime', 'build', 'dev'])
def test_every_requirement_is_locked(name: str) -> None:
    locked = pins('runtime') | pins('build') | pins('dev')
    wanted = (REQUIREMENTS / f'{name}.in').read_text().splitlines()
    names = [re.split(r'[<>=\[;]', line)[0].strip() for line in wanted if line[:1] not in '#']
    assert names
    for key in names:
        assert re.sub(r'[-_.]+', '-', key).lower() in locked


def test_sourced_ros_stays_out(tmp_path: Path) -> None:
    environment = sourced_environment(tmp_path / 'jazzy')
    query = (
        'import os, rclpy; print(hasattr(rclpy, "FOREIGN"), os.environ["ROS_DOMAIN_ID"], '
        '"RMW_IMPLEMENTATION" in os.environ, os.environ["LD_LIBRARY_PATH"])'
    )
    result = subprocess.run(
        [*CLEAN, sys.executable, '-c', query],
        env=environment,
        check=True,
        text=True,
        stdout=subprocess.PIPE,
        timeout=60,
    )
    foreign, domain, middleware, library_path = result.stdout.split()
    assert (foreign, domain, middleware) == ('False', '7', 'False')
    assert '/opt/vendor/lib' in library_path.split(os.pathsep)
    assert str(tmp_path) not in library_path


def test_exit_code_passes_through() -> None:
    command = [*CLEAN, sys.executable, '-c', 'raise SystemExit(3)']
    assert subprocess.run(command, check=False, timeout=60).returncode == 3


@pytest.mark.timeout(900)  # the first one builds the interfaces if a message was just edited
def test_second_set_up_does_nothing() -> None:
    command = ['make', '--no-print-directory', 'setup-dev']
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL, timeout=850)
    second = subprocess.run(
        command, cwd=ROOT, check=True, text=True, stdout=subprocess.PIPE, timeout=30
    )
    assert second.stdout == ''


def test_unusable_python_is_named() -> None:
    result = subprocess.run(
        ['sh', str(SCRIPTS / 'find_python.sh')],
        check=False,
        text=True,
        env={**os.environ, 'PYTHON': '/nowhere/python3.12'},
        capture_output=True,
        timeout=60,
    )
    assert result.returncode == 1
    assert 'PYTHON=/nowhere/python3.12' in result.stderr


def test_missing_python_names_the_packages(tmp_path: Path) -> None:
    environment = {'PATH': str(tmp_path)}
    result = subprocess.run(
        ['/bin/sh', str(SCRIPTS / 'find_python.sh')],
        check=False,
        text=True,
        env=environment,
        capture_output=True,
        timeout=60,
    )
    assert result.returncode == 1
    assert 'python3-venv' in result.stderr


def test_missing_compilers_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.syspath_prepend(str(SCRIPTS))
    set_up = importlib.import_module('setup_environment')
    monkeypatch.setenv('PATH', str(tmp_path))
    monkeypatch.setenv('CC', 'missing-compiler')
    with pytest.raises(set_up.SetUpError, match=r'apt install gcc g\+\+'):
        set_up.check_compilers()


def test_stamp_follows_the_content(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.syspath_prepend(str(SCRIPTS))
    stamps = importlib.import_module('stamps')
    source, stamp_file = tmp_path / 'input', tmp_path / 'stamps' / 'step'
    source.write_text('one')
    first = stamps.Stamp(stamp_file, stamps.digest([source], '3.12'))
    assert not first.is_current()
    first.write()
    assert first.is_current()
    assert not stamps.Stamp(stamp_file, stamps.digest([source], '3.13')).is_current()
    source.write_text('two')
    assert not stamps.Stamp(stamp_file, stamps.digest([source], '3.12')).is_current()
