# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Tuples of many arrays, boxed once for compiled functions.

Numba unboxes every array argument at every call of a compiled function: 0.2 us each.  For the
hundred arrays of a model this takes longer than many computations with them.  A boxed tuple is
converted once and passed as one pointer.
"""

from __future__ import annotations

from typing import Any, Generic, TypeVar

from numba import types
from numba.experimental import structref

from human_model.compiled_cache import njit

_Tuple = TypeVar('_Tuple', bound=tuple[Any, ...])


@structref.register
class _BoxedType(types.StructRef):
    """Numba's type of a boxed tuple."""


class Boxed(structref.StructRefProxy, Generic[_Tuple]):
    """A tuple boxed once, so that compiled functions receive it as one pointer; see `boxed`.

    Attributes
    ----------
    content
        The tuple; for compiled functions only.
    """

    content: _Tuple


structref.define_proxy(Boxed, _BoxedType, ['content'])  # type: ignore[no-untyped-call]


@njit
def _box(content: _Tuple) -> Boxed[_Tuple]:
    # Not `Boxed(content)` in Python: numba would compile that anew in every process.
    return Boxed(content)  # type: ignore[no-untyped-call]


def boxed(content: _Tuple) -> Boxed[_Tuple]:
    """Box a (named) tuple of arrays, numbers and such tuples."""
    return _box(content)
