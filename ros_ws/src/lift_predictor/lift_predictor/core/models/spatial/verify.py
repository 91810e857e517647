# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Check of a spatial solution between the nodes, on a dense time grid."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.spatial.evaluation import SpatialLoads, evaluate
from lift_predictor.core.models.spatial.grid import (
    ANGLE_CONSTRAINTS,
    ARM_CONSTRAINTS,
    BODY_CONSTRAINTS,
    COLLISION_CONSTRAINTS,
    GROUND_CONSTRAINTS,
    HAND_SCALE,
    LIMITED,
    NODE_CONSTRAINTS,
    TORQUE_CONSTRAINTS,
    WAY_CONSTRAINTS,
    SpatialBounds,
    SpatialGrid,
    constraint_slice,
)
from lift_predictor.core.models.spatial.parameters import (
    DEPENDENT,
    N_SPLINED,
    SPHERE_NAMES,
    STRONG,
)
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.problem.verification import (
    DENSITY,
    Family,
    Verification,
    dense_times,
    near_nodes,
)
from lift_predictor.core.solvers.library import NodeLibrary

TOLERANCE: Final[dict[str, float]] = {
    'joint_angle [rad]': 1e-3,
    'joint_torque [N m]': 0.5,
    'balance [m]': 1e-3,
    'foot_pulled [N]': 1.0,
    'collision [m]': 1e-3,
    'way [m]': 1e-3,
    'arms': 2e-2,
    'hamstrings [rad]': 1e-3,
    'box_acceleration [m/s^2]': 0.05,
    'hand_distance [m]': 2e-3,
    'box_level [m]': 2e-3,
    'hand_position [m]': 1e-4,
    'static_ends [rad/s]': 1e-6,
    'static_ends [rad/s^2]': 1e-6,
    'posture [rad]': 1e-3,
    'ground_window [N]': 1.0,
}
"""Largest violation that passes: what motion capture and force plates resolve (1 mm, 0.06 deg, 0.5
N m, 1 N); 2 mm for the grip, which gives by more than that."""
ELSEWHERE: Final = 0.5
"""Part of the largest excess of a constraint that becomes a margin at its other nodes."""
FEET: Final = ('right foot', 'left foot')


def verify(
    library: NodeLibrary,
    grid: SpatialGrid,
    task: SpatialTask,
    control: Array,
    box_mass: float,
    duration: float,
) -> Verification:
    """Evaluate all constraints on the dense grid of `verification.dense_times`.

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
    s = dense_times(grid.n_nodes)
    q, dq, ddq = grid.spline.sample(control, s, duration)
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
    # By differences of the places, independent of the model's accelerations.
    step = duration / (len(s) - 1)
    box_acceleration = np.diff(loads.hand.mean(axis=1), 2, axis=0) / step**2
    moved_box = np.linalg.norm(box_acceleration, axis=1) - p.box_acceleration
    # Asked for with rest in acceleration only.
    still = float(grid.rest == 'acceleration')
    pulled = -loads.ground_force[:, :, 2]
    families = {
        'joint_angle [rad]': Family(
            np.maximum(low - angles, angles - high), LIMITED + DEPENDENT, s
        ),
        'joint_torque [N m]': Family(
            np.maximum(loads.lower - loads.torque, loads.torque - loads.upper), STRONG, s
        ),
        'balance [m]': Family(
            length * np.maximum(-loads.fraction, loads.fraction - 1.0)[:, None], ('both feet',), s
        ),
        'foot_pulled [N]': Family(pulled, FEET, s),
        'collision [m]': Family(-loads.gaps, SPHERE_NAMES, s),
        'way [m]': Family(-loads.inside, ('right edge', 'left edge', 'lower place'), s),
        'arms': Family(-loads.arms, ARM_CONSTRAINTS, s),
        'hamstrings [rad]': Family(-loads.hamstrings, BODY_CONSTRAINTS[:2], s),
        'box_acceleration [m/s^2]': Family(moved_box[:, None], ('box',), s[1:-1]),
        'hand_distance [m]': Family(np.abs(width - p.box_width)[:, None], ('hands',), s),
        'box_level [m]': Family(np.abs(apart[:, 2:]), ('hands',), s),
        'hand_position [m]': Family(at_ends, ('right hand', 'left hand'), s[[0, -1]]),
        'static_ends [rad/s]': Family(
            np.abs(dq[[0, -1]]).max(axis=1)[:, None], ('body',), s[[0, -1]]
        ),
        'static_ends [rad/s^2]': Family(
            still * np.abs(ddq[[0, -1]]).max(axis=1)[:, None], ('body',), s[[0, -1]]
        ),
        'posture [rad]': Family(posture, LIMITED + DEPENDENT, grid.times),
        'ground_window [N]': Family(ground, FEET, grid.times),
    }
    node_excess = _node_excess(loads, leg, weight)
    angle_excess = np.stack((near_nodes(own[0] - limited), near_nodes(limited - own[1])))
    return Verification.of(families, TOLERANCE, np.dstack((node_excess, angle_excess)))


def tightened(bounds: SpatialBounds, excess: Array, factor: float) -> SpatialBounds:
    """Return bounds with a margin of a factor times the excess at each node.

    A part of the largest excess of a constraint goes to all other nodes, as the next solution may
    leave its bounds elsewhere. A margin is at most a quarter of the distance of two bounds, so
    that there is always an interior.

    Parameters
    ----------
    bounds : SpatialBounds
        Of the task.
    excess : ndarray, shape (2, n_nodes, 111)
        `Verification.excess`.
    factor : float
        Margin in units of the excess.
    """

    def narrow(low: Array, high: Array, excess: Array) -> tuple[Array, Array]:
        with np.errstate(invalid='ignore'):
            room = 0.25 * (high - low)
        spread = np.maximum(excess, ELSEWHERE * excess.max(axis=1, keepdims=True))
        least, most = (np.minimum(factor * part, room) for part in spread)
        return low + least, high - most

    at_nodes, of_angles = np.split(excess, [len(NODE_CONSTRAINTS)], axis=2)
    node = narrow(bounds.node_lower, bounds.node_upper, at_nodes)
    angle = narrow(bounds.angle_lower, bounds.angle_upper, of_angles)
    return replace(
        bounds, node_lower=node[0], node_upper=node[1], angle_lower=angle[0], angle_upper=angle[1]
    )


def _node_excess(loads: SpatialLoads, leg: tuple[Array, Array], weight: float) -> Array:
    """Excess of the node constraints over their limits without windows, (2, n_nodes, 89)."""
    n = len(loads.fraction)
    low, high = np.full((2, n, len(NODE_CONSTRAINTS)), -np.inf)
    span = loads.upper - loads.lower
    part = constraint_slice(TORQUE_CONSTRAINTS)
    low[:, part] = (loads.lower - loads.torque) / span
    high[:, part] = (loads.torque - loads.upper) / span
    part = constraint_slice(ANGLE_CONSTRAINTS)
    low[:, part], high[:, part] = leg[0] - loads.angles, loads.angles - leg[1]
    start = constraint_slice(GROUND_CONSTRAINTS).start
    low[:, start], high[:, start] = -loads.fraction, loads.fraction - 1.0
    low[:, start + 1 : start + 3] = -loads.ground_force[:, :, 2] / weight
    low[:, constraint_slice(COLLISION_CONSTRAINTS)] = np.where(
        loads.gaps < 0.0, -loads.clear, -np.inf
    )
    low[:, constraint_slice(ARM_CONSTRAINTS)] = -loads.arms
    low[:, constraint_slice(BODY_CONSTRAINTS)] = -np.hstack((loads.hamstrings, loads.pull))
    low[:, constraint_slice(WAY_CONSTRAINTS)] = -loads.inside / HAND_SCALE
    return np.stack((near_nodes(low), near_nodes(high)))


def _windows(
    bounds: SpatialBounds, limited: Array, loads: SpatialLoads, weight: float
) -> tuple[Array, Array]:
    """Excess over the task's own bounds at the nodes: angles [rad] and vertical forces [N]."""
    angles = np.hstack((limited, loads.angles))[::DENSITY]
    part = constraint_slice(ANGLE_CONSTRAINTS)
    low = np.hstack((bounds.angle_lower, bounds.node_lower[:, part]))
    high = np.hstack((bounds.angle_upper, bounds.node_upper[:, part]))
    start = constraint_slice(GROUND_CONSTRAINTS).start + 1
    force = loads.ground_force[::DENSITY, :, 2]
    return np.maximum(low - angles, angles - high), np.maximum(
        weight * bounds.node_lower[:, start : start + 2] - force,
        force - weight * bounds.node_upper[:, start : start + 2],
    )
