# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What kernels count and what they refuse."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numba import njit
from numba.core.errors import NumbaError
from numpy.typing import NDArray

from muscle_analyzer.core.kernel import kernel


def _add(total: NDArray[np.float64], rows: NDArray[np.float64]) -> None:
    row = total
    for k in range(rows.shape[0]):
        if rows[k, 0] > 0.0:
            row = rows[k]
        for i in range(total.size):
            total[i] += row[i] / 0.0


def _counts(function: Callable[..., None]) -> int:
    """Give how often the code of a compiled function counts a reference."""
    return int(function.inspect_llvm(function.signatures[0]).count('call void @NRT_incref'))


def test_kernel_fills_what_it_is_given_without_counting_references() -> None:
    total, rows = np.zeros(2), np.array([[1.0, -1.0], [1.0, -2.0]])
    counted, uncounted = njit(error_model='numpy')(_add), kernel(_add)
    counted(total.copy(), rows)
    uncounted(total, rows)
    assert total.tolist() == [np.inf, -np.inf]
    assert _counts(uncounted) == 0 < _counts(counted)


def test_function_that_allocates_is_no_kernel() -> None:
    def double(value: NDArray[np.float64], out: NDArray[np.float64]) -> None:
        copy = np.empty(value.size)
        for i in range(value.size):
            copy[i] = 2.0 * value[i]
            out[i] = copy[i]

    with pytest.raises(NumbaError, match='empty'):
        kernel(double)(np.ones(2), np.ones(2))
