# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Dependency order of packages and modules (docs/architecture.md)."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
from collections.abc import Container
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / 'ros_ws' / 'src'
#: Modules in a folder, apart from `__init__`.
MOST_MODULES = 25
ROS = {'rclpy', 'lifting_interfaces', 'lifting_node', 'launch', 'launch_ros'}


def package_table() -> dict[str, set[str]]:
    """Return the packages of docs/architecture.md in their order, with those they may import."""
    text = (ROOT / 'docs' / 'architecture.md').read_text(encoding='utf-8')
    rows = [line.split('|')[1:4] for line in text.splitlines() if line.startswith('| `')]
    return {
        name: set(re.findall(r'`(\w+)`', allowed))
        for names, _, allowed in rows
        for name in re.findall(r'`(\w+)`', names)
    }


MAY_IMPORT = package_table()
PYTHON_PACKAGES = [name for name in MAY_IMPORT if (SOURCES / name / name).is_dir()]


def imported(path: Path) -> set[str]:
    """Return the top-level modules a file imports."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.Import):
            found |= {alias.name.split('.')[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module.split('.')[0])
    return found


def test_table_of_packages_is_in_dependency_order() -> None:
    assert set(MAY_IMPORT) == {path.parent.name for path in SOURCES.glob('*/package.xml')}
    order = list(MAY_IMPORT)
    for name, allowed in MAY_IMPORT.items():
        assert allowed <= set(order[: order.index(name)]), f'{name} may import a higher package'


@pytest.mark.parametrize('package', PYTHON_PACKAGES)
def test_package_imports_only_what_it_may(package: str) -> None:
    files = list((SOURCES / package / package).rglob('*.py'))
    assert files
    for path in files:
        wrong = imported(path) & set(MAY_IMPORT) - MAY_IMPORT[package] - {package}
        assert not wrong, f'{path.relative_to(SOURCES)} imports {sorted(wrong)}'


@pytest.mark.parametrize(
    'folder',
    [
        'human_model/human_model',
        'lifting_messages/lifting_messages',
        'lifting_recordings/lifting_recordings',
        'lifting/lifting',
        *(f'{p}/{p}/core' for p in PYTHON_PACKAGES if (SOURCES / p / p / 'core').is_dir()),
    ],
)
def test_cores_import_no_ros(folder: str) -> None:
    assert_no_ros(list((SOURCES / folder).rglob('*.py')))


def test_stations_import_no_ros() -> None:
    assert_no_ros([*SOURCES.glob('*/*/station.py'), *SOURCES.glob('*/*/topics.py')])


def assert_no_ros(files: list[Path]) -> None:
    """Assert that there are files, and that none imports a package of ROS or of its messages."""
    assert files
    for path in files:
        wrong = {name for name in imported(path) if name in ROS or name.endswith('_msgs')}
        assert not wrong, f'{path.relative_to(SOURCES)} imports {sorted(wrong)}'


def module_name(path: Path) -> str:
    """Return the dotted name of a module of one of the packages."""
    parts = path.relative_to(SOURCES).with_suffix('').parts[1:]
    return '.'.join(parts[:-1] if parts[-1] == '__init__' else parts)


def imported_modules(path: Path, modules: Container[str]) -> set[str]:
    """Return the modules of the project that a module imports, anywhere in its file."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = {f'{node.module}.{alias.name}' for alias in node.names}
            inner = {name for name in names if name in modules}
            found |= inner if inner == names else {node.module, *inner}
    return {name for name in found if name in modules}


def project_imports() -> dict[str, set[str]]:
    """Return the imports of every module of the packages."""
    paths = {
        module_name(path): path
        for package in PYTHON_PACKAGES
        for path in (SOURCES / package / package).rglob('*.py')
    }
    return {name: imported_modules(path, paths) - {name} for name, path in paths.items()}


def test_no_import_circle() -> None:
    """Imports in functions and for type checkers count as well."""
    try:
        TopologicalSorter(project_imports()).prepare()
    except CycleError as error:
        pytest.fail(f'import circle: {" -> ".join(error.args[1])}')


def test_cores_import_nothing_above_them() -> None:
    """A module of a core imports of its own package only the core, and of others no node."""
    for name, imports in project_imports().items():
        package, *rest = name.split('.')
        if rest[:1] != ['core']:
            continue
        wrong = {
            other
            for other in imports
            if other.split('.')[0] == package and other.split('.')[1:2] not in ([], ['core'])
        }
        assert not wrong, f'{name} imports {sorted(wrong)}'


@pytest.mark.parametrize(
    'package',
    [
        'human_model',
        'motion_tracker',
        'lift_predictor',
        'muscle_analyzer',
        'injury_monitor',
        'lifting',
        'lifting_recordings',
    ],
)
def test_exported_names_exist_and_load_at_their_first_use(package: str) -> None:
    heavy = {'numpy', 'numba', 'scipy', 'casadi', 'matplotlib'}
    code = f'import sys, {package}; print(sorted({heavy} & set(sys.modules)))'
    answer = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=True
    )
    assert answer.stdout.strip() == '[]'
    module = importlib.import_module(package)
    for name in set(module.__all__) - {'__version__'}:
        assert getattr(module, name).__name__ == name
    with pytest.raises(AttributeError, match='no_such_name'):
        _ = module.no_such_name


def test_no_folder_has_too_many_modules() -> None:
    counts = {
        str(folder.relative_to(SOURCES)): len(list(folder.glob('*.py'))) - 1
        for package in SOURCES.iterdir()
        for folder in (package / package.name, *(package / package.name).rglob('*'))
        if folder.is_dir()
    }
    assert {name: count for name, count in counts.items() if count > MOST_MODULES} == {}
