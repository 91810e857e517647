# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Functions compiled by numba, once per machine for each state of the sources.

Numba's own cache compiles a function again when its file changes, but not when a function in
another file changes that is part of the compiled code.  Here the compilations of a module are
kept in a folder of their own for each content of the module and of all modules that it imports.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, Final, TypeVar, cast, overload

import numba
import numpy as np
from numba.core import caching
from numba.core.dispatcher import Dispatcher

from human_model.cache import cache_directory, discard_unused, source_hash

_Function = TypeVar('_Function', bound=Callable[..., Any])


class _Locator(caching._CacheLocator):
    """Location of the compilations of a function."""

    def __init__(self, folder: Path, line: int) -> None:
        self._folder = folder
        self._line = line

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> _Locator | None:
        """Return the locator of a function; None if its compilations cannot be kept."""
        folder = _folder(py_func.__module__, py_file)
        return None if folder is None else cls(folder, py_func.__code__.co_firstlineno)

    def get_cache_path(self) -> str:
        """Return the folder of the module at the present state of the sources."""
        return str(self._folder)

    def get_source_stamp(self) -> str:
        """Return the state of the sources, which the folder's name holds."""
        return self._folder.name

    def get_disambiguator(self) -> str:
        """Return the line that tells functions of one name apart."""
        return str(self._line)


class _CacheImpl(caching.CompileResultCacheImpl):
    _locator_classes = [_Locator]  # noqa: RUF012


class _Cache(caching.FunctionCache):
    _impl_class = _CacheImpl


@cache
def _folder(module: str, file: str) -> Path | None:
    """Make the folder of a module's compilations; None if they cannot be kept."""
    parent = cache_directory(f'numba/numba{numba.__version__}-numpy{np.__version__}')
    try:
        folder = parent / f'{module}_{source_hash(file)}'
        if folder.is_dir():
            os.utime(folder)
        else:
            folder.mkdir(parents=True, exist_ok=True)
            _discard_once(parent)
    except OSError:  # no source file, or a cache that cannot be written: compiled without one
        return None
    return folder


@cache
def _discard_once(parent: Path) -> None:
    discard_unused(parent.iterdir())


@overload
def njit(function: _Function, /) -> _Function: ...
@overload
def njit(**options: Any) -> Callable[[_Function], _Function]: ...
def njit(function: Any = None, /, **options: Any) -> Any:
    """Compile a function with numba in nopython mode, or load what was compiled before.

    Parameters
    ----------
    function : callable
        The function.
    **options
        As of `numba.njit`.
    """

    def compiled(function: _Function) -> _Function:
        dispatcher = numba.njit(**options)(function)
        if isinstance(dispatcher, Dispatcher) and _folder(
            function.__module__, function.__code__.co_filename
        ):
            dispatcher._cache = _Cache(function)  # type: ignore[attr-defined, no-untyped-call]
        return cast(_Function, dispatcher)

    return compiled if function is None else compiled(function)


kernel: Final = njit(error_model='numpy', _nrt=False)
"""Compile a function that writes into the arrays it is given.

Numba counts references of every array that a function takes, in functions that could free one.
Each count is an atomic operation, and in loops over muscles they cost more than the arithmetic.
A kernel allocates nothing and returns no array, so it needs no counts: a function that allocates
does not compile.  Division by zero gives infinity or NaN, as in NumPy.
"""
