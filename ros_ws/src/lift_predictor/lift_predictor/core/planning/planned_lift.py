# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The answer to a task that was planned."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from human_model.report import SolveReport
from human_model.subject import Subject
from lift_predictor.core.planning.feet import Placement
from lift_predictor.core.planning.plan_task import PlanTask
from lift_predictor.core.sagittal.prediction import PredictedLift2D

if TYPE_CHECKING:
    from lift_predictor.core.spatial.prediction import PredictedLift3D


@dataclass(frozen=True, eq=False)
class PlannedLift:
    """A planned lift and how it was found.

    Attributes
    ----------
    subject : Subject
        Who lifts.
    task : PlanTask
        What was asked for.
    prediction : PredictedLift2D or PredictedLift3D
        The lift; its report says whether there is one. In space where the box lies aside.
    ankle, left : float
        Middle of the ankles, forward and to the left [m]; NaN where none was found or the task was
        refused.
    heading : float
        Direction of the feet about the vertical, 0: forward, positive to the left [rad].
    index : float
        Stoop-Squat-Index of the first posture; NaN without a lift, or where C7 is not lowered.
    placements : tuple of Placement
        Places that were tried, if the feet were free.
    binding : tuple of str
        Limits that the lift touches, the one that costs most first.
    effort : float
        Effort of a lift in space (first term of equation 3.9) [s]; otherwise NaN.
    """

    subject: Subject
    task: PlanTask
    prediction: PredictedLift2D | PredictedLift3D
    ankle: float
    left: float
    heading: float
    index: float
    placements: tuple[Placement, ...]
    binding: tuple[str, ...]
    effort: float = float('nan')

    @property
    def report(self) -> SolveReport:
        """Report of the solve; status 0: good data."""
        return self.prediction.report

    @property
    def in_space(self) -> bool:
        """Whether it was planned in space."""
        return not isinstance(self.prediction, PredictedLift2D)


@dataclass(frozen=True, eq=False)
class SagittalPlan(PlannedLift):
    """A planned lift in the sagittal plane."""

    prediction: PredictedLift2D


@dataclass(frozen=True, eq=False)
class SpatialPlan(PlannedLift):
    """A planned lift in space."""

    prediction: PredictedLift3D
