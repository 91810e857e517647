# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The node functions of the sagittal programme, for the compiled kernels (imports CasADi)."""

from __future__ import annotations

import casadi as ca

from lift_predictor.core.models.sagittal.grid import (
    HAND_SCALE,
    N_NODE,
    REPORT_OUTPUTS,
)
from lift_predictor.core.models.sagittal.node_functions import node_functions
from lift_predictor.core.models.sagittal.parameters import (
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
    """
    functions = node_functions()
    p = ca.SX.sym('p', N_PARAMETERS)
    z, q = ca.SX.sym('z', N_NODE), ca.SX.sym('q', N_JOINTS)
    s, none = ca.SX.sym('s', N_SCALARS), ca.SX(0, 1)
    blocks = unpack(p)
    duration, gravity = blocks['duration'][0][0], blocks['gravity'][0][0]
    effort_factor, weight_factor = blocks['objective'][0]
    effort, rows = functions['node'](z, s, p)
    weight = gravity * s[0] + WEIGHT_OFFSET
    cost = effort_factor * duration * effort - weight_factor * ca.log(weight)
    thirds = (z[:N_JOINTS], z[N_JOINTS : 2 * N_JOINTS], z[2 * N_JOINTS :])
    outputs = functions['report'](*thirds, s, p)
    report = ca.vertcat(*(ca.vec(outputs[i]) for i in range(len(REPORT_OUTPUTS))))
    return [
        NodeFunction('node', z, s, p, rows, cost),
        NodeFunction('angle', q, none, p, q),
        NodeFunction('hand', q, none, p, functions['hand'](q, p) / HAND_SCALE),
        NodeFunction('report', z, s, p, report, differentiable=False),
    ]
