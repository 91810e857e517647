# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of the muscle analysis."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from muscle_analyzer.core.loads.disc_frame import DEFAULT_OPTION
from muscle_analyzer.core.loads.lumbar_balance import AbdomenSupport, LumbarBalance
from muscle_analyzer.core.recruitment.static_optimization import StaticOptimizationOptions
from muscle_analyzer.core.recruitment.weights import MuscleWeighting
from muscle_analyzer.core.subject.muscle_strength import StrengthOptions, StrengthScaling
from muscle_analyzer.core.subject.segment_masses import MassDistribution


@dataclass(frozen=True)
class MuscleAnalyzerOptions:
    """Settings of the analysis.

    Attributes
    ----------
    model_path
        Generic model; None is the lifting full-body model of the pose2sim wheel.
    disc_frame
        Source of the orientation of the L5-S1 disc (see `disc_frame`).
    lumbar_balance
        Lumbar moments that the muscles balance (see `lumbar_balance.LumbarBalance`).
    abdomen
        What carries the pull on the abdominal body (see `lumbar_balance.AbdomenSupport`).
    force_length_velocity
        Whether muscles are weaker away from their optimal length and when they shorten; off, as
        in the reference, they have their isometric force everywhere.
    passive_force
        Whether stretched fibres resist; only with `force_length_velocity`.  The lifting
        full-body model asks for off.
    geodesic_wrapping
        Whether paths over a single cylinder are geodesics or OpenSim's construction.
    strength
        Scaling of the muscle strength (see `muscle_strength.StrengthScaling`).
    strength_ageing
        Only with strength `population`: effect of age on trunk and shoulder muscles (see
        `muscle_strength.StrengthOptions`).
    mass_distribution
        Source of the segment masses (see `segment_masses.MassDistribution`).
    coefficient_set
        Published joint strength data (see `human_model.strength`).
    muscle_weighting
        Weight of an activation in the cost (see `weights.MuscleWeighting`).
    abdominal_activation
        Least activation of the abdominal muscles: co-contraction that the optimisation alone
        never finds.
    static_optimization
        Settings of the solver, the criterion among them.
    """

    model_path: Path | None = None
    disc_frame: str = DEFAULT_OPTION
    lumbar_balance: str = LumbarBalance.COUPLED
    abdomen: str = AbdomenSupport.RHYTHM
    force_length_velocity: bool = False
    passive_force: bool = False
    geodesic_wrapping: bool = False
    strength: StrengthScaling = StrengthScaling.NONE
    strength_ageing: str = 'doherty2003'
    mass_distribution: MassDistribution = MassDistribution.MODEL
    coefficient_set: str = 'anderson2007_nonneg'
    muscle_weighting: str = MuscleWeighting.EQUAL
    abdominal_activation: float = 0.0
    static_optimization: StaticOptimizationOptions = field(
        default_factory=StaticOptimizationOptions
    )

    def as_opensim(self) -> MuscleAnalyzerOptions:
        """Return the options with the lumbar balance of OpenSim."""
        return replace(self, lumbar_balance=LumbarBalance.COUPLED, abdomen=AbdomenSupport.RHYTHM)

    @property
    def muscle_strength(self) -> StrengthOptions:
        """The options of the muscle strength together."""
        return StrengthOptions(self.strength, self.strength_ageing, self.coefficient_set)
