# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The muscle analysis of a block: external loads, solution, quality of the transfer, reports."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from human_model.constants import GRAVITY, SIDES
from human_model.motion import BodyMotion
from human_model.report import SolveReport, SolveStatus
from human_model.typing import BoolArray, IntArray
from muscle_analyzer.core.boxed_tuple import boxed
from muscle_analyzer.core.loads.analysis import MuscleAnalysis, Origin
from muscle_analyzer.core.loads.block_arrays import (
    ANGLE_GOAL,
    DISTANCE_GOAL,
    Loaded,
    OutsideForces,
    Places,
    SolvedArrays,
    outside_wrenches,
    solved_arrays,
)
from muscle_analyzer.core.loads.joint_loads import ABDOMINAL
from muscle_analyzer.core.loads.load_solver import LoadSolver
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.loads.sample_status import (
    NO_ISSUE,
    Issue,
    overall_report,
    spine_report,
    torque_status,
    tracker_issue,
)
from muscle_analyzer.core.subject.model import SubjectModel
from muscle_analyzer.core.transfer.motion_transfer import TransferredMotion

#: Bodies on which ground and box act, and points of hands and feet; always [right, left].
FEET, HANDS = ('calcn_r', 'calcn_l'), ('hand_r', 'hand_l')
HAND_POINTS = (('wrist_r', 'hand_r'), ('wrist_l', 'hand_l'))
FOOT_POINTS = (('heel_r', 'mtp_r', 'toe_r'), ('heel_l', 'mtp_l', 'toe_l'))
#: Fraction of the body weight above which the ground's force needs a centre of pressure.
LOADED_FRACTION = 0.05


class BlockSolver:
    """Solver of one stream of blocks.

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
        self._disc_frame = str(self._loads.disc)
        # The joint of the abdominal body is the last.
        self._n_joints = len(self._loads.joint_names) - (ABDOMINAL in self._loads.joint_names)
        self._weight = GRAVITY * model.source.mass
        points, frames = subject.points.names, subject.points.frame_names
        self._places = boxed(
            Places(
                n_bodies=len(model.body_names),
                feet=_numbers(FEET, model.body_names),
                hands=_numbers(HANDS, model.body_names),
                lumbosacral=self._loads.lumbosacral,
                hand_points=np.array([_numbers(side, points) for side in HAND_POINTS]),
                foot_points=np.array([_numbers(side, points) for side in FOOT_POINTS]),
                thorax=frames.index('thorax'),
                hand_frames=_numbers(HANDS, frames),
                foot_frames=_numbers(('foot_r', 'foot_l'), frames),
            )
        )
        self._point_names: tuple[str, ...] = ()
        self._hands = np.zeros(2, np.int64)

    def reset(self) -> None:
        """Clear the warm start."""
        self._loads.reset()

    def solve(
        self,
        poses: TransferredMotion,
        motion: BodyMotion,
        tracker_status: IntArray,
        origin: Origin,
        build_time: float,
    ) -> MuscleAnalysis:
        """Analyse a transferred block.

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
        given = self._external(motion)
        loads = self._loads.solve_block(poses.q, poses.qd, poses.qdd, given.external)
        arrays = solved_arrays(
            self._places,
            loads.disc_pose,
            loads.joint_force,
            loads.joint_moment,
            loads.net_moment,
            loads.pelvis_residual,
            poses.point_distance,
            poses.frame_angle,
        )
        n = len(motion)
        times = build_time / n, (time.perf_counter() - began) / n
        status = tracker_status.tolist()
        reports, spine_reports = [], []
        for k in range(n):
            issues = (
                tracker_issue(status[k]),
                _transfer_issue(poses, k),
                self._ground_issue(given, motion, k),
            )
            own = self._loads.report(loads, k, *times)
            report = overall_report(own, issues, _transfer_notes(poses, arrays, k))
            reports.append(report)
            spine_reports.append(self._spine_report(report, loads.weak[k]))
        statuses = [torque_status(report) for report in reports]
        unusable = [k for k in range(n) if statuses[k] is not SolveStatus.OK]
        unsolved = np.flatnonzero(~loads.converged).tolist()
        arrays.discard_dynamics(unusable)
        loads.discard_dynamics(unusable)
        arrays.discard_muscles(unusable + unsolved)
        loads.discard_muscles(unusable + unsolved)
        return MuscleAnalysis(
            lift_id=origin.lift_id,
            source=origin.source,
            pseudonym=origin.pseudonym,
            body_mass=origin.body_mass,
            time=motion.time,
            muscle_names=self._loads.muscle_names,
            activation=loads.activation,
            force=loads.force,
            coordinate_names=self._loads.coordinate_names,
            torque=loads.torque,
            reserve=loads.reserve,
            disc_frame=self._disc_frame,
            joint_names=self._loads.joint_names[: self._n_joints],
            joint_force=loads.joint_force[:, : self._n_joints],
            joint_moment=loads.joint_moment[:, : self._n_joints],
            joint_net_force=loads.joint_net_force[:, : self._n_joints],
            joint_net_moment=loads.joint_net_moment[:, : self._n_joints],
            # No joint, no moment: models without an abdominal body.
            abdomen_moment=loads.joint_moment[:, self._n_joints :].sum(axis=1),
            lumbar_balance=str(self._loads.lumbar_balance),
            abdomen=str(self._loads.abdomen),
            torque_status=np.array(statuses, np.int64),
            reports=tuple(reports),
            spine_reports=tuple(spine_reports),
            **_results(arrays),
        )

    def _external(self, motion: BodyMotion) -> Loaded:
        """Return the wrenches of ground and box."""
        if motion.point_names != self._point_names:
            self._hands = _numbers(HANDS, motion.point_names)
            self._point_names = motion.point_names
        return outside_wrenches(
            self._places,
            OutsideForces(
                motion.ground_force,
                motion.centre_of_pressure,
                motion.free_moment,
                motion.hand_force,
                motion.points,
                self._hands,
            ),
        )

    def _spine_report(self, report: SolveReport, weak: BoolArray) -> SolveReport:
        """Return the report of the L5-S1 load of a sample."""
        if report.status is not SolveStatus.MUSCLE_TOO_WEAK:
            return report
        names = [self._loads.coordinate_names[j] for j in np.flatnonzero(weak)]
        return spine_report(report, names, self._loads.lumbar)

    def _ground_issue(self, given: Loaded, motion: BodyMotion, k: int) -> Issue:
        """Return the issue of a sample with a loaded foot that has no centre of pressure."""
        if given.complete[k]:
            return NO_ISSUE
        loaded = given.loaded[k]
        if not loaded.any():
            return Issue(SolveStatus.MUSCLE_NO_GROUND_FORCE, 'no foot is on a force plate')
        side = int(np.argmin(loaded))
        size = float(np.linalg.norm(motion.ground_force[k, side]))
        if size <= LOADED_FRACTION * self._weight:
            return NO_ISSUE
        return Issue(
            SolveStatus.MUSCLE_BAD_INPUT,
            f'{SIDES[side]} foot: ground force of {size:.0f} N without centre of pressure',
        )


def _numbers(wanted: tuple[str, ...], names: tuple[str, ...]) -> IntArray:
    return np.array([names.index(name) for name in wanted], np.int64)


def _results(arrays: SolvedArrays) -> dict[str, Any]:
    """Return the arrays that are results without a change."""
    named = arrays._asdict()
    del named['missed']
    return named


def _transfer_issue(poses: TransferredMotion, k: int) -> Issue:
    """Return the issue of a sample whose transfer did not converge."""
    if poses.converged[k]:
        return NO_ISSUE
    return Issue(
        SolveStatus.MUSCLE_TRANSFER_FAILED,
        f'transfer not converged in {poses.iterations[k]} iterations',
    )


def _transfer_notes(poses: TransferredMotion, arrays: SolvedArrays, k: int) -> list[str]:
    """Return notes on the goals that the transfer of a sample misses."""
    notes = []
    if arrays.missed[k]:
        for what, values, goal, factor, unit in (
            ('hands', arrays.hand_distance, DISTANCE_GOAL, 1e3, 'mm'),
            ('feet', arrays.foot_distance, DISTANCE_GOAL, 1e3, 'mm'),
            ('trunk', arrays.trunk_angle, ANGLE_GOAL, float(np.rad2deg(1.0)), 'deg'),
            ('hands', arrays.hand_angle, ANGLE_GOAL, float(np.rad2deg(1.0)), 'deg'),
            ('feet', arrays.foot_angle, ANGLE_GOAL, float(np.rad2deg(1.0)), 'deg'),
        ):
            value = float(values[k].max())
            if not value <= goal:
                notes.append(f'transfer leaves {what} off by {factor * value:.1f} {unit}')
    if poses.at_limit[k].any():
        notes.append(f'at the limit of their range: {", ".join(poses.limits(k))}')
    return notes
