# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscle forces and L5-S1 loads of a lift or of any body motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from human_model.motion import BodyMotion
from human_model.report import SolveReport
from human_model.subject import Subject
from human_model.typing import Array, IntArray
from lifting.exceptions import IncompleteLiftError
from lifting.lift import Lift
from lifting.prediction import Prediction
from muscle_analyzer.core.loads.analysis import MuscleAnalysis
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.core.loads.equivalent_extensor import equivalent_l5_s1_compression
from muscle_analyzer.core.loads.lumbar_moments import LumbarMoments, lumbar_moments
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.loads.torque_limits import JointTorques

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class SpineLoad:
    """Load of the L5-S1 disc at n samples.

    Attributes
    ----------
    time : ndarray, shape (n,)
        [s].
    compression, anterior_shear, lateral_shear : ndarray, shape (n,)
        [N].
    equivalent_compression : ndarray, shape (n,)
        Compression with one equivalent extensor at 50 mm, as in the models that the limits of
        compression come from (see `equivalent_extensor`) [N].
    status : ndarray, shape (n,)
        SolveStatus; only samples with status 0 are data.
    peak_compression : float
        Of the samples with status 0 [N]; NaN if there is none.
    report : SolveReport
        Of the worst sample.
    """

    time: Array
    compression: Array
    anterior_shear: Array
    lateral_shear: Array
    equivalent_compression: Array
    status: IntArray
    peak_compression: float
    report: SolveReport


@dataclass(frozen=True, eq=False)
class Muscles:
    """Muscles at n samples.

    Attributes
    ----------
    names : tuple of str, n_m
    activation : ndarray, shape (n, n_m)
        0 to 1.
    force : ndarray, shape (n, n_m)
        Along the tendon [N].
    status : ndarray, shape (n,)
        SolveStatus.
    """

    names: tuple[str, ...]
    activation: Array
    force: Array
    status: IntArray


@dataclass(frozen=True, eq=False)
class Loads:
    """Loads of a lift or of a motion.

    Attributes
    ----------
    analysis : MuscleAnalysis
        Everything that was computed.
    torques : JointTorques
        Beside the strength of the joints.
    lift : Lift or None
        What was analysed; None for a motion without a lift.
    """

    analysis: MuscleAnalysis
    torques: JointTorques
    lift: Lift | None

    @property
    def l5_s1(self) -> SpineLoad:
        """Load of the L5-S1 disc."""
        a = self.analysis
        return SpineLoad(
            a.time, a.compression, a.anterior_shear, a.lateral_shear,
            equivalent_l5_s1_compression(a), a.spine_status, a.peak_compression, a.spine_report,
        )  # fmt: skip

    @property
    def muscles(self) -> Muscles:
        """Activations and forces of the muscles."""
        a = self.analysis
        return Muscles(a.muscle_names, a.activation, a.force, a.status)

    @property
    def lumbar_moments(self) -> LumbarMoments:
        """Parts of the net moment at each lumbar level: muscles, reserves, constraints."""
        return lumbar_moments(self.analysis)

    def plot(self) -> Figure:
        """Draw the L5-S1 load with the limits; return the Matplotlib figure."""
        from lifting.plots import plot_spine_load

        lifts_per_day = self.lift.work.lifts_per_day if self.lift and self.lift.work else 0.0
        return plot_spine_load(self.analysis, lifts_per_day)


def analyze(
    lift: Lift | Prediction | BodyMotion,
    subject: Subject | None = None,
    options: MuscleAnalyzerOptions | None = None,
) -> Loads:
    """Compute muscle forces and the L5-S1 load.

    Parameters
    ----------
    lift : Lift, Prediction or BodyMotion
    subject : Subject, optional
        Whose motion it is; needed with a BodyMotion.
    options : MuscleAnalyzerOptions, optional

    Raises
    ------
    NoSolutionError
        If the prediction has no solution.
    IncompleteLiftError
        If the subject of a motion is missing.
    MuscleAnalyzerError
        If the musculoskeletal model is missing or does not fit the motion.
    """
    if isinstance(lift, BodyMotion):
        if subject is None:
            raise IncompleteLiftError('', 'the subject')
        return _loads(subject, options, lift, None, None)
    found = lift.lift if isinstance(lift, Prediction) else lift
    return _loads(found.subject, options, found.motion, found.status, found)


def _loads(
    subject: Subject,
    options: MuscleAnalyzerOptions | None,
    motion: BodyMotion,
    status: IntArray | None,
    lift: Lift | None,
) -> Loads:
    analyzer = MuscleAnalyzer(subject, options)
    lift_id, source = ('', 'measured') if lift is None else (lift.lift_id, lift.source)
    analysis = analyzer.analyze(motion, lift_id, source, status)
    return Loads(analysis, analyzer.joint_torques(analysis, motion), lift)
