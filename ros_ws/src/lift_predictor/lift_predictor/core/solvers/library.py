# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Libraries of compiled node functions, loaded with ctypes: neither CasADi nor a compiler needed.

Without a C compiler, or if it fails, the same functions run in CasADi's virtual machine
(`virtual_assembler.py`): slower, same numbers, and `backend` says why.
"""

from __future__ import annotations

import ctypes
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Final

from human_model.cache import cache_directory
from lift_predictor.core.solvers import cache

if TYPE_CHECKING:
    from lift_predictor.core.solvers.node_function import Derivatives, NodeFunction

FLAGS: Final = (
    '-O3', '-march=native', '-fno-math-errno', '-fno-trapping-math', '-fPIC', '-shared',
)  # fmt: skip
VECTOR_LIBM: Final = ('-DVECTOR_LIBM', '-lmvec')
"""Sine, exponential and so on of glibc's vector library, where there is one."""
KERNEL: Final = (
    'lanes.h', 'assembly.c', 'condense.c', 'solver.c', 'measures.c', 'steps.c',
    'interior_point.c',
)  # fmt: skip


@dataclass(frozen=True)
class FunctionFacts:
    """Sizes of a node function: place in the library, inputs (z, s), parameters, constraints."""

    index: int
    n_in: int
    n_parameters: int
    n_g: int


class _CFunction(ctypes.Structure):
    """The beginning of `struct function` in lanes.h."""

    _fields_ = (
        ('name', ctypes.c_char_p),
        *((name, ctypes.c_int) for name in ('n_in', 'n_parameters', 'n_g')),
    )


@dataclass(frozen=True, eq=False)
class NodeLibrary:
    """Node functions, compiled or not.

    Attributes
    ----------
    functions : dict of FunctionFacts
        By name.
    compiled : ctypes.CDLL or None
        The library.
    virtual : dict of Derivatives
        CasADi's functions by name if there is no library; empty otherwise.
    lanes : int
        Nodes that are evaluated at once.
    build_time : float
        Wall time to load or build [s].
    backend : str
        In words: from the cache, compiled, or in the virtual machine and why.
    """

    functions: dict[str, FunctionFacts]
    compiled: ctypes.CDLL | None
    virtual: dict[str, Derivatives]
    lanes: int
    build_time: float
    backend: str


def load_library(
    name: str, sources: Sequence[Path], make: Callable[[], Sequence[NodeFunction]]
) -> NodeLibrary:
    """Load node functions from the cache, compiling them first if it has none.

    Parameters
    ----------
    name : str
        Name of the file, before its hash.
    sources : sequence of Path
        Modules that define the functions: the library is built again when one of them, or a
        module that they import, changes.
    make : callable
        Builds the functions; called only if they are not in the cache.
    """
    start = time.perf_counter()
    compiler = cache.find_compiler()
    if compiler is None:
        return _virtual(make, start, 'no C compiler was found')
    try:
        path = cache_directory() / f'{name}_{library_hash(sources, compiler)}.so'
        how = cache.FROM_CACHE
        if cache.built_once(path, lambda scratch, built: _compile(make, compiler, scratch, built)):
            how = f'functions compiled with {compiler}'
        library = ctypes.CDLL(str(path))
    except (OSError, subprocess.SubprocessError) as error:
        return _virtual(make, start, cache.reason(error))
    library.lift_function.restype = ctypes.POINTER(_CFunction)
    functions: dict[str, FunctionFacts] = {}
    while pointer := library.lift_function(len(functions)):
        facts = pointer.contents
        functions[facts.name.decode()] = FunctionFacts(
            len(functions), facts.n_in, facts.n_parameters, facts.n_g
        )
    return NodeLibrary(
        functions, library, {}, library.lift_lanes(), time.perf_counter() - start, how
    )


def library_hash(sources: Sequence[Path], compiler: str) -> str:
    """Return the hash of a library: functions, kernel, compiler and processor."""
    facts = (_kernel(), FLAGS, VECTOR_LIBM, cache.processor_features())
    return cache.content_hash([*sources, Path(__file__).with_name('emit.py')], facts, compiler)


def _kernel() -> list[str]:
    """Return the C files of the kernel."""
    folder = files('lift_predictor') / 'data' / 'kernel'
    return [(folder / name).read_text(encoding='utf-8') for name in KERNEL]


def _compile(
    make: Callable[[], Sequence[NodeFunction]], compiler: str, scratch: Path, built: Path
) -> None:
    # CasADi loads for long and is only needed here.
    from lift_predictor.core.solvers.emit import library_source

    generated = library_source([function.derived() for function in make()])
    parts = _kernel()
    source = scratch / 'library.c'
    source.write_text('\n'.join((parts[0], generated, *parts[1:])), encoding='utf-8')
    command = [compiler, *FLAGS, str(source), '-o', str(built)]
    try:
        cache.run_compiler([*command, *VECTOR_LIBM, '-lm'])
        ctypes.CDLL(str(built))
    except (OSError, subprocess.CalledProcessError):
        # No vector library on this machine: one lane after the other.
        cache.run_compiler([*command, '-lm'])


def _virtual(make: Callable[[], Sequence[NodeFunction]], start: float, why: str) -> NodeLibrary:
    derived = [function.derived() for function in make()]
    functions = {
        f.name: FunctionFacts(i, f.n_in, f.n_parameters, f.n_g) for i, f in enumerate(derived)
    }
    how = f"functions run in CasADi's virtual machine: {why}"
    virtual = {f.name: f for f in derived}
    return NodeLibrary(functions, None, virtual, 1, time.perf_counter() - start, how)
