# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The Newton system of the interior-point method, condensed to the variables."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.constants import (
    CONVEXIFICATION,
    EQUALITY_SHIFT,
    FIRST_GROWTH,
    FIRST_SHIFT,
    LARGEST_SHIFT,
    LEAST_SHIFT,
    SHIFT_DECAY,
    SHIFT_GROWTH,
)


@dataclass
class InertiaMemory:
    """The last multiple of the identity that was needed; the next search begins near it."""

    last: float = 0.0


class NewtonSystem:
    """Factors of [K, E'; E, 0] by Cholesky of K and of the Schur complement of E.

    Parameters
    ----------
    matrix : array, shape (n, n)
        Condensed matrix with the bounds' curvature on its diagonal.
    equality : array, shape (n_equalities, n)
        Jacobian E of the equality constraints.
    memory : InertiaMemory
        Kept from iteration to iteration.
    """

    def __init__(self, matrix: Array, equality: Array, memory: InertiaMemory) -> None:
        self._equality = equality
        self._weight = 0.0
        if len(equality):
            squares = float(np.sum(equality * equality))
            if squares > 0.0:
                trace = float(np.abs(np.diagonal(matrix)).mean())
                self._weight = CONVEXIFICATION * max(trace, 1.0) * len(equality) / squares
            matrix = matrix + self._weight * (equality.T @ equality)
        self.shift, self._factor = _factorise(matrix, memory)
        if len(equality):
            self._inner = cholesky_solve(self._factor, equality.T)
            schur = equality @ self._inner
            self._schur = _regularised(schur)

    def solve(self, right: Array, residual: Array) -> tuple[Array, Array]:
        """Solve K dx + E' y = right with E dx = -residual; return dx and y."""
        if not len(self._equality):
            return cholesky_solve(self._factor, right), residual
        corrected = right - self._weight * (self._equality.T @ residual)
        free = cholesky_solve(self._factor, corrected)
        y = cholesky_solve(self._schur, self._equality @ free + residual)
        return free - self._inner @ y, y


def _regularised(schur: Array) -> Array:
    """Factor of a positive semidefinite matrix, shifted as far as it is singular."""
    factor = cholesky(schur)
    shift = EQUALITY_SHIFT * max(float(np.abs(np.diagonal(schur)).max()), 1e-300)
    while factor is None:
        if not np.isfinite(shift):
            raise np.linalg.LinAlgError('the Schur complement is not finite')
        factor = cholesky(schur + shift * np.eye(len(schur)))
        shift *= 10.0
    return factor


def _factorise(matrix: Array, memory: InertiaMemory) -> tuple[float, Array]:
    factor = cholesky(matrix)
    if factor is not None:
        return 0.0, factor
    shift = FIRST_SHIFT if memory.last == 0.0 else max(LEAST_SHIFT, memory.last / SHIFT_DECAY)
    growth = FIRST_GROWTH if memory.last == 0.0 else SHIFT_GROWTH
    unit = np.eye(len(matrix))
    while shift < LARGEST_SHIFT:
        factor = cholesky(matrix + shift * unit)
        if factor is not None:
            memory.last = shift
            return shift, factor
        shift *= growth
    raise np.linalg.LinAlgError('the condensed matrix is not finite')


def cholesky(matrix: Array) -> Array | None:
    """Lower Cholesky factor, or None if the matrix is not positive definite."""
    # Loads for long, and only this reference implementation needs it.
    from scipy.linalg.lapack import dpotrf

    factor, info = dpotrf(matrix, lower=1, clean=0)
    return factor if info == 0 and np.isfinite(factor[-1, -1]) else None


def cholesky_solve(factor: Array, right: Array) -> Array:
    """Solve with a matrix whose factor is given."""
    from scipy.linalg.lapack import dpotrs

    solution: Array = dpotrs(factor, right, lower=1)[0]
    return solution
