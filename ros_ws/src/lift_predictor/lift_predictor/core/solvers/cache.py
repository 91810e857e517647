# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled functions in a cache on disk, once per machine.

A file's name holds a hash of everything that decides its content. Two processes that build at once
wait for each other (file lock); a library appears under its name only when it is complete.
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
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Final

from human_model.cache import discard_unused, source_hash

COMPILE_TIMEOUT: Final = 300.0
FROM_CACHE: Final = 'compiled functions from the cache'


def find_compiler() -> str | None:
    """Path of the C compiler (`$CC`, else cc, gcc, clang), or None."""
    own = os.environ.get('CC')
    for name in (own,) if own else ('cc', 'gcc', 'clang'):
        path = shutil.which(name)
        if path:
            return path
    return None


def content_hash(sources: Iterable[Path], facts: object, compiler: str) -> str:
    """Return the hash of everything that decides the content of a compiled library.

    Parameters
    ----------
    sources : iterable of Path
        Modules that generate the library; the modules that they import are included.
    facts : object
        Everything else, with a `repr` that depends on the value only.
    compiler : str
        Path of the compiler.
    """
    machine = platform.machine(), compiler_version(compiler), version('casadi')
    content = repr((source_hash(*sources), facts, machine))
    return hashlib.sha256(content.encode()).hexdigest()[:24]


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
    """Put a library into the cache unless it is there; return whether this call built it.

    Parameters
    ----------
    library : Path
        Its place.
    build : callable
        Builds it, given an empty folder for its work and the file to write.

    Raises
    ------
    OSError, subprocess.SubprocessError
        If the cache cannot be written or the compiler fails.
    """
    library.parent.mkdir(parents=True, exist_ok=True)
    if library.exists():
        with suppress(OSError):  # a cache of another user
            library.touch()
        return False
    discard_unused(path for path in library.parent.iterdir() if path.is_file())
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
