# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Check of a solution between the nodes, on a dense time grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.dense_grid import DENSITY, near_nodes
from lift_predictor.core.sagittal.evaluation import evaluate, sample
from lift_predictor.core.sagittal.grid import NODE_UPPER, Grid, LiftBounds
from lift_predictor.core.sagittal.kinematics import chain_positions
from lift_predictor.core.sagittal.parameters import JOINTS, LiftParameters
from lift_predictor.core.sagittal.report_function import ReportFunction

TOLERANCE: Final[dict[str, float]] = {
    'joint_angle [rad]': 1e-3,
    'joint_torque [N m]': 0.5,
    'balance [m]': 1e-3,
    'collision [m]': 1e-3,
    'height [m]': 1e-3,
    'hand_position [m]': 1e-4,
    'static_ends [rad/s]': 1e-6,
    'static_ends [rad/s^2]': 1e-6,
    'posture [rad]': 1e-3,
}
"""Largest violation that passes: below what motion capture and force plates resolve (1 mm, 0.06
deg, 0.5 N m)."""


@dataclass(frozen=True)
class Verification:
    """Largest violation of each constraint family on the dense grid.

    Attributes
    ----------
    n_points : int
        Points of the dense grid.
    violation : dict of float
        By the names of `TOLERANCE`, whose unit is in brackets; 0: none.
    worst : dict of str
        What is violated most in each family, and when; empty: nothing.
    excess : array, shape (2, n_nodes, n_g + 6)
        How far node rows and joint angles leave their lower and upper bounds in the intervals on
        both sides of each node; 0: nowhere.
    """

    n_points: int
    violation: dict[str, float]
    worst: dict[str, str]
    excess: Array

    @property
    def passed(self) -> bool:
        """Tell whether every family is within its tolerance."""
        return all(self.violation[name] <= limit for name, limit in TOLERANCE.items())

    def failures(self) -> str:
        """Families beyond their tolerance, in words."""
        return '; '.join(
            f'{name}: {self.violation[name]:.3g} ({self.worst[name]})'
            for name, limit in TOLERANCE.items()
            if self.violation[name] > limit
        )


def verify(
    report: ReportFunction,
    grid: Grid,
    control: Array,
    parameters: LiftParameters,
    bounds: LiftBounds,
) -> Verification:
    """Evaluate all constraints on `DENSITY` times as many points as the grid has node intervals.

    Parameters
    ----------
    report : ReportFunction
        `LiftOptimiser.report`.
    grid : Grid
        Of the solution.
    control : array, shape (n_free, 6)
        Free control values [rad].
    parameters, bounds
        Person and task.
    """
    s = np.linspace(0.0, 1.0, DENSITY * (grid.n_nodes - 1) + 1)
    q, dq, ddq = sample(grid.spline, control, s, parameters.duration)
    loads = evaluate(report, q, dq, ddq, parameters)
    gaps = chain_positions(q, parameters).gaps
    rear, front = parameters.support
    angle = np.maximum(bounds.angle_lower - q, q - bounds.angle_upper)
    torque = np.maximum(loads.lower - loads.torque, loads.torque - loads.upper)
    balance = np.maximum(rear - loads.zmp, loads.zmp - front)
    lifted_off = loads.ground_force[:, 1] <= 0.0
    balance[lifted_off] = np.inf
    height = parameters.lowest_grip - loads.centres[:, -1, 1]
    middle = len(s) // 2
    posture = np.maximum(
        bounds.posture_lower - q[[0, middle, -1]], q[[0, middle, -1]] - bounds.posture_upper
    )
    # Asked for with rest in acceleration only.
    moved = np.abs(ddq[[0, -1]]) if grid.rest == 'acceleration' else np.zeros((2, len(JOINTS)))
    hands = np.linalg.norm(loads.centres[[0, -1], -1] - bounds.hand, axis=1)

    families = {
        'joint_angle [rad]': (angle, JOINTS, s),
        'joint_torque [N m]': (torque, JOINTS, s),
        'balance [m]': (balance[:, None], ('zero-moment point',), s),
        'collision [m]': (-gaps, tuple(f'circle {i + 1}' for i in range(gaps.shape[1])), s),
        'height [m]': (height[:, None], ('grip',), s),
        'hand_position [m]': (hands[:, None], ('grip',), s[[0, -1]]),
        'static_ends [rad/s]': (np.abs(dq[[0, -1]]), JOINTS, s[[0, -1]]),
        'static_ends [rad/s^2]': (moved, JOINTS, s[[0, -1]]),
        'posture [rad]': (posture, JOINTS, s[[0, middle, -1]]),
    }
    violation, worst = {}, {}
    for name, (excess, labels, times) in families.items():
        row, column = np.unravel_index(int(np.argmax(excess)), excess.shape)
        value = max(float(excess[row, column]), 0.0)
        violation[name] = value
        worst[name] = f'{labels[column]} at {100.0 * times[row]:.0f} %' if value > 0.0 else ''
    values = np.hstack((loads.rows, q))
    low = np.concatenate((np.zeros(loads.rows.shape[1]), bounds.angle_lower))
    high = np.concatenate((NODE_UPPER, bounds.angle_upper))
    excess = np.stack((near_nodes(low - values), near_nodes(values - high)))
    return Verification(len(s), violation, worst, excess)
