# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Small dense least squares, compiled: normal equations and Cholesky's method.

Not from a library: for some forty unknowns a library call takes as long as the computation, and a
body's point depends on few of a tree's coordinates, so that most entries are zero.
"""

from __future__ import annotations

import numpy as np

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array, IntArray


@njit(error_model='numpy')
def normal_equations(jacobian: Array, residual: Array) -> tuple[Array, Array]:
    """Return J^T J (n, n) and J^T r (n,) of a Jacobian (3 m, n) and a residual (3 m,).

    Rows come in threes that depend on the same unknowns: the axes of a point or a rotation.
    """
    n = jacobian.shape[1]
    normal, gradient = np.zeros((n, n)), np.zeros(n)
    for row in range(0, jacobian.shape[0], 3):
        rx, ry, rz = residual[row], residual[row + 1], residual[row + 2]
        for i in range(n):
            x, y, z = jacobian[row, i], jacobian[row + 1, i], jacobian[row + 2, i]
            if x != 0.0 or y != 0.0 or z != 0.0:
                gradient[i] += x * rx + y * ry + z * rz
                for j in range(i + 1):
                    normal[i, j] += (
                        x * jacobian[row, j] + y * jacobian[row + 1, j] + z * jacobian[row + 2, j]
                    )
    for i in range(n):
        for j in range(i):
            normal[j, i] = normal[i, j]
    return normal, gradient


@njit(error_model='numpy')
def transposed_times(matrix: Array, vector: Array) -> Array:
    """Return A^T v (n,) of a matrix (m, n) and a vector (m,)."""
    out = np.zeros(matrix.shape[1])
    for row in range(matrix.shape[0]):
        factor = vector[row]
        for k in range(out.size):
            out[k] += factor * matrix[row, k]
    return out


@njit(error_model='numpy')
def factorise(matrix: Array) -> bool:
    """Write U of a positive definite matrix U^T U (n, n) into its upper triangle; False if not.

    Entries below the diagonal are overwritten.
    """
    n = matrix.shape[0]
    # A copy of the row that is subtracted from those below: it lets the compiler vectorise.
    row = np.empty(n)
    for k in range(n):
        if not matrix[k, k] > 0.0:
            return False
        root = np.sqrt(matrix[k, k])
        for j in range(n):
            row[j] = matrix[k, j] / root
            matrix[k, j] = row[j]
        for i in range(k + 1, n):
            factor = row[i]
            for j in range(n):
                matrix[i, j] -= factor * row[j]
    return True


@kernel
def solve_factorised(upper: Array, right: Array) -> None:
    """Solve U^T U x = right (n,) of `factorise`; the solution takes the right side's place."""
    n = right.size
    for k in range(n):
        right[k] /= upper[k, k]
        for i in range(k + 1, n):
            right[i] -= upper[k, i] * right[k]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            right[i] -= upper[i, k] * right[k]
        right[i] /= upper[i, i]


@njit
def damped_part(normal: Array, index: IntArray, damping: float) -> Array:
    """Return the rows and columns `index` of the normal matrix, with damping."""
    n = index.size
    matrix = np.empty((n, n))
    for i in range(n):
        for j in range(n):
            matrix[i, j] = normal[index[i], index[j]]
        matrix[i, i] += damping
    return matrix


@njit
def solution(factor: Array, positive: bool, index: IntArray, right: Array) -> Array:
    """Return the solution (n_q,) for the unknowns `index`, zero elsewhere; NaN without one."""
    part = right[index]
    if positive:
        solve_factorised(factor, part)
    else:
        part[:] = np.nan
    out = np.zeros(right.size)
    out[index] = part
    return out
