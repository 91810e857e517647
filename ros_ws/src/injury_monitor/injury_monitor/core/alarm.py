# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Alarm states and their transitions as in ISA-18.2 / IEC 62682, pure data and functions."""

from __future__ import annotations

from enum import Enum, IntEnum

from injury_monitor.core.exceptions import AlarmCommandError


class AlarmState(IntEnum):
    """States of an alarm; the codes are those of the interface package."""

    NORMAL = 0
    UNACKNOWLEDGED_ACTIVE = 1
    ACKNOWLEDGED_ACTIVE = 2
    UNACKNOWLEDGED_RETURNED = 3
    LATCHED_UNACKNOWLEDGED = 4
    LATCHED_ACKNOWLEDGED = 5
    SHELVED = 6
    SUPPRESSED = 7
    OUT_OF_SERVICE = 8


class Trigger(Enum):
    """Causes of a change of the state of an alarm."""

    RAISE = 'raise'
    CLEAR = 'clear'
    ACKNOWLEDGE = 'acknowledge'
    RESET = 'reset'
    SHELVE = 'shelve'
    UNSHELVE = 'unshelve'
    SUPPRESS = 'suppress'
    UNSUPPRESS = 'unsuppress'
    REMOVE_FROM_SERVICE = 'remove from service'
    RETURN_TO_SERVICE = 'return to service'


SILENT_STATES = (AlarmState.SHELVED, AlarmState.SUPPRESSED, AlarmState.OUT_OF_SERVICE)
ANNOUNCED_STATES = tuple(state for state in AlarmState if state not in SILENT_STATES)
ACTIVE_STATES = (AlarmState.UNACKNOWLEDGED_ACTIVE, AlarmState.ACKNOWLEDGED_ACTIVE)
PROCESS_TRIGGERS = (Trigger.RAISE, Trigger.CLEAR)

_S = AlarmState
_T = Trigger
_TABLE: dict[tuple[AlarmState, Trigger], AlarmState] = {
    (_S.NORMAL, _T.RAISE): _S.UNACKNOWLEDGED_ACTIVE,
    (_S.UNACKNOWLEDGED_RETURNED, _T.RAISE): _S.UNACKNOWLEDGED_ACTIVE,
    (_S.LATCHED_UNACKNOWLEDGED, _T.RAISE): _S.UNACKNOWLEDGED_ACTIVE,
    (_S.LATCHED_ACKNOWLEDGED, _T.RAISE): _S.UNACKNOWLEDGED_ACTIVE,
    (_S.UNACKNOWLEDGED_ACTIVE, _T.ACKNOWLEDGE): _S.ACKNOWLEDGED_ACTIVE,
    (_S.UNACKNOWLEDGED_RETURNED, _T.ACKNOWLEDGE): _S.NORMAL,
    (_S.LATCHED_UNACKNOWLEDGED, _T.ACKNOWLEDGE): _S.LATCHED_ACKNOWLEDGED,
    (_S.LATCHED_ACKNOWLEDGED, _T.RESET): _S.NORMAL,
    (_S.SHELVED, _T.REMOVE_FROM_SERVICE): _S.OUT_OF_SERVICE,
    (_S.SUPPRESSED, _T.REMOVE_FROM_SERVICE): _S.OUT_OF_SERVICE,
}
_TABLE.update(
    {
        (state, trigger): target
        for state in ANNOUNCED_STATES
        for trigger, target in (
            (_T.SHELVE, _S.SHELVED),
            (_T.SUPPRESS, _S.SUPPRESSED),
            (_T.REMOVE_FROM_SERVICE, _S.OUT_OF_SERVICE),
        )
    }
)

_CLEAR_PLAIN = {
    _S.UNACKNOWLEDGED_ACTIVE: _S.UNACKNOWLEDGED_RETURNED,
    _S.ACKNOWLEDGED_ACTIVE: _S.NORMAL,
}
_CLEAR_LATCHING = {
    _S.UNACKNOWLEDGED_ACTIVE: _S.LATCHED_UNACKNOWLEDGED,
    _S.ACKNOWLEDGED_ACTIVE: _S.LATCHED_ACKNOWLEDGED,
}
_END_OF_SILENCE = {
    _T.UNSHELVE: _S.SHELVED,
    _T.UNSUPPRESS: _S.SUPPRESSED,
    _T.RETURN_TO_SERVICE: _S.OUT_OF_SERVICE,
}


def next_state(
    state: AlarmState,
    trigger: Trigger,
    latching: bool = False,
    active: bool = False,
    tripped: bool = False,
) -> AlarmState:
    """Return the state after a trigger.

    Parameters
    ----------
    state : AlarmState
    trigger : Trigger
    latching : bool
        The alarm stays after its condition has returned, until it is acknowledged and reset.
    active : bool
        The condition holds now; decides where shelving, suppression and service end.
    tripped : bool
        A latching alarm was raised and not reset since; it must not get lost while silent.

    Returns
    -------
    AlarmState
        The same state where a raise or clear changes nothing (silent alarms, repeated edges).

    Raises
    ------
    AlarmCommandError
        If an operator's command does not apply to this state.
    """
    if trigger is Trigger.CLEAR:
        return (_CLEAR_LATCHING if latching else _CLEAR_PLAIN).get(state, state)
    if trigger in _END_OF_SILENCE and state is _END_OF_SILENCE[trigger]:
        if active:
            return AlarmState.UNACKNOWLEDGED_ACTIVE
        return AlarmState.LATCHED_UNACKNOWLEDGED if latching and tripped else AlarmState.NORMAL
    target = _TABLE.get((state, trigger))
    if target is not None:
        return target
    if trigger in PROCESS_TRIGGERS:
        return state
    raise AlarmCommandError(f'{trigger.value}: not possible in the state {state.name}')
