# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The record of one transition of one alarm."""

from __future__ import annotations

from dataclasses import dataclass

from injury_monitor.core.alarm import AlarmState, Trigger


def occurrence_id(station: str, alarm: str, recording: str, stamp: float, value: float) -> str:
    """Name one occurrence of an alarm so that the same data always give the same name.

    The lift is left out on purpose: its name may be another one when the same recording is seen a
    second time.  The value is part of the name because clocks may begin at zero with each trial:
    other data then have the same stamps, and an alarm of theirs must not be taken for one that
    was announced before.

    Parameters
    ----------
    station, alarm, recording : str
        ``recording`` keeps two recordings apart whose clocks both start at zero.
    stamp : float
        Stamp of the raise [s].
    value : float
        Value at the raise, in the unit of the limit.
    """
    return f'{station}/{alarm}/{recording}/{stamp:.6f}/{value:.6g}'


@dataclass(frozen=True)
class AlarmEvent:
    """One transition.

    Attributes
    ----------
    occurrence : str
        The same for all transitions from a raise until the next one; '' before the first raise.
    alarm, station : str
    trigger : Trigger
        Cause of the transition.
    previous_state, state : AlarmState
    severity : int
    value, limit, margin : float
        Value at the transition (the last good one for an operator's command; NaN before any),
        limit, and limit minus value.
    unit, limit_source : str
    stamp : float
        Stamp of the sample that caused the transition [s].
    onset : float
        First sample beyond the limit [s]; NaN before the first raise.
    stamp_raised, stamp_returned, stamp_acknowledged : float
        Of this occurrence [s]; NaN if not yet.
    lift_id : str
        Lift during which it happened; '' outside a lift.
    detail : str
        Joint or muscle concerned; '' for the spine.
    operator, reason : str
        Of an operator's command.
    shelved_until : float
        End of shelving by the clock of the station [s since 1970]; NaN if not shelved.
    historical : bool
        From data that the caller declared to be stored data.
    """

    occurrence: str
    alarm: str
    station: str
    trigger: Trigger
    previous_state: AlarmState
    state: AlarmState
    severity: int
    value: float
    limit: float
    margin: float
    unit: str
    limit_source: str
    stamp: float
    onset: float
    stamp_raised: float
    stamp_returned: float
    stamp_acknowledged: float
    lift_id: str
    detail: str
    operator: str
    reason: str
    shelved_until: float
    historical: bool

    def message(self) -> str:
        """Return the event in words, with value, limit and margin."""
        unit = '' if self.unit == '1' else f' {self.unit}'
        digits = 2 if self.unit == '1' else 0
        about = f' ({self.detail})' if self.detail else ''
        text = (
            f'{self.alarm}{about}: {self.previous_state.name} to {self.state.name} by '
            f'{self.trigger.value}; value {self.value:.{digits}f}{unit}, limit '
            f'{self.limit:.{digits}f}{unit}, margin {self.margin:.{digits}f}{unit}'
        )
        if self.operator:
            text += f'; by {self.operator}'
        if self.reason:
            text += f'; {self.reason}'
        return text
