# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The whole analysis of frames of motion in one compiled function.

Kinematics, inverse dynamics, muscle paths, force-length-velocity, static optimisation (equation
4.10), reactions of all joints (equation 4.11) and the loads in their anatomical frames, frame
after frame without a step back into Python.  Everything is in OpenSim's axes.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array
from muscle_analyzer.core.held import Held
from muscle_analyzer.core.loads.disc_frame import turn_disc
from muscle_analyzer.core.loads.joint_loads import joint_loads
from muscle_analyzer.core.loads.sample_data import FrameLoads, FrameModel, FrameRoom
from muscle_analyzer.core.multibody.inverse_dynamics import balance_motion, refer_wrench
from muscle_analyzer.core.multibody.joint_reaction import react
from muscle_analyzer.core.multibody.kinematics import move_bodies
from muscle_analyzer.core.muscles.curves import fill_strength
from muscle_analyzer.core.muscles.paths import pull_bodies, trace_paths
from muscle_analyzer.core.recruitment.muscle_recruitment import (
    Actuators,
    account,
    first_guess,
    remember,
    share_torque,
)

#: Steps of `solve_frames`.
WHOLE, ASK, ANSWER = 0, 1, 2


_inner: Final = njit(error_model='numpy', no_cpython_wrapper=True)
"""Compile a function that only compiled functions call: without an entry from Python."""


@kernel
def _copy(source: Array, target: Array, k: int) -> None:
    """Copy into row k, element by element: slices cost the compiler seconds."""
    for i in range(source.size):
        target[k, i] = source[i]


@kernel
def _muscle_strength(model: FrameModel, room: FrameRoom, qd: Array) -> None:
    """Fill what the muscles can do."""
    if not model.force_length_velocity:
        for m in range(room.active.size):
            room.active[m] = model.muscles.max_isometric_force[m]
            room.passive[m] = 0.0
        return
    start, index, arm = model.paths.crossed_start, model.paths.crossed_index, room.paths.arm
    for m in range(room.speed.size):
        room.speed[m] = 0.0
        for c in range(start[m], start[m + 1]):
            room.speed[m] -= arm[c] * qd[index[c]]
    fill_strength(
        model.muscles, room.paths.length, room.speed, model.passive_force, room.active,
        room.passive,
    )  # fmt: skip


@kernel
def demand(
    model: FrameModel, room: FrameRoom, q: Array, qd: Array, qdd: Array, external: Array
) -> int:
    """Compute what one frame asks of the muscles and what they can do.

    Parameters
    ----------
    model
        The model.
    room
        Takes all of it.
    q, qd, qdd : (n_q,)
        Independent coordinates, rates and accelerations [rad or m, per s, per s^2].
    external : (n_b, 6)
        Wrenches on the bodies from outside (see `inverse_dynamics.add_force`).

    Returns
    -------
    int
        First coordinate whose torque or moment arms are not finite, or -1.
    """
    move_bodies(model.tree, q, qd, qdd, room.kinematics, room.state)
    balance_motion(model.tree, room.state, external, room.dynamics)
    trace_paths(model.paths, room.state, room.path_room, room.paths)
    _muscle_strength(model, room, qd)
    torque, to_balance = room.torque, room.to_balance
    wrong = -1
    for j in range(torque.size):
        torque[j] = room.dynamics.force[model.balanced[j]]
        to_balance[j] = torque[j]
        if wrong < 0 and not np.isfinite(torque[j]):
            wrong = j
    start, index, arm = model.paths.crossed_start, model.paths.crossed_index, room.paths.arm
    first, row, value = room.columns
    n = 0
    for m in range(room.active.size):
        first[m] = n
        for c in range(start[m], start[m + 1]):
            j = model.row[index[c]]
            if j < 0:
                continue
            row[n] = j
            value[n] = arm[c] * room.active[m]
            to_balance[j] -= arm[c] * room.passive[m]
            if not np.isfinite(value[n]) and (wrong < 0 or j < wrong):
                wrong = j
            n += 1
    first[room.active.size] = n
    return wrong


@kernel
def add_reactions(model: FrameModel, room: FrameRoom, q: Array, out: FrameLoads, k: int) -> None:
    """Put what the muscles do to the joints into the solution of frame number k.

    Parameters
    ----------
    model
        The model.
    room
        Holds the `demand` of the frame.
    q : (n_q,)
        Its coordinates.
    out
        Gives activations, takes forces, reactions and net moments.
    k
        Number of the frame in it.
    """
    state, l5, root = room.state, model.lumbosacral, model.root
    joint_wrench, reaction = room.dynamics.joint_wrench, room.reaction
    for i in range(room.force.size):
        room.force[i] = out.activation[k, i] * room.active[i] + room.passive[i]
        out.force[k, i] = room.force[i]
    paths = model.paths
    pull_bodies(paths.body_start, paths.body_index, room.paths.wrench, room.force, reaction)
    react(model.tree, joint_wrench, reaction)
    knee = 0.5 * (q[model.knees[0]] + q[model.knees[1]])
    turn_disc(model.disc, state.rotation[l5], state.rotation[model.thorax], knee, room.disc)
    for i in range(3):
        for j in range(3):
            out.disc_pose[k, i, j] = room.disc[i, j]
        out.disc_pose[k, i, 3] = state.joint_position[l5, i]
    joint_loads(
        model.joints, reaction, state.joint_position, state.rotation, room.disc,
        out.joint_force[k], out.joint_moment[k],
    )  # fmt: skip
    centre = state.joint_position[l5]
    refer_wrench(joint_wrench[l5], centre, room.net[0])
    refer_wrench(joint_wrench[root], centre, room.net[1])
    for i in range(3):
        # The wrenches of all bodies add up to what is left over at the root.
        out.net_moment[k, 0, i] = room.net[0, i]
        out.net_moment[k, 1, i] = room.net[0, i] - room.net[1, i]
    refer_wrench(reaction[l5], centre, out.reaction[k])
    refer_wrench(joint_wrench[root], state.position[root], out.pelvis_residual[k])


@_inner
def _optimize(actuators: Actuators, room: FrameRoom, past: Array, out: FrameLoads, k: int) -> None:
    """Share the torques of frame number k among the muscles."""
    multiplier = first_guess(past)
    activation, residual, iterations, converged = share_torque(
        actuators, room.columns, room.to_balance, multiplier
    )
    out.account[k, 0], out.account[k, 1], out.account[k, 2] = account(
        actuators, room.columns, room.to_balance, activation, residual, multiplier,
        1.0, np.inf, out.reserve[k], out.weak[k],
    )  # fmt: skip
    _copy(activation, out.activation, k)
    _copy(residual, out.residual, k)
    _copy(multiplier, out.multiplier, k)
    out.iterations[k] = iterations
    out.converged[k] = converged
    remember(past, multiplier, converged)


@njit(error_model='numpy', nogil=True)
def solve_frames(
    held: Held[tuple[FrameModel, FrameRoom]],
    q: Array,
    qd: Array,
    qdd: Array,
    external: Array,
    step: int,
    past: Array,
    out: FrameLoads,
    matrix: Array,
) -> None:
    """Solve frame after frame, each from the solution of the one before.

    Parameters
    ----------
    held
        The model and room for a frame.
    q, qd, qdd : (n, n_q)
        Independent coordinates, rates and accelerations [rad or m, per s, per s^2].
    external : (n, n_b, 6)
        Wrenches on the bodies from outside (see `inverse_dynamics.add_force`).
    step
        `WHOLE` for all of it, the cost being a power of the activations; `ASK` and `ANSWER` for
        what comes before and after an optimisation elsewhere.
    past : (2, n_c)
        Multipliers of the two frames before, last first (see `muscle_recruitment.first_guess`);
        on return those to go on from.
    out
        Takes the solutions; with `ANSWER` it gives the activations.
    matrix : (n, n_c, n_m)
        With `ASK`, takes the torque of each muscle at full activation [N m]; zeros before.
    """
    model, room = held.content
    for k in range(q.shape[0]):
        out.wrong[k] = demand(model, room, q[k], qd[k], qdd[k], external[k])
        _copy(room.torque, out.torque, k)
        _copy(room.to_balance, out.to_balance, k)
        if out.wrong[k] >= 0:
            continue
        if step == ASK:
            start, row, value = room.columns
            for m in range(start.size - 1):
                for c in range(start[m], start[m + 1]):
                    matrix[k, row[c], m] = value[c]
            continue
        if step == WHOLE:
            _optimize(model.actuators, room, past, out, k)
        add_reactions(model, room, q[k], out, k)
