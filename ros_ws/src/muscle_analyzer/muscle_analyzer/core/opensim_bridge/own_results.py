# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The own side of a comparison: the same functions as in the analysis, step by step.

The analysis gives only what its users need; the comparison looks at every step between, and puts
OpenSim's muscle forces into them to tell differences of one step from those of the steps before.
Everything is in OpenSim's ground axes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from human_model.typing import Array
from muscle_analyzer.core.exceptions import OpenSimError
from muscle_analyzer.core.loads.disc_frame import disc_option, disc_rotation
from muscle_analyzer.core.loads.joint_loads import lumbosacral_body
from muscle_analyzer.core.loads.load_solver import KNEES, THORAX, LoadSolver
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.multibody.inverse_dynamics import inverse_dynamics, wrench_at
from muscle_analyzer.core.multibody.joint_reaction import joint_reactions
from muscle_analyzer.core.multibody.kinematics import BodyState, body_jacobians, forward_kinematics
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import MusclePaths, body_wrenches, posture_paths
from muscle_analyzer.core.opensim_bridge.motion_on_model import MotionOnModel
from muscle_analyzer.core.opensim_bridge.results import Answer
from muscle_analyzer.core.recruitment.reserves import read_reserves
from muscle_analyzer.core.recruitment.static_optimization import Criterion, StaticOptimization

Rows = NDArray[np.int64]


class OwnSide:
    """Computes with this project's functions on a motion.

    Parameters
    ----------
    motion : MotionOnModel
    options : MuscleAnalyzerOptions
        The lumbar balance is always that of OpenSim.

    Raises
    ------
    OptionError
        If the optimisation cannot be set up.
    """

    def __init__(self, motion: MotionOnModel, options: MuscleAnalyzerOptions) -> None:
        self.motion = motion
        # OpenSim balances the coupled coordinates.
        self._options = options.as_opensim()
        self._solver = LoadSolver(motion.model, self._options)
        self.muscle_names = self._solver.muscle_names
        self.coordinate_names = self._solver.coordinate_names
        names = motion.model.coordinate_names
        self._balanced = [names.index(name) for name in self.coordinate_names]
        self._table = path_table(motion.model, options.geodesic_wrapping)

    def torques(self) -> Array:
        """Return the torques (n, n_x) of all samples and tree coordinates, N m or N."""
        tree = self.motion.model.tree
        return np.array(
            [
                inverse_dynamics(tree, self._state(k), self.motion.external(k)).tree_force
                for k in range(self.motion.time.size)
            ]
        )

    def answer(self, rows: Rows) -> Answer:
        """Return this project's answer for these samples.

        Raises
        ------
        OpenSimError
            If the optimisation does not converge in one of them: nothing to compare.
        """
        motion = self.motion
        found = []
        for k in rows.tolist():
            self._solver.reset()
            state = (motion.q[k], motion.qd[k], motion.qdd[k])
            loads = self._solver.solve(*state, motion.external(k))
            balance = loads.balance
            if not balance.converged:
                raise OpenSimError(
                    f'{motion.time[k]:.3f} s: nothing to compare, {balance.report.message}'
                )
            paths = self._paths(k)
            arm = paths.moment_arm[:, self._balanced]
            reaction = self.reactions(k, loads.force)
            found.append(
                (paths.length, arm, balance.activation, loads.force, balance.reserve, reaction)
            )
        return Answer(self.torques(), *map(np.array, zip(*found, strict=True)))

    def _state(self, k: int) -> BodyState:
        motion = self.motion
        return forward_kinematics(motion.model.tree, motion.q[k], motion.qd[k], motion.qdd[k])

    def _paths(self, k: int) -> MusclePaths:
        state = self._state(k)
        jacobian = body_jacobians(self.motion.model.tree, state)
        return posture_paths(self._table, state, jacobian)

    def reactions(self, k: int, force: Array) -> Array:
        """Return the reactions (n_b, 6) at all joints under given muscle forces (n_m,), N."""
        tree = self.motion.model.tree
        state = self._state(k)
        dynamics = inverse_dynamics(tree, state, self.motion.external(k))
        wrench = self._paths(k).wrench
        pulls = body_wrenches(self._table, wrench, force, len(self.motion.model.body_names))
        about_ground = joint_reactions(tree, dynamics.joint_wrench, pulls)
        return np.array(
            [wrench_at(w, p) for w, p in zip(about_ground, state.joint_position, strict=True)]
        )

    def optimum(
        self, k: int, force: Array, activation: Array, reserve: Array
    ) -> tuple[float, float, Array]:
        """Distribute the torques that other muscle forces and reserves balance.

        The muscles are as strong as the others': force over activation. The criterion is the sum
        of squares as OpenSim's, whatever that of the analysis is.

        Parameters
        ----------
        k : int
            Sample.
        force, activation : (n_m,) arrays
            N; activations are positive.
        reserve : (n_c,) array
            N m.

        Returns
        -------
        tuple of float, float and (n_m,) array
            Smallest cost, the cost of the given activations (sums of squares), and the forces of
            the smallest cost, N.
        """
        arm = self._paths(k).moment_arm[:, self._balanced]
        strength = force / activation
        reserves = read_reserves(self.coordinate_names)
        unit = np.array([reserve.torque for reserve in reserves])
        # OpenSim has only sums of powers; squares are used.
        options = replace(self._options.static_optimization, criterion=Criterion.SQUARES)
        solver = StaticOptimization(self.muscle_names, reserves, options)
        balance = solver.solve((arm * strength[:, None]).T, arm.T @ force + reserve)
        cost = float(np.sum(activation**2) + np.sum((reserve / unit) ** 2))
        return balance.report.objective, cost, balance.activation * strength

    def disc_rotation(self, k: int) -> Array:
        """Return the rotation (3, 3) ground <- L5-S1 disc in a sample."""
        state, model = self._state(k), self.motion.model
        knee = np.mean([self.motion.q[k, model.coordinate_index(name)] for name in KNEES])
        return disc_rotation(
            disc_option(self._options.disc_frame),
            state.rotation[model.body_index(lumbosacral_body(model))],
            state.rotation[model.body_index(THORAX)],
            float(knee),
        )
