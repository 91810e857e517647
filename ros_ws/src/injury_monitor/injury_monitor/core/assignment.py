# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The person, the box and the work at a station."""

from __future__ import annotations

from dataclasses import dataclass

from human_model.task import Work
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.validation import non_negative, positive


@dataclass(frozen=True)
class Assignment:
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
    work : Work
    """

    recording: str
    subject: str
    body_mass: float
    box_mass: float
    work: Work

    def __post_init__(self) -> None:
        """Check the fields that the alarms need."""
        if not self.subject:
            raise InvalidInputError('subject', self.subject, 'must not be empty')
        positive('body_mass', self.body_mass)
        non_negative('box_mass', self.box_mass)
        non_negative('lifts_per_day', self.work.lifts_per_day)
