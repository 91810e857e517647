# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Torques, limits, ground forces and constraint values of a motion by the sagittal model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.sagittal.grid import CENTRES, REPORT_OUTPUTS
from lift_predictor.core.models.sagittal.parameters import LiftParameters
from lift_predictor.core.problem.loads import report_values
from lift_predictor.core.solvers.library import NodeLibrary


@dataclass(frozen=True)
class SagittalLoads:
    """Loads of n instants by the sagittal model.

    Attributes
    ----------
    torque, lower, upper : array, shape (n, 6)
        Generalised forces of the joints and their dynamic limits [N m], both limbs together.
    ground_force : array, shape (n, 2)
        Force of the ground, forward and up [N].
    zmp : array, shape (n,)
        Zero-moment point, forward [m].
    hand_force : array, shape (n, 2)
        Force of the box on both hands [N].
    constraints : array, shape (n, n_g)
        Scaled constraints of `grid.NODE_CONSTRAINTS`.
    effort : array, shape (n,)
        Integrand of the first term of equation 2.11.
    centres : array, shape (n, 7, 2)
        Joint centres of `grid.CENTRES` [m].
    """

    torque: Array
    lower: Array
    upper: Array
    ground_force: Array
    zmp: Array
    hand_force: Array
    constraints: Array
    effort: Array
    centres: Array


def evaluate(
    library: NodeLibrary, q: Array, dq: Array, ddq: Array, parameters: LiftParameters
) -> SagittalLoads:
    """Run the model over n instants.

    Parameters
    ----------
    library : NodeLibrary
        `assembly.sagittal_library`.
    q, dq, ddq : array, shape (n, 6)
        Joint coordinates [rad], [rad/s], [rad/s^2].
    parameters : LiftParameters
        Person, task and the mass in the hands.
    """
    n = len(q)
    inputs = np.hstack((q, dq, ddq, np.full((n, 1), parameters.box_mass)))
    values = report_values(library, REPORT_OUTPUTS, inputs, parameters.pack())
    ground_force = values['ground_force']
    return SagittalLoads(
        torque=values['torque'],
        lower=values['lower'],
        upper=values['upper'],
        ground_force=ground_force,
        zmp=values['ground_moment'][:, 0] / ground_force[:, 1],
        hand_force=values['hand_force'],
        constraints=values['constraints'],
        effort=values['effort'][:, 0],
        centres=values['centres'].reshape(n, len(CENTRES), 2),
    )
