# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The alarms of a station: limit, severity, delays, deadband, latching."""

from __future__ import annotations

from dataclasses import dataclass

from human_model.tables import read_table
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.validation import non_negative


@dataclass(frozen=True)
class AlarmSettings:
    """Settings of one alarm.

    Attributes
    ----------
    alarm : str
        Name.
    limit : str
        Name of the limit in ``data/limits.csv``, or ``shear_in_force``.
    severity : int
        1 to 1000 (range of OPC UA Part 5).
    on_delay, off_delay : float
        [s].
    deadband : float
        Fraction of the limit.
    latching : bool
    """

    alarm: str
    limit: str
    severity: int
    on_delay: float
    off_delay: float
    deadband: float
    latching: bool

    def __post_init__(self) -> None:
        """Refuse settings outside their range."""
        non_negative(f'{self.alarm}.on_delay', self.on_delay)
        non_negative(f'{self.alarm}.off_delay', self.off_delay)
        if not 1 <= self.severity <= 1000:
            raise InvalidInputError(
                f'{self.alarm}.severity', self.severity, 'must lie in 1 to 1000'
            )
        if not 0.0 <= self.deadband < 1.0:
            raise InvalidInputError(f'{self.alarm}.deadband', self.deadband, 'must lie in 0 to 1')


def read_alarm_settings() -> tuple[AlarmSettings, ...]:
    """Read the default settings of ``data/alarms.csv``."""
    columns = 'alarm limit severity on_delay off_delay deadband latching'
    return tuple(
        AlarmSettings(
            row['alarm'],
            row['limit'],
            row.whole('severity'),
            row.number('on_delay'),
            row.number('off_delay'),
            row.number('deadband'),
            row.flag('latching'),
        )
        for row in read_table('injury_monitor', 'alarms.csv', columns)
    )
