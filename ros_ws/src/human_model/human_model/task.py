# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""How often a task is done, and how its box can be grasped."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from human_model.fields import Fields


class Coupling(IntEnum):
    """Hand-to-object coupling of NIOSH 94-110, section 1.3.6; numbers of `Task.msg`."""

    GOOD = 1
    FAIR = 2
    POOR = 3


#: Couplings by the names in files.
COUPLINGS = {coupling.name.lower(): coupling for coupling in Coupling}


@dataclass(frozen=True)
class Work:
    """How often and how long the task is done at a station.

    The limits and the lifting equation check the values that they use, so that a missing one does
    not switch off the others.

    Attributes
    ----------
    lifts_per_day : float
        Selects the shear limit.
    lifts_per_minute, duration_hours : float
        For the revised NIOSH lifting equation; the duration is that of a day [h].
    coupling : Coupling
    control_at_destination : bool
        Whether the box needs significant control where it is put down.
    """

    lifts_per_day: float = 100.0
    lifts_per_minute: float = 0.2
    duration_hours: float = 8.0
    coupling: Coupling = Coupling.FAIR
    control_at_destination: bool = False


def read_work(fields: Fields, *default: Work) -> Work:
    """Take the fields of the work; those that are missing are those of the default, if given."""
    return Work(
        fields.at_least_zero('lifts_per_day', *(work.lifts_per_day for work in default)),
        fields.at_least_zero('lifts_per_minute', *(work.lifts_per_minute for work in default)),
        fields.at_least_zero('duration_hours', *(work.duration_hours for work in default)),
        fields.choice('coupling', COUPLINGS, *(work.coupling for work in default)),
        fields.flag('control_at_destination', False),
    )
