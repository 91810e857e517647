# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of cached results, and the sources on which a result depends."""

import os
import time
from pathlib import Path

import pytest

import human_model
from human_model import cache
from human_model.cache import cache_directory, discard_unused, source_files, source_hash

PACKAGE = Path(human_model.__file__).parent


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Return a function that writes the modules of a package, all older than this process."""
    monkeypatch.syspath_prepend(tmp_path)

    def write(**modules):
        cache._read.cache_clear()
        cache._file_of.cache_clear()
        cache._folder_of.cache_clear()
        cache._root.cache_clear()
        monkeypatch.setattr(cache, '_LOADED', time.time() + 1000.0)
        folder = tmp_path / 'rooms'
        folder.mkdir(exist_ok=True)
        for name, text in {'__init__': '', **modules}.items():
            path = folder / f'{name}.py'
            path.parent.mkdir(exist_ok=True)
            path.write_text(text)
        return folder

    return write


def test_directory_follows_the_environment(monkeypatch, tmp_path):
    monkeypatch.setenv('LIFT_CACHE', str(tmp_path / 'own'))
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path / 'xdg'))
    assert cache_directory() == tmp_path / 'own'
    assert cache_directory('models') == tmp_path / 'own' / 'models'
    monkeypatch.delenv('LIFT_CACHE')
    assert cache_directory() == tmp_path / 'xdg' / 'lift_monitor'
    monkeypatch.delenv('XDG_CACHE_HOME')
    monkeypatch.setenv('HOME', str(tmp_path))
    assert cache_directory() == tmp_path / '.cache' / 'lift_monitor'


@pytest.mark.parametrize(
    'line',
    [
        'from rooms.callee import f',
        'from rooms import callee',
        'from rooms import (\n    other,  # a comment\n    callee as c,\n)',
        'import rooms.callee',
        'import numpy as np, rooms.callee as c',
        'if True:\n    from rooms.callee import f',
        'from rooms.other import g',
    ],
)
def test_imported_modules_are_found(package, line):
    folder = package(caller=line, callee='X = 1', other='from rooms.callee import X')
    assert str(folder / 'callee.py') in source_files(folder / 'caller.py')


def test_names_of_a_package_and_foreign_modules(package):
    folder = package(caller='import os\nimport numpy as np\nfrom rooms import X, no_module\n')
    found = {Path(path).name for path in source_files(folder / 'caller.py')}
    assert found == {'caller.py', '__init__.py'}


def test_hash_follows_the_imported_content_and_neither_date_nor_place(package, tmp_path):
    def current(callee):
        return source_hash(
            package(caller='from rooms.callee import X', callee=callee) / 'caller.py'
        )

    first = current('X = 1')
    assert current('X = 2') != first
    assert current('X = 1') == first
    moved = (tmp_path / 'rooms' / 'caller.py').rename(tmp_path / 'moved.py')
    assert source_hash(moved) == first


def test_file_that_changed_since_the_start_gives_a_hash_of_this_process_only(package, monkeypatch):
    folder = package(caller='X = 1')
    first = source_hash(folder / 'caller.py')
    monkeypatch.setattr(cache, '_LOADED', 0.0)
    other = source_hash(folder / 'caller.py')
    assert other != first
    assert source_hash(folder / 'caller.py') == other
    monkeypatch.setattr(cache, '_OWN', b'another process')
    assert source_hash(folder / 'caller.py') not in (first, other)


def test_compiled_functions_of_the_packages_depend_on_the_modules_they_call():
    found = {Path(path).name for path in source_files(PACKAGE / 'compiled_blocks.py')}
    assert {'compiled.py', 'tree.py'} <= found


def test_old_entries_are_removed_except_the_last_used(tmp_path):
    now = time.time()
    for i in range(9):
        entry = tmp_path / f'library_{i}'
        entry.mkdir()
        os.utime(entry, (now - i * 20_000.0,) * 2)
    (tmp_path / 'other_0').write_text('')
    os.utime(tmp_path / 'other_0', (0.0, 0.0))
    discard_unused(tmp_path.iterdir())
    left = sorted(path.name for path in tmp_path.iterdir())
    # Five are younger than a day; the first four would be kept at any age.
    assert left == [*(f'library_{i}' for i in range(5)), 'other_0']
