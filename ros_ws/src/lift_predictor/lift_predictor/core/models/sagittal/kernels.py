# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Effort and constraints of one instant of the sagittal lift (imports CasADi)."""

from __future__ import annotations

from typing import Any

import casadi as ca

from lift_predictor.core.models.sagittal.grid import CENTRES, HAND_SCALE, N_NODE, REPORT_OUTPUTS
from lift_predictor.core.models.sagittal.model import chain_state, torque_limits
from lift_predictor.core.models.sagittal.parameters import (
    BODIES,
    HIP,
    KNEE,
    N_JOINTS,
    N_PARAMETERS,
    N_SCALARS,
    unpack,
)
from lift_predictor.core.problem.task import WEIGHT_OFFSET
from lift_predictor.core.solvers.node_function import NodeFunction


def kernel_functions() -> list[NodeFunction]:
    """Return `node` (equations 2.11, 4.2, 4.3, 4.5), `angle` (4.1, 4.8), `hand` (4.6), `report`.

    The cost of a node is a T effort - b log(W + 10): its mean over the lift is the objective.

    Notes
    -----
    Effort is the integrand of the first term of equation 2.11, over the six joints above the feet
    (no strength of the metatarsophalangeal joint is published). Constraints are scaled to order 1:
    torques are 0 at the lower and 1 at the upper dynamic limit, balance is divided by weight times
    foot length, height by `HAND_SCALE`, the box's squared acceleration by its largest one.
    """
    p = ca.SX.sym('p', N_PARAMETERS)
    z, q = ca.SX.sym('z', N_NODE), ca.SX.sym('q', N_JOINTS)
    s, none = ca.SX.sym('s', N_SCALARS), ca.SX(0, 1)
    blocks = unpack(p)
    duration, gravity = blocks['duration'][0][0], blocks['gravity'][0][0]
    effort_factor, weight_factor = blocks['objective'][0]
    angle, rate, acceleration = z[:N_JOINTS], z[N_JOINTS : 2 * N_JOINTS], z[2 * N_JOINTS :]
    instant = _instant(angle, rate / duration, acceleration / duration**2, s, p)
    weight = gravity * s[0] + WEIGHT_OFFSET
    cost = effort_factor * duration * instant['effort'] - weight_factor * ca.log(weight)
    still = ca.SX(N_JOINTS, 1)
    hand = _instant(q, still, still, s, p)['centres'][-2:]
    # In physical units: derivatives by time.
    physical = _instant(angle, rate, acceleration, s, p)
    report = ca.vertcat(*(ca.vec(physical[name]) for name, _ in REPORT_OUTPUTS))
    return [
        NodeFunction('node', z, s, p, instant['constraints'], cost),
        NodeFunction('angle', q, none, p, q),
        NodeFunction('hand', q, none, p, hand / HAND_SCALE),
        NodeFunction('report', z, s, p, report, differentiable=False),
    ]


def _instant(q: Any, dq: Any, ddq: Any, s: Any, p: Any) -> dict[str, Any]:
    blocks = unpack(p)
    state = chain_state(q, dq, ddq, s, p)
    lower, upper = torque_limits(q, dq, p)
    mass = sum(row[0] for row in blocks['body']) + s[0]
    rear, front = blocks['support'][0]
    scale = (front - rear) * mass * blocks['gravity'][0][0]
    vertical = state.ground_force[1]
    return {
        'torque': state.torque,
        'lower': lower,
        'upper': upper,
        'ground_force': state.ground_force,
        'ground_moment': state.ground_moment,
        'hand_force': state.hand_force,
        'effort': ca.sumsqr(state.torque / (upper - lower)),
        'constraints': ca.vertcat(
            (state.torque - lower) / (upper - lower),
            (state.ground_moment - rear * vertical) / scale,
            (front * vertical - state.ground_moment) / scale,
            state.clearance,
            (state.position['hand'][1] - blocks['lowest_grip'][0][0]) / HAND_SCALE,
            blocks['hip_range'][0][0] + blocks['hip_range'][0][1] * q[KNEE] - q[HIP],
            1.0 - ca.sumsqr(state.acceleration['hand']) / blocks['box_acceleration'][0][0] ** 2,
        ),
        'centres': ca.vertcat(*(state.position[name] for name in CENTRES)),
        'segment_angle': ca.vertcat(*(state.angle[name][0] for name in BODIES)),
    }
