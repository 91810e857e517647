# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The whole sagittal programme as CasADi functions for IPOPT, compiled once per machine.

Node functions, splines and quadrature in one library (`nlp.py`), in the cache of `cache.py`.
"""

from __future__ import annotations

import os
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import casadi as ca

from human_model.cache import cache_directory
from lift_predictor.core.models.sagittal.grid import SagittalGrid
from lift_predictor.core.models.sagittal.nlp import programme_functions
from lift_predictor.core.solvers import cache

FLAGS: Final = ('-O1', '-fPIC', '-shared')
"""With -O2 the compiler takes twice as long for functions that are no faster."""


@dataclass(frozen=True)
class Programme:
    """The functions of the programme, compiled or not.

    Attributes
    ----------
    grid : SagittalGrid
        Its sizes.
    library : Path or None
        The compiled library; None if the functions run in CasADi's virtual machine.
    functions : dict of casadi.Function
        By name, as `nlp.programme_functions`.
    build_time : float
        Wall time to load or build [s].
    backend : str
        In words: from the cache, compiled, or in the virtual machine and why.
    """

    grid: SagittalGrid
    library: Path | None
    functions: dict[str, Any]
    build_time: float
    backend: str


def build_programme(grid: SagittalGrid) -> Programme:
    """Load the compiled functions of a grid, compiling them first if the cache has none.

    Without a C compiler, or if it fails, the functions run in CasADi's virtual machine (slower,
    same numbers) and `backend` says why.
    """
    start = time.perf_counter()
    compiler = cache.find_compiler()
    if compiler is None:
        return _virtual_machine(grid, start, 'no C compiler was found')
    name = f'lift_{grid.n_control}_{grid.n_nodes}_{content_hash(grid, compiler)}'
    try:
        library = cache_directory() / f'{name}.so'
        how = cache.FROM_CACHE
        if cache.built_once(
            library, lambda scratch, built: _compile(grid, compiler, scratch, built)
        ):
            how = f'functions compiled with {compiler}'
    except (OSError, subprocess.SubprocessError) as error:
        return _virtual_machine(grid, start, cache.reason(error))
    names = ('nlp_grad_f', 'nlp_jac_g', 'report')
    functions = {name: ca.external(name, str(library)) for name in names}
    return Programme(grid, library, functions, time.perf_counter() - start, how)


def content_hash(grid: SagittalGrid, compiler: str) -> str:
    """Return the hash of everything that decides the content of a compiled library."""
    return cache.content_hash([Path(__file__)], (grid, FLAGS), compiler)


def _compile(grid: SagittalGrid, compiler: str, scratch: Path, built: Path) -> None:
    generator = ca.CodeGenerator('programme.c')
    for function in programme_functions(grid):
        generator.add(function)
    generator.generate(str(scratch) + os.sep)
    source = str(scratch / 'programme.c')
    cache.run_compiler([compiler, *FLAGS, source, '-o', str(built), '-lm'])


def _virtual_machine(grid: SagittalGrid, start: float, reason: str) -> Programme:
    functions = {function.name(): function for function in programme_functions(grid)}
    how = f"functions run in CasADi's virtual machine: {reason}"
    return Programme(grid, None, functions, time.perf_counter() - start, how)
