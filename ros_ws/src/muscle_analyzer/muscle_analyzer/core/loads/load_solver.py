# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscle forces and L5-S1 reaction of the musculoskeletal model in one state of motion.

Inverse dynamics gives the torques, static optimisation (equation 4.10) distributes them over
the muscles, and the muscle forces give the joint reactions (equation 4.11).
Everything here is in OpenSim's axes.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from human_model.report import SolveReport
from human_model.typing import Array
from muscle_analyzer.core.boxed_tuple import boxed
from muscle_analyzer.core.exceptions import InputArrayError
from muscle_analyzer.core.loads.disc_frame import DiscLoad, disc_option, disc_setting
from muscle_analyzer.core.loads.joint_loads import JointLoad, JointLoadFrames, lumbosacral_body
from muscle_analyzer.core.loads.lumbar_balance import (
    LumbarBalance,
    abdomen_support,
    balanced_model,
    lumbar_balance,
)
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.loads.sample import solve_samples
from muscle_analyzer.core.loads.sample_data import (
    SampleLoads,
    SampleModel,
    allocate_loads,
    allocate_workspace,
)
from muscle_analyzer.core.multibody.joint_reaction import NetMoment
from muscle_analyzer.core.multibody.model import MultibodyModel
from muscle_analyzer.core.muscles.curves import MuscleParameters
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.recruitment.reserves import Reserve, read_reserves
from muscle_analyzer.core.recruitment.static_optimization import MuscleBalance, StaticOptimization
from muscle_analyzer.core.recruitment.weights import least_activations, muscle_weights

#: Bodies and coordinates of the lifting full-body model that the analysis asks for.
ROOT, THORAX = 'pelvis', 'torso'
KNEES = ('knee_angle_r', 'knee_angle_l')


@dataclass(frozen=True, eq=False)
class LoadSolution:
    """Loads in one state, OpenSim's axes.

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
    """Solver for one model; the optimisation starts from the state solved before.

    Parameters
    ----------
    model
        The subject's model; states are those of its coordinates.
    options
        Settings.
    reserves : tuple of Reserve, optional
        In place of those of the tables, one for each coordinate to balance.

    Attributes
    ----------
    model : MultibodyModel
        The model whose coordinates are balanced (see `lumbar_balance.balanced_model`).

    Raises
    ------
    UnknownNameError
        If the model lacks a body or coordinate that the analysis asks for.
    OptionError
        If an option or the table of reserves cannot be used.
    """

    def __init__(
        self,
        model: MultibodyModel,
        options: MuscleAnalyzerOptions,
        reserves: tuple[Reserve, ...] | None = None,
    ) -> None:
        self.disc = disc_option(options.disc_frame)
        self.lumbar_balance = lumbar_balance(options.lumbar_balance)
        self.abdomen = abdomen_support(options.abdomen)
        free = balanced_model(model, self.lumbar_balance, self.abdomen)
        model = self.model = free.model
        names, balanced = model.coordinate_names, free.balanced
        row = np.full(len(names), -1, np.int64)
        row[balanced] = np.arange(len(balanced))
        self.muscle_names = tuple(muscle.name for muscle in model.source.muscles)
        self.coordinate_names = tuple(names[k] for k in balanced)
        self.lumbar = free.lumbar
        levels = self.lumbar_balance is LumbarBalance.LEVELS
        muscles = MuscleParameters.of(model.source.muscles)
        frames = JointLoadFrames(model, self.disc)
        self.joint_names = frames.names
        self.lumbosacral = frames.joints.lumbosacral
        self.optimization = StaticOptimization(
            self.muscle_names,
            reserves or read_reserves(self.coordinate_names, levels=levels),
            options.static_optimization,
            muscle_weights(muscles, options.muscle_weighting),
            least_activations(self.muscle_names, options.abdominal_activation),
        )
        self.sample_model = SampleModel(
            source=free.source,
            gain=free.gain,
            offset=free.offset,
            tree=model.tree,
            paths=path_table(model, options.geodesic_wrapping),
            muscles=muscles,
            actuators=self.optimization.actuators,
            joints=frames.joints,
            disc=disc_setting(self.disc),
            balanced=balanced,
            row=row,
            root=model.body_index(ROOT),
            lumbosacral=model.body_index(lumbosacral_body(model)),
            thorax=model.body_index(THORAX),
            knees=np.array([model.coordinate_index(name) for name in KNEES], np.int64),
            force_length_velocity=bool(options.force_length_velocity),
            passive_force=bool(options.passive_force),
        )
        self._boxed = boxed((self.sample_model, allocate_workspace(self.sample_model)))

    def reset(self) -> None:
        """Clear the warm start."""
        self.optimization.reset()

    def solve(self, q: Array, qd: Array, qdd: Array, external: Array) -> LoadSolution:
        """Solve one state.

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
        began = time.perf_counter()
        loads = self.solve_block(q[None], qd[None], qdd[None], external[None])
        return self.solution(loads, 0, time.perf_counter() - began)

    def solve_block(self, q: Array, qd: Array, qdd: Array, external: Array) -> SampleLoads:
        """Solve states that follow each other.

        Parameters
        ----------
        q, qd, qdd : (n, n_q)
        external : (n, n_b, 6)
            As in `solve`.

        Raises
        ------
        InputArrayError
            If a torque or moment arm is not finite.
        """
        out = allocate_loads(self.sample_model, len(q))
        solve_samples(
            self._boxed,
            np.ascontiguousarray(q, np.float64),
            np.ascontiguousarray(qd, np.float64),
            np.ascontiguousarray(qdd, np.float64),
            np.ascontiguousarray(external, np.float64),
            self.optimization.warm_start,
            out,
        )
        self._check(out)
        return out

    def solution(self, loads: SampleLoads, k: int, solve_time: float) -> LoadSolution:
        """Return the loads in one state of a block.

        Parameters
        ----------
        loads
            Of the block.
        k
            Number of the state.
        solve_time
            To be reported [s].
        """
        balance = self.optimization.balance(loads.recruitment(k), 0.0, solve_time)
        joints = JointLoad(loads.joint_force[k], loads.joint_moment[k])
        l5 = self.lumbosacral
        above, below = loads.net_moment[k]
        return LoadSolution(
            force=loads.force[k],
            torque=loads.torque[k],
            balance=balance,
            reaction=loads.reaction[k],
            disc=DiscLoad(joints.force[l5], joints.moment[l5]) if balance.converged else None,
            joints=joints,
            net=NetMoment(above, below, above - below),
            residual=loads.pelvis_residual[k],
        )

    def report(
        self, loads: SampleLoads, k: int, build_time: float, solve_time: float
    ) -> SolveReport:
        """Return the report of one state of a block.

        Parameters
        ----------
        loads
            Of the block.
        k
            Number of the state.
        build_time, solve_time
            To be reported [s].
        """
        return self.optimization.report(loads.recruitment(k), build_time, solve_time)

    def _check(self, loads: SampleLoads) -> None:
        if loads.wrong.max(initial=-1) < 0:
            return
        k = int(np.argmax(loads.wrong >= 0))
        j = int(loads.wrong[k])
        raise InputArrayError(
            f'coordinate {self.coordinate_names[j]}: torque {loads.torque[k, j]} or moment arms '
            'are not finite'
        )
