# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Names of columns as one text with a line for each, as messages of each frame carry them.

A list of texts is decoded and encoded one by one: 170 of the 190 microseconds of a muscle
analysis with 318 muscles.  One text takes one, and stays with its numbers in every message.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

from lifting_messages.exceptions import NameListError


def join(names: Iterable[str]) -> str:
    """Return names as one text.

    Raises
    ------
    NameListError
        If a name is empty or contains a line break.
    """
    return _join(tuple(names))


@lru_cache(maxsize=64)
def split(text: str) -> tuple[str, ...]:
    """Return the names of a text; none of an empty one."""
    return tuple(text.split('\n')) if text else ()


@lru_cache(maxsize=64)
def _join(names: tuple[str, ...]) -> str:
    for name in names:
        if not name or '\n' in name:
            raise NameListError(name)
    return '\n'.join(names)
