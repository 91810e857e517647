# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The answer to a task that was planned."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from human_model.report import SolveReport
from human_model.subject import Subject
from lift_predictor.core.planning.plan_task import Feet, Placement, PlanTask
from lift_predictor.core.problem.prediction import Prediction

UNKNOWN_FEET: Final = Feet(float('nan'), float('nan'), float('nan'))


@dataclass(frozen=True, eq=False)
class PlannedLift:
    """A planned lift and how it was found.

    Attributes
    ----------
    subject : Subject
        Person.
    task : PlanTask
        The task.
    prediction : Prediction
        The lift; its report holds the status. By the spatial model where the box lies aside.
    feet : Feet
        Place of the feet; NaN where none was found or the task was refused.
    index : float
        Stoop-Squat-Index of the first posture; NaN without a lift, or where C7 is not lowered.
    placements : tuple of Placement
        Places that were tried, if the feet were free.
    """

    subject: Subject
    task: PlanTask
    prediction: Prediction
    feet: Feet = UNKNOWN_FEET
    index: float = float('nan')
    placements: tuple[Placement, ...] = ()

    @property
    def report(self) -> SolveReport:
        """Report of the solve; status 0: good data."""
        return self.prediction.report

    @property
    def value(self) -> float:
        """Effort [s], or minus the mass [kg] where it is maximised; infinite: no lift."""
        if not self.report.ok:
            return float('inf')
        if self.task.box_mass is None:
            return -self.prediction.box_mass
        return self.report.objective
