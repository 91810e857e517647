# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""One sample of the muscle analysis: loads from outside, solution, transfer quality, verdict."""

from __future__ import annotations

import time
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from human_model.frames import from_opensim, to_opensim
from human_model.motion import SIDES, BodyMotion
from human_model.report import SolveReport, SolveStatus
from muscle_analyzer.core import verdict
from muscle_analyzer.core.analyzer_options import MuscleAnalyzerOptions
from muscle_analyzer.core.inverse_dynamics import add_force
from muscle_analyzer.core.load_solver import LoadSolution, LoadSolver
from muscle_analyzer.core.subject_model import SubjectModel
from muscle_analyzer.core.transfer import TransferredPose

Array = NDArray[np.float64]

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
DYNAMICS = ('torque', 'net_moment_top_down', 'net_moment_bottom_up', 'pelvis_residual')
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


@dataclass(frozen=True, eq=False)
class AnalysisSample:
    """One row of `MuscleAnalysis`; the arrays have its names, and its shapes without n."""

    activation: Array
    force: Array
    torque: Array
    reserve: Array
    l5_s1_force: Array
    l5_s1_moment: Array
    joint_force: Array
    joint_moment: Array
    compression_per_degree: float
    anterior_shear_per_degree: float
    net_moment_top_down: Array
    net_moment_bottom_up: Array
    pelvis_residual: Array
    hand_distance: Array
    foot_distance: Array
    trunk_angle: float
    hand_angle: Array
    foot_angle: Array
    torque_status: SolveStatus
    report: SolveReport
    spine_report: SolveReport

    @classmethod
    def array_fields(cls) -> tuple[str, ...]:
        """Give the names of all fields of numbers."""
        verdicts = ('torque_status', 'report', 'spine_report')
        return tuple(field.name for field in fields(cls) if field.name not in verdicts)


class SampleSolver:
    """
    Solver of one stream of samples.

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
        self._feet = [model.body_index(name) for name in FEET]
        self._hands = [model.body_index(name) for name in HANDS]
        points, frames = list(subject.points.names), list(subject.points.frame_names)
        self._hand_points = [[points.index(name) for name in side] for side in HAND_POINTS]
        self._foot_points = [[points.index(name) for name in side] for side in FOOT_POINTS]
        self._thorax = frames.index('thorax')
        self._hand_frames = [frames.index(name) for name in ('hand_r', 'hand_l')]
        self._foot_frames = [frames.index(name) for name in ('foot_r', 'foot_l')]
        self.muscle_names = self._loads.muscle_names
        self.coordinate_names = self._loads.coordinate_names
        self.joint_names = self._loads.joint_names

    def reset(self) -> None:
        """Forget the sample before."""
        self._loads.reset()

    def solve(
        self, pose: TransferredPose, motion: BodyMotion, k: int, tracker_status: int = 0
    ) -> AnalysisSample:
        """
        Analyse one transferred sample.

        Parameters
        ----------
        pose
            The sample on the musculoskeletal model.
        motion
            Block with the forces on feet and hands.
        k
            Number of the sample in it.
        tracker_status
            SolveStatus of the motion tracker; a sample that is not good there is not good here.
        """
        began = time.perf_counter()
        external, forces = self._external(motion, k)
        solution = self._loads.solve(pose.q, pose.qd, pose.qdd, external)
        sample = self._row(pose, solution)
        fit = verdict.Problem()
        if not pose.converged:
            fit = verdict.Problem(
                SolveStatus.MUSCLE_TRANSFER_FAILED,
                f'transfer not converged in {pose.iterations} iterations',
            )
        problems = (verdict.tracker_problem(tracker_status), fit, forces)
        report = verdict.overall(solution.balance.report, problems, _transfer_notes(pose, sample))
        elapsed = time.perf_counter() - began
        report = replace(report, build_time=elapsed - report.solve_time)
        torque_status = verdict.torques(report)
        empty: tuple[str, ...] = ()
        if torque_status is not SolveStatus.OK:
            empty = DYNAMICS + MUSCLES
        elif not solution.balance.converged:
            empty = MUSCLES
        return replace(
            sample,
            **{name: np.full_like(getattr(sample, name), np.nan) for name in empty},
            torque_status=torque_status,
            report=report,
            spine_report=verdict.spine(report, solution.balance.unbalanced, self._loads.lumbar),
        )

    def _external(self, motion: BodyMotion, k: int) -> tuple[Array, verdict.Problem]:
        """Give the wrenches (n_b, 6) from ground and box, OpenSim's axes, and what is wrong."""
        external = np.zeros((len(self._loads.model.body_names), 6))
        force, moment = to_opensim(motion.ground_force[k]), to_opensim(motion.free_moment[k])
        place = to_opensim(motion.cop[k])
        loaded = [bool(np.isfinite(row).all()) for row in place]
        problem = verdict.Problem()
        for side in range(2):
            if loaded[side]:
                add_force(external, self._feet[side], force[side], place[side], moment[side])
            elif np.linalg.norm(force[side]) > LOADED_SHARE * self._weight:
                problem = verdict.Problem(
                    SolveStatus.MUSCLE_BAD_INPUT,
                    f'{SIDES[side]} foot: ground force of {np.linalg.norm(force[side]):.0f} N '
                    'without centre of pressure',
                )
        if not any(loaded):
            problem = verdict.Problem(
                SolveStatus.MUSCLE_NO_GROUND_FORCE, 'no foot is on a force plate'
            )
        grip = to_opensim(np.array([motion.point(name)[k] for name in HANDS]))
        pull = to_opensim(motion.hand_force[k])
        for side in range(2):
            add_force(external, self._hands[side], pull[side], grip[side], np.zeros(3))
        return external, problem

    def _row(self, pose: TransferredPose, solution: LoadSolution) -> AnalysisSample:
        """Put a solution into REP-103 axes and beside it the quality of the transfer."""
        disc, net = solution.disc, solution.net
        nothing = np.full(3, np.nan)
        residual = solution.residual
        return AnalysisSample(
            activation=solution.balance.activation,
            force=solution.force,
            torque=solution.torque,
            reserve=solution.balance.reserve,
            l5_s1_force=disc.force if disc else nothing,
            l5_s1_moment=disc.moment if disc else nothing,
            joint_force=solution.joints.force,
            joint_moment=solution.joints.moment,
            compression_per_degree=disc.compression_per_degree if disc else np.nan,
            anterior_shear_per_degree=disc.shear_per_degree if disc else np.nan,
            net_moment_top_down=from_opensim(net.top_down),
            net_moment_bottom_up=from_opensim(net.bottom_up),
            pelvis_residual=np.concatenate(
                [from_opensim(residual[3:]), from_opensim(residual[:3])]
            ),
            hand_distance=np.array([pose.point_distance[i].max() for i in self._hand_points]),
            foot_distance=np.array([pose.point_distance[i].max() for i in self._foot_points]),
            trunk_angle=float(pose.frame_angle[self._thorax]),
            hand_angle=pose.frame_angle[self._hand_frames],
            foot_angle=pose.frame_angle[self._foot_frames],
            torque_status=SolveStatus.OK,
            report=solution.balance.report,
            spine_report=solution.balance.report,
        )


def _transfer_notes(pose: TransferredPose, sample: AnalysisSample) -> list[str]:
    """Say where the transfer misses its goals."""
    notes = []
    for what, value, goal, factor, unit in (
        ('hands', sample.hand_distance.max(), DISTANCE_GOAL, 1e3, 'mm'),
        ('feet', sample.foot_distance.max(), DISTANCE_GOAL, 1e3, 'mm'),
        ('trunk', sample.trunk_angle, ANGLE_GOAL, np.rad2deg(1.0), 'deg'),
        ('hands', sample.hand_angle.max(), ANGLE_GOAL, np.rad2deg(1.0), 'deg'),
        ('feet', sample.foot_angle.max(), ANGLE_GOAL, np.rad2deg(1.0), 'deg'),
    ):
        if not value <= goal:
            notes.append(f'transfer leaves {what} off by {factor * value:.1f} {unit}')
    if pose.at_limit:
        notes.append(f'at the limit of their range: {", ".join(pose.at_limit)}')
    return notes
