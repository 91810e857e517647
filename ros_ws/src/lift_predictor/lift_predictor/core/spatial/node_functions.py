# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Effort and constraints of one instant of the spatial lift."""

from __future__ import annotations

from typing import Any, Final

import casadi as ca

from lift_predictor.core.sagittal.model import strength
from lift_predictor.core.spatial.body import body_state
from lift_predictor.core.spatial.dynamics import loads
from lift_predictor.core.spatial.parameters import (
    CONSTANT_STRENGTH,
    DEPENDENT,
    N_PARAMETERS,
    N_SCALARS,
    N_SPLINED,
    SPHERE_BODIES,
    SPHERE_NAMES,
    STRONG,
    unpack,
)

N_NODE: Final = 3 * N_SPLINED
"""Node variables: splined coordinates and their first and second derivatives by normalised time."""

_SIDE_NAMES: Final = ('right', 'left')
TORQUE_ROWS: Final = tuple(f'joint torque limit of {joint}' for joint in STRONG)
ANGLE_ROWS: Final = tuple(f'joint angle limit of {joint}' for joint in DEPENDENT)
GROUND_ROWS: Final = (
    'balance (4.3) between heels and tips of the toes',
    *(f'vertical ground reaction of the {side} foot' for side in _SIDE_NAMES),
)
COLLISION_ROWS: Final = tuple(f'collision (3.10) of the box with the {n}' for n in SPHERE_NAMES)
HAND_ROWS: Final = (
    'distance of the hands (3.11)',
    'box level (3.12)',
    *(f'{side} hand (3.13) {axis}' for side in _SIDE_NAMES for axis in ('forward', 'left', 'up')),
)
NODE_ROWS: Final = (*TORQUE_ROWS, *ANGLE_ROWS, *GROUND_ROWS, *COLLISION_ROWS, *HAND_ROWS)
"""Rows of every node. Units: torques 0 at the lower and 1 at the upper dynamic limit; angles [rad];
balance 0 at the heels, 1 at the tips of the toes; ground reactions per body weight; collision
squared distance per squared sum of radii, less 1; hands `HAND_SCALE`."""

HAND_SCALE: Final = 0.1
"""Unit of the hand rows [m]: 10 cm of reach weigh as much as the range of a joint torque."""

REPORT_OUTPUTS: Final = (
    'torque',
    'lower',
    'upper',
    'ground_force',
    'pressure',
    'free_moment',
    'hand_force',
    'hand',
    'rows',
    'effort',
    'pelvis',
    'angles',
    'spheres',
)


def row_slice(rows: tuple[str, ...]) -> slice:
    """Place of a family of rows, one of the tuples above, within `NODE_ROWS`."""
    start = NODE_ROWS.index(rows[0])
    return slice(start, start + len(rows))


def node_expressions() -> tuple[Any, Any, Any, Any, Any]:
    """Symbols z, s, p of one node, and the expressions of its effort and rows.

    Returns
    -------
    z : SX, 78 x 1
        Splined coordinates, first and second derivative by normalised time.
    s : SX, 2 x 1
        `parameters.SCALARS`: box mass [kg], duration [s].
    p : SX
        `SpatialParameters.pack`.
    effort : SX
        Integrand of the first term of equation 3.9.
    rows : SX
        `NODE_ROWS`.
    """
    z, s = ca.SX.sym('z', N_NODE), ca.SX.sym('s', N_SCALARS)
    p = ca.SX.sym('p', N_PARAMETERS)
    instant = _instant(
        z[:N_SPLINED],
        z[N_SPLINED : 2 * N_SPLINED] / s[1],
        z[2 * N_SPLINED :] / s[1] ** 2,
        s[0],
        p,
    )
    return z, s, p, instant['effort'], instant['rows']


def report_function() -> Any:
    """CasADi function (q, dq, ddq, box mass, p) -> `REPORT_OUTPUTS`, in physical units.

    Derivatives are by time; vectors are in the stance frame.
    """
    q, dq, ddq = (ca.SX.sym(name, N_SPLINED) for name in ('q', 'dq', 'ddq'))
    mass, p = ca.SX.sym('box_mass'), ca.SX.sym('p', N_PARAMETERS)
    instant = _instant(q, dq, ddq, mass, p)
    return ca.Function(
        'report', [q, dq, ddq, mass, p], [instant[name] for name in REPORT_OUTPUTS],
        ['q', 'dq', 'ddq', 'box_mass', 'p'], list(REPORT_OUTPUTS),
    )  # fmt: skip


def torque_limits(angle: dict[str, Any], rate: dict[str, Any], p: Any) -> tuple[Any, Any]:
    """Lower and upper dynamic torque limits (2.14 to 2.19) of `STRONG` [N m]."""
    blocks = unpack(p)
    limits = []
    for side in ('lower', 'upper'):
        own = []
        for name, row in zip(STRONG, blocks[f'strength_{side}'], strict=True):
            constant = name in CONSTANT_STRENGTH
            own.append(row[0] if constant else strength(angle[name], rate[name], row))
        limits.append(ca.vertcat(*own))
    return limits[0], limits[1]


def _instant(q: Any, dq: Any, ddq: Any, mass: Any, p: Any) -> dict[str, Any]:
    blocks = unpack(p)
    state = body_state(q, dq, ddq, p)
    load = loads(state, mass, p)
    lower, upper = torque_limits(state.angle, state.rate, p)
    weight = sum(row[0] for row in blocks['body']) * blocks['gravity'][0][0]
    right, left = (hand[0] for hand in state.hand)
    width = blocks['box_width'][0][0]
    apart = left - right
    spheres, clear = _collision(state, right, left, blocks)
    pelvis = state.segment['pelvis']
    return {
        'torque': load.torque,
        'lower': lower,
        'upper': upper,
        'ground_force': ca.vertcat(*load.ground_force),
        'pressure': ca.vertcat(*load.pressure),
        'free_moment': ca.vertcat(*load.free_moment),
        'hand_force': ca.vertcat(*load.hand_force),
        'hand': ca.vertcat(right, left),
        'effort': ca.sumsqr(load.torque / (upper - lower)),
        'rows': ca.vertcat(
            (load.torque - lower) / (upper - lower),
            *(state.angle[name] for name in DEPENDENT),
            load.share,
            load.ground_force[0][2] / weight,
            load.ground_force[1][2] / weight,
            clear,
            (ca.sumsqr(apart) / width - width) / (2.0 * HAND_SCALE),
            apart[2] / HAND_SCALE,
            right / HAND_SCALE,
            left / HAND_SCALE,
        ),
        'pelvis': ca.vertcat(pelvis.place, *pelvis.turning.axes),
        'angles': ca.vertcat(*(state.angle[name] for name in DEPENDENT)),
        'spheres': spheres,
    }


def _collision(state: Any, right: Any, left: Any, blocks: dict[str, Any]) -> tuple[Any, Any]:
    """Sphere centres [m] and scaled squared distances of equation 3.10 (positive: clear)."""
    line = left - right
    length = ca.sqrt(line[0] ** 2 + line[1] ** 2)
    forward, up = ca.vertcat(line[1], -line[0], 0.0) / length, ca.vertcat(0.0, 0.0, 1.0)
    aside = ca.vertcat(line[0], line[1], 0.0) / length
    x, y, z = blocks['box_from_hand'][0]
    box = 0.5 * (right + left) + x * forward + y * aside + z * up
    centres, rows = [], []
    for name, (a, b, c, radius) in zip(SPHERE_BODIES, blocks['sphere'], strict=True):
        segment = state.segment[name]
        centre = segment.place + segment.turning.place([a, b, c])
        used = radius > 0.0
        reach = ca.if_else(used, radius + blocks['box_radius'][0][0], 1.0)
        centres.append(centre)
        # An unused sphere reads "clear" whatever the posture.
        rows.append(ca.if_else(used, ca.sumsqr(box - centre) / reach**2 - 1.0, 1.0))
    return ca.vertcat(*centres), ca.vertcat(*rows)


