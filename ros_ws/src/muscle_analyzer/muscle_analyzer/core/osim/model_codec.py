# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a model as read into one text and one array, and back, bit by bit the same.

The text is JSON with the objects' structure; every array is a piece of the one array of numbers.
Nothing in it is executed when it is read.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass

import numpy as np

from human_model.typing import Array
from muscle_analyzer.core.exceptions import ModelCacheError
from muscle_analyzer.core.osim import model as osim_model
from muscle_analyzer.core.osim.functions import PiecewisePolynomial
from muscle_analyzer.core.osim.model import OsimModel

_CLASSES = {
    kind.__name__: kind
    for kind in (*vars(osim_model).values(), PiecewisePolynomial)
    if isinstance(kind, type) and is_dataclass(kind)
}
_FIELDS = {name: tuple(f.name for f in fields(kind)) for name, kind in _CLASSES.items()}
#: Keys that mark an array (offset and shape) and a mapping; no class has such a name.
_ARRAY, _MAPPING = '@', '%'


def encode(model: OsimModel) -> tuple[str, Array]:
    """Return the structure and the numbers (n,) of a model."""
    pieces: list[Array] = []
    size = 0

    def plain(value: object) -> object:
        nonlocal size
        if isinstance(value, np.ndarray):
            pieces.append(np.asarray(value, dtype=np.float64).ravel())
            size += value.size
            return {_ARRAY: [size - value.size, *value.shape]}
        if isinstance(value, tuple):
            return [plain(item) for item in value]
        if isinstance(value, Mapping):
            return {_MAPPING: {key: plain(item) for key, item in value.items()}}
        name = type(value).__name__
        if name in _FIELDS:
            return {name: [plain(getattr(value, field)) for field in _FIELDS[name]]}
        return value

    structure = json.dumps(plain(model), separators=(',', ':'))
    return structure, np.concatenate([np.zeros(0), *pieces])


def decode(structure: str, numbers: Array) -> OsimModel:
    """Return the model of a structure and its numbers (n,).

    Raises
    ------
    ModelCacheError
        If they are not what `encode` returns.
    """

    def lively(value: object) -> object:
        if isinstance(value, list):
            return tuple([lively(item) for item in value])
        if not isinstance(value, dict):
            return value
        ((key, content),) = value.items()
        if key == _ARRAY:
            offset, *shape = content
            size = 1
            for n in shape:
                size *= n
            return numbers[offset : offset + size].reshape(shape)
        if key == _MAPPING:
            return {name: lively(item) for name, item in content.items()}
        return _CLASSES[key](*[lively(item) for item in content])

    try:
        model = lively(json.loads(structure))
    except (KeyError, TypeError, ValueError) as error:
        raise ModelCacheError(f'no structure of a model: {error!r}') from error
    if not isinstance(model, OsimModel):
        raise ModelCacheError(f'structure of a {type(model).__name__}, not of a model')
    return model
