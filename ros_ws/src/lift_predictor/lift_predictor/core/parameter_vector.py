# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Named blocks of numbers as one vector of the compiled functions (matrices are row-major)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError


def pack_blocks(owner: object, shapes: Mapping[str, tuple[int, int]]) -> Array:
    """Return the fields of `owner` that `shapes` names, in that order, as one vector.

    Raises
    ------
    TaskError
        A field of the wrong shape or a value that is not finite.
    """
    parts = []
    for name, shape in shapes.items():
        value = np.asarray(getattr(owner, name), dtype=float)
        if value.size != shape[0] * shape[1]:
            raise TaskError(f'{name}: shape {value.shape}, expected {shape}')
        if not np.all(np.isfinite(value)):
            raise TaskError(f'{name}: not finite: {value.tolist()}')
        parts.append(value.ravel())
    return np.concatenate(parts)


def unpack_blocks(
    vector: Any, shapes: Mapping[str, tuple[int, int]]
) -> dict[str, list[list[Any]]]:
    """Split a symbolic vector of `pack_blocks` into named blocks."""
    blocks = {}
    start = 0
    for name, (rows, columns) in shapes.items():
        blocks[name] = [
            [vector[start + r * columns + c] for c in range(columns)] for r in range(rows)
        ]
        start += rows * columns
    return blocks
