# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
The whole analysis of frames of motion in one compiled function.

Kinematics, inverse dynamics, muscle paths, force-length-velocity, static optimisation (equation
4.10), reactions of all joints (equation 4.11) and the loads in their anatomical frames, frame
after frame without a step back into Python.  Everything is in OpenSim's axes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar, cast

import numpy as np
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core.disc_frame import DiscSetting, disc_rotation_of
from muscle_analyzer.core.dual_newton import Columns
from muscle_analyzer.core.held import Held
from muscle_analyzer.core.inverse_dynamics import inverse_dynamics, wrench_at
from muscle_analyzer.core.joint_loads import JointFrames, joint_loads
from muscle_analyzer.core.joint_reaction import joint_reactions, net_moment
from muscle_analyzer.core.kinematics import BodyState, forward_kinematics
from muscle_analyzer.core.multibody import Tree
from muscle_analyzer.core.muscle_curves import MuscleParameters, strength
from muscle_analyzer.core.muscle_path_table import PathTable
from muscle_analyzer.core.muscle_paths import body_wrenches, crossed_paths
from muscle_analyzer.core.torque_sharing import (
    Actuators,
    account,
    first_guess,
    remember,
    share_torque,
)

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
_Function = TypeVar('_Function', bound=Callable[..., object])

#: Steps of `solve_frames`.
WHOLE, ASK, ANSWER = 0, 1, 2


class FrameModel(NamedTuple):
    """
    Everything about a model that a frame needs.

    Attributes
    ----------
    tree : Tree
    paths : PathTable
    muscles : MuscleParameters
    actuators : Actuators
    joints : JointFrames
    disc : DiscSetting
    balanced : (n_c,) int
        Independent coordinates whose torques muscles and reserves balance.
    row : (n_q,) int
        Place of each independent coordinate among them, or -1.
    root, lumbosacral, thorax : int
        Numbers of the bodies.
    knees : (2,) int
        Coordinates of the knees.
    force_length_velocity, passive_force : bool
        Whether lengths and velocities change muscle strength, and stretched fibres resist.
    """

    tree: Tree
    paths: PathTable
    muscles: MuscleParameters
    actuators: Actuators
    joints: JointFrames
    disc: DiscSetting
    balanced: IntArray
    row: IntArray
    root: int
    lumbosacral: int
    thorax: int
    knees: IntArray
    force_length_velocity: bool
    passive_force: bool


class Demand(NamedTuple):
    """
    What a frame asks of the muscles.

    Attributes
    ----------
    state : BodyState
    joint_wrench : (n_b, 6)
        See `inverse_dynamics.InverseDynamics`.
    path_wrench : (n_e, 6)
        See `muscle_paths.MusclePaths`.
    active, passive : (n_m,)
        Muscle force per unit activation, and without activation [N].
    torque : (n_c,)
        Net joint torque of each balanced coordinate [N m].
    to_balance : (n_c,)
        The same less what passive muscle forces do [N m].
    columns : Columns
        Torque of each muscle at full activation [N m].
    wrong : int
        First coordinate whose torque or moment arms are not finite, or -1.
    """

    state: BodyState
    joint_wrench: Array
    path_wrench: Array
    active: Array
    passive: Array
    torque: Array
    to_balance: Array
    columns: Columns
    wrong: int


class FrameLoads(NamedTuple):
    """
    Solutions of n frames.

    Attributes
    ----------
    activation, force : (n, n_m)
        Muscle forces along the tendon [N].
    torque, to_balance : (n, n_c)
        See `Demand`.
    reserve, multiplier, residual : (n, n_c)
        Torque of the reserves, dual solution, what is not balanced [N m, 1 / (N m), N m].
    weak : (n, n_c) bool
        Whether the muscles of a coordinate are too weak.
    account : (n, 3)
        See `torque_sharing.Account`.
    iterations : (n,) int
    converged : (n,) bool
    wrong : (n,) int
        See `Demand`; nothing else of such a frame is to be used.
    reaction : (n, 6)
        Moment about the L5-S1 joint's centre and force of S1 on L5 [N m, N].
    disc_pose : (n, 3, 4)
        Rotation ground <- L5-S1 disc, and in the last column the joint's centre [m].
    joint_force, joint_moment : (n, n_j, 3)
        Loads of all joints in their anatomical frames [N, N m]; L5-S1's are those of its disc.
    net_moment : (n, 2, 3)
        Net moment at L5-S1, top-down and bottom-up [N m].
    pelvis_residual : (n, 6)
        Moment about the pelvis' origin and force left over at the pelvis [N m, N].
    """

    activation: Array
    force: Array
    torque: Array
    to_balance: Array
    reserve: Array
    multiplier: Array
    residual: Array
    weak: BoolArray
    account: Array
    iterations: IntArray
    converged: BoolArray
    wrong: IntArray
    reaction: Array
    disc_pose: Array
    joint_force: Array
    joint_moment: Array
    net_moment: Array
    pelvis_residual: Array


def _inner(function: _Function) -> _Function:
    """Compile a function that only compiled ones call: without a way in from Python."""
    compiled = njit(cache=True, error_model='numpy', no_cpython_wrapper=True)  # type: ignore[call-overload]
    return cast(_Function, compiled(function))


def no_loads(model: FrameModel, n: int) -> FrameLoads:
    """Give room for the solutions of n frames."""
    n_m, n_c, n_j = model.actuators.lower.size, model.balanced.size, model.joints.body.size
    return FrameLoads(
        activation=np.empty((n, n_m)),
        force=np.empty((n, n_m)),
        torque=np.empty((n, n_c)),
        to_balance=np.empty((n, n_c)),
        reserve=np.empty((n, n_c)),
        multiplier=np.empty((n, n_c)),
        residual=np.empty((n, n_c)),
        weak=np.empty((n, n_c), np.bool_),
        account=np.empty((n, 3)),
        iterations=np.empty(n, np.int64),
        converged=np.empty(n, np.bool_),
        wrong=np.empty(n, np.int64),
        reaction=np.empty((n, 6)),
        disc_pose=np.empty((n, 3, 4)),
        joint_force=np.empty((n, n_j, 3)),
        joint_moment=np.empty((n, n_j, 3)),
        net_moment=np.empty((n, 2, 3)),
        pelvis_residual=np.empty((n, 6)),
    )


@_inner
def _copy(source: Array, target: Array, k: int) -> None:
    """Copy into row k, element by element: slices cost the compiler seconds."""
    for i in range(source.size):
        target[k, i] = source[i]


@_inner
def demand(model: FrameModel, q: Array, qd: Array, qdd: Array, external: Array) -> Demand:
    """
    Compute what one frame asks of the muscles and what they can do.

    Parameters
    ----------
    model
        The model.
    q, qd, qdd : (n_q,)
        Independent coordinates, rates and accelerations [rad or m, per s, per s^2].
    external : (n_b, 6)
        Wrenches on the bodies from outside (see `inverse_dynamics.add_force`).
    """
    table = model.paths
    start, index = table.crossed_start, table.crossed_index
    state = forward_kinematics(model.tree, q, qd, qdd)
    dynamics = inverse_dynamics(model.tree, state, external)
    paths = crossed_paths(table, state)
    n_m, n_c = paths.length.size, model.balanced.size
    arm = paths.arm
    if model.force_length_velocity:
        speed = np.zeros(n_m)
        for m in range(n_m):
            for c in range(start[m], start[m + 1]):
                speed[m] -= arm[c] * qd[index[c]]
        active, passive = strength(model.muscles, paths.length, speed, model.passive_force)
    else:
        active, passive = model.muscles.max_isometric_force.copy(), np.zeros(n_m)
    torque = np.empty(n_c)
    wrong = -1
    for j in range(n_c):
        torque[j] = dynamics.force[model.balanced[j]]
        if wrong < 0 and not np.isfinite(torque[j]):
            wrong = j
    to_balance = torque.copy()
    first, row, value = np.empty(n_m + 1, np.int64), np.empty_like(index), np.empty(index.size)
    n = 0
    for m in range(n_m):
        first[m] = n
        for c in range(start[m], start[m + 1]):
            j = model.row[index[c]]
            if j < 0:
                continue
            row[n] = j
            value[n] = arm[c] * active[m]
            to_balance[j] -= arm[c] * passive[m]
            if not np.isfinite(value[n]) and (wrong < 0 or j < wrong):
                wrong = j
            n += 1
    first[n_m] = n
    columns = Columns(first, row[:n], value[:n])
    return Demand(
        state, dynamics.joint_wrench, paths.wrench, active, passive, torque, to_balance, columns,
        wrong,
    )  # fmt: skip


@_inner
def add_reactions(
    model: FrameModel, asked: Demand, q: Array, out: FrameLoads, k: int
) -> None:
    """
    Put what the muscles do to the joints into the solution of frame number k.

    Parameters
    ----------
    model
        The model.
    asked
        Of the frame.
    q : (n_q,)
        Its coordinates.
    out
        Gives activations, takes forces, reactions and net moments.
    k
        Number of the frame in it.
    """
    state, l5, root = asked.state, model.lumbosacral, model.root
    force = np.empty(asked.active.size)
    for i in range(force.size):
        force[i] = out.activation[k, i] * asked.active[i] + asked.passive[i]
        out.force[k, i] = force[i]
    pulls = body_wrenches(model.paths, asked.path_wrench, force, model.tree.parent.size)
    reactions = joint_reactions(model.tree, asked.joint_wrench, pulls)
    knee = 0.5 * (q[model.knees[0]] + q[model.knees[1]])
    disc = disc_rotation_of(model.disc, state.rotation[l5], state.rotation[model.thorax], knee)
    for i in range(3):
        for j in range(3):
            out.disc_pose[k, i, j] = disc[i, j]
        out.disc_pose[k, i, 3] = state.joint_position[l5, i]
    joint_loads(
        model.joints, reactions, state.joint_position, state.rotation, disc,
        out.joint_force[k], out.joint_moment[k],
    )  # fmt: skip
    net = net_moment(asked.joint_wrench, state, l5, root)
    _copy(wrench_at(reactions[l5], state.joint_position[l5]), out.reaction, k)
    _copy(net.top_down, out.net_moment[k], 0)
    _copy(net.bottom_up, out.net_moment[k], 1)
    _copy(wrench_at(asked.joint_wrench[root], state.position[root]), out.pelvis_residual, k)


@_inner
def _optimize(model: FrameModel, asked: Demand, past: Array, out: FrameLoads, k: int) -> None:
    """Share the torques of frame number k among the muscles."""
    multiplier = first_guess(past)
    activation, residual, iterations, converged = share_torque(
        model.actuators, asked.columns, asked.to_balance, multiplier
    )
    out.account[k, 0], out.account[k, 1], out.account[k, 2] = account(
        model.actuators, asked.columns, asked.to_balance, activation, residual, multiplier,
        1.0, np.inf, out.reserve[k], out.weak[k],
    )  # fmt: skip
    _copy(activation, out.activation, k)
    _copy(residual, out.residual, k)
    _copy(multiplier, out.multiplier, k)
    out.iterations[k] = iterations
    out.converged[k] = converged
    remember(past, multiplier, converged)


@njit(cache=True, error_model='numpy', nogil=True)
def solve_frames(
    held: Held[FrameModel],
    q: Array,
    qd: Array,
    qdd: Array,
    external: Array,
    step: int,
    past: Array,
    out: FrameLoads,
    matrix: Array,
) -> None:
    """
    Solve frame after frame, each from the solution of the one before.

    Parameters
    ----------
    held
        The model.
    q, qd, qdd : (n, n_q)
        Independent coordinates, rates and accelerations [rad or m, per s, per s^2].
    external : (n, n_b, 6)
        Wrenches on the bodies from outside (see `inverse_dynamics.add_force`).
    step
        `WHOLE` for all of it, the cost being a power of the activations; `ASK` and `ANSWER` for
        what comes before and after an optimisation elsewhere.
    past : (2, n_c)
        Multipliers of the two frames before, the last first (see `torque_sharing.first_guess`);
        on return those to go on from.
    out
        Takes the solutions; with `ANSWER` it gives the activations.
    matrix : (n, n_c, n_m)
        With `ASK`, takes the torque of each muscle at full activation [N m]; zeros before.
    """
    model = held.content
    for k in range(q.shape[0]):
        asked = demand(model, q[k], qd[k], qdd[k], external[k])
        out.wrong[k] = asked.wrong
        _copy(asked.torque, out.torque, k)
        _copy(asked.to_balance, out.to_balance, k)
        if asked.wrong >= 0:
            continue
        if step == ASK:
            columns = asked.columns
            for m in range(columns.start.size - 1):
                for c in range(columns.start[m], columns.start[m + 1]):
                    matrix[k, columns.row[c], m] = columns.value[c]
            continue
        if step == WHOLE:
            _optimize(model, asked, past, out, k)
        add_reactions(model, asked, q[k], out, k)
