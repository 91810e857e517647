# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compile the functions of the programme to machine code, once per machine, in a cache on disk.

The cache is `$LIFT_CACHE`, else `$XDG_CACHE_HOME/lift_monitor`, else `~/.cache/lift_monitor`. A
file's name carries a hash of everything that goes into it: the modules that define the functions,
the grid, CasADi's version, compiler and flags. Two processes that build at once wait for each
other (file lock); a library appears under its name only when it is complete.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

import casadi as ca

from lift_predictor.core.sagittal.grid import Grid
from lift_predictor.core.sagittal.nlp import programme_functions

SOURCES: Final = (
    'bspline.py',
    'sagittal/grid.py',
    'sagittal/model.py',
    'sagittal/nlp.py',
    'sagittal/node_functions.py',
    'sagittal/parameters.py',
)
FLAGS: Final = ('-O1', '-fPIC', '-shared')
"""With -O2 the compiler takes twice as long for functions that are no faster."""
COMPILE_TIMEOUT: Final = 300.0


@dataclass(frozen=True)
class Programme:
    """The functions of the programme, compiled or not.

    Attributes
    ----------
    grid : Grid
        Its sizes.
    library : Path or None
        The compiled library; None if the functions run in CasADi's virtual machine.
    functions : dict of casadi.Function
        By name, as `nlp.programme_functions`.
    build_time : float
        Wall time to load or build [s].
    how : str
        In words: from the cache, compiled, or in the virtual machine and why.
    """

    grid: Grid
    library: Path | None
    functions: dict[str, Any]
    build_time: float
    how: str


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


def build_programme(grid: Grid) -> Programme:
    """Load the compiled functions of a grid, compiling them first if the cache has none.

    Without a C compiler, or if it fails, the functions run in CasADi's virtual machine (slower,
    same numbers) and `how` says why.
    """
    start = time.perf_counter()
    compiler = find_compiler()
    if compiler is None:
        return _virtual_machine(grid, start, 'no C compiler was found')
    name = f'lift_{grid.n_control}_{grid.n_nodes}_{content_hash(grid, compiler)}'
    try:
        directory = cache_directory()
        directory.mkdir(parents=True, exist_ok=True)
        library = directory / f'{name}.so'
        how = 'compiled functions from the cache'
        if not library.exists() and _compile_locked(grid, compiler, library):
            how = f'functions compiled with {compiler}'
    except (OSError, subprocess.SubprocessError) as error:
        return _virtual_machine(grid, start, _reason(error))
    names = ('nlp_grad_f', 'nlp_jac_g', 'report')
    functions = {name: ca.external(name, str(library)) for name in names}
    return Programme(grid, library, functions, time.perf_counter() - start, how)


def content_hash(grid: Grid, compiler: str) -> str:
    """Hash of everything that decides what a compiled library holds."""
    digest = hashlib.sha256()
    for name in SOURCES:
        digest.update((Path(__file__).parents[1] / name).read_bytes())
    facts = (grid, ca.CasadiMeta.version(), platform.machine(), _version(compiler), FLAGS)
    digest.update(repr(facts).encode())
    return digest.hexdigest()[:24]


@cache
def _version(compiler: str) -> str:
    done = subprocess.run(
        [compiler, '--version'], capture_output=True, text=True, timeout=30, check=False
    )
    return done.stdout


def _compile_locked(grid: Grid, compiler: str, library: Path) -> bool:
    """Compile into the cache; False if another process has just done so."""
    with library.with_suffix('.lock').open('w') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if library.exists():
            return False
        with tempfile.TemporaryDirectory(dir=library.parent) as scratch:
            generator = ca.CodeGenerator('programme.c')
            for function in programme_functions(grid):
                generator.add(function)
            generator.generate(scratch + os.sep)
            built = Path(scratch) / 'programme.so'
            subprocess.run(
                [compiler, *FLAGS, str(Path(scratch) / 'programme.c'), '-o', str(built), '-lm'],
                capture_output=True,
                text=True,
                timeout=COMPILE_TIMEOUT,
                check=True,
            )
            built.replace(library)
        return True


def _virtual_machine(grid: Grid, start: float, reason: str) -> Programme:
    functions = {function.name(): function for function in programme_functions(grid)}
    how = f"functions run in CasADi's virtual machine: {reason}"
    return Programme(grid, None, functions, time.perf_counter() - start, how)


def _reason(error: Exception) -> str:
    detail = getattr(error, 'stderr', None) or str(error)
    return f'compiling failed: {detail.strip()[:500]}'
