# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The whole workspace builds with colcon, and what it installs is complete."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / 'ros_ws' / 'src'
INSTALL = ROOT / 'build' / 'colcon' / 'install'

pytestmark = [pytest.mark.long, pytest.mark.timeout(1200)]


@pytest.fixture(scope='module')
def packages() -> list[Path]:
    """Build the workspace; return the source folders of its packages."""
    result = subprocess.run(
        ['make', '--no-print-directory', 'colcon'],
        cwd=ROOT,
        check=False,
        text=True,
        timeout=1100,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    found = sorted(path.parent for path in SOURCES.glob('*/package.xml'))
    assert result.returncode == 0, result.stdout[-4000:]
    assert f'{len(found)} packages finished' in result.stdout
    return found


def test_every_package_is_in_the_index(packages: list[Path]) -> None:
    for package in packages:
        share = INSTALL / package.name / 'share'
        assert (share / 'ament_index/resource_index/packages' / package.name).exists()
        assert (share / package.name / 'package.xml').exists()


def test_every_source_data_and_launch_file_is_installed(packages: list[Path]) -> None:
    for package in packages:
        module = package / package.name
        sources = [
            path
            for path in module.rglob('*')
            if path.is_file()
            and (path.suffix in ('.py', '.typed') or 'data' in path.relative_to(module).parts[:-1])
            and '__pycache__' not in path.parts
        ]
        installed = [
            path
            for path in (INSTALL / package.name).glob('lib/python3*/*-packages/*')
            if path.name == package.name
        ]
        if sources:
            missing = [
                str(path)
                for path in sources
                if not (installed[0] / path.relative_to(module)).exists()
            ]
            assert not missing
        for folder in ('config', 'launch'):
            share = INSTALL / package.name / 'share' / package.name / folder
            assert {path.name for path in package.glob(f'{folder}/*.*')} == {
                path.name for path in share.glob('*.*')
            }


@pytest.mark.usefixtures('packages')
def test_installed_interfaces_import() -> None:
    query = (
        'import lifting_interfaces.msg as m; from rclpy.serialization import '
        'serialize_message as s; s(m.BodyMotion()); print(m.__file__)'
    )
    shell = f'. {INSTALL}/local_setup.sh && exec {ROOT}/.venv/bin/python -c "$QUERY"'
    environment = {**os.environ, 'QUERY': query, 'COLCON_CURRENT_PREFIX': str(INSTALL)}
    result = subprocess.run(
        ['sh', '-c', shell],
        check=True,
        text=True,
        timeout=60,
        stdout=subprocess.PIPE,
        env=environment,
    )
    assert result.stdout.strip().startswith(str(INSTALL))
