# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of the muscle analysis."""

from dataclasses import dataclass, field
from pathlib import Path

from muscle_analyzer.core.disc_frame import DEFAULT_OPTION
from muscle_analyzer.core.recruitment import MuscleWeighting
from muscle_analyzer.core.scaling import StrengthScaling
from muscle_analyzer.core.segment_masses import MassDistribution
from muscle_analyzer.core.static_optimization import StaticOptimizationOptions


@dataclass(frozen=True)
class MuscleAnalyzerOptions:
    """
    Settings of the analysis.

    Attributes
    ----------
    model_path
        Generic model; None is the lifting full-body model of the pose2sim wheel.
    disc_frame
        Source of the orientation of the L5-S1 disc (see `disc_frame`).
    force_length_velocity
        Whether muscles are weaker away from their optimal length and when they shorten; off, as
        in the reference, they have their isometric force everywhere.
    passive_force
        Whether stretched fibres resist; only with `force_length_velocity`.  The lifting
        full-body model asks for off.
    geodesic_wrapping
        Whether paths over a single cylinder are geodesics or OpenSim's construction.
    strength
        How muscle strength follows body mass.
    mass_distribution
        Whose share of the body mass each segment has (see `segment_masses.MassDistribution`).
    coefficient_set
        Published joint strength data (see `human_model.strength`).
    muscle_weighting
        What an activation weighs in the cost (see `recruitment.MuscleWeighting`).
    abdominal_activation
        Least activation of the abdominal muscles: co-contraction that the optimisation alone
        never finds.
    static_optimization
        Settings of the solver, the criterion among them.
    """

    model_path: Path | None = None
    disc_frame: str = DEFAULT_OPTION
    force_length_velocity: bool = False
    passive_force: bool = False
    geodesic_wrapping: bool = False
    strength: StrengthScaling = StrengthScaling.NONE
    mass_distribution: MassDistribution = MassDistribution.MODEL
    coefficient_set: str = 'anderson2007_nonneg'
    muscle_weighting: str = MuscleWeighting.EQUAL
    abdominal_activation: float = 0.0
    static_optimization: StaticOptimizationOptions = field(
        default_factory=StaticOptimizationOptions
    )
