# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Muscle forces and L5-S1 reaction of the musculoskeletal model in one state of motion.

Inverse dynamics gives the torques, static optimisation (equation 4.10) shares them among the
muscles, and what the muscles do to the bodies gives the joint reaction (equation 4.11).
Everything here is in OpenSim's axes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from muscle_analyzer.core.analyzer_options import MuscleAnalyzerOptions
from muscle_analyzer.core.disc_frame import DiscLoad, disc_load, disc_option, disc_rotation
from muscle_analyzer.core.inverse_dynamics import inverse_dynamics, wrench_at
from muscle_analyzer.core.joint_loads import JointLoad, JointLoadFrames, lumbosacral_body
from muscle_analyzer.core.joint_reaction import NetMoment, joint_reactions, net_moment
from muscle_analyzer.core.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody import MultibodyModel
from muscle_analyzer.core.muscle_curves import MuscleParameters
from muscle_analyzer.core.muscle_path_table import path_table
from muscle_analyzer.core.muscle_paths import body_wrenches, posture_paths
from muscle_analyzer.core.recruitment import least_activations, muscle_weights
from muscle_analyzer.core.reserves import read_reserves
from muscle_analyzer.core.static_optimization import MuscleBalance, StaticOptimization

Array = NDArray[np.float64]

#: Bodies and coordinates of the lifting full-body model that the analysis asks for.
ROOT, THORAX = 'pelvis', 'torso'
KNEES = ('knee_angle_r', 'knee_angle_l')
ROOT_COORDINATES = 'pelvis_'
#: Coordinates of the lumbar joints: every muscle that crosses L5-S1 works on them.
LUMBAR_COORDINATES = 'L5_S1_'


@dataclass(frozen=True, eq=False)
class LoadSolution:
    """
    Loads in one state, OpenSim's axes.

    Attributes
    ----------
    force : (n_m,)
        Muscle forces along the tendon [N].
    torque : (n_c,)
        Torque to balance [N m].
    balance : MuscleBalance
        Activations, reserves and report of the static optimisation.
    reaction : (6,)
        Moment about the L5-S1 joint's centre and force of S1 on L5 [N m, N].
    disc : DiscLoad or None
        The reaction in the disc frame; None when the optimisation did not converge.
    joints : JointLoad
        Loads of the joints of `LoadSolver.joint_names` in their anatomical frames.
    net : NetMoment
        Net moment at L5-S1 from both sides [N m].
    residual : (6,)
        Moment about the pelvis' origin and force left over at the pelvis [N m, N].
    """

    force: Array
    torque: Array
    balance: MuscleBalance
    reaction: Array
    disc: DiscLoad | None
    joints: JointLoad
    net: NetMoment
    residual: Array


class LoadSolver:
    """
    Solver for one model; the optimisation starts from the state solved before.

    Parameters
    ----------
    model
        The subject's model.
    options
        Settings.

    Raises
    ------
    UnknownNameError
        If the model lacks a body or coordinate that the analysis asks for.
    OptionError
        If an option or the table of reserves cannot be used.
    """

    def __init__(self, model: MultibodyModel, options: MuscleAnalyzerOptions) -> None:
        self.model = model
        self.disc = disc_option(options.disc_frame)
        self._options = options
        lumbosacral = lumbosacral_body(model)
        self._root, self._l5, self._thorax = map(model.body_index, (ROOT, lumbosacral, THORAX))
        self._knees = [model.coordinate_index(name) for name in KNEES]
        names = model.coordinate_names
        self._balanced = np.array(
            [k for k, name in enumerate(names) if not name.startswith(ROOT_COORDINATES)]
        )
        self.muscle_names = tuple(muscle.name for muscle in model.source.muscles)
        self.coordinate_names = tuple(names[k] for k in self._balanced)
        self.lumbar = tuple(name for name in names if name.startswith(LUMBAR_COORDINATES))
        self._table = path_table(model, options.geodesic_wrapping)
        self._muscles = MuscleParameters.of(model.source.muscles)
        self._frames = JointLoadFrames(model, self.disc)
        self.joint_names = self._frames.names
        self._optimization = StaticOptimization(
            self.muscle_names,
            read_reserves(self.coordinate_names),
            options.static_optimization,
            muscle_weights(self._muscles, options.muscle_weighting),
            least_activations(self.muscle_names, options.abdominal_activation),
        )

    def reset(self) -> None:
        """Forget the state solved before."""
        self._optimization.reset()

    def solve(self, q: Array, qd: Array, qdd: Array, external: Array) -> LoadSolution:
        """
        Solve one state.

        Parameters
        ----------
        q, qd, qdd : (n_q,)
            Independent coordinates, rates and accelerations [rad or m, per s, per s^2].
        external : (n_b, 6)
            Wrenches on the bodies from outside (see `inverse_dynamics.add_force`).

        Raises
        ------
        InputArrayError
            If a torque or moment arm is not finite.
        """
        tree = self.model.tree
        state = forward_kinematics(tree, q, qd, qdd)
        dynamics = inverse_dynamics(tree, state, external)
        jacobian = body_jacobians(tree, state)
        paths = posture_paths(self._table, state, jacobian)
        if self._options.force_length_velocity:
            speed = -paths.moment_arm @ qd
            strength = self._muscles.state(paths.length, speed, self._options.passive_force)
        else:
            strength = self._muscles.isometric()
        arms = paths.moment_arm[:, self._balanced].T
        torque = dynamics.force[self._balanced]
        balance = self._optimization.solve(
            arms * strength.active, torque - arms @ strength.passive
        )
        force = balance.activation * strength.active + strength.passive

        pulls = body_wrenches(self._table, paths.wrench, force, len(self.model.body_names))
        reactions = joint_reactions(tree, dynamics.joint_wrench, pulls)
        reaction = wrench_at(reactions[self._l5], state.joint_position[self._l5])
        knee = float(np.mean(q[self._knees]))
        rotation = disc_rotation(
            self.disc, state.rotation[self._l5], state.rotation[self._thorax], knee
        )
        converged = balance.converged
        return LoadSolution(
            force=force,
            torque=torque,
            balance=balance,
            reaction=reaction,
            disc=disc_load(reaction, rotation) if converged else None,
            joints=self._frames.loads(
                reactions, state.joint_position, state.rotation, rotation
            ),
            net=net_moment(dynamics.joint_wrench, state, self._l5, self._root),
            residual=wrench_at(dynamics.joint_wrench[self._root], state.position[self._root]),
        )
