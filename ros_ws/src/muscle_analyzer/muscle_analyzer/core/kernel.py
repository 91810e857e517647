# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""How the innermost functions are compiled.

Numba counts references of every array that a function takes, in functions that could set one
free.  Each count is an atomic operation, and in loops over muscles they cost more than the
arithmetic.  A kernel allocates nothing and gives no array back, so it needs no counts.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

from numba import njit

_Function = TypeVar('_Function', bound=Callable[..., object])


def kernel(function: _Function) -> _Function:
    """Compile a function that writes into the arrays it is given.

    One that allocates does not compile.  Division by zero gives infinity or NaN, as in NumPy.
    """
    compiled = njit(cache=True, error_model='numpy', _nrt=False)  # type: ignore[call-overload]
    return cast(_Function, compiled(function))
