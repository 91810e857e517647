# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The muscle analysis of a block: loads from outside, solution, transfer quality, verdicts."""

from __future__ import annotations

import time

import numpy as np
from numba import njit
from numpy.typing import NDArray

from human_model.frames import from_opensim, to_opensim
from human_model.motion import SIDES, BodyMotion
from human_model.report import SolveStatus
from muscle_analyzer.core import verdict
from muscle_analyzer.core.analyzer_options import MuscleAnalyzerOptions
from muscle_analyzer.core.disc_frame import DEGREE
from muscle_analyzer.core.disc_pose import world_poses
from muscle_analyzer.core.frame import FrameLoads
from muscle_analyzer.core.inverse_dynamics import add_force
from muscle_analyzer.core.load_solver import LoadSolver
from muscle_analyzer.core.muscle_analysis import MuscleAnalysis, Origin
from muscle_analyzer.core.subject_model import SubjectModel
from muscle_analyzer.core.transfer import TransferredMotion

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: Bodies that the ground and the box push, and points that tell where hands and feet are; always
#: [right, left].
FEET, HANDS = ('calcn_r', 'calcn_l'), ('hand_r', 'hand_l')
HAND_POINTS = (('wrist_r', 'hand_r'), ('wrist_l', 'hand_l'))
FOOT_POINTS = (('heel_r', 'mtp_r', 'toe_r'), ('heel_l', 'mtp_l', 'toe_l'))
#: Distance [m] and angle [rad] that hands, feet and trunk should keep in the transfer (the
#: project's goals); what is above them is told in the report's message.
DISTANCE_GOAL, ANGLE_GOAL = 0.005, float(np.deg2rad(1.0))
#: Share of the body weight above which the ground's force needs a centre of pressure.
LOADED_SHARE = 0.05
#: Standard acceleration of free fall [m/s^2] (CGPM 1901).
GRAVITY = 9.80665
#: What hangs on motion and forces, and what hangs on the optimisation as well.
DYNAMICS = (
    'torque',
    'disc_position',
    'disc_orientation',
    'net_moment_top_down',
    'net_moment_bottom_up',
    'pelvis_residual',
)
MUSCLES = (
    'activation',
    'force',
    'reserve',
    'l5_s1_force',
    'joint_force',
    'joint_moment',
    'l5_s1_moment',
    'compression_per_degree',
    'anterior_shear_per_degree',
)


@njit(cache=True)
def _wrenches(bodies: IntArray, n_b: int, force: Array, place: Array, moment: Array) -> Array:
    """Give the wrenches (n, n_b, 6) of forces, places and moments (n, n_f, 3) on bodies (n_f,)."""
    n = force.shape[0]
    out = np.zeros((n, n_b, 6))
    for k in range(n):
        for f in range(bodies.size):
            add_force(out[k], bodies[f], force[k, f], place[k, f], moment[k, f])
    return out


class BlockSolver:
    """
    Solver of one stream of blocks.

    Parameters
    ----------
    subject
        The subject's model with its points.
    options
        Settings.
    """

    def __init__(self, subject: SubjectModel, options: MuscleAnalyzerOptions) -> None:
        model = subject.multibody
        self._loads = LoadSolver(model, options)
        self._weight = GRAVITY * model.source.mass
        self._pushed = np.array([model.body_index(name) for name in FEET + HANDS], np.int64)
        points, frames = list(subject.points.names), list(subject.points.frame_names)
        self._hand_points = [[points.index(name) for name in side] for side in HAND_POINTS]
        self._foot_points = [[points.index(name) for name in side] for side in FOOT_POINTS]
        self._thorax = frames.index('thorax')
        self._hand_frames = [frames.index(name) for name in ('hand_r', 'hand_l')]
        self._foot_frames = [frames.index(name) for name in ('foot_r', 'foot_l')]

    def reset(self) -> None:
        """Forget the sample before."""
        self._loads.reset()

    def solve(
        self,
        poses: TransferredMotion,
        motion: BodyMotion,
        tracker_status: IntArray,
        origin: Origin,
        build_time: float,
    ) -> MuscleAnalysis:
        """
        Analyse a transferred block.

        Parameters
        ----------
        poses
            The block on the musculoskeletal model.
        motion
            Block with the forces on feet and hands.
        tracker_status
            (n,) SolveStatus of the motion tracker; a sample that is not good there is not good
            here.
        origin
            Whose block it is and where it comes from.
        build_time
            That the transfer took [s].

        Raises
        ------
        InputArrayError
            If a torque or moment arm is not finite.
        """
        began = time.perf_counter()
        external, forces = self._external(motion)
        loads = self._loads.solve_block(poses.q, poses.qd, poses.qdd, external)
        arrays = self._arrays(poses, loads)
        times = np.array([build_time, time.perf_counter() - began]) / len(motion)
        reports, spine_reports = [], []
        for k in range(len(motion)):
            problems = (
                verdict.tracker_problem(int(tracker_status[k])),
                _fit_problem(poses, k),
                forces[k],
            )
            own = self._loads.report(loads, k, *times.tolist())
            report = verdict.overall(own, problems, _transfer_notes(poses, arrays, k))
            reports.append(report)
            weak = [self._loads.coordinate_names[j] for j in np.flatnonzero(loads.weak[k])]
            spine_reports.append(verdict.spine(report, weak, self._loads.lumbar))
        torque_status = np.array([int(verdict.torques(report)) for report in reports], np.int64)
        unusable = torque_status != SolveStatus.OK
        for names, empty in ((DYNAMICS, unusable), (MUSCLES, unusable | ~loads.converged)):
            if empty.any():
                for name in names:
                    arrays[name][empty] = np.nan
        return MuscleAnalysis(
            lift_id=origin.lift_id,
            source=origin.source,
            pseudonym=origin.pseudonym,
            body_mass=origin.body_mass,
            time=motion.time,
            muscle_names=self._loads.muscle_names,
            coordinate_names=self._loads.coordinate_names,
            joint_names=self._loads.joint_names,
            disc_frame=str(self._loads.disc),
            torque_status=torque_status,
            reports=tuple(reports),
            spine_reports=tuple(spine_reports),
            **arrays,
        )

    def _external(self, motion: BodyMotion) -> tuple[Array, list[verdict.Problem]]:
        """Give the wrenches (n, n_b, 6) of ground and box, OpenSim's axes, and what is wrong."""
        n = len(motion)
        hands = [motion.point_names.index(name) for name in HANDS]
        force, place, moment = np.zeros((3, n, 4, 3))
        place[:, :2] = to_opensim(motion.cop)
        force[:, :2] = to_opensim(motion.ground_force)
        moment[:, :2] = to_opensim(motion.free_moment)
        place[:, 2:] = to_opensim(motion.points[:, hands])
        force[:, 2:] = to_opensim(motion.hand_force)
        loaded = np.asarray(np.isfinite(place[:, :2]).all(axis=2))
        problems = [verdict.Problem()] * n
        for k in np.flatnonzero(~loaded.all(axis=1)).tolist():
            problems[k] = self._ground_problem(loaded[k], np.linalg.norm(force[k, :2], axis=1))
            for side in np.flatnonzero(~loaded[k]):
                place[k, side] = force[k, side] = moment[k, side] = 0.0
        n_b = len(self._loads.model.body_names)
        return _wrenches(self._pushed, n_b, force, place, moment), problems

    def _ground_problem(self, loaded: BoolArray, size: Array) -> verdict.Problem:
        """Say what is wrong with feet that have no centre of pressure."""
        if not loaded.any():
            return verdict.Problem(
                SolveStatus.MUSCLE_NO_GROUND_FORCE, 'no foot is on a force plate'
            )
        side = int(np.argmin(loaded))
        if size[side] <= LOADED_SHARE * self._weight:
            return verdict.Problem()
        return verdict.Problem(
            SolveStatus.MUSCLE_BAD_INPUT,
            f'{SIDES[side]} foot: ground force of {size[side]:.0f} N without centre of pressure',
        )

    def _arrays(self, poses: TransferredMotion, loads: FrameLoads) -> dict[str, Array]:
        """Put solutions into REP-103 axes and beside them the quality of the transfer."""
        l5_s1 = self._loads.lumbosacral
        force = loads.joint_force[:, l5_s1].copy()
        net, residual = from_opensim(loads.net_moment), loads.pelvis_residual.reshape(-1, 2, 3)
        distance, angle = poses.point_distance, poses.frame_angle
        disc_position, disc_orientation = world_poses(loads.disc_pose)
        return {
            'activation': loads.activation,
            'force': loads.force,
            'torque': loads.torque,
            'reserve': loads.reserve,
            'disc_position': disc_position,
            'disc_orientation': disc_orientation,
            'l5_s1_force': force,
            'l5_s1_moment': loads.joint_moment[:, l5_s1].copy(),
            'joint_force': loads.joint_force,
            'joint_moment': loads.joint_moment,
            # Leaning the disc's normal forward turns it towards x, and x towards -z.
            'compression_per_degree': force[:, 0] * DEGREE,
            'anterior_shear_per_degree': force[:, 2] * DEGREE,
            'net_moment_top_down': net[:, 0],
            'net_moment_bottom_up': net[:, 1],
            'pelvis_residual': from_opensim(residual[:, ::-1]).reshape(-1, 6),
            'hand_distance': distance[:, self._hand_points].max(axis=2),
            'foot_distance': distance[:, self._foot_points].max(axis=2),
            'trunk_angle': angle[:, self._thorax],
            'hand_angle': angle[:, self._hand_frames],
            'foot_angle': angle[:, self._foot_frames],
        }


def _fit_problem(poses: TransferredMotion, k: int) -> verdict.Problem:
    """Say what is wrong with the transfer of a sample."""
    if poses.converged[k]:
        return verdict.Problem()
    return verdict.Problem(
        SolveStatus.MUSCLE_TRANSFER_FAILED,
        f'transfer not converged in {poses.iterations[k]} iterations',
    )


def _transfer_notes(poses: TransferredMotion, arrays: dict[str, Array], k: int) -> list[str]:
    """Say where the transfer of a sample misses its goals."""
    notes = []
    for what, name, goal, factor, unit in (
        ('hands', 'hand_distance', DISTANCE_GOAL, 1e3, 'mm'),
        ('feet', 'foot_distance', DISTANCE_GOAL, 1e3, 'mm'),
        ('trunk', 'trunk_angle', ANGLE_GOAL, float(np.rad2deg(1.0)), 'deg'),
        ('hands', 'hand_angle', ANGLE_GOAL, float(np.rad2deg(1.0)), 'deg'),
        ('feet', 'foot_angle', ANGLE_GOAL, float(np.rad2deg(1.0)), 'deg'),
    ):
        value = float(arrays[name][k].max())
        if not value <= goal:
            notes.append(f'transfer leaves {what} off by {factor * value:.1f} {unit}')
    if poses.at_limit[k].any():
        notes.append(f'at the limit of their range: {", ".join(poses.limits(k))}')
    return notes
