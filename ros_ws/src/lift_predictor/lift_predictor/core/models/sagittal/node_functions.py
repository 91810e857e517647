# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Effort and constraints of one instant of the lift, with exact first and second derivatives."""

from __future__ import annotations

from typing import Any

import casadi as ca

from lift_predictor.core.models.sagittal.grid import (
    CENTRES,
    HAND_SCALE,
    N_NODE,
    NODE_CONSTRAINTS,
    REPORT_OUTPUTS,
)
from lift_predictor.core.models.sagittal.model import chain_state, torque_limits
from lift_predictor.core.models.sagittal.parameters import (
    BODIES,
    N_JOINTS,
    N_PARAMETERS,
    N_SCALARS,
    unpack,
)


def node_functions() -> dict[str, Any]:
    """Return the CasADi functions of one instant by name.

    Returns
    -------
    dict
        `node(z, s, p)` -> effort, rows; `node_jac` adds their derivatives by (z, s);
        `node_hess(z, s, p, sigma, multiplier)` -> Hessian of sigma effort + multiplier' rows by
        (z, s); `hand(q, p)`, `hand_jac`, `hand_hess` the same for the grip; `report(q, dq, ddq, s,
        p)` -> `REPORT_OUTPUTS` in physical units. s holds the box's mass [kg].

    Notes
    -----
    Effort is the integrand of the first term of equation 2.11, over the six joints above the feet
    (no strength of the metatarsophalangeal joint is published). Rows are scaled to order 1:
    torques are 0 at the lower and 1 at the upper dynamic limit, balance is divided by weight times
    foot length, collision by the squared sum of the radii, height by `HAND_SCALE`.
    """
    p = ca.SX.sym('p', N_PARAMETERS)
    z = ca.SX.sym('z', N_NODE)
    s = ca.SX.sym('s', N_SCALARS)
    zs = ca.vertcat(z, s)
    sigma = ca.SX.sym('sigma')
    multiplier = ca.SX.sym('multiplier', len(NODE_CONSTRAINTS))
    duration = unpack(p)['duration'][0][0]
    instant = _instant(
        z[:N_JOINTS], z[N_JOINTS : 2 * N_JOINTS] / duration, z[2 * N_JOINTS :] / duration**2, s, p
    )
    effort, rows = instant['effort'], instant['constraints']
    gradient = ca.gradient(sigma * effort + ca.dot(multiplier, rows), zs)

    q, dq, ddq = (ca.SX.sym(name, N_JOINTS) for name in ('q', 'dq', 'ddq'))
    physical = _instant(q, dq, ddq, s, p)
    hand = physical['centres'][-2:]
    hand_multiplier = ca.SX.sym('hand_multiplier', 2)
    return {
        'node': ca.Function('node', [z, s, p], [effort, rows]),
        'node_jac': ca.Function(
            'node_jac', [z, s, p], [effort, rows, ca.gradient(effort, zs), ca.jacobian(rows, zs)]
        ),
        'node_hess': ca.Function(
            'node_hess', [z, s, p, sigma, multiplier], [ca.jacobian(gradient, zs)]
        ),
        'hand': ca.Function('hand', [q, p], [hand]),
        'hand_jac': ca.Function('hand_jac', [q, p], [hand, ca.jacobian(hand, q)]),
        'hand_hess': ca.Function(
            'hand_hess', [q, p, hand_multiplier], [ca.hessian(ca.dot(hand_multiplier, hand), q)[0]]
        ),
        'report': ca.Function(
            'report',
            [q, dq, ddq, s, p],
            [physical[name] for name, _ in REPORT_OUTPUTS],
            ['q', 'dq', 'ddq', 's', 'p'],
            [name for name, _ in REPORT_OUTPUTS],
        ),
    }


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
        ),
        'centres': ca.vertcat(*(state.position[name] for name in CENTRES)),
        'segment_angle': ca.vertcat(*(state.angle[name][0] for name in BODIES)),
    }
