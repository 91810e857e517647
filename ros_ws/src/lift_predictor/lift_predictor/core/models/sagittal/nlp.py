# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lift as a nonlinear programme (equations 2.10 to 2.12 and 4.1 to 4.8).

The variables are the free control values of the angles and the mass of the box; the objective is
a effort - b log(W + 10). With equal bounds on the mass it is the lift of a given weight.

The node functions are mapped over uniform time nodes and gathered into the programme by the
constant matrices of the spline: gradient, Jacobian and Hessian are products of small dense blocks
with them. Person and task are parameters, so that the functions depend on the numbers of control
points and nodes only and are compiled once for everybody.
"""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np

from lift_predictor.core.bspline import simpson_weights
from lift_predictor.core.models.sagittal.grid import (
    HAND_SCALE,
    N_NODE,
    NODE_CONSTRAINTS,
    SagittalGrid,
)
from lift_predictor.core.models.sagittal.node_functions import node_functions
from lift_predictor.core.models.sagittal.parameters import (
    N_JOINTS,
    N_PARAMETERS,
    N_SCALARS,
    SHAPES,
)
from lift_predictor.core.problem.task import WEIGHT_OFFSET


def programme_functions(grid: SagittalGrid) -> list[Any]:
    """Build the programme's functions under the names that CasADi's solvers look for.

    Returns
    -------
    list of casadi.Function
        `nlp`, `nlp_f`, `nlp_g`, `nlp_grad_f`, `nlp_jac_g`, `nlp_hess_l` (upper triangle),
        `nlp_grad`, `report`.
    """
    node = node_functions()
    n, n_splined = grid.n_nodes, grid.n_splined
    x = ca.MX.sym('x', grid.n_variables)
    p = ca.MX.sym('p', N_PARAMETERS)
    lam_f = ca.MX.sym('lam_f')
    lam_g = ca.MX.sym('lam_g', len(grid.constraint_names))
    duration = p[_offset('duration')]
    effort_factor = p[_offset('objective')] * duration
    weights = ca.DM(simpson_weights(n))
    heaviness, d_heaviness, dd_heaviness = _heaviness(x[-1], p)

    gather = _gather(grid)
    z = ca.reshape(ca.mtimes(gather, x), N_NODE + N_SCALARS, n)[:N_NODE, :]
    s = x[-1]
    angles, middle = _linear_rows(grid)
    q_ends = (x[:N_JOINTS], x[n_splined - N_JOINTS : n_splined])

    def stack(rows: Any, hands: list[Any]) -> Any:
        return ca.vertcat(ca.vec(rows), ca.mtimes(angles, x), *hands, ca.mtimes(middle, x))

    effort, rows = node['node'].map(n)(z, s, p)
    f = effort_factor * ca.dot(weights, effort.T) - heaviness
    g = stack(rows, [node['hand'](q, p) / HAND_SCALE for q in q_ends])

    effort_j, rows_j, d_effort, d_rows = node['node_jac'].map(n)(z, s, p)
    f_j = effort_factor * ca.dot(weights, effort_j.T) - heaviness
    weighted = d_effort * ca.repmat(weights.T, N_NODE + N_SCALARS, 1)
    by_mass = ca.vertcat(ca.DM(n_splined, 1), d_heaviness)
    grad_f = effort_factor * ca.mtimes(gather.T, ca.vec(weighted)) - by_mass
    blocks = ca.diagcat(*ca.horzsplit(d_rows, N_NODE + N_SCALARS))
    hand_values, hand_rows = [], []
    for q, first in zip(q_ends, (0, n_splined - N_JOINTS), strict=True):
        value, slope = node['hand_jac'](q, p)
        hand_values.append(value / HAND_SCALE)
        before = ca.DM(2, first)
        after = ca.DM(2, grid.n_variables - N_JOINTS - first)
        hand_rows.append(ca.horzcat(before, slope / HAND_SCALE, after))
    g_j = stack(rows_j, hand_values)
    jac_g = ca.vertcat(ca.mtimes(blocks, gather), angles, *hand_rows, middle)

    n_rows = len(NODE_CONSTRAINTS)
    node_multiplier = ca.reshape(lam_g[: n * n_rows], n_rows, n)
    sigma = lam_f * effort_factor * weights.T
    hessians = node['node_hess'].map(n)(z, s, p, sigma, node_multiplier)
    block_hess = ca.diagcat(*ca.horzsplit(hessians, N_NODE + N_SCALARS))
    hess = ca.mtimes(ca.mtimes(gather.T, block_hess), gather)
    first_hand = n * (n_rows + N_JOINTS)
    ends = [
        node['hand_hess'](
            q, p, lam_g[first_hand + 2 * end : first_hand + 2 * end + 2] / HAND_SCALE
        )
        for end, q in enumerate(q_ends)
    ]
    between = n_splined - 2 * N_JOINTS
    hess = hess + ca.diagcat(ends[0], ca.DM(between, between), ends[1], -lam_f * dd_heaviness)

    point = ([x, p], ['x', 'p'])
    return [
        ca.Function('nlp', point[0], [f, g], point[1], ['f', 'g']),
        ca.Function('nlp_f', point[0], [f], point[1], ['f']),
        ca.Function('nlp_g', point[0], [g], point[1], ['g']),
        ca.Function('nlp_grad_f', point[0], [f_j, grad_f], point[1], ['f', 'grad_f_x']),
        ca.Function('nlp_jac_g', point[0], [g_j, jac_g], point[1], ['g', 'jac_g_x']),
        ca.Function(
            'nlp_hess_l',
            [x, p, lam_f, lam_g],
            [ca.triu(hess)],
            ['x', 'p', 'lam_f', 'lam_g'],
            ['triu_hess_gamma_x_x'],
        ),
        # CasADi asks for this one at start-up; sensitivities to the parameters are left out.
        ca.Function(
            'nlp_grad',
            [x, p, lam_f, lam_g],
            [f_j, g_j, lam_f * grad_f + ca.mtimes(jac_g.T, lam_g), ca.DM(N_PARAMETERS, 1)],
            ['x', 'p', 'lam_f', 'lam_g'],
            ['f', 'g', 'grad_gamma_x', 'grad_gamma_p'],
        ),
        node['report'],
    ]


def _offset(field: str) -> int:
    start = 0
    for name, (rows, columns) in SHAPES.items():
        if name == field:
            return start
        start += rows * columns
    raise KeyError(field)


def _heaviness(mass: Any, p: Any) -> tuple[Any, Any, Any]:
    """Second term of equation 2.11, b log(W + 10) with W in N, and two derivatives by the mass."""
    gravity, factor = p[_offset('gravity')], p[_offset('objective') + 1]
    total = gravity * mass + WEIGHT_OFFSET
    slope = factor * gravity / total
    return factor * ca.log(total), slope, -slope * gravity / total


def _gather(grid: SagittalGrid) -> Any:
    """Sparse matrix from the variables to the stacked node variables, (19 n, n_variables)."""
    basis = [grid.spline.basis(grid.times, derivative) for derivative in range(3)]
    blocks = np.stack(basis, axis=1).reshape(3 * grid.n_nodes, grid.spline.n_free)
    gather = np.zeros((grid.n_nodes, N_NODE + N_SCALARS, grid.n_variables))
    gather[:, :N_NODE, :-N_SCALARS] = np.kron(blocks, np.eye(N_JOINTS)).reshape(
        grid.n_nodes, N_NODE, grid.n_splined
    )
    gather[:, N_NODE:, -N_SCALARS:] = np.eye(N_SCALARS)
    return ca.sparsify(ca.DM(gather.reshape(-1, grid.n_variables)), 1e-12)


def _linear_rows(grid: SagittalGrid) -> tuple[Any, Any]:
    """Joint angles at all nodes and at half time, as matrices on the variables."""
    unit = np.eye(N_JOINTS)
    rows = []
    for times in (grid.times, np.array([0.5])):
        by_angles = np.kron(grid.spline.basis(times), unit)
        by_mass = np.zeros((len(by_angles), N_SCALARS))
        rows.append(ca.sparsify(ca.DM(np.hstack((by_angles, by_mass))), 1e-12))
    return rows[0], rows[1]
