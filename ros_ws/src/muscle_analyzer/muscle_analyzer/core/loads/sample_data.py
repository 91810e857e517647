# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Model, workspace and results of the analysis of a sample of motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.typing import Array, BoolArray, IntArray
from muscle_analyzer.core.loads.disc_frame import DiscSetting
from muscle_analyzer.core.loads.joint_loads import JointFrames
from muscle_analyzer.core.multibody.inverse_dynamics import InverseDynamics, allocate_dynamics
from muscle_analyzer.core.multibody.kinematics import (
    BodyState,
    KinematicsWorkspace,
    allocate_kinematics,
)
from muscle_analyzer.core.multibody.model import Tree
from muscle_analyzer.core.muscles.curves import MuscleParameters
from muscle_analyzer.core.muscles.path_table import PathTable
from muscle_analyzer.core.muscles.paths import CrossedPaths, PathWorkspace, allocate_paths
from muscle_analyzer.core.recruitment.dual_newton import Columns
from muscle_analyzer.core.recruitment.muscle_recruitment import Actuators, Recruitment, Residuals


class SampleModel(NamedTuple):
    """Everything about a model that the analysis of a sample needs.

    Attributes
    ----------
    source, gain, offset : (n_x,)
        See `lumbar_balance.BalancedModel`.
    tree : Tree
    paths : PathTable
    muscles : MuscleParameters
    actuators : Actuators
    joints : JointFrames
    disc : DiscSetting
    balanced : (n_c,) int
        Independent coordinates whose torques muscles and reserves balance.
    row : (n_x,) int
        Place of each independent coordinate among them, or -1.
    root, lumbosacral, thorax : int
        Numbers of the bodies.
    knees : (2,) int
        Coordinates of the knees.
    force_length_velocity, passive_force : bool
        Whether lengths and velocities change muscle strength, and stretched fibres resist.
    """

    source: IntArray
    gain: Array
    offset: Array
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


class Workspace(NamedTuple):
    """Arrays that the analysis of a sample writes to: allocated once, overwritten by every sample.

    Attributes
    ----------
    q, qd, qdd : (n_x,)
        Coordinates of the balanced model, rates and accelerations.
    kinematics : KinematicsWorkspace
    state : BodyState
    dynamics : InverseDynamics
    path_workspace : PathWorkspace
    paths : CrossedPaths
    speed : (n_m,)
        Of the paths, lengthening positive [m/s].
    active, passive : (n_m,)
        Muscle force per unit activation, and without activation [N].
    torque : (n_c,)
        Net joint torque of each balanced coordinate [N m].
    to_balance : (n_c,)
        The same less what passive muscle forces do [N m].
    columns : Columns
        Torque of each muscle at full activation [N m].
    force : (n_m,)
        Muscle forces along the tendon [N].
    reaction : (n_b, 6)
        See `joint_reaction.joint_reactions`.
    disc : (3, 3)
        Ground <- L5-S1 disc.
    net : (2, 6)
        Wrenches at L5-S1: of what it carries, and of what is left over at the root.
    """

    q: Array
    qd: Array
    qdd: Array
    kinematics: KinematicsWorkspace
    state: BodyState
    dynamics: InverseDynamics
    path_workspace: PathWorkspace
    paths: CrossedPaths
    speed: Array
    active: Array
    passive: Array
    torque: Array
    to_balance: Array
    columns: Columns
    force: Array
    reaction: Array
    disc: Array
    net: Array


def allocate_workspace(model: SampleModel) -> Workspace:
    """Return the workspace of a model."""
    n_b, n_m, n_c = model.tree.parent.size, model.actuators.lower.size, model.balanced.size
    n_k, n_x = model.paths.crossed_index.size, model.source.size
    kinematics, state = allocate_kinematics(model.tree)
    path_workspace, paths = allocate_paths(model.paths, n_b)
    return Workspace(
        q=np.empty(n_x),
        qd=np.empty(n_x),
        qdd=np.empty(n_x),
        kinematics=kinematics,
        state=state,
        dynamics=allocate_dynamics(model.tree),
        path_workspace=path_workspace,
        paths=paths,
        speed=np.empty(n_m),
        active=np.empty(n_m),
        passive=np.empty(n_m),
        torque=np.empty(n_c),
        to_balance=np.empty(n_c),
        columns=Columns(np.empty(n_m + 1, np.int64), np.empty(n_k, np.int64), np.empty(n_k)),
        force=np.empty(n_m),
        reaction=np.empty((n_b, 6)),
        disc=np.empty((3, 3)),
        net=np.empty((2, 6)),
    )


class SampleLoads(NamedTuple):
    """Solutions of n samples.

    Attributes
    ----------
    activation, force : (n, n_m)
        Muscle forces along the tendon [N].
    torque, to_balance : (n, n_c)
        See `Workspace`.
    reserve, multiplier, imbalance : (n, n_c)
        Torque of the reserves, dual solution, what is not balanced [N m, 1 / (N m), N m].
    weak : (n, n_c) bool
        Whether the muscles of a coordinate are too weak.
    residuals : (n, 3)
        See `muscle_recruitment.Residuals`.
    iterations : (n,) int
    converged : (n,) bool
    wrong : (n,) int
        First coordinate whose torque or moment arms are not finite, or -1; nothing else of such a
        sample is valid.
    reaction : (n, 6)
        Moment about the L5-S1 joint's centre and force of S1 on L5 [N m, N].
    disc_pose : (n, 3, 4)
        Rotation ground <- L5-S1 disc, and in the last column the joint's centre [m].
    joint_force, joint_moment : (n, n_j, 3)
        Loads of all joints in their anatomical frames [N, N m]; L5-S1's are those of its disc.
    joint_net_force, joint_net_moment : (n, n_j, 3)
        Of joint and muscles together, in the same frames [N, N m].
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
    imbalance: Array
    weak: BoolArray
    residuals: Array
    iterations: IntArray
    converged: BoolArray
    wrong: IntArray
    reaction: Array
    disc_pose: Array
    joint_force: Array
    joint_moment: Array
    joint_net_force: Array
    joint_net_moment: Array
    net_moment: Array
    pelvis_residual: Array

    def recruitment(self, k: int) -> Recruitment:
        """Return the solution of the static optimisation in sample k."""
        return Recruitment(
            self.activation[k],
            self.reserve[k],
            self.multiplier[k],
            self.imbalance[k],
            self.weak[k],
            int(self.iterations[k]),
            bool(self.converged[k]),
            Residuals(*self.residuals[k].tolist()),
        )

    def discard_dynamics(self, samples: list[int]) -> None:
        """Set to NaN the results that depend on motion and external forces alone."""
        if samples:
            for array in (
                self.torque, self.joint_net_force, self.joint_net_moment, self.net_moment,
                self.pelvis_residual, self.disc_pose,
            ):  # fmt: skip
                array[samples] = np.nan

    def discard_muscles(self, samples: list[int]) -> None:
        """Set to NaN the results that depend on the muscle forces."""
        if samples:
            for array in (
                self.activation, self.force, self.reserve, self.joint_force, self.joint_moment,
            ):  # fmt: skip
                array[samples] = np.nan


def allocate_loads(model: SampleModel, n: int) -> SampleLoads:
    """Return arrays for the solutions of n samples."""
    n_m, n_c, n_j = model.actuators.lower.size, model.balanced.size, model.joints.body.size
    return SampleLoads(
        activation=np.empty((n, n_m)),
        force=np.empty((n, n_m)),
        torque=np.empty((n, n_c)),
        to_balance=np.empty((n, n_c)),
        reserve=np.empty((n, n_c)),
        multiplier=np.empty((n, n_c)),
        imbalance=np.empty((n, n_c)),
        weak=np.empty((n, n_c), np.bool_),
        residuals=np.empty((n, 3)),
        iterations=np.empty(n, np.int64),
        converged=np.empty(n, np.bool_),
        wrong=np.empty(n, np.int64),
        reaction=np.empty((n, 6)),
        disc_pose=np.empty((n, 3, 4)),
        joint_force=np.empty((n, n_j, 3)),
        joint_moment=np.empty((n, n_j, 3)),
        joint_net_force=np.empty((n, n_j, 3)),
        joint_net_moment=np.empty((n, n_j, 3)),
        net_moment=np.empty((n, 2, 3)),
        pelvis_residual=np.empty((n, 6)),
    )
