# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Check of a solution between the nodes, on a dense time grid."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.sagittal.evaluation import evaluate
from lift_predictor.core.models.sagittal.grid import NODE_UPPER, LiftBounds, SagittalGrid
from lift_predictor.core.models.sagittal.kinematics import chain_positions
from lift_predictor.core.models.sagittal.parameters import JOINTS, LiftParameters
from lift_predictor.core.problem.verification import Family, Verification, dense_times, near_nodes
from lift_predictor.core.solvers.library import NodeLibrary

TOLERANCE: Final[dict[str, float]] = {
    'joint_angle [rad]': 1e-3,
    'joint_torque [N m]': 0.5,
    'balance [m]': 1e-3,
    'collision [m]': 1e-3,
    'height [m]': 1e-3,
    'hamstrings [rad]': 1e-3,
    'box_acceleration [m/s^2]': 0.05,
    'hand_position [m]': 1e-4,
    'static_ends [rad/s]': 1e-6,
    'static_ends [rad/s^2]': 1e-6,
    'posture [rad]': 1e-3,
}
"""Largest violation that passes: below what motion capture and force plates resolve (1 mm, 0.06
deg, 0.5 N m)."""


def verify(
    library: NodeLibrary,
    grid: SagittalGrid,
    control: Array,
    parameters: LiftParameters,
    bounds: LiftBounds,
) -> Verification:
    """Evaluate all constraints on the dense grid of `verification.dense_times`.

    Parameters
    ----------
    library : NodeLibrary
        `assembly.sagittal_library`.
    grid : SagittalGrid
        Of the solution.
    control : array, shape (n_free, 6)
        Free control values [rad].
    parameters, bounds
        Person and task.
    """
    s = dense_times(grid.n_nodes)
    q, dq, ddq = grid.spline.sample(control, s, parameters.duration)
    loads = evaluate(library, q, dq, ddq, parameters)
    state = chain_positions(q, parameters)
    gaps = state.gaps
    rear, front = parameters.support
    angle = np.maximum(bounds.angle_lower - q, q - bounds.angle_upper)
    torque = np.maximum(loads.lower - loads.torque, loads.torque - loads.upper)
    balance = np.maximum(rear - loads.zmp, loads.zmp - front)
    lifted_off = loads.ground_force[:, 1] <= 0.0
    balance[lifted_off] = np.inf
    height = parameters.lowest_grip - loads.centres[:, -1, 1]
    # By differences of the places, independent of the model's accelerations.
    step = parameters.duration / (len(s) - 1)
    box_acceleration = np.diff(state.joints['hand'], 2, axis=0) / step**2
    moved_box = np.linalg.norm(box_acceleration, axis=1) - parameters.box_acceleration
    middle = len(s) // 2
    posture = np.maximum(
        bounds.posture_lower - q[[0, middle, -1]], q[[0, middle, -1]] - bounds.posture_upper
    )
    # Asked for with rest in acceleration only.
    moved = np.abs(ddq[[0, -1]]) if grid.rest == 'acceleration' else np.zeros((2, len(JOINTS)))
    hands = np.linalg.norm(loads.centres[[0, -1], -1] - bounds.hand, axis=1)

    families = {
        'joint_angle [rad]': Family(angle, JOINTS, s),
        'joint_torque [N m]': Family(torque, JOINTS, s),
        'balance [m]': Family(balance[:, None], ('zero-moment point',), s),
        'collision [m]': Family(-gaps, tuple(f'circle {i + 1}' for i in range(gaps.shape[1])), s),
        'height [m]': Family(height[:, None], ('grip',), s),
        'hamstrings [rad]': Family(-state.hamstrings[:, None], ('hip',), s),
        'box_acceleration [m/s^2]': Family(moved_box[:, None], ('box',), s[1:-1]),
        'hand_position [m]': Family(hands[:, None], ('grip',), s[[0, -1]]),
        'static_ends [rad/s]': Family(np.abs(dq[[0, -1]]), JOINTS, s[[0, -1]]),
        'static_ends [rad/s^2]': Family(moved, JOINTS, s[[0, -1]]),
        'posture [rad]': Family(posture, JOINTS, s[[0, middle, -1]]),
    }
    values = np.hstack((loads.constraints, q))
    low = np.concatenate((np.zeros(loads.constraints.shape[1]), bounds.angle_lower))
    high = np.concatenate((NODE_UPPER, bounds.angle_upper))
    excess = np.stack((near_nodes(low - values), near_nodes(values - high)))
    return Verification.of(families, TOLERANCE, excess)
