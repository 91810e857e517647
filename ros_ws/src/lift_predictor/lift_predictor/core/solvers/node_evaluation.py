# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""One node function at many instants, outside of any problem."""

from __future__ import annotations

import ctypes

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.library import NodeLibrary


def evaluate_node(library: NodeLibrary, name: str, inputs: Array, parameters: Array) -> Array:
    """Rows of a node function.

    Parameters
    ----------
    library : NodeLibrary
        Compiled or not.
    name : str
        Of the function.
    inputs : array, shape (n, n_in)
        (z, s) of each instant.
    parameters : array, shape (n_parameters,)
        Of all instants.

    Returns
    -------
    array, shape (n, n_g)
    """
    facts = library.functions[name]
    inputs = np.ascontiguousarray(inputs, dtype=float)
    parameters = np.ascontiguousarray(parameters, dtype=float)
    if inputs.ndim != 2 or inputs.shape[1] != facts.n_in:
        raise ValueError(f'{name}: inputs of shape {inputs.shape}, expected (n, {facts.n_in})')
    if parameters.shape != (facts.n_parameters,):
        raise ValueError(f'{name}: {parameters.shape} parameters, expected {facts.n_parameters}')
    if library.compiled is None:
        outputs = library.virtual[name].value.map(len(inputs))(inputs.T, parameters)
        return np.asarray(outputs).T[:, 1:]
    out = np.empty((len(inputs), 1 + facts.n_g))
    pointers = [ctypes.c_void_p(array.ctypes.data) for array in (inputs, parameters, out)]
    library.compiled.lift_evaluate(facts.index, len(inputs), *pointers)
    return out[:, 1:]
