# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Node functions of the spatial model on splines in time (no CasADi needed)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from human_model.typing import Array
from lift_predictor.core.bspline import simpson_weights
from lift_predictor.core.models.spatial.grid import (
    LIMITED,
    NODE_CONSTRAINTS,
    TECHNIQUE_CONSTRAINTS,
    SpatialBounds,
    SpatialGrid,
)
from lift_predictor.core.models.spatial.parameters import N_SCALARS, N_SPLINED
from lift_predictor.core.solvers.layout import Channel, Group
from lift_predictor.core.solvers.library import NodeLibrary, load_library
from lift_predictor.core.solvers.spline_nlp import Assembler, SplineNlp, make_assembler

if TYPE_CHECKING:
    from lift_predictor.core.solvers.node_function import NodeFunction


def spatial_library() -> NodeLibrary:
    """Load the compiled functions, or compile them (half a minute)."""

    def make() -> list[NodeFunction]:
        # Imports CasADi, which is not needed when the cache has the library.
        from lift_predictor.core.models.spatial.kernels import kernel_functions

        return kernel_functions()

    return load_library('spatial', [Path(__file__).with_name('kernels.py')], make)


def spatial_groups(grid: SpatialGrid, technique: bool = False) -> list[Group]:
    """Return the node functions of a grid, with or without those of a technique."""

    def splines(times: Array, orders: int) -> tuple[Channel]:
        basis = np.stack([grid.spline.basis(times, order) for order in range(orders)])
        return (Channel(0, N_SPLINED, basis),)

    weights = simpson_weights(grid.n_nodes)
    scalars = tuple(range(grid.n_splined, grid.n_splined + N_SCALARS))
    groups = [
        Group('node', splines(grid.times, 3), scalars, len(NODE_CONSTRAINTS), weights),
        Group('angle', splines(grid.times, 1), (), len(LIMITED), np.zeros(grid.n_nodes)),
        Group('hand', splines(np.array([0.0, 1.0]), 1), (), 6, np.zeros(2)),
    ]
    if technique:
        channels = splines(np.array([0.0]), 1)
        groups.append(Group('technique', channels, (), len(TECHNIQUE_CONSTRAINTS), np.zeros(1)))
    return groups


def spatial_assembler(
    library: NodeLibrary, grid: SpatialGrid, technique: bool = False
) -> Assembler:
    """Assembler of a grid, for all persons and tasks with or without a technique."""
    return make_assembler(library, spatial_groups(grid, technique), grid.n_variables)


def posture_assembler(library: NodeLibrary) -> Assembler:
    """Assembler of one posture at rest: the same functions at one instant without motion."""
    still = np.array([1.0, 0.0, 0.0]).reshape(3, 1, 1)
    scalars = (N_SPLINED, N_SPLINED + 1)
    groups = [
        Group('node', (Channel(0, N_SPLINED, still),), scalars, len(NODE_CONSTRAINTS), np.ones(1)),
        Group('angle', (Channel(0, N_SPLINED, still[:1]),), (), len(LIMITED), np.zeros(1)),
        Group('hand', (Channel(0, N_SPLINED, still[:1]),), (), 6, np.zeros(1)),
    ]
    return make_assembler(library, groups, N_SPLINED + N_SCALARS)


def spatial_nlp(
    assembler: Assembler, grid: SpatialGrid, parameters: Array, bounds: SpatialBounds
) -> SplineNlp:
    """Return the NLP of one person and task.

    Parameters
    ----------
    assembler : Assembler
        Of the grid.
    grid : SpatialGrid
        Sizes.
    parameters : ndarray
        Person and task, as the model's parameters pack them.
    bounds : SpatialBounds
        Demands of the task.
    """
    return SplineNlp(
        assembler,
        parameters,
        bounds.variables(grid),
        bounds.constraints(),
        lambda index: grid.constraint_names[index],
        grid.variable_name,
    )
