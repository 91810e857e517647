# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Tuples of many arrays, kept in the form that compiled functions have them in.

Numba turns every array that a compiled function is called with into a structure of its own, at
every call: 0.2 us each, so that the hundred arrays of a model take longer than many a computation
with them.  A held tuple is turned once, and handed over as one pointer.
"""

from __future__ import annotations

from typing import Any, Generic, TypeVar

from numba import types
from numba.experimental import structref

from human_model.compiled_cache import njit

_Tuple = TypeVar('_Tuple', bound=tuple[Any, ...])


@structref.register
class _HeldType(types.StructRef):
    """Numba's type of a held tuple."""


class Held(structref.StructRefProxy, Generic[_Tuple]):
    """A tuple that compiled functions get at without turning it over; made by `hold`.

    Attributes
    ----------
    content
        The tuple; for compiled functions only.
    """

    content: _Tuple


structref.define_proxy(Held, _HeldType, ['content'])  # type: ignore[no-untyped-call]


@njit
def _hold(content: _Tuple) -> Held[_Tuple]:
    # Not `Held(content)` in Python: numba would compile that anew in every process.
    return Held(content)  # type: ignore[no-untyped-call]


def hold(content: _Tuple) -> Held[_Tuple]:
    """Hold a (named) tuple of arrays, numbers and such tuples."""
    return _hold(content)
