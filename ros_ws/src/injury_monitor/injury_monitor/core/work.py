# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Who works at the station and what is lifted there how often."""

from __future__ import annotations

from dataclasses import dataclass

from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.lifting_equation import Coupling
from injury_monitor.core.validation import non_negative, positive


@dataclass(frozen=True)
class Work:
    """Person and task, on which the limits and the lifting equation depend.

    Attributes
    ----------
    recording : str
        Name of the recording or of the live session; part of every alarm's name.
    subject : str
        Pseudonym; never leaves the station with an alarm.
    body_mass : float
        [kg].
    box_mass : float
        [kg]; 0: nothing is lifted.
    lifts_per_day : float
        Selects the shear limit.
    lifts_per_minute, duration_hours, coupling, control_at_destination
        For the revised NIOSH lifting equation; checked when it is evaluated, so that a missing
        one of these does not switch off the alarms.
    """

    recording: str
    subject: str
    body_mass: float
    box_mass: float
    lifts_per_day: float
    lifts_per_minute: float
    duration_hours: float
    coupling: Coupling
    control_at_destination: bool = False

    def __post_init__(self) -> None:
        """Check the fields that the alarms need."""
        if not self.subject:
            raise InvalidInputError('subject', self.subject, 'must not be empty')
        positive('body_mass', self.body_mass)
        non_negative('box_mass', self.box_mass)
        non_negative('lifts_per_day', self.lifts_per_day)
