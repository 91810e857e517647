# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Torques, limits, ground reactions and distances of a motion by the spatial model."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.contact import gaps
from lift_predictor.core.models.spatial.grid import HAND_SCALE, REPORT_OUTPUTS
from lift_predictor.core.models.spatial.parameters import SpatialParameters
from lift_predictor.core.problem.loads import report_values
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.solvers.node_evaluation import evaluate_node


@dataclass(frozen=True, eq=False)
class SpatialLoads:
    """Loads of n instants by the spatial model, vectors in the stance frame.

    Attributes
    ----------
    torque, lower, upper : array, shape (n, 26)
        Joint torques of `parameters.STRONG` and their dynamic limits [N m].
    ground_force, pressure : array, shape (n, 2, 3)
        Of right and left foot: force [N], centre of pressure [m].
    free_moment : array, shape (n, 2)
        About the vertical [N m].
    hand_force, hand : array, shape (n, 2, 3)
        Force of the box on right and left hand [N], grip [m].
    effort : array, shape (n,)
        Integrand of the first term of equation 3.9.
    angles : array, shape (n, 10)
        Leg coordinates `parameters.DEPENDENT` [rad].
    gaps : array, shape (n, 32)
        Distance of the box from the collision spheres (3.10) [m]; infinite for an unused one.
    clear, arms, hamstrings, pull : array, shape (n, 32), (n, 8), (n, 2), (n, 1)
        Constraints of collision, arms, hip flexion [rad] and acceleration, as at the nodes.
    fraction : array, shape (n,)
        Place of the centres of pressure, 0 at the heels, 1 at the tips of the toes.
    inside : array, shape (n, 3)
        Distance of the box's centre from right and left edge of its sector, and from the lower of
        its places [m].
    """

    torque: Array
    lower: Array
    upper: Array
    ground_force: Array
    pressure: Array
    free_moment: Array
    hand_force: Array
    hand: Array
    effort: Array
    angles: Array
    gaps: Array
    clear: Array
    arms: Array
    hamstrings: Array
    pull: Array
    fraction: Array
    inside: Array

    @property
    def zmp(self) -> Array:
        """Zero-moment point on the ground (n, 2) [m]."""
        load = self.ground_force[:, :, 2:]
        return np.asarray((load * self.pressure[:, :, :2]).sum(axis=1) / load.sum(axis=1))


def evaluate(
    library: NodeLibrary,
    q: Array,
    dq: Array,
    ddq: Array,
    box_mass: float,
    parameters: SpatialParameters,
) -> SpatialLoads:
    """Run the model over n instants.

    Parameters
    ----------
    library : NodeLibrary
        `assembly.spatial_library`.
    q, dq, ddq : array, shape (n, 26)
        Splined coordinates and derivatives by time.
    box_mass : float
        [kg].
    parameters : SpatialParameters
        Person and task.
    """
    n = len(q)
    # The report takes derivatives by normalised time: of a lift that lasts one second.
    scalars = np.tile((box_mass, 1.0), (n, 1))
    inputs = np.hstack((q, dq, ddq, scalars))
    values = report_values(library, REPORT_OUTPUTS, inputs, parameters.pack())
    for name in ('ground_force', 'pressure', 'hand_force', 'hand'):
        values[name] = values[name].reshape(n, 2, 3)
    for name in ('effort', 'fraction'):
        values[name] = values[name][:, 0]
    offset = values.pop('offset').reshape(n, -1, 3)
    free = gaps(offset, parameters.box_half, parameters.sphere[:, 3])
    return SpatialLoads(gaps=free, **values)


def lowering(library: NodeLibrary, q: Array, parameters: SpatialParameters) -> tuple[Array, Array]:
    """How far hips and C7 are below their height in upright standing in postures q (n, 26) [m]."""
    whole = replace(parameters, technique=np.array([0.0, 1.0])).pack()
    hips, rest = HAND_SCALE * evaluate_node(library, 'technique', q, whole).T
    return hips, hips + rest
