# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a body motion to muscle forces and the L5-S1 reaction: the pipeline of this package.

One sample goes through transfer to the musculoskeletal model, inverse dynamics, static
optimisation (equation 4.10) and joint reaction (equation 4.11).  Live blocks of one sample and
whole lifts take the same path.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import ArrayLike

from human_model.motion import BodyMotion
from human_model.skeleton import Skeleton
from human_model.skeletons import Skeleton2D, Skeleton3D
from human_model.subject import Subject
from muscle_analyzer.core.exceptions import InputArrayError
from muscle_analyzer.core.loads.analysis import MuscleAnalysis, Origin
from muscle_analyzer.core.loads.block_solver import BlockSolver
from muscle_analyzer.core.loads.disc_frame import disc_option
from muscle_analyzer.core.loads.muscle_model import read_generic_model, scaled_model
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.loads.torque_limits import JointTorques, TorqueLimits
from muscle_analyzer.core.osim.model import OsimModel
from muscle_analyzer.core.transfer.motion_transfer import MotionTransfer

#: Sources of a motion.
SOURCES = ('live', 'measured', 'predicted')
#: Motions that arrive during live ones: their solvers are built in advance.
STREAMS = (('measured', '3d_40dof'), ('predicted', '3d_40dof'), ('predicted', '2d_10dof'))
_SKELETONS: dict[str, type[Skeleton2D] | type[Skeleton3D]] = {
    '2d_10dof': Skeleton2D,
    '3d_40dof': Skeleton3D,
}


class MuscleAnalyzer:
    """Muscle analysis of one subject.

    A live stream of blocks is warm-started from sample to sample; each lift starts afresh.  The
    constructor scales the model and loads the compiled functions, so that the first sample takes
    no longer than the others.

    Parameters
    ----------
    subject : Subject
    options : MuscleAnalyzerOptions, optional
    model : OsimModel, optional
        The generic model, if it has been read before; otherwise it is read from
        ``options.model_path``.

    Raises
    ------
    MuscleAnalyzerError
        If the model cannot be read or scaled, or an option cannot be used.
    HumanModelError
        If the subject's measures cannot be used.
    """

    def __init__(
        self,
        subject: Subject,
        options: MuscleAnalyzerOptions | None = None,
        model: OsimModel | None = None,
    ) -> None:
        self.subject = subject
        self.options = options or MuscleAnalyzerOptions()
        disc_option(self.options.disc_frame)  # Refuses an unknown one before the model is read.
        self.generic_model = model or read_generic_model(self.options)
        skeleton = Skeleton3D.of(subject)
        self._model = scaled_model(self.generic_model, skeleton, subject, self.options)
        self._streams: dict[tuple[str, str], tuple[MotionTransfer, BlockSolver]] = {}
        self._limits: dict[str, TorqueLimits] = {}
        # Live and recorded 3D motion share all compiled functions.
        self._warm_up(skeleton)

    def for_subject(self, subject: Subject) -> MuscleAnalyzer:
        """Return the analyzer of another subject with the same options and generic model."""
        return MuscleAnalyzer(subject, self.options, self.generic_model)

    def _warm_up(self, skeleton: Skeleton) -> None:
        q = skeleton.standing()
        motion = skeleton.body_motion(0.0, q, np.zeros_like(q), np.zeros_like(q))
        self.joint_torques(self.analyze(motion), motion)
        self._streams = {}
        for source, name in STREAMS:
            self._stream(source, name)

    def _stream(self, source: str, skeleton: str) -> tuple[MotionTransfer, BlockSolver]:
        """Return the warm-started solvers of one kind of motion."""
        key = (source, skeleton)
        if key not in self._streams:
            own = _SKELETONS[skeleton].of(self.subject)
            self._streams[key] = (
                MotionTransfer(self._model, own),
                BlockSolver(self._model, self.options),
            )
            if skeleton not in self._limits:
                self._limits[skeleton] = TorqueLimits(
                    self.subject, skeleton, own.coordinates, self.options.coefficient_set
                )
        return self._streams[key]

    def new_transfer(self, skeleton: str) -> MotionTransfer:
        """Return a new transfer from a skeleton to the subject's model, as `analyze` uses it.

        Parameters
        ----------
        skeleton
            Its name, as in `BodyMotion.skeleton`.
        """
        return MotionTransfer(self._model, _SKELETONS[skeleton].of(self.subject))

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
            Whether this block continues the previous one of the same source: a lift in
            parts has the same results as in one block (`analysis.JoinedParts`).

        Raises
        ------
        TransferError
            If the motion is not one of this subject.
        InputArrayError
            If the source is not known or not every sample has a status.
        """
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
        origin = Origin(lift_id, source, self.subject.pseudonym, self.subject.mass)
        return solver.solve(poses, motion, tracked, origin, elapsed)

    def joint_torques(self, analysis: MuscleAnalysis, motion: BodyMotion) -> JointTorques:
        """Return the joint torques of an analysis with the dynamic strength of the joints.

        Parameters
        ----------
        analysis
            Of `motion`, by `analyze`.
        motion
            The motion.

        Raises
        ------
        InputArrayError
            If the two do not belong together.
        """
        return self._limits[motion.skeleton].of(analysis, motion)
