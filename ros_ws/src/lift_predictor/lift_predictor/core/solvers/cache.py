# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled functions in a cache on disk, once per machine.

The cache is `$LIFT_CACHE`, else `$XDG_CACHE_HOME/lift_monitor`, else `~/.cache/lift_monitor`. A
file's name carries a hash of everything that goes into it. Two processes that build at once wait
for each other (file lock); a library appears under its name only when it is complete.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterable
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Final

COMPILE_TIMEOUT: Final = 300.0
FROM_CACHE: Final = 'compiled functions from the cache'


def cache_directory() -> Path:
    """Directory of the compiled libraries."""
    own = os.environ.get('LIFT_CACHE')
    if own:
        return Path(own)
    base = os.environ.get('XDG_CACHE_HOME')
    return (Path(base) if base else Path.home() / '.cache') / 'lift_monitor'


def find_compiler() -> str | None:
    """Path of the C compiler (`$CC`, else cc, gcc, clang), or None."""
    own = os.environ.get('CC')
    for name in (own,) if own else ('cc', 'gcc', 'clang'):
        path = shutil.which(name)
        if path:
            return path
    return None


def content_hash(files: Iterable[Path], facts: object, compiler: str) -> str:
    """Hash of everything that decides what a compiled library holds."""
    digest = hashlib.sha256()
    for path in files:
        digest.update(path.read_bytes())
    machine = platform.machine(), compiler_version(compiler), version('casadi')
    digest.update(repr((facts, machine)).encode())
    return digest.hexdigest()[:24]


@cache
def compiler_version(compiler: str) -> str:
    """Words of the compiler about itself."""
    done = subprocess.run(
        [compiler, '--version'], capture_output=True, text=True, timeout=30, check=False
    )
    return done.stdout


@cache
def processor_features() -> str:
    """Instruction sets of the processor, for code that is compiled for this one."""
    try:
        lines = Path('/proc/cpuinfo').read_text(encoding='utf-8').splitlines()
    except OSError:
        return platform.processor()
    names = ('flags', 'Features', 'model name', 'CPU part')
    return '; '.join(sorted({line for line in lines if line.startswith(names)}))


def built_once(library: Path, build: Callable[[Path, Path], None]) -> bool:
    """Put a library into the cache; False if another process has just done so.

    Parameters
    ----------
    library : Path
        Where it belongs.
    build : callable
        Makes it: gets an empty folder to work in and the file to write.
    """
    with library.with_suffix('.lock').open('w') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if library.exists():
            return False
        with tempfile.TemporaryDirectory(dir=library.parent) as scratch:
            built = Path(scratch) / 'built.so'
            build(Path(scratch), built)
            built.replace(library)
        return True


def run_compiler(command: list[str]) -> None:
    """Run a compiler; raises `subprocess.SubprocessError` or `OSError` if it fails."""
    subprocess.run(command, capture_output=True, text=True, timeout=COMPILE_TIMEOUT, check=True)


def reason(error: Exception) -> str:
    """Why compiling failed, with the compiler's own words."""
    detail = getattr(error, 'stderr', None) or str(error)
    return f'compiling failed: {detail.strip()[:500]}'
