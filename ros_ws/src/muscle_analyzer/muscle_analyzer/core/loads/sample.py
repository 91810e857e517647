# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Analysis of samples of motion: one compiled function for all samples of a block.

Kinematics, inverse dynamics, muscle paths, force-length-velocity, static optimisation (equation
4.10), reactions of all joints (equation 4.11) and the loads in their anatomical frames.  All in
OpenSim's axes.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.compiled_cache import kernel, njit
from human_model.typing import Array
from muscle_analyzer.core.boxed_tuple import Boxed
from muscle_analyzer.core.loads.disc_frame import turn_disc
from muscle_analyzer.core.loads.joint_loads import joint_loads
from muscle_analyzer.core.loads.sample_data import SampleLoads, SampleModel, Workspace
from muscle_analyzer.core.multibody.inverse_dynamics import compute_inverse_dynamics, refer_wrench
from muscle_analyzer.core.multibody.joint_reaction import compute_joint_reactions
from muscle_analyzer.core.multibody.kinematics import compute_kinematics
from muscle_analyzer.core.muscles.curves import fill_strength
from muscle_analyzer.core.muscles.paths import apply_muscle_forces, compute_muscle_paths
from muscle_analyzer.core.recruitment.muscle_recruitment import Actuators, recruit

_inner: Final = njit(error_model='numpy', no_cpython_wrapper=True)
"""Compile a function that only compiled functions call, without a wrapper for Python."""


@kernel
def _copy(source: Array, target: Array, k: int) -> None:
    """Copy into row k, element by element: slices cost the compiler seconds."""
    for i in range(source.size):
        target[k, i] = source[i]


@kernel
def _follow(model: SampleModel, workspace: Workspace, q: Array, qd: Array, qdd: Array) -> None:
    """Fill the coordinates of the balanced model from those of the coupled model."""
    for i in range(model.source.size):
        gain = model.gain[i]
        workspace.q[i] = gain * q[model.source[i]] + model.offset[i]
        workspace.qd[i] = gain * qd[model.source[i]]
        workspace.qdd[i] = gain * qdd[model.source[i]]


@kernel
def _muscle_strength(model: SampleModel, workspace: Workspace, qd: Array) -> None:
    """Fill the muscle forces per unit activation and without activation."""
    if not model.force_length_velocity:
        for m in range(workspace.active.size):
            workspace.active[m] = model.muscles.max_isometric_force[m]
            workspace.passive[m] = 0.0
        return
    start, index, arm = model.paths.crossed_start, model.paths.crossed_index, workspace.paths.arm
    for m in range(workspace.speed.size):
        workspace.speed[m] = 0.0
        for c in range(start[m], start[m + 1]):
            workspace.speed[m] -= arm[c] * qd[index[c]]
    fill_strength(
        model.muscles, workspace.paths.length, workspace.speed, model.passive_force,
        workspace.active, workspace.passive,
    )  # fmt: skip


@kernel
def compute_joint_torques(model: SampleModel, workspace: Workspace, external: Array) -> int:
    """Compute joint torques, muscle paths and muscle strength of one sample.

    Parameters
    ----------
    model
        The model.
    workspace
        Has the coordinates of the balanced model; receives the results.
    external : (n_b, 6)
        Wrenches on the bodies from outside (see `inverse_dynamics.add_force`).

    Returns
    -------
    int
        First coordinate whose torque or moment arms are not finite, or -1.
    """
    q, qd, qdd = workspace.q, workspace.qd, workspace.qdd
    compute_kinematics(model.tree, q, qd, qdd, workspace.kinematics, workspace.state)
    compute_inverse_dynamics(model.tree, workspace.state, external, workspace.dynamics)
    compute_muscle_paths(model.paths, workspace.state, workspace.path_workspace, workspace.paths)
    _muscle_strength(model, workspace, qd)
    torque, to_balance = workspace.torque, workspace.to_balance
    wrong = -1
    for j in range(torque.size):
        torque[j] = workspace.dynamics.force[model.balanced[j]]
        to_balance[j] = torque[j]
        if wrong < 0 and not np.isfinite(torque[j]):
            wrong = j
    start, index, arm = model.paths.crossed_start, model.paths.crossed_index, workspace.paths.arm
    first, row, value = workspace.columns
    n = 0
    for m in range(workspace.active.size):
        first[m] = n
        for c in range(start[m], start[m + 1]):
            j = model.row[index[c]]
            if j < 0:
                continue
            row[n] = j
            value[n] = arm[c] * workspace.active[m]
            to_balance[j] -= arm[c] * workspace.passive[m]
            if not np.isfinite(value[n]) and (wrong < 0 or j < wrong):
                wrong = j
            n += 1
    first[workspace.active.size] = n
    return wrong


@kernel
def compute_sample_loads(
    model: SampleModel, workspace: Workspace, out: SampleLoads, k: int
) -> None:
    """Compute muscle forces, joint reactions and net moments of sample k.

    Parameters
    ----------
    model
        The model.
    workspace
        After `compute_joint_torques` of the sample.
    out
        Has the activations; receives forces, reactions and net moments.
    k
        Index of the sample in it.
    """
    state, l5, root = workspace.state, model.lumbosacral, model.root
    joint_wrench, reaction = workspace.dynamics.joint_wrench, workspace.reaction
    for i in range(workspace.force.size):
        workspace.force[i] = out.activation[k, i] * workspace.active[i] + workspace.passive[i]
        out.force[k, i] = workspace.force[i]
    paths = model.paths
    apply_muscle_forces(
        paths.body_start, paths.body_index, workspace.paths.wrench, workspace.force, reaction
    )
    compute_joint_reactions(model.tree, joint_wrench, reaction)
    knee = 0.5 * (workspace.q[model.knees[0]] + workspace.q[model.knees[1]])
    turn_disc(model.disc, state.rotation[l5], state.rotation[model.thorax], knee, workspace.disc)
    for i in range(3):
        for j in range(3):
            out.disc_pose[k, i, j] = workspace.disc[i, j]
        out.disc_pose[k, i, 3] = state.joint_position[l5, i]
    joint_loads(
        model.joints, reaction, state.joint_position, state.rotation, workspace.disc,
        out.joint_force[k], out.joint_moment[k],
    )  # fmt: skip
    joint_loads(
        model.joints, joint_wrench, state.joint_position, state.rotation, workspace.disc,
        out.joint_net_force[k], out.joint_net_moment[k],
    )  # fmt: skip
    centre = state.joint_position[l5]
    refer_wrench(joint_wrench[l5], centre, workspace.net[0])
    refer_wrench(joint_wrench[root], centre, workspace.net[1])
    for i in range(3):
        # The wrenches of all bodies add up to what is left over at the root.
        out.net_moment[k, 0, i] = workspace.net[0, i]
        out.net_moment[k, 1, i] = workspace.net[0, i] - workspace.net[1, i]
    refer_wrench(reaction[l5], centre, out.reaction[k])
    refer_wrench(joint_wrench[root], state.position[root], out.pelvis_residual[k])


@_inner
def _recruit(
    actuators: Actuators, workspace: Workspace, warm_start: Array, out: SampleLoads, k: int
) -> None:
    """Distribute the torques of sample k over the muscles."""
    found = recruit(actuators, workspace.columns, workspace.to_balance, warm_start)
    _copy(found.activation, out.activation, k)
    _copy(found.reserve, out.reserve, k)
    _copy(found.multiplier, out.multiplier, k)
    _copy(found.imbalance, out.imbalance, k)
    for j in range(found.weak.size):
        out.weak[k, j] = found.weak[j]
    out.iterations[k] = found.iterations
    out.converged[k] = found.converged
    out.residuals[k, 0], out.residuals[k, 1], out.residuals[k, 2] = found.residuals


@njit(error_model='numpy', nogil=True)
def solve_samples(
    boxed: Boxed[tuple[SampleModel, Workspace]],
    q: Array,
    qd: Array,
    qdd: Array,
    external: Array,
    warm_start: Array,
    out: SampleLoads,
) -> None:
    """Solve the samples of a block, each from the solution of the one before.

    Parameters
    ----------
    boxed
        The model and its workspace.
    q, qd, qdd : (n, n_q)
        Independent coordinates, rates and accelerations [rad or m, per s, per s^2].
    external : (n, n_b, 6)
        Wrenches on the bodies from outside (see `inverse_dynamics.add_force`).
    warm_start : (2, n_c)
        Multipliers of the two samples before (see `muscle_recruitment.extrapolate_warm_start`);
        updated.
    out
        Receives the solutions.
    """
    model, workspace = boxed.content
    for k in range(q.shape[0]):
        _follow(model, workspace, q[k], qd[k], qdd[k])
        out.wrong[k] = compute_joint_torques(model, workspace, external[k])
        _copy(workspace.torque, out.torque, k)
        _copy(workspace.to_balance, out.to_balance, k)
        if out.wrong[k] < 0:
            _recruit(model.actuators, workspace, warm_start, out, k)
            compute_sample_loads(model, workspace, out, k)
