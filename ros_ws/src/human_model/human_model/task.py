# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A lifting task: the box, its places, how often it is lifted, and how it can be grasped."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

from human_model.exceptions import BoxError
from human_model.fields import Fields

Point = tuple[float, float, float]


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


@dataclass(frozen=True)
class Box:
    """A box and its places.

    Attributes
    ----------
    mass : float
        [kg]; 0: nothing is lifted.
    size : tuple of 3 float
        Depth (forward; twice r2 of equation 4.5), width (between the hands), height [m].
    start, end : tuple of 3 float, or None
        Centre before and after the lift in the laboratory [m]; None: as recorded.
    """

    mass: float
    size: Point = (0.0, 0.0, 0.0)
    start: Point | None = None
    end: Point | None = None

    def __post_init__(self) -> None:
        """Check every field."""
        if not (math.isfinite(self.mass) and self.mass >= 0.0):
            raise BoxError('mass', self.mass, 'a mass of at least 0 kg is needed')
        for name in ('size', 'start', 'end'):
            value = getattr(self, name)
            if value is None and name != 'size':
                continue
            x, y, z = (float(v) for v in value)
            if not all(map(math.isfinite, (x, y, z))):
                raise BoxError(name, (x, y, z), 'finite lengths are needed')
            object.__setattr__(self, name, (x, y, z))
        if min(self.size) < 0.0:
            raise BoxError('size', self.size, 'lengths of at least 0 m are needed')

    @property
    def depth(self) -> float:
        """Extent forward [m]."""
        return self.size[0]


@dataclass(frozen=True)
class Task:
    """The task of a recording.

    Attributes
    ----------
    task_id : str
        Short name.
    box : Box
    work : Work
    description : str
        In words.
    simulated : bool
        Whether the recording was made by a simulation, not by a person.
    """

    task_id: str
    box: Box
    work: Work
    description: str = ''
    simulated: bool = False


def read_work(fields: Fields, *default: Work) -> Work:
    """Take the fields of the work; those that are missing are those of the default, if given."""
    return Work(
        fields.at_least_zero('lifts_per_day', *(work.lifts_per_day for work in default)),
        fields.at_least_zero('lifts_per_minute', *(work.lifts_per_minute for work in default)),
        fields.at_least_zero('duration_hours', *(work.duration_hours for work in default)),
        fields.choice('coupling', COUPLINGS, *(work.coupling for work in default)),
        fields.flag('control_at_destination', False),
    )
