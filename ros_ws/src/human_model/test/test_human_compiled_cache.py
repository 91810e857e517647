# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Kernels: the references they count, and the functions that are none."""

import numba
import numpy as np
import pytest
from numba.core.errors import NumbaError

from human_model import compiled_cache
from human_model.compiled_cache import kernel, njit


def _add(total, rows):
    row = total
    for k in range(rows.shape[0]):
        if rows[k, 0] > 0.0:
            row = rows[k]
        for i in range(total.size):
            total[i] += row[i] / 0.0


def _counts(function):
    """Return how often the code of a compiled function counts a reference."""
    return int(function.inspect_llvm(function.signatures[0]).count('call void @NRT_incref'))


def test_kernel_fills_its_arguments_without_counting_references(monkeypatch):
    monkeypatch.setattr(compiled_cache, '_folder', lambda *_: None)  # numba shows new code only
    total, rows = np.zeros(2), np.array([[1.0, -1.0], [1.0, -2.0]])
    counted, uncounted = numba.njit(error_model='numpy')(_add), kernel(_add)
    counted(total.copy(), rows)
    uncounted(total, rows)
    assert total.tolist() == [np.inf, -np.inf]
    assert _counts(uncounted) == 0 < _counts(counted)


def test_function_that_allocates_is_no_kernel():
    def double(value, out):
        copy = np.empty(value.size)
        for i in range(value.size):
            copy[i] = 2.0 * value[i]
            out[i] = copy[i]

    with pytest.raises(NumbaError, match='empty'):
        kernel(double)(np.ones(2), np.ones(2))


def test_function_without_source_file_is_compiled():
    scope = {'__name__': 'typed_in'}
    exec('def double(x):\n    return 2.0 * x\n', scope)
    assert njit(scope['double'])(2.0) == 4.0
