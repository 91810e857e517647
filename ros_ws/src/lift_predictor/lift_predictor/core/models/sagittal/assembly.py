# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Node functions of the sagittal model on splines in time (no CasADi needed)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from human_model.typing import Array
from lift_predictor.core.bspline import simpson_weights
from lift_predictor.core.models.sagittal.grid import NODE_CONSTRAINTS, LiftBounds, SagittalGrid
from lift_predictor.core.models.sagittal.parameters import N_JOINTS, N_SCALARS
from lift_predictor.core.solvers.layout import Channel, Group
from lift_predictor.core.solvers.library import NodeLibrary, load_library
from lift_predictor.core.solvers.spline_nlp import Assembler, SplineNlp, make_assembler

if TYPE_CHECKING:
    from lift_predictor.core.solvers.node_function import NodeFunction


def sagittal_library() -> NodeLibrary:
    """Load the compiled functions, or compile them."""

    def make() -> list[NodeFunction]:
        # Imports CasADi, which is not needed when the cache has the library.
        from lift_predictor.core.models.sagittal.kernels import kernel_functions

        return kernel_functions()

    return load_library('sagittal', [Path(__file__).with_name('kernels.py')], make)


def sagittal_groups(grid: SagittalGrid) -> list[Group]:
    """Return the node functions of a grid: constraints in the order of `Grid.constraint_names`."""
    scalars = tuple(range(grid.n_splined, grid.n_splined + N_SCALARS))

    def angles(times: Array, orders: int) -> tuple[Channel]:
        basis = np.stack([grid.spline.basis(times, order) for order in range(orders)])
        return (Channel(0, N_JOINTS, basis),)

    nodes, ends, middle = grid.times, np.array([0.0, 1.0]), np.array([0.5])
    return [
        Group(
            'node', angles(nodes, 3), scalars, len(NODE_CONSTRAINTS), simpson_weights(grid.n_nodes)
        ),
        Group('angle', angles(nodes, 1), (), N_JOINTS, np.zeros(grid.n_nodes)),
        Group('hand', angles(ends, 1), (), 2, np.zeros(2)),
        Group('angle', angles(middle, 1), (), N_JOINTS, np.zeros(1)),
    ]


def sagittal_assembler(library: NodeLibrary, grid: SagittalGrid) -> Assembler:
    """Assembler of a grid, for all persons and tasks."""
    return make_assembler(library, sagittal_groups(grid), grid.n_variables)


def sagittal_nlp(
    assembler: Assembler, grid: SagittalGrid, parameters: Array, bounds: LiftBounds
) -> SplineNlp:
    """Return the NLP of one person and task.

    Parameters
    ----------
    assembler : Assembler
        Of the grid.
    grid : SagittalGrid
        Sizes.
    parameters : ndarray
        Person and task, as the model's parameters pack them.
    bounds : LiftBounds
        Demands of the task.
    """
    return SplineNlp(
        assembler,
        parameters,
        bounds.variables(grid),
        bounds.constraints(grid),
        lambda index: grid.constraint_names[index],
        grid.variable_name,
    )
