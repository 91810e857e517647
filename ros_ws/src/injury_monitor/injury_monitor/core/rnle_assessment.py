# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The revised NIOSH lifting equation applied to both ends of one recorded lift."""

from __future__ import annotations

import math
from dataclasses import dataclass

from injury_monitor.core.assignment import Assignment
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.lifting_equation import (
    LiftingEquation,
    lifting_equation,
    lifting_index_band,
)
from injury_monitor.core.lifting_geometry import LiftEnd, forward_direction, lifting_task


@dataclass(frozen=True)
class LiftEnds:
    """Places of hands and ankles where the lift begins and where it ends."""

    origin: LiftEnd
    destination: LiftEnd


@dataclass(frozen=True)
class LiftingAssessment:
    """Lifting index of one lift.

    Attributes
    ----------
    origin, destination : LiftingEquation or None
        None where the equation could not be formed (the reason stands in ``note``); the
        destination counts only if significant control is needed there.
    governing : str
        ``origin`` or ``destination``: the end with the larger index; '' if there is none.
    lifting_index, recommended_weight_limit : float
        Of the governing end; NaN if there is none.
    band : str
        Exposure band of the index.
    note : str
        Why there is no index; '' if there is one.
    """

    origin: LiftingEquation | None
    destination: LiftingEquation | None
    governing: str
    lifting_index: float
    recommended_weight_limit: float
    band: str
    note: str

    def result(self) -> LiftingEquation | None:
        """Return the equation at the governing end, or None."""
        return self.destination if self.governing == 'destination' else self.origin


def assess_lifting(assignment: Assignment, ends: LiftEnds | None) -> LiftingAssessment:
    """Evaluate the equation for one lift.

    The sagittal direction is that of the feet at the origin, the neutral body position before the
    person turns.

    Parameters
    ----------
    assignment : Assignment
    ends : LiftEnds or None

    Returns
    -------
    LiftingAssessment
        Without an index, and with the reason, where an input is missing or out of range.
    """
    if ends is None:
        return _without('the places of hands and ankles are not known')
    work = assignment.work
    if assignment.box_mass == 0.0:
        return _without('nothing is lifted (box mass 0 kg)')
    travel = float(ends.destination.grip[2] - ends.origin.grip[2])
    try:
        forward = forward_direction(ends.origin.ankles)
        origin, destination = (
            lifting_equation(
                lifting_task(
                    end, travel, forward, work.lifts_per_minute, work.duration_hours, work.coupling
                ),
                assignment.box_mass,
            )
            for end in (ends.origin, ends.destination)
        )
    except InvalidInputError as error:
        return _without(str(error))
    governing, result = 'origin', origin
    if work.control_at_destination and destination.lifting_index > origin.lifting_index:
        governing, result = 'destination', destination
    return LiftingAssessment(
        origin,
        destination,
        governing,
        result.lifting_index,
        result.recommended_weight_limit,
        lifting_index_band(result.lifting_index),
        '',
    )


def _without(note: str) -> LiftingAssessment:
    return LiftingAssessment(None, None, '', math.nan, math.nan, '', note)
