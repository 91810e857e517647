# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Effort and constraints of one instant of the spatial lift."""

from __future__ import annotations

from itertools import accumulate, pairwise
from typing import Any

import casadi as ca

from lift_predictor.core.models.contact import clearance
from lift_predictor.core.models.passive import passive_hip_moment
from lift_predictor.core.models.sagittal.model import strength
from lift_predictor.core.models.spatial.body import BodyState, body_state
from lift_predictor.core.models.spatial.dynamics import loads
from lift_predictor.core.models.spatial.grid import (
    HAND_SCALE,
    LIMITED,
    N_NODE,
    REPORT_OUTPUTS,
)
from lift_predictor.core.models.spatial.parameters import (
    ARM,
    ARM_POINTS,
    CONSTANT_STRENGTH,
    DEPENDENT,
    N_PARAMETERS,
    N_SCALARS,
    N_SPLINED,
    ROOT,
    SIDES,
    SPHERE_BODIES,
    SPINE,
    STRONG,
    TRUNK,
    unpack,
)
from lift_predictor.core.problem.task import WEIGHT_OFFSET
from lift_predictor.core.solvers.node_function import NodeFunction
from lift_predictor.core.solvers.sweeps import SweptFunction


def kernel_functions() -> list[NodeFunction]:
    """Return the node functions of the compiled library.

    `node` (z = splined coordinates and two derivatives by normalised time, s = `SCALARS`): cost
    a T effort - b log(W + 10), whose mean over the lift is the objective (3.9), and
    `NODE_CONSTRAINTS`; `angle`: `LIMITED`; `hand`: right and left grip; `technique`: how far the
    hips are lowered beyond the least and short of the largest part of C7's lowering; `report`:
    `REPORT_OUTPUTS`.
    """
    z, s = ca.SX.sym('z', N_NODE), ca.SX.sym('s', N_SCALARS)
    p, none = ca.SX.sym('p', N_PARAMETERS), ca.SX(0, 1)
    mass, duration = s[0], s[1]
    q, dq, ddq = z[:N_SPLINED], z[N_SPLINED : 2 * N_SPLINED], z[2 * N_SPLINED :]
    instant = _instant(q, dq / duration, ddq / duration**2, mass, p)
    effort_factor, weight_factor = unpack(p)['objective'][0]
    weight = unpack(p)['gravity'][0][0] * mass + WEIGHT_OFFSET
    cost = effort_factor * duration * instant['effort'] - weight_factor * ca.log(weight)
    posture, still = ca.SX.sym('q', N_SPLINED), ca.SX(N_SPLINED, 1)
    state = body_state(posture, still, still, p)
    right, left = state.hand
    report = ca.vertcat(*(ca.vec(instant[name]) for name, _ in REPORT_OUTPUTS))
    return [
        SweptFunction('node', z, s, p, instant['constraints'], cost, sets=_sets()),
        NodeFunction('angle', posture, none, p, posture[N_SPLINED - len(LIMITED) :]),
        NodeFunction('hand', posture, none, p, ca.vertcat(right[0], left[0]) / HAND_SCALE),
        NodeFunction('technique', posture, none, p, _technique(state, p) / HAND_SCALE),
        NodeFunction('report', z, s, p, report, differentiable=False),
    ]


def _sets() -> tuple[tuple[int, ...], ...]:
    """Return the inputs of `node` in the order of their sweeps: what touches most of it first.

    The duration acts on everything, pelvis and legs move the whole body, spine and arms what is
    beyond them, accelerations and the box's mass act on the loads only.
    """
    edges = accumulate((0, len(ROOT), len(SPINE), len(ARM), len(ARM)))
    posture_and_speed = (
        tuple(range(order * N_SPLINED + first, order * N_SPLINED + last))
        for first, last in pairwise(edges)
        for order in (0, 1)
    )
    accelerations = range(2 * N_SPLINED, 3 * N_SPLINED)
    mass, duration = N_NODE, N_NODE + 1
    return ((duration,), *posture_and_speed, (*accelerations, mass))


def torque_limits(angle: dict[str, Any], rate: dict[str, Any], p: Any) -> tuple[Any, Any]:
    """Lower and upper limits (2.14 to 2.19) of the net torques of `STRONG` [N m].

    The passive moment of the hips is added to what the muscles can do.
    """
    blocks = unpack(p)
    limits = []
    for side in ('lower', 'upper'):
        own = []
        for name, row in zip(STRONG, blocks[f'strength_{side}'], strict=True):
            constant = name in CONSTANT_STRENGTH
            limit = row[0] if constant else strength(angle[name], rate[name], row)
            if name.startswith('hip_flexion'):
                knee = angle[name.replace('hip_flexion', 'knee_angle')]
                limit += passive_hip_moment(angle[name], knee, ca.exp)
            own.append(limit)
        limits.append(ca.vertcat(*own))
    return limits[0], limits[1]


def _technique(state: BodyState, p: Any) -> Any:
    """Room to both ends of the range of the Stoop-Squat-Index, by the hips [m]."""
    blocks = unpack(p)
    forward, up, hips_upright, c7_upright = blocks['standing'][0]
    least, most = blocks['technique'][0]
    thorax = state.segment['thorax']
    c7 = c7_upright - (thorax.place + thorax.turning.place([forward, 0.0, up]))[2]
    hips = hips_upright - state.segment['pelvis'].place[2]
    return ca.vertcat(hips - least * c7, most * c7 - hips)


def _instant(q: Any, dq: Any, ddq: Any, mass: Any, p: Any) -> dict[str, Any]:
    blocks = unpack(p)
    state = body_state(q, dq, ddq, p)
    load = loads(state, mass, p)
    lower, upper = torque_limits(state.angle, state.rate, p)
    weight = sum(row[0] for row in blocks['body']) * blocks['gravity'][0][0]
    right, left = (hand[0] for hand in state.hand)
    width = blocks['box_width'][0][0]
    apart = left - right
    offset, clear, inside = _collision(state, right, left, blocks)
    arms = _arms(state, blocks)
    straight, per_knee = blocks['hip_range'][0]
    hamstrings = ca.vertcat(
        *(
            straight + per_knee * state.angle[f'knee_angle_{s}'] - state.angle[f'hip_flexion_{s}']
            for s in SIDES
        )
    )
    push = 0.5 * (state.hand[0][1] + state.hand[1][1])
    pull = 1.0 - ca.sumsqr(push) / blocks['box_acceleration'][0][0] ** 2
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
        'constraints': ca.vertcat(
            (load.torque - lower) / (upper - lower),
            *(state.angle[name] for name in DEPENDENT),
            load.fraction,
            load.ground_force[0][2] / weight,
            load.ground_force[1][2] / weight,
            clear,
            inside / HAND_SCALE,
            arms,
            hamstrings,
            pull,
            (ca.sumsqr(apart) / width - width) / (2.0 * HAND_SCALE),
            apart[2] / HAND_SCALE,
        ),
        'angles': ca.vertcat(*(state.angle[name] for name in DEPENDENT)),
        'offset': offset,
        'clear': clear,
        'arms': arms,
        'hamstrings': hamstrings,
        'pull': pull,
        'fraction': load.fraction,
        'inside': inside,
    }


def _collision(state: Any, right: Any, left: Any, blocks: dict[str, Any]) -> tuple[Any, ...]:
    """Spheres seen from the box, their constraints (equation 3.10), and the box inside its way.

    Offsets along the axes of the box [m]; `contact.clearance`; distances inside [m].
    """
    line = left - right
    length = ca.sqrt(line[0] ** 2 + line[1] ** 2)
    forward, up = ca.vertcat(line[1], -line[0], 0.0) / length, ca.vertcat(0.0, 0.0, 1.0)
    aside = ca.vertcat(line[0], line[1], 0.0) / length
    x, y, z = blocks['box_from_hand'][0]
    box = 0.5 * (right + left) + x * forward + y * aside + z * up
    offsets, rows = [], []
    table = zip(SPHERE_BODIES, blocks['sphere'], blocks['semi_axes'], strict=True)
    for name, (a, b, c, radius), axes in table:
        segment = state.segment[name]
        centre = segment.place + segment.turning.place([a, b, c])
        used = radius > 0.0
        offset = [ca.dot(axis, centre - box) for axis in (forward, aside, up)]
        offsets += offset
        lengths = [ca.if_else(used, axis, 1.0) for axis in axes]
        # An unused sphere reads "clear" whatever the posture.
        rows.append(ca.if_else(used, clearance(offset, lengths, ca.sqrt), 1.0))
    inside = [ca.dot(box, ca.vertcat(*row[:3])) + row[3] for row in blocks['way']]
    return ca.vertcat(*offsets), ca.vertcat(*rows), ca.vertcat(*inside)


def _arms(state: BodyState, blocks: dict[str, Any]) -> Any:
    """Squared distance of elbows and wrists from the trunk's ellipsoids per semi-axes, less 1."""
    rows = []
    for name, (x, z, *axes) in zip(TRUNK, blocks['trunk'], strict=True):
        segment = state.segment[name]
        centre = segment.place + segment.turning.place([x, 0.0, z])
        for point in ARM_POINTS:
            gap = state.segment[point].place - centre
            own = [ca.dot(axis, gap) for axis in segment.turning.axes]
            rows.append(sum((a / b) ** 2 for a, b in zip(own, axes, strict=True)) - 1.0)
    return ca.vertcat(*rows)
