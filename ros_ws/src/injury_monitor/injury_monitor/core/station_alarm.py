# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""One alarm of one station: its condition, its state, its occurrences."""

from __future__ import annotations

import math
from dataclasses import dataclass

from injury_monitor.core.alarm import (
    ACTIVE_STATES,
    PROCESS_TRIGGERS,
    AlarmState,
    Trigger,
    next_state,
)
from injury_monitor.core.alarm_event import AlarmEvent, occurrence_id
from injury_monitor.core.alarm_settings import AlarmSettings
from injury_monitor.core.condition import EdgeKind, LimitCondition
from injury_monitor.core.exceptions import AlarmCommandError
from injury_monitor.core.limits import Limit

_NAN = math.nan


@dataclass(frozen=True)
class Sample:
    """One good value for an alarm.

    Attributes
    ----------
    stamp : float
        [s].
    value : float
    lift_id, detail : str
        ``detail`` names the joint or muscle the value belongs to.
    historical : bool
        Whether the data are stored data.
    """

    stamp: float
    value: float
    lift_id: str = ''
    detail: str = ''
    historical: bool = False


class StationAlarm:
    """State machine of one alarm; all time comes from the stamps given to it.

    Parameters
    ----------
    settings : AlarmSettings
    limit : Limit
    station, recording : str
        Parts of the occurrence's name.
    max_gap : float
        See :class:`LimitCondition` [s].
    known : set of str
        Occurrences already announced, shared by the alarms of a station. A raise that is in the
        set comes from data seen before: it is withheld together with the return that follows.
    """

    def __init__(
        self,
        settings: AlarmSettings,
        limit: Limit,
        station: str,
        recording: str,
        max_gap: float,
        known: set[str],
    ) -> None:
        self.settings = settings
        self.station = station
        self.max_gap = max_gap
        self.known = known
        self.state = AlarmState.NORMAL
        self.shelved_until = _NAN
        self.repeats_withheld = 0
        self._tripped = False
        self._muted = False
        self.last_event: AlarmEvent | None = None
        self._last = Sample(_NAN, _NAN)
        self._occurrence = ''
        self._onset = self._raised = self._returned = self._acknowledged = _NAN
        self.recording = recording
        self.condition = self._new_condition(limit)

    def set_limit(self, limit: Limit, recording: str) -> None:
        """Put another limit or recording in force; the state of the alarm stays."""
        condition = self._new_condition(limit)
        condition.active = self.condition.active
        self.recording = recording
        self.condition = condition

    def sample(self, sample: Sample) -> list[AlarmEvent]:
        """Take one good sample and return the transitions it causes."""
        self._last = sample
        edge = self.condition.sample(sample.stamp, sample.value)
        if edge is None:
            return []
        if edge.kind is EdgeKind.RAISE:
            name = occurrence_id(
                self.station, self.settings.alarm, self.recording, edge.stamp, edge.value
            )
            if name in self.known:
                self._muted = True
                self.repeats_withheld += 1
                return []
            self.known.add(name)
            self._occurrence = name
            self._onset, self._raised = edge.onset, edge.stamp
            self._returned = self._acknowledged = _NAN
            self._tripped = self.settings.latching
            return self._apply(Trigger.RAISE, edge.stamp)
        if self._muted:
            self._muted = False
            return []
        self._returned = edge.stamp
        return self._apply(Trigger.CLEAR, edge.stamp)

    def command(
        self,
        trigger: Trigger,
        stamp: float,
        operator: str,
        reason: str = '',
        shelved_until: float = _NAN,
    ) -> list[AlarmEvent]:
        """Apply an operator's command.

        Parameters
        ----------
        trigger : Trigger
        stamp : float
            Of the latest sample [s].
        operator, reason : str
        shelved_until : float
            End of shelving by the clock of the station [s].

        Raises
        ------
        AlarmCommandError
            If it does not apply to the present state; nothing changes then.
        """
        if trigger in PROCESS_TRIGGERS:
            raise AlarmCommandError(f'{trigger.value}: comes from samples, not from an operator')
        before = self.shelved_until
        self.shelved_until = shelved_until if trigger is Trigger.SHELVE else _NAN
        try:
            return self._apply(trigger, stamp, operator, reason)
        except AlarmCommandError:
            self.shelved_until = before
            raise

    def end_shelving(self, now: float, stamp: float) -> list[AlarmEvent]:
        """End a shelving whose time is over; `now` is the clock of the station [s]."""
        if self.state is not AlarmState.SHELVED or not now >= self.shelved_until:
            return []
        self.shelved_until = _NAN
        return self._apply(Trigger.UNSHELVE, stamp, reason='the time is over')

    def restore(self, event: AlarmEvent) -> None:
        """Take over the state that an earlier process recorded with its last event.

        To be called with all events of the alarm in their order: a latching alarm that was raised
        and silenced is known from an earlier one.
        """
        self.last_event = event
        self.state = event.state
        self.shelved_until = event.shelved_until
        self._occurrence = event.occurrence
        self._onset, self._raised = event.onset, event.stamp_raised
        self._returned, self._acknowledged = event.stamp_returned, event.stamp_acknowledged
        self._last = Sample(
            event.stamp, event.value, event.lift_id, event.detail, event.historical
        )
        if event.trigger is Trigger.RAISE:
            self._tripped = self.settings.latching
        elif event.trigger is Trigger.RESET:
            self._tripped = False
        # Of a silent alarm the next samples show whether its condition holds.
        self.condition.active = event.state in ACTIVE_STATES

    def _new_condition(self, limit: Limit) -> LimitCondition:
        return LimitCondition(
            limit,
            self.settings.on_delay,
            self.settings.off_delay,
            self.settings.deadband,
            self.max_gap,
        )

    def _apply(
        self, trigger: Trigger, stamp: float, operator: str = '', reason: str = ''
    ) -> list[AlarmEvent]:
        previous = self.state
        active = self.condition.active and not self._muted
        self.state = next_state(previous, trigger, self.settings.latching, active, self._tripped)
        if self.state is previous:
            return []
        if trigger is Trigger.ACKNOWLEDGE:
            self._acknowledged = stamp
        if trigger is Trigger.RESET:
            self._tripped = False
        self.last_event = self._event(trigger, previous, stamp, operator, reason)
        return [self.last_event]

    def _event(
        self, trigger: Trigger, previous: AlarmState, stamp: float, operator: str, reason: str
    ) -> AlarmEvent:
        limit = self.condition.limit
        return AlarmEvent(
            self._occurrence,
            self.settings.alarm,
            self.station,
            trigger,
            previous,
            self.state,
            self.settings.severity,
            self._last.value,
            limit.value,
            limit.margin(self._last.value),
            limit.unit,
            limit.source,
            stamp,
            self._onset,
            self._raised,
            self._returned,
            self._acknowledged,
            self._last.lift_id,
            self._last.detail,
            operator,
            reason,
            self.shelved_until,
            self._last.historical,
        )
