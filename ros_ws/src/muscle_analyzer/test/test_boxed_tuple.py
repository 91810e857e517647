# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Tuples boxed for compiled functions: what is in them, how long, and the cache."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core import boxed_tuple as module
from muscle_analyzer.core.boxed_tuple import Boxed, boxed


class Inner(NamedTuple):
    """A part of `Outer`."""

    value: NDArray[np.float64]


class Outer(NamedTuple):
    """What is boxed_tuple."""

    inner: Inner
    number: NDArray[np.int64]
    factor: float


@pytest.fixture(autouse=True)
def _uncached(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the tuples of this file out of the cache: no other process could read its index."""
    monkeypatch.setattr(module, '_box', njit(module._box.py_func))


@njit
def _weighted(boxed_content: Boxed[Outer]) -> float:
    content = boxed_content.content
    total = 0.0
    for i in range(content.number.size):
        total += content.inner.value[i] * content.number[i]
    return content.factor * total


def test_compiled_functions_see_the_content() -> None:
    boxed_content = boxed(Outer(Inner(np.array([0.5, 0.25])), np.array([2, 4]), 3.0))
    assert _weighted(boxed_content) == 6.0


def test_arrays_are_shared_and_kept_alive() -> None:
    value = np.array([1.0, 2.0])
    boxed_content = boxed(Outer(Inner(value), np.array([1, 1]), 1.0))
    value[0] = 5.0
    assert _weighted(boxed_content) == 7.0
    del value
    gc.collect()
    np.full(2, np.nan)
    assert _weighted(boxed_content) == 7.0


def test_arrays_are_given_free() -> None:
    value = np.array([1.0, 2.0])
    before = sys.getrefcount(value)
    boxed_content = boxed(Outer(Inner(value), np.array([1, 1]), 1.0))
    assert sys.getrefcount(value) > before
    del boxed_content
    gc.collect()
    assert sys.getrefcount(value) == before


def test_a_second_process_does_not_compile(tmp_path: Path) -> None:
    script = (
        'import numpy as np\n'
        'from muscle_analyzer.core import boxed_tuple\n'
        'boxed_tuple.boxed((np.zeros(2), 1.0))\n'
        'print(sum(boxed_tuple._box.stats.cache_misses.values()))'
    )
    misses = [
        subprocess.run(
            [sys.executable, '-c', script],
            check=True,
            capture_output=True,
            text=True,
            timeout=120.0,
            env={**os.environ, 'LIFT_CACHE': str(tmp_path)},
        ).stdout.strip()
        for _ in range(2)
    ]
    assert misses == ['1', '0']
