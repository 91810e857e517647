# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of cached results, and the hash of the sources that a result depends on.

A cached result is valid only while its sources are unchanged: the module that produces it and
every module imported from there, directly or not.  The hash covers the contents of these files,
not their dates or places: equal copies of the sources share their results.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import re
import shutil
import sys
import time
import uuid
from collections import defaultdict
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Final

_LOADED: Final = time.time()
_OWN: Final = uuid.uuid4().bytes
_CLOCK_STEP: Final = 0.01
"""A file system may date a change so much too early [s]."""

THIRD_PARTY: Final = frozenset({'casadi', 'numba', 'numpy', 'pytest', 'scipy', 'yaml'})
"""Packages whose modules are not followed; any other is, so an omission here is safe."""
_IMPORT: Final = re.compile(
    r'\n[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|.*)|import[ \t]+([\w., \t]+))'
)
_WORD: Final = re.compile(r'\w+')

_KEPT: Final = 4
_DAY: Final = 86_400.0


def cache_directory(name: str = '') -> Path:
    """Return the folder of cached results, or one of its folders.

    It is `$LIFT_CACHE`, else `$XDG_CACHE_HOME/lift_monitor`, else `~/.cache/lift_monitor`.
    """
    if own := os.environ.get('LIFT_CACHE'):
        return Path(own) / name
    base = os.environ.get('XDG_CACHE_HOME')
    return (Path(base) if base else Path.home() / '.cache') / 'lift_monitor' / name


def source_hash(*files: Path | str) -> str:
    """Return the hash of Python files and of all modules that they import.

    If one of the files changed after this process started, the process may hold its old content.
    The hash is then different in each process, so that no other process finds the result.
    """
    found = [_read(path)[1:] for path in source_files(*files)]
    parts = sorted(content for content, _ in found)
    if any(changed > _LOADED - _CLOCK_STEP for _, changed in found):
        parts.append(_OWN)
    return hashlib.sha256(b''.join(parts)).hexdigest()[:32]


def source_files(*files: Path | str) -> set[str]:
    """Return Python files and the files of all modules that they import, directly or not."""
    found: set[str] = set()
    pending = [os.fspath(file) for file in files]
    while pending:
        path = pending.pop()
        if path not in found:
            found.add(path)
            pending += _read(path)[0]
    return found


def discard_unused(entries: Iterable[Path]) -> None:
    """Remove old entries `<name>_<hash>` of a cache, except the last used of each name.

    An entry is used when its time of modification is set.  None that was used within a day is
    removed: a running process may still need it.
    """
    groups: dict[str, list[tuple[float, Path]]] = defaultdict(list)
    for entry in entries:
        try:
            groups[entry.name.rpartition('_')[0]].append((entry.stat().st_mtime, entry))
        except OSError:
            continue
    for group in groups.values():
        for used, entry in sorted(group, reverse=True)[_KEPT:]:
            if used < time.time() - _DAY:
                _remove(entry)


def _remove(entry: Path) -> None:
    if entry.is_dir():
        shutil.rmtree(entry, ignore_errors=True)
    else:
        entry.unlink(missing_ok=True)


@cache
def _read(path: str) -> tuple[frozenset[str], bytes, float]:
    """Return the imported files, the hash and the time of the last change of a file."""
    with open(path, 'rb') as file:  # noqa: PTH123 - pathlib takes twice as long
        content = file.read()
        changed = os.fstat(file.fileno()).st_ctime
    imported: set[str | None] = set()
    for module, names, modules in _IMPORT.findall('\n' + content.decode(errors='replace')):
        if module:
            imported |= _imported_from(module, names)
        else:
            imported |= {_file_of(part.split()[0]) for part in modules.split(',') if part.strip()}
    followed = frozenset(file for file in imported if file is not None)
    return followed, hashlib.sha256(content).digest(), changed


def _imported_from(module: str, names: str) -> set[str | None]:
    """Return the files of `from module import names`: the module, or modules of a package."""
    path = _file_of(module)
    if path is None and _folder_of(module) is None:
        return set()
    if path is not None and not path.endswith('__init__.py'):
        return {path}
    return {_file_of(f'{module}.{name}') or path for name in _WORD.findall(names)} | {path}


@cache
def _file_of(module: str) -> str | None:
    """Return the source file of a module; None for one that is not followed."""
    parent, _, name = module.rpartition('.')
    if not parent:
        return _root(module)[0]
    folder = _folder_of(parent)
    if folder is None:
        return None
    for path in (f'{folder}/{name}.py', f'{folder}/{name}/__init__.py'):
        if os.path.isfile(path):  # noqa: PTH113
            return path
    return None


@cache
def _folder_of(package: str) -> str | None:
    root, _, rest = package.partition('.')
    folder = _root(root)[1]
    return folder and f'{folder}/{rest.replace(".", "/")}'.rstrip('/')


@cache
def _root(name: str) -> tuple[str | None, str | None]:
    """Return file and folder of a top-level package; None for one that is not followed."""
    if name in THIRD_PARTY or name in sys.stdlib_module_names or not name:
        return None, None
    try:
        spec = importlib.util.find_spec(name)
    except ValueError:  # such as __main__
        return None, None
    if spec is None or not spec.origin or not spec.origin.endswith('.py'):
        return None, None
    folder = spec.submodule_search_locations
    return spec.origin, folder[0] if folder else None
