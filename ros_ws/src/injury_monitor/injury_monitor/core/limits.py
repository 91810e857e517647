# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Published limits of the L5-S1 load and the choice of the shear limit by loads a day."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

from human_model.tables import read_table
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.validation import non_negative


@dataclass(frozen=True)
class Limit:
    """One limit of one quantity.

    Attributes
    ----------
    name, quantity : str
        Names as in ``data/limits.csv``.
    value : float
        The limit in ``unit``; a load at or above it is beyond the limit.
    unit : str
        ``N``, or ``1`` for an index.
    loads_above, loads_up_to : float
        Loads a day (lower bound excluded, upper bound included) the limit is published for;
        0 and infinity where the source makes no difference.
    source : str
        Publication.
    """

    name: str
    quantity: str
    value: float
    unit: str
    loads_above: float
    loads_up_to: float
    source: str

    def margin(self, value: float) -> float:
        """Return limit minus value; zero or negative means that the limit is reached."""
        return self.value - value


class Zone(IntEnum):
    """NIOSH 1981 zone of a compression force (thesis section 4.2.3)."""

    UNKNOWN = 0
    NOMINAL = 1
    ACTION = 2
    HAZARDOUS = 3


@dataclass(frozen=True)
class LimitSet:
    """The limits in force for one station.

    Attributes
    ----------
    compression_action, compression_maximum : Limit
        NIOSH 1981, 3400 N and 6400 N on L5-S1.
    shear : Limit
        The anterior shear limit for the loads a day of this station.
    torque_index, activation_index : Limit
        Limits of the two indices.
    loads_per_day : float
        Loads per day that select the shear limit.
    shear_within_source : bool
        False if the loads a day lie beyond what the shear limits were published for; then the
        limit of the highest published number of loads is used and may be too high.
    """

    compression_action: Limit
    compression_maximum: Limit
    shear: Limit
    torque_index: Limit
    activation_index: Limit
    loads_per_day: float
    shear_within_source: bool

    def by_name(self, name: str) -> Limit:
        """Return a limit by its name in ``data/limits.csv``, or ``shear_in_force``."""
        if name == 'shear_in_force':
            return self.shear
        fixed = (
            self.compression_action,
            self.compression_maximum,
            self.torque_index,
            self.activation_index,
        )
        for limit in fixed:
            if limit.name == name:
                return limit
        raise InvalidInputError('limit', name, 'is not a limit in force')

    def zone(self, compression: float) -> Zone:
        """Return the NIOSH 1981 zone of a compression force [N]; NaN gives UNKNOWN."""
        if math.isnan(compression):
            return Zone.UNKNOWN
        if compression >= self.compression_maximum.value:
            return Zone.HAZARDOUS
        if compression >= self.compression_action.value:
            return Zone.ACTION
        return Zone.NOMINAL


def read_limits() -> dict[str, Limit]:
    """Read all limits of ``data/limits.csv`` by name."""
    columns = 'limit quantity value unit loads_per_day_above loads_per_day_up_to'
    limits: dict[str, Limit] = {}
    for row in read_table('injury_monitor', 'limits.csv', columns):
        value = row.number('value')
        if not value > 0.0:
            raise row.error('value', 'a number above 0 is needed')
        if row['limit'] in limits:
            raise row.error('limit', 'the limit occurs twice')
        limits[row['limit']] = Limit(
            row['limit'],
            row['quantity'],
            value,
            row['unit'],
            row.number('loads_per_day_above', 0.0),
            row.number('loads_per_day_up_to', math.inf),
            row['source'],
        )
    return limits


def limits_for(loads_per_day: float) -> LimitSet:
    """Return the limits in force.

    Parameters
    ----------
    loads_per_day : float
        How often a day the spine is loaded at this station. Up to 100: the occasional shear
        limit (1000 N); above 100: the repetitive one (700 N), published up to 1000 loads.

    Raises
    ------
    InvalidInputError
        If the number is negative or not finite.
    """
    loads = non_negative('loads_per_day', loads_per_day)
    limits = read_limits()
    shear = sorted(
        (limit for limit in limits.values() if limit.quantity == 'l5_s1_anterior_shear'),
        key=lambda limit: limit.loads_up_to,
    )
    within = [limit for limit in shear if loads <= limit.loads_up_to]
    return LimitSet(
        limits['compression_action'],
        limits['compression_maximum'],
        within[0] if within else shear[-1],
        limits['torque_index'],
        limits['activation_index'],
        loads,
        bool(within),
    )


def zone_meaning(zone: Zone) -> str:
    """Return in words what a NIOSH 1981 zone means."""
    if zone is Zone.UNKNOWN:
        return 'unknown: no solved sample'
    rows = read_table('injury_monitor', 'zones.csv', 'zone code meaning')
    return {row.whole('code'): row['meaning'] for row in rows}[zone]
