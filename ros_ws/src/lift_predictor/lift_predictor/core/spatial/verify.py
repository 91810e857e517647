# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Check of a spatial solution between the nodes, on a dense time grid."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.dense_grid import DENSITY, near_nodes
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.spatial.evaluation import SpatialLoads, evaluate, sample
from lift_predictor.core.spatial.grid import (
    ANGLE_ROWS,
    COLLISION_ROWS,
    GROUND_ROWS,
    HAND_SCALE,
    LIMITED,
    NODE_ROWS,
    TORQUE_ROWS,
    WAY_ROWS,
    SpatialBounds,
    SpatialGrid,
    row_slice,
)
from lift_predictor.core.spatial.parameters import DEPENDENT, N_SPLINED, SPHERE_NAMES, STRONG
from lift_predictor.core.spatial.task import SpatialTask

TOLERANCE: Final[dict[str, float]] = {
    'joint_angle [rad]': 1e-3,
    'joint_torque [N m]': 0.5,
    'balance [m]': 1e-3,
    'foot_pulled [N]': 1.0,
    'collision [m]': 1e-3,
    'way [m]': 1e-3,
    'hand_distance [m]': 2e-3,
    'box_level [m]': 2e-3,
    'hand_position [m]': 1e-4,
    'static_ends [rad/s]': 1e-6,
    'posture [rad]': 1e-3,
    'ground_window [N]': 1.0,
}
"""Largest violation that passes: what motion capture and force plates resolve (1 mm, 0.06 deg, 0.5
N m, 1 N); 2 mm for the grip, which gives by more than that."""
ELSEWHERE: Final = 0.5
"""Part of the largest excess of a row that becomes a margin at its other nodes."""
FEET: Final = ('right foot', 'left foot')


@dataclass(frozen=True, eq=False)
class SpatialVerification:
    """Largest violation of each constraint family on the dense grid.

    Attributes
    ----------
    n_points : int
        Points of the dense grid.
    violation : dict of float
        By the names of `TOLERANCE`, whose unit is in brackets; 0: none.
    worst : dict of str
        What is violated most in each family, and when; empty: nothing.
    node_excess, angle_excess : array, shape (2, n_nodes, 58), (2, n_nodes, 22)
        How far node rows and joint angles leave their lower and upper limits in the intervals on
        both sides of each node; 0: nowhere.
    """

    n_points: int
    violation: dict[str, float]
    worst: dict[str, str]
    node_excess: Array
    angle_excess: Array

    @property
    def passed(self) -> bool:
        """Tell whether every family is within its tolerance."""
        return all(self.violation[name] <= limit for name, limit in TOLERANCE.items())

    def failures(self) -> str:
        """Families beyond their tolerance, in words."""
        return '; '.join(
            f'{name}: {self.violation[name]:.3g} ({self.worst[name]})'
            for name, limit in TOLERANCE.items()
            if not self.violation[name] <= limit
        )

    def tightened(self, bounds: SpatialBounds, factor: float) -> SpatialBounds:
        """Bounds with a margin of a factor times the excess at each node.

        A part of the largest excess of a row goes to all other nodes, as the next solution may
        leave its bounds elsewhere. A margin is at most a quarter of what is left between two
        bounds, so that there is always an inside.
        """

        def narrow(low: Array, high: Array, excess: Array) -> tuple[Array, Array]:
            with np.errstate(invalid='ignore'):
                room = 0.25 * (high - low)
            spread = np.maximum(excess, ELSEWHERE * excess.max(axis=1, keepdims=True))
            least, most = (np.minimum(factor * part, room) for part in spread)
            return low + least, high - most

        node = narrow(bounds.node_lower, bounds.node_upper, self.node_excess)
        angle = narrow(bounds.angle_lower, bounds.angle_upper, self.angle_excess)
        return replace(
            bounds, node_lower=node[0], node_upper=node[1], angle_lower=angle[0],
            angle_upper=angle[1],
        )  # fmt: skip


def verify(
    library: NodeLibrary,
    grid: SpatialGrid,
    task: SpatialTask,
    control: Array,
    box_mass: float,
    duration: float,
) -> SpatialVerification:
    """Evaluate all constraints on `DENSITY` times as many points as the grid has node intervals.

    Parameters
    ----------
    library : NodeLibrary
        Functions.
    grid : SpatialGrid
        Of the solution.
    task : SpatialTask
        Person and task.
    control : array, shape (n_free, 26)
        Free control values.
    box_mass, duration : float
        [kg], [s].
    """
    s = np.linspace(0.0, 1.0, DENSITY * (grid.n_nodes - 1) + 1)
    q, dq, ddq = sample(grid, control, s, duration)
    loads = evaluate(library, q, dq, ddq, box_mass, task.parameters)
    p, person = task.parameters, task.person
    leg, own = person.limits(DEPENDENT), person.limits(LIMITED)
    limited = q[:, N_SPLINED - len(LIMITED) :]
    apart = loads.hand[:, 1] - loads.hand[:, 0]
    width = np.linalg.norm(apart, axis=1)
    length = float(p.sole[1] - p.sole[0])
    wanted = task.bounds.hand.reshape(2, 2, 3)
    at_ends = np.linalg.norm(loads.hand[[0, -1]] - wanted, axis=2)
    weight = p.body_mass * p.gravity
    posture, ground = _windows(task.bounds, limited, loads, weight)
    angles = np.hstack((limited, loads.angles))
    low, high = (np.concatenate(pair) for pair in zip(own, leg, strict=True))
    pulled = -loads.ground_force[:, :, 2]
    families = {
        'joint_angle [rad]': (np.maximum(low - angles, angles - high), LIMITED + DEPENDENT, s),
        'joint_torque [N m]': (
            np.maximum(loads.lower - loads.torque, loads.torque - loads.upper), STRONG, s,
        ),
        'balance [m]': (
            length * np.maximum(-loads.share, loads.share - 1.0)[:, None], ('both feet',), s,
        ),
        'foot_pulled [N]': (pulled, FEET, s),
        'collision [m]': (-loads.gaps, SPHERE_NAMES, s),
        'way [m]': (-loads.inside, ('right edge', 'left edge', 'lower place'), s),
        'hand_distance [m]': (np.abs(width - p.box_width)[:, None], ('hands',), s),
        'box_level [m]': (np.abs(apart[:, 2:]), ('hands',), s),
        'hand_position [m]': (at_ends, ('right hand', 'left hand'), s[[0, -1]]),
        'static_ends [rad/s]': (np.abs(dq[[0, -1]]).max(axis=1)[:, None], ('body',), s[[0, -1]]),
        'posture [rad]': (posture, LIMITED + DEPENDENT, grid.times),
        'ground_window [N]': (ground, FEET, grid.times),
    }  # fmt: skip
    violation, worst = {}, {}
    for name, (excess, labels, times) in families.items():
        # What is not a number is no solution.
        known = np.where(np.isnan(excess), np.inf, excess)
        row, column = np.unravel_index(int(np.argmax(known)), known.shape)
        value = max(float(known[row, column]), 0.0)
        violation[name] = value
        worst[name] = f'{labels[column]} at {100.0 * times[row]:.0f} %' if value > 0.0 else ''
    node_excess = _row_excess(loads, leg, p.sphere[:, 3] + p.box_radius, weight)
    angle_excess = np.stack((near_nodes(own[0] - limited), near_nodes(limited - own[1])))
    return SpatialVerification(len(s), violation, worst, node_excess, angle_excess)


def _row_excess(
    loads: SpatialLoads, leg: tuple[Array, Array], reach: Array, weight: float
) -> Array:
    """Excess of the node rows over their limits (windows and bands aside), (2, n_nodes, 58)."""
    n = len(loads.share)
    low, high = np.full((2, n, len(NODE_ROWS)), -np.inf)
    span = loads.upper - loads.lower
    part = row_slice(TORQUE_ROWS)
    low[:, part] = (loads.lower - loads.torque) / span
    high[:, part] = (loads.torque - loads.upper) / span
    part = row_slice(ANGLE_ROWS)
    low[:, part], high[:, part] = leg[0] - loads.angles, loads.angles - leg[1]
    start = row_slice(GROUND_ROWS).start
    low[:, start], high[:, start] = -loads.share, loads.share - 1.0
    low[:, start + 1 : start + 3] = -loads.ground_force[:, :, 2] / weight
    low[:, row_slice(COLLISION_ROWS)] = -(((loads.gaps + reach) / reach) ** 2 - 1.0)
    low[:, row_slice(COLLISION_ROWS)][loads.gaps >= 0.0] = -np.inf
    low[:, row_slice(WAY_ROWS)] = -loads.inside / HAND_SCALE
    return np.stack((near_nodes(low), near_nodes(high)))


def _windows(
    bounds: SpatialBounds, limited: Array, loads: SpatialLoads, weight: float
) -> tuple[Array, Array]:
    """Excess over the task's own bounds at the nodes: angles [rad] and vertical forces [N]."""
    angles = np.hstack((limited, loads.angles))[::DENSITY]
    part = row_slice(ANGLE_ROWS)
    low = np.hstack((bounds.angle_lower, bounds.node_lower[:, part]))
    high = np.hstack((bounds.angle_upper, bounds.node_upper[:, part]))
    start = row_slice(GROUND_ROWS).start + 1
    force = loads.ground_force[::DENSITY, :, 2]
    return np.maximum(low - angles, angles - high), np.maximum(
        weight * bounds.node_lower[:, start : start + 2] - force,
        force - weight * bounds.node_upper[:, start : start + 2],
    )
