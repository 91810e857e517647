# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Packages describe themselves truly: manifests, entry points, headers, sizes, paths."""

from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import yaml

import human_model

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / 'ros_ws' / 'src'
PROJECT = tomllib.loads((ROOT / 'pyproject.toml').read_text())['project']
PACKAGES = sorted(path.parent for path in SOURCES.glob('*/package.xml'))
PYTHON_PACKAGES = sorted(path.parent for path in SOURCES.glob('*/setup.py'))
OWN = {path.name for path in PACKAGES}
SKIPPED_FOLDERS = {'build', 'install', 'log', 'out', '__pycache__'}
CODE_SUFFIXES = {'.py', '.sh', '.cmake', '.msg', '.srv', '.action', '.toml', '.xml', '.cfg'}
TEXT_SUFFIXES = CODE_SUFFIXES | {
    '.md',
    '.yaml',
    '.yml',
    '.csv',
    '.json',
    '.txt',
    '.in',
    '.html',
    '.urdf',
    '.mot',
    '.sto',
    '.trc',
}
MAXIMUM_LINES = 400
READ_METADATA = """
import json, os, sys, setuptools
from distutils.core import run_setup
for folder in sys.argv[1:]:
    os.chdir(folder)
    found = run_setup('setup.py', stop_after='config')
    print(json.dumps({
        'name': found.get_name(), 'version': found.get_version(), 'license': found.get_license(),
        'description': found.get_description(), 'maintainer': found.get_maintainer_email(),
        'packages': found.packages, 'entry_points': found.entry_points,
        'requires': found.install_requires, 'extras': found.extras_require,
        'data_files': dict(found.data_files), 'scripts': found.get_option_dict('install'),
    }))
"""
HEADER = (
    '# SPDX-FileCopyrightText: 2026 The lift monitor authors\n'
    '# SPDX-License-Identifier: Apache-2.0\n'
)

# Imported module -> rosdep key. lz4 and backports.zstd come with rosbags.
ROSDEP_KEYS = {
    'ament_index_python': 'ament_index_python',
    'backports': 'python3-rosbags-pip',
    'jinja2': 'python3-jinja2',
    'lz4': 'python3-rosbags-pip',
    'matplotlib': 'python3-matplotlib',
    'numba': 'python3-numba',
    'numpy': 'python3-numpy',
    'rich': 'python3-rich',
    'rosbags': 'python3-rosbags-pip',
    'scipy': 'python3-scipy',
    'yaml': 'python3-yaml',
}
# Imported module -> wheel, where the names differ. lz4 and backports.zstd come with rosbags.
WHEELS = {'backports': 'rosbags', 'lz4': 'rosbags', 'yaml': 'pyyaml'}
# muscle_analyzer's script for OpenSim runs in OpenSim's own environment (make opensim);
# mocap4r2_msgs come with the workspace of a driver.
OTHER_ENVIRONMENT = {'opensim', 'mocap4r2_msgs'}
# Of the extra `ros`, or of a ROS 2 installation; beside the packages of messages.
FROM_ROS = {
    'ament_index_python',
    'builtin_interfaces',
    'launch',
    'launch_ros',
    'rcl_interfaces',
    'rclpy',
    'rosidl_parser',
    'std_srvs',
}
# Only on PyPI and without a rosdep key; the README says how to install them.
WITHOUT_ROSDEP_KEY = {'apsw', 'casadi', 'distributed', 'ezc3d', 'pyarrow'}
STANDARD_LIBRARY = sys.stdlib_module_names | {'compression'}  # compression: from Python 3.14
# Started as processes by the launch files, or read as installed data; not imported.
STARTED_BY_BRINGUP = {
    'motion_tracker',
    'lift_predictor',
    'muscle_analyzer',
    'injury_monitor',
    'lifting_visualization',
}


def project_files(suffixes: set[str]) -> Iterator[Path]:
    for folder, names, files in os.walk(ROOT):
        names[:] = [
            name for name in names if name not in SKIPPED_FOLDERS and not name.startswith('.')
        ]
        for name in files:
            if Path(name).suffix in suffixes or name in ('Makefile', 'CMakeLists.txt'):
                yield Path(folder) / name


def manifest(package: Path) -> ElementTree.Element:
    return ElementTree.parse(package / 'package.xml').getroot()


def field(root: ElementTree.Element, tag: str) -> str:
    element = root.find(tag)
    assert element is not None and element.text, f'package.xml has no {tag}'
    return element.text.strip()


def dependencies(root: ElementTree.Element, *tags: str) -> set[str]:
    return {element.text.strip() for tag in tags for element in root.iter(tag) if element.text}


@cache
def distributions() -> dict[str, dict[str, Any]]:
    """Return the metadata that setuptools reads in each Python package."""
    answer = subprocess.run(
        [sys.executable, '-c', READ_METADATA, *map(str, PYTHON_PACKAGES)],
        check=True,
        capture_output=True,
        text=True,
    )
    return {
        path.name: json.loads(line)
        for path, line in zip(PYTHON_PACKAGES, answer.stdout.splitlines(), strict=True)
    }


def wheels(modules: set[str]) -> set[str]:
    """Return the wheels from PyPI that provide the modules."""
    others = {name for name in modules if name in OWN | FROM_ROS or name.endswith('_msgs')}
    return {WHEELS.get(name, name) for name in modules - others}


def imported_modules(package: Path) -> set[str]:
    """Return the top-level modules that the package and its launch files import."""
    found = set()
    for path in [*(package / package.name).rglob('*.py'), *package.glob('launch/*.py')]:
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                found |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                found.add(node.module.split('.')[0])
            elif isinstance(node, ast.Call) and 'import_module' in ast.unparse(node.func):
                name = node.args[0]
                if isinstance(name, ast.Constant):
                    found.add(str(name.value).split('.')[0])
    return found - STANDARD_LIBRARY - OTHER_ENVIRONMENT - {package.name}


def message_packages(package: Path) -> set[str]:
    """Return the packages with the types of the declared topics."""
    if not (package / package.name / f'{package.name}_node.py').exists():
        return set()
    topics = import_module(f'{package.name}.topics')
    return {topic.type.partition('/')[0] for topic in (*topics.INPUTS, *topics.OUTPUTS)}


def test_workspace_has_the_packages_of_the_graph() -> None:
    assert {
        'lifting_interfaces',
        'human_model',
        'motion_tracker',
        'lift_predictor',
        'muscle_analyzer',
        'injury_monitor',
        'lifting_visualization',
        'lifting_recordings',
        'lifting_report',
        'lifting_cli',
        'lifting_bringup',
    } <= OWN


@pytest.mark.parametrize('package', PACKAGES, ids=lambda path: path.name)
def test_manifest_is_complete(package: Path) -> None:
    root = manifest(package)
    assert root.get('format') == '3'
    assert field(root, 'name') == package.name
    assert field(root, 'license') == 'Apache-2.0'
    assert len(field(root, 'description')) > 40
    assert (package / 'README.md').stat().st_size > 200


def test_one_version() -> None:
    """The manifests, which colcon reads, and the citation repeat the version of human_model."""
    found = {path.name: field(manifest(path), 'version') for path in PACKAGES}
    found['CITATION.cff'] = yaml.safe_load((ROOT / 'CITATION.cff').read_text())['version']
    assert found == dict.fromkeys(found, human_model.__version__)
    assert 'version' in PROJECT['dynamic']


def test_setup_files_are_the_same() -> None:
    assert len({(package / 'setup.py').read_text() for package in PYTHON_PACKAGES}) == 1


@pytest.mark.parametrize('package', PYTHON_PACKAGES, ids=lambda path: path.name)
def test_setup_reads_the_manifest(package: Path) -> None:
    root, found = manifest(package), distributions()[package.name]
    for key in ('name', 'version', 'license', 'description'):
        assert found[key] == field(root, key)
    assert found['maintainer'].endswith('.example')
    assert found['scripts']['install_scripts'][1] == f'$base/lib/{package.name}'
    (marker,) = found['data_files']['share/ament_index/resource_index/packages']
    assert marker == f'resource/{package.name}' and (package / marker).exists()
    assert found['data_files'][f'share/{package.name}'] == ['package.xml']
    assert field(root, 'export/build_type') == 'ament_python'
    if (package / package.name).exists():
        assert package.name in found['packages']
        assert not [name for name in found['packages'] if name.split('.')[0] != package.name]
        assert (package / package.name / 'py.typed').exists()


@pytest.mark.parametrize('package', PYTHON_PACKAGES, ids=lambda path: path.name)
def test_setup_requires_the_imported_wheels(package: Path) -> None:
    """`pip install` of one folder brings the Python packages that it imports."""
    found = distributions()[package.name]
    extras = {name for extra in found['extras'].values() for name in extra}
    assert {*found['requires'], *extras} == wheels(imported_modules(package))


@pytest.mark.parametrize('package', PYTHON_PACKAGES, ids=lambda path: path.name)
def test_entry_points_exist(package: Path) -> None:
    groups = distributions()[package.name]['entry_points'] or {}
    for entry in groups.get('console_scripts', []):
        module, _, function = entry.split('=')[1].strip().partition(':')
        path = (package / module.replace('.', '/')).with_suffix('.py')
        assert path.exists(), f'{entry}: there is no {path.relative_to(ROOT)}'
        names = {
            node.name
            for node in ast.parse(path.read_text()).body
            if isinstance(node, ast.FunctionDef)
        }
        assert function in names, f'{entry}: {path.name} has no {function}()'


@pytest.mark.parametrize('package', PYTHON_PACKAGES, ids=lambda path: path.name)
def test_manifest_names_the_imports_and_the_types_of_topics(package: Path) -> None:
    declared = dependencies(manifest(package), 'exec_depend', 'depend')
    modules = imported_modules(package) - WITHOUT_ROSDEP_KEY | message_packages(package)
    needed = {ROSDEP_KEYS.get(module, module) for module in modules}
    assert not needed - declared, f'package.xml lacks {sorted(needed - declared)}'
    known = set(ROSDEP_KEYS.values()) | OWN
    unused = (declared & known) - needed
    if package.name == 'lifting_bringup':
        unused -= STARTED_BY_BRINGUP
    assert not unused, f'package.xml names {sorted(unused)}, which nothing imports'


def test_wheel_requires_what_the_packages_require() -> None:
    """The dependencies of the wheel are those of its packages, and the locked ones."""
    extras = PROJECT['optional-dependencies']
    packages = distributions().values()
    assert set(PROJECT['dependencies']) == {name for one in packages for name in one['requires']}
    studies = {name for one in packages for name in one['extras'].get('study', [])}
    assert set(extras['study']) == studies
    required = {*PROJECT['dependencies'], *(name for extra in extras.values() for name in extra)}
    lines = (ROOT / 'requirements' / 'runtime.in').read_text().splitlines()
    assert required == {line for line in lines if not line.startswith('#')}


def test_interface_dependencies_are_those_used() -> None:
    package = SOURCES / 'lifting_interfaces'
    used = set()
    for folder in ('msg', 'srv', 'action'):
        for path in package.glob(f'{folder}/*'):
            used |= set(re.findall(r'^(\w+)/\w+', path.read_text(), re.MULTILINE))
    declared = dependencies(manifest(package), 'depend')
    cmake = (package / 'CMakeLists.txt').read_text()
    block = re.search(r'set\(interface_dependencies\s+([^)]*)\)', cmake)
    assert block is not None
    assert set(block[1].split()) == declared
    implied = {'action_msgs'} if any(package.glob('action/*')) else set()
    assert used - {package.name} | implied == declared


@pytest.mark.parametrize('suffix', ['.py', '.sh'])
def test_spdx_header(suffix: str) -> None:
    without = []
    for path in project_files({suffix}):
        if path.suffix == suffix:
            text = path.read_text()
            if suffix == '.sh':
                text = text.split('\n', 1)[1]
            if not text.removeprefix('#!/usr/bin/env python3\n').startswith(HEADER):
                without.append(str(path.relative_to(ROOT)))
    assert not without


def test_no_file_is_too_long() -> None:
    lengths = {
        str(path.relative_to(ROOT)): path.read_text().count('\n')
        for path in project_files(CODE_SUFFIXES)
    }
    assert {name: count for name, count in lengths.items() if count > MAXIMUM_LINES} == {}


def test_no_paths_of_one_machine() -> None:
    pattern = re.compile(r'(?<![\w.])/(?:home|root|work|Users|tmp)/\w+')
    found = []
    for path in project_files(TEXT_SUFFIXES):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if pattern.search(line):
                found.append(f'{path.relative_to(ROOT)}:{number}: {line.strip()[:80]}')
    assert not found


def test_test_files_have_different_names() -> None:
    names = [path.name for path in project_files({'.py'}) if path.name.startswith('test_')]
    assert len(names) == len(set(names))
