# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Torques, limits, ground reactions and distances of a motion by the spatial model."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass, replace

import numpy as np

from human_model.typing import Array
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.spatial.grid import HAND_SCALE, REPORT_OUTPUTS, SpatialGrid
from lift_predictor.core.spatial.parameters import SpatialParameters


@dataclass(frozen=True, eq=False)
class SpatialLoads:
    """What the spatial model says of n instants, vectors in the stance frame.

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
    gaps : array, shape (n, 12)
        Distance of the box from the collision spheres (3.10) [m]; 1 for an unused one.
    share : array, shape (n,)
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
    share: Array
    inside: Array

    @property
    def zmp(self) -> Array:
        """Zero-moment point on the ground (n, 2) [m]."""
        load = self.ground_force[:, :, 2:]
        return np.asarray((load * self.pressure[:, :, :2]).sum(axis=1) / load.sum(axis=1))


def sample(
    grid: SpatialGrid, control: Array, s: Array, duration: float
) -> tuple[Array, Array, Array]:
    """Splined coordinates at normalised times s (n,): q, dq, ddq by real time, (n, 26) each.

    `control` are the free control values, shape (n_free, 26).
    """
    q, dq, ddq = (grid.spline.basis(s, derivative) @ control for derivative in range(3))
    return q, dq / duration, ddq / duration**2


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
        `programme.spatial_library`.
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
    inputs = np.ascontiguousarray(np.hstack((q, dq, ddq, scalars)))
    rows = _run(library, 'report', inputs, parameters.pack())
    values, start = {}, 0
    for name, size in REPORT_OUTPUTS:
        values[name] = rows[:, start : start + size]
        start += size
    for name in ('ground_force', 'pressure', 'hand_force', 'hand'):
        values[name] = values[name].reshape(n, 2, 3)
    for name in ('effort', 'share'):
        values[name] = values[name][:, 0]
    return SpatialLoads(**values)


def lowering(library: NodeLibrary, q: Array, parameters: SpatialParameters) -> tuple[Array, Array]:
    """How far hips and C7 are below their height in upright standing in postures q (n, 26) [m]."""
    whole = replace(parameters, technique=np.array([0.0, 1.0])).pack()
    hips, rest = HAND_SCALE * _run(library, 'technique', np.ascontiguousarray(q), whole).T
    return hips, hips + rest


def _run(library: NodeLibrary, name: str, inputs: Array, parameters: Array) -> Array:
    """Rows (n, n_g) of a function of the library at n inputs."""
    facts = library.functions[name]
    if library.compiled is None:
        function = library.virtual[name].value
        return np.asarray(function.map(len(inputs))(inputs.T, parameters)).T[:, 1:]
    out = np.empty((len(inputs), 1 + facts.n_g))
    library.compiled.lift_evaluate(
        facts.index, len(inputs), *(ctypes.c_void_p(a.ctypes.data) for a in (
            inputs, parameters, out,
        )),
    )  # fmt: skip
    return out[:, 1:]
