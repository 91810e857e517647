# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Revised NIOSH lifting equation (Waters et al. 1993; NIOSH publication 94-110).

Multipliers are computed from the metric formulas and not rounded. The manual rounds them to two
decimals in its tables, so its worked examples differ from these numbers by up to 4 %.
"""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass

from human_model.tables import read_table
from human_model.task import COUPLINGS, Coupling
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.validation import finite, non_negative

# NIOSH 94-110, section 1.3: load constant [kg] and the metric multiplier formulas [cm, deg].
LOAD_CONSTANT = 23.0
MULTIPLIERS = ('HM', 'VM', 'DM', 'AM', 'FM', 'CM')

_H_MIN, _H_MAX = 25.0, 63.0
_V_REFERENCE, _V_SLOPE, _V_MAX = 75.0, 0.003, 175.0
_D_OFFSET, _D_FACTOR, _D_MIN, _D_MAX = 0.82, 4.5, 25.0, 175.0
_A_SLOPE, _A_MAX = 0.0032, 135.0
_LONGEST_DURATION = 8.0


@dataclass(frozen=True)
class LiftingTask:
    """Task variables at one end of a lift, in the units of the equation.

    Attributes
    ----------
    horizontal : float
        H, from the mid-point of the ankles to the mid-point of the hands [cm].
    vertical : float
        V, hands above the floor [cm].
    distance : float
        D, vertical travel of the hands [cm].
    asymmetry : float
        A [deg], 0 to 180.
    lifts_per_minute : float
        F; rarer than 0.2 is taken as 0.2 (NIOSH 94-110, section 1.3.5).
    duration_hours : float
        Hours of lifting a day, up to 8.
    coupling : Coupling
    """

    horizontal: float
    vertical: float
    distance: float
    asymmetry: float
    lifts_per_minute: float
    duration_hours: float
    coupling: Coupling

    def __post_init__(self) -> None:
        """Refuse values the equation has no meaning for."""
        for field in ('horizontal', 'vertical', 'distance', 'lifts_per_minute'):
            non_negative(field, getattr(self, field))
        if not 0.0 <= finite('asymmetry', self.asymmetry) <= 180.0:
            raise InvalidInputError('asymmetry', self.asymmetry, 'must lie in 0 to 180 deg')
        if not 0.0 < finite('duration_hours', self.duration_hours) <= _LONGEST_DURATION:
            raise InvalidInputError(
                'duration_hours', self.duration_hours, 'must lie in 0 (excluded) to 8 h'
            )
        if self.coupling not in tuple(Coupling):
            raise InvalidInputError('coupling', self.coupling, 'must be good, fair or poor')


@dataclass(frozen=True)
class LiftingEquation:
    """Result of the equation at one end of a lift.

    Attributes
    ----------
    task : LiftingTask
    multipliers : tuple of six floats
        HM, VM, DM, AM, FM, CM.
    recommended_weight_limit : float
        RWL [kg].
    lifting_index : float
        LI = load / RWL; infinite where the RWL is zero and something is lifted.
    limiting_multiplier : str
        The smallest multiplier; '' if all are 1.
    """

    task: LiftingTask
    multipliers: tuple[float, float, float, float, float, float]
    recommended_weight_limit: float
    lifting_index: float
    limiting_multiplier: str


def horizontal_multiplier(horizontal: float) -> float:
    """HM = 25 / H: 1 up to 25 cm, 0 beyond 63 cm."""
    if horizontal > _H_MAX:
        return 0.0
    return _H_MIN / max(horizontal, _H_MIN)


def vertical_multiplier(vertical: float) -> float:
    """VM = 1 - 0.003 |V - 75|: 0 beyond 175 cm."""
    if vertical > _V_MAX:
        return 0.0
    return 1.0 - _V_SLOPE * abs(vertical - _V_REFERENCE)


def distance_multiplier(distance: float) -> float:
    """DM = 0.82 + 4.5 / D: 1 up to 25 cm, 0 beyond 175 cm."""
    if distance > _D_MAX:
        return 0.0
    return _D_OFFSET + _D_FACTOR / max(distance, _D_MIN)


def asymmetry_multiplier(asymmetry: float) -> float:
    """AM = 1 - 0.0032 A: 0 beyond 135 deg."""
    return 0.0 if asymmetry > _A_MAX else 1.0 - _A_SLOPE * asymmetry


def frequency_multiplier(lifts_per_minute: float, duration_hours: float, vertical: float) -> float:
    """FM of NIOSH 94-110 table 5, linear between its rows, 0 beyond 15 lifts a minute.

    Durations: short up to 1 h, moderate up to 2 h, long up to 8 h; the recovery the shorter two
    ask for (1.2 and 0.3 times the work time) is the user's statement.
    """
    duration = (
        'short' if duration_hours <= 1.0 else 'moderate' if duration_hours <= 2.0 else 'long'
    )
    column = f'{duration}_{"low" if vertical < _V_REFERENCE else "high"}'
    columns = f'lifts_per_minute {column}'
    rows = read_table('injury_monitor', 'frequency_multipliers.csv', columns)
    rates = [row.number('lifts_per_minute') for row in rows]
    values = [row.number(column) for row in rows]
    for row, before, rate in zip(rows[1:], rates, rates[1:], strict=False):
        if rate <= before:
            raise row.error('lifts_per_minute', 'rates must increase')
    if lifts_per_minute <= rates[0]:
        return values[0]
    if lifts_per_minute > rates[-1]:
        return 0.0
    k = bisect.bisect_left(rates, lifts_per_minute)
    part = (lifts_per_minute - rates[k - 1]) / (rates[k] - rates[k - 1])
    return values[k - 1] + part * (values[k] - values[k - 1])


def coupling_multiplier(coupling: Coupling, vertical: float) -> float:
    """CM of NIOSH 94-110 table 7."""
    rows = read_table('injury_monitor', 'coupling_multipliers.csv', 'coupling low high')
    row = {row.choice('coupling', COUPLINGS): row for row in rows}[coupling]
    return row.number('low' if vertical < _V_REFERENCE else 'high')


def lifting_equation(task: LiftingTask, load: float) -> LiftingEquation:
    """Compute the recommended weight limit and the lifting index.

    Parameters
    ----------
    task : LiftingTask
    load : float
        Mass lifted [kg].

    Returns
    -------
    LiftingEquation
    """
    mass = non_negative('load', load)
    multipliers = (
        horizontal_multiplier(task.horizontal),
        vertical_multiplier(task.vertical),
        distance_multiplier(task.distance),
        asymmetry_multiplier(task.asymmetry),
        frequency_multiplier(task.lifts_per_minute, task.duration_hours, task.vertical),
        coupling_multiplier(task.coupling, task.vertical),
    )
    limit = LOAD_CONSTANT * math.prod(multipliers)
    without_limit = math.inf if mass > 0.0 else 0.0
    index = mass / limit if limit > 0.0 else without_limit
    smallest = min(multipliers)
    limiting = MULTIPLIERS[multipliers.index(smallest)] if smallest < 1.0 else ''
    return LiftingEquation(task, multipliers, limit, index, limiting)


def lifting_index_band(index: float) -> str:
    """Return the exposure band of a lifting index (ISO/TR 12295; NIOSH 94-110, revised 2021)."""
    if math.isnan(index) or index < 0.0:
        raise InvalidInputError('lifting_index', index, 'must not be NaN or negative')
    rows = read_table('injury_monitor', 'lifting_index_bands.csv', 'up_to band')
    return next(row['band'] for row in rows if index <= row.number('up_to', math.inf))
