# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a body motion to muscle forces and the L5-S1 reaction: the pipeline of this package.

One sample goes through transfer to the musculoskeletal model, inverse dynamics, static
optimisation (equation 4.10) and joint reaction (equation 4.11).  Live blocks of one sample and
whole lifts take the same way.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import ArrayLike

from human_model.motion import BodyMotion
from human_model.named_subjects import named_subject, subject_names
from human_model.skeleton import Skeleton
from human_model.skeleton_2d import Skeleton2D
from human_model.skeleton_3d import Skeleton3D
from human_model.subject import Subject
from muscle_analyzer.core.exceptions import InputArrayError, NotConfiguredError
from muscle_analyzer.core.loads.analysis import MuscleAnalysis, Origin
from muscle_analyzer.core.loads.block_solver import BlockSolver
from muscle_analyzer.core.loads.disc_frame import disc_option
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.loads.torque_limits import JointTorques, TorqueLimits
from muscle_analyzer.core.osim.model import OsimModel
from muscle_analyzer.core.osim.model_cache import load_model
from muscle_analyzer.core.subject.model import lifting_model_path, subject_model
from muscle_analyzer.core.subject.muscle_strength import force_factors
from muscle_analyzer.core.subject.segment_masses import MassDistribution, segment_masses
from muscle_analyzer.core.transfer.motion_transfer import MotionTransfer

#: Where a motion may come from.
SOURCES = ('live', 'measured', 'predicted')
#: Motions that come while live ones go on: what they need is built before.
STREAMS = (('measured', '3d_40dof'), ('predicted', '3d_40dof'), ('predicted', '2d_10dof'))
_SKELETONS: dict[str, type[Skeleton2D] | type[Skeleton3D]] = {
    '2d_10dof': Skeleton2D,
    '3d_40dof': Skeleton3D,
}


class MuscleAnalyzer:
    """Muscle analysis of one subject.

    Call `configure` once per subject, then `analyze` on block after block.  A live stream of
    blocks is warm-started from sample to sample; lifts start afresh.
    """

    def __init__(self, options: MuscleAnalyzerOptions | None = None) -> None:
        self.options = options or MuscleAnalyzerOptions()
        disc_option(self.options.disc_frame)  # An unknown one is refused here already.
        self._generic: OsimModel | None = None
        self._subject: Subject | None = None
        self._streams: dict[tuple[str, str], tuple[MotionTransfer, BlockSolver]] = {}
        self._limits: dict[str, TorqueLimits] = {}

    def configure(self, subject: Subject) -> None:
        """Scale the model to a subject and prepare everything that a sample needs.

        Raises
        ------
        MuscleAnalyzerError
            If the model cannot be read or scaled.
        HumanModelError
            If the subject's measures cannot be used.
        """
        self._generic = self._generic or self._read()
        skeleton = Skeleton3D.of(subject)
        upright = np.zeros(len(skeleton.coordinates))
        own = self.options.mass_distribution is MassDistribution.SEGMENTS
        self._model = subject_model(
            self._generic,
            skeleton.points(upright),
            skeleton.parameters.lengths,
            subject.mass,
            force_factors(self._generic, subject, self.options.muscle_strength),
            segment_masses(skeleton) if own else None,
        )
        self._subject = subject
        self._streams = {}
        self._limits = {}
        # Live and recorded 3D motion share all compiled functions: load them now.
        self._warm_up(skeleton)

    def prepare(self) -> None:
        """Do what takes time and needs no subject: read the model, load the compiled functions.

        Raises
        ------
        MuscleAnalyzerError
            If the model cannot be read or an option cannot be used.
        """
        self.configure(named_subject(subject_names()[0]))
        self._subject = None

    def _read(self) -> OsimModel:
        return load_model(self.options.model_path or lifting_model_path())

    def _warm_up(self, skeleton: Skeleton) -> None:
        q = skeleton.standing()
        motion = skeleton.body_motion(0.0, q, np.zeros_like(q), np.zeros_like(q))
        self.joint_torques(self.analyze(motion), motion)
        self._streams = {}
        for source, name in STREAMS:
            self._stream(source, name)

    def _stream(self, source: str, skeleton: str) -> tuple[MotionTransfer, BlockSolver]:
        """Give the warm-started solvers of one kind of motion."""
        key = (source, skeleton)
        if key not in self._streams:
            assert self._subject is not None
            own = _SKELETONS[skeleton].of(self._subject)
            self._streams[key] = (
                MotionTransfer(self._model, own),
                BlockSolver(self._model, self.options),
            )
            if skeleton not in self._limits:
                self._limits[skeleton] = TorqueLimits(
                    self._subject, skeleton, own.coordinates, self.options.coefficient_set
                )
        return self._streams[key]

    def new_transfer(self, skeleton: str) -> MotionTransfer:
        """Give a transfer of its own from a skeleton to the subject's model, as `analyze` uses it.

        Parameters
        ----------
        skeleton
            Its name, as in `BodyMotion.skeleton`.

        Raises
        ------
        NotConfiguredError
            If no subject has been given.
        """
        if self._subject is None:
            raise NotConfiguredError('new_transfer: no subject yet, call configure first')
        return MotionTransfer(self._model, _SKELETONS[skeleton].of(self._subject))

    def analyze(
        self,
        motion: BodyMotion,
        lift_id: str = '',
        source: str = 'live',
        tracker_status: ArrayLike | None = None,
        continued: bool = False,
    ) -> MuscleAnalysis:
        """Analyse a block of one or more samples.

        Parameters
        ----------
        motion
            Motion with the forces on feet and hands.
        lift_id
            Identifier of the lift; empty outside one.
        source
            ``'live'``, ``'measured'`` or ``'predicted'``.
        tracker_status
            (n,) SolveStatus of the motion tracker per sample; none if the motion was not tracked.
        continued
            Whether this block goes on where the one before of the same source ended: a lift in
            parts has the same results as in one block (`analysis.JoinedParts`).

        Raises
        ------
        NotConfiguredError
            If no subject has been given.
        TransferError
            If the motion is not one of this subject.
        InputArrayError
            If the source is not known or not every sample has a status.
        """
        if self._subject is None:
            raise NotConfiguredError('analyze: no subject yet, call configure first')
        if source not in SOURCES:
            raise InputArrayError(f'source {source!r}: one of {SOURCES} is needed')
        tracked = np.zeros(len(motion), np.int64)
        if tracker_status is not None:
            tracked = np.asarray(tracker_status, np.int64)
        if tracked.shape != (len(motion),):
            raise InputArrayError(
                f'tracker status of shape {tracked.shape}: one for each of the {len(motion)} '
                'samples is needed'
            )
        transfer, solver = self._stream(source, motion.skeleton)
        if source != 'live' and not continued:
            transfer.reset()
            solver.reset()
        began = time.perf_counter()
        poses = transfer.block(motion)
        elapsed = time.perf_counter() - began
        origin = Origin(lift_id, source, self._subject.pseudonym, self._subject.mass)
        return solver.solve(poses, motion, tracked, origin, elapsed)

    def joint_torques(self, analysis: MuscleAnalysis, motion: BodyMotion) -> JointTorques:
        """Put the joint torques of an analysis beside the dynamic strength of the joints.

        Parameters
        ----------
        analysis
            Of `motion`, by `analyze`.
        motion
            The motion.

        Raises
        ------
        NotConfiguredError
            If no subject has been given.
        InputArrayError
            If the two do not belong together.
        """
        if self._subject is None:
            raise NotConfiguredError('joint_torques: no subject yet, call configure first')
        if motion.skeleton not in self._limits:
            raise InputArrayError(f'no {motion.skeleton} motion has been analysed')
        return self._limits[motion.skeleton].of(analysis, motion)
