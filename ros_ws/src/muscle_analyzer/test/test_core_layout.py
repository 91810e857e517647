# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Layout of the core: small folders, and imports only from a sub-package to those below it."""

from __future__ import annotations

import ast
from pathlib import Path

import muscle_analyzer

CORE = Path(muscle_analyzer.__file__).parent / 'core'
PREFIX = 'muscle_analyzer.core.'
MAXIMUM_MODULES = 25
#: Sub-packages from below; one imports only from those before it.
FLOORS = (
    'osim',
    'multibody',
    'muscles',
    'recruitment',
    'subject',
    'transfer',
    'loads',
    'emg',
    'opensim_bridge',
)


def imports(path: Path) -> set[str]:
    """Return the modules of the core that a file imports, without the prefix."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.ImportFrom) and f'{node.module}.'.startswith(PREFIX):
            module = f'{node.module}.'[len(PREFIX) : -1]
            found.add(module)
            found |= {f'{module}.{alias.name}'.strip('.') for alias in node.names}
    return {name for name in found if (CORE / f'{name.replace(".", "/")}.py').exists()}


def test_no_folder_has_too_many_modules() -> None:
    for folder in (CORE, *(CORE / floor for floor in FLOORS)):
        assert 0 < len(list(folder.glob('*.py'))) <= MAXIMUM_MODULES
    assert {path.parent.name for path in CORE.glob('*/*.py')} == set(FLOORS)


def test_sub_packages_import_only_downwards() -> None:
    for floor, name in enumerate(FLOORS):
        for path in (CORE / name).glob('*.py'):
            above = {m for m in imports(path) if m.partition('.')[0] in FLOORS[floor + 1 :]}
            assert not above, f'{name}/{path.name} imports {sorted(above)}'
    for path in CORE.glob('*.py'):
        below = {m for m in imports(path) if '.' in m}
        assert path.name == '__init__.py' or not below, f'{path.name} imports {sorted(below)}'


def test_no_modules_import_each_other_in_a_circle() -> None:
    waiting = {
        '.'.join(path.relative_to(CORE).with_suffix('').parts): imports(path)
        for path in CORE.rglob('*.py')
    }
    while free := {name for name, needed in waiting.items() if not needed & waiting.keys()}:
        for name in free:
            del waiting[name]
    assert not waiting
