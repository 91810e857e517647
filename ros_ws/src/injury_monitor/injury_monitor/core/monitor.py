# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The injury monitor of one station: samples in, alarm events and assessments out."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from human_model.motion import all_finite
from injury_monitor.core.activation_index import DEFAULT_MAX_GAP, DEFAULT_WINDOW, SlidingMean
from injury_monitor.core.alarm import AlarmState, Trigger
from injury_monitor.core.alarm_event import AlarmEvent
from injury_monitor.core.alarm_settings import AlarmSettings, read_alarm_settings
from injury_monitor.core.assessment import RiskAssessment, assess_lift
from injury_monitor.core.assignment import Assignment
from injury_monitor.core.exceptions import (
    InjuryMonitorError,
    OperatorError,
    ShelveDurationError,
    UnknownAlarmError,
)
from injury_monitor.core.limits import LimitSet, limits_for
from injury_monitor.core.loads import LiftLoads
from injury_monitor.core.rnle_assessment import LiftEnds
from injury_monitor.core.station_alarm import Sample, StationAlarm
from injury_monitor.core.torque_index import worst_torque_index
from injury_monitor.core.validation import array, finite, positive

# Longest shelving [s]: one shift, so that no alarm stays shelved into the next one
# (engineering choice; ISA-18.2 requires a limit and leaves its length to the plant).
DEFAULT_MAX_SHELVE = 8 * 3600.0

_QUANTITIES = (
    'l5_s1_compression',
    'l5_s1_anterior_shear',
    'joint_torque_index',
    'activation_index',
)
_STREAMS = ('spine_load', 'joint_torques', 'activations')


@dataclass
class StreamCounts:
    """Numbers of used and refused samples of one stream.

    Attributes
    ----------
    used : int
        Samples that drove the alarms.
    unsolved : int
        Solve report not good, or a value not finite: neither raises nor clears an alarm.
    out_of_order : int
        Stamp not later than the one before: left out.
    restarts : int
        Jumps of the stamps back by more than the largest gap: a recording played again.
    """

    used: int = 0
    unsolved: int = 0
    out_of_order: int = 0
    restarts: int = 0


class InjuryMonitor:
    """Alarms and assessments of one station.

    The result depends on the samples and their stamps only: the same samples give the same events
    online and offline. A stretch of data that was seen before (same recording, same stamps) does
    not announce its alarms again.

    Parameters
    ----------
    station : str
        Name of the station, not of the worker.
    settings : iterable of AlarmSettings, optional
        Default: ``data/alarms.csv``.
    max_gap : float
        Longest step between two samples that counts as seen time [s].
    activation_window : float
        Of the activation index [s].
    max_shelve : float
        Longest shelving [s].
    history : iterable of AlarmEvent
        Events of earlier processes in their order, from the journal: the alarms go on from the
        state after them, and occurrences in them are not announced again.
    clock : callable
        Clock of the station [s since 1970], by which shelving ends.
    assignment : Assignment, optional
        Person and task; otherwise `configure` sets them later.
    """

    def __init__(
        self,
        station: str = 'station',
        settings: Iterable[AlarmSettings] | None = None,
        max_gap: float = DEFAULT_MAX_GAP,
        activation_window: float = DEFAULT_WINDOW,
        max_shelve: float = DEFAULT_MAX_SHELVE,
        history: Iterable[AlarmEvent] = (),
        clock: Callable[[], float] = time.time,
        assignment: Assignment | None = None,
    ) -> None:
        self.station = station
        self.settings = tuple(read_alarm_settings() if settings is None else settings)
        self.max_gap = positive('max_gap', max_gap)
        self.max_shelve = positive('max_shelve', max_shelve)
        self.activation_window = positive('activation_window', activation_window)
        self._history = list(history)
        self.known = {event.occurrence for event in self._history if event.occurrence}
        self._clock = clock
        self.counts = {stream: StreamCounts() for stream in _STREAMS}
        self.limits: LimitSet | None = None
        self.assignment: Assignment | None = None
        self._mean = SlidingMean(activation_window, max_gap)
        self._stamps: dict[str, float] = {}
        self._alarms: dict[str, StationAlarm] = {}
        self._by_quantity: dict[str, list[StationAlarm]] = {}
        if assignment is not None:
            self.configure(assignment)

    def configure(self, assignment: Assignment) -> LimitSet:
        """Set person and task; alarms keep their state, their limits may change.

        Returns
        -------
        LimitSet
            The limits now in force.
        """
        limits = limits_for(assignment.work.lifts_per_day)
        self._by_quantity = {quantity: [] for quantity in _QUANTITIES}
        for settings in self.settings:
            limit = limits.by_name(settings.limit)
            alarm = self._alarms.get(settings.alarm)
            if alarm is None:
                alarm = StationAlarm(
                    settings, limit, self.station, assignment.recording, self.max_gap, self.known
                )
                self._alarms[settings.alarm] = alarm
                for event in self._history:
                    if event.alarm == settings.alarm:
                        alarm.restore(event)
            else:
                alarm.set_limit(limit, assignment.recording)
            self._by_quantity[limit.quantity].append(alarm)
        if self.assignment is not None and assignment.recording != self.assignment.recording:
            self._stamps.clear()
            self._mean.reset()
        self._history.clear()
        self.assignment = assignment
        self.limits = limits
        return limits

    def update_spine_load(
        self,
        stamp: float,
        compression: float,
        anterior_shear: float,
        solved: bool,
        lift_id: str = '',
        historical: bool = False,
    ) -> list[AlarmEvent]:
        """Take one live sample of the L5-S1 load.

        Parameters
        ----------
        stamp : float
            Of the sample [s].
        compression, anterior_shear : float
            [N], positive as in the interface package.
        solved : bool
            The solve report of this sample is good.
        lift_id : str
            '' outside a lift.
        historical : bool
            Whether the data are stored data; the events are marked then.

        Returns
        -------
        list of AlarmEvent
            Transitions caused by this sample; mostly empty.
        """
        good = solved and math.isfinite(compression) and math.isfinite(anterior_shear)
        if not self._admit('spine_load', stamp, good, _QUANTITIES[:2]):
            return []
        return self._drive(
            'l5_s1_compression', Sample(stamp, compression, lift_id, '', historical)
        ) + self._drive(
            'l5_s1_anterior_shear', Sample(stamp, anterior_shear, lift_id, '', historical)
        )

    def update_joint_torques(
        self,
        stamp: float,
        joints: Sequence[str],
        torque: npt.ArrayLike,
        lower: npt.ArrayLike,
        upper: npt.ArrayLike,
        solved: bool,
        lift_id: str = '',
        historical: bool = False,
    ) -> list[AlarmEvent]:
        """Take one live sample of the joint torques and their dynamic limits [N m], (n_j,).

        A joint whose limits are NaN (no published strength) is left out.
        """
        shape = (len(joints),)
        values = [
            array(field, value, shape)
            for field, value in (('torque', torque), ('lower', lower), ('upper', upper))
        ]
        good = solved and all_finite(values[0])
        worst = worst_torque_index(*values) if good else None
        admitted = self._admit('joint_torques', stamp, worst is not None, _QUANTITIES[2:3])
        if not admitted or worst is None:
            return []
        k, index = worst
        return self._drive(
            'joint_torque_index', Sample(stamp, index, lift_id, joints[k], historical)
        )

    def update_activations(
        self,
        stamp: float,
        muscles: Sequence[str],
        activation: npt.ArrayLike,
        solved: bool,
        lift_id: str = '',
        historical: bool = False,
    ) -> list[AlarmEvent]:
        """Take one live sample of the muscle activations [0..1], (n_m,)."""
        values = array('activation', activation, (len(muscles),))
        good = solved and len(muscles) > 0 and all_finite(values)
        if not self._admit('activations', stamp, good, _QUANTITIES[3:]):
            return []
        mean = self._mean.add(stamp, values)
        if mean is None:
            return []
        k = int(np.argmax(mean))
        return self._drive(
            'activation_index', Sample(stamp, float(mean[k]), lift_id, muscles[k], historical)
        )

    def command(
        self,
        trigger: Trigger,
        alarm: str,
        operator: str,
        reason: str = '',
        duration: float = math.nan,
    ) -> list[AlarmEvent]:
        """Apply an operator's command to one alarm.

        Parameters
        ----------
        trigger : Trigger
            Acknowledge, reset, shelve, unshelve, suppress, unsuppress, remove from or return to
            service.
        alarm : str
        operator, reason : str
            Role or terminal, and why.
        duration : float
            Of shelving [s], more than 0 and not more than ``max_shelve``.

        Raises
        ------
        OperatorError, UnknownAlarmError, AlarmCommandError, ShelveDurationError
            Nothing changes then.
        """
        if not operator.strip():
            raise OperatorError('operator', operator, 'name the role or terminal')
        if alarm not in self._alarms:
            raise UnknownAlarmError(f'alarm {alarm!r} is not one of {sorted(self._alarms)}')
        if trigger is Trigger.SHELVE and not 0.0 < duration <= self.max_shelve:
            raise ShelveDurationError(
                'duration', duration, f'must lie in 0 (excluded) to {self.max_shelve:g} s'
            )
        return self._alarms[alarm].command(
            trigger, self._latest(), operator, reason, self._clock() + duration
        )

    def tick(self) -> list[AlarmEvent]:
        """End the shelvings whose time is over by the clock, also while no samples come."""
        now = self._clock()
        return [
            event
            for alarm in self._alarms.values()
            for event in alarm.end_shelving(now, self._latest())
        ]

    def last_events(self) -> list[AlarmEvent]:
        """Return the last event of each alarm that has one."""
        return [a.last_event for a in self._alarms.values() if a.last_event is not None]

    def states(self) -> dict[str, AlarmState]:
        """Return the state of every alarm."""
        return {name: alarm.state for name, alarm in self._alarms.items()}

    def repeats_withheld(self) -> int:
        """Return how many raises were withheld because they had been announced before."""
        return sum(alarm.repeats_withheld for alarm in self._alarms.values())

    def assess(
        self,
        measured: LiftLoads,
        predicted: LiftLoads | None = None,
        ends: LiftEnds | None = None,
        no_prediction: str = '',
    ) -> RiskAssessment:
        """Assess one whole lift; see :func:`injury_monitor.core.assessment.assess_lift`."""
        assignment, limits = self._configured()
        return assess_lift(
            assignment, limits, measured, predicted, ends, self.activation_window, no_prediction
        )

    def _latest(self) -> float:
        return max(self._stamps.values(), default=0.0)

    def _configured(self) -> tuple[Assignment, LimitSet]:
        if self.assignment is None or self.limits is None:
            raise InjuryMonitorError('no person and task yet: call configure first')
        return self.assignment, self.limits

    def _admit(self, stream: str, stamp: float, good: bool, quantities: Sequence[str]) -> bool:
        """Count a sample; return whether it may drive the alarms of its quantities."""
        self._configured()
        finite(f'{stream}.stamp', stamp)
        counts = self.counts[stream]
        last = self._stamps.get(stream, -math.inf)
        if stamp <= last:
            if last - stamp <= self.max_gap:
                counts.out_of_order += 1
                return False
            counts.restarts += 1
            for alarm in self._alarms_of(quantities):
                alarm.condition.restart()
            if stream == 'activations':
                self._mean.reset()
        self._stamps[stream] = stamp
        if not good:
            counts.unsolved += 1
            for alarm in self._alarms_of(quantities):
                alarm.condition.interrupt()
            return False
        counts.used += 1
        return True

    def _alarms_of(self, quantities: Sequence[str]) -> list[StationAlarm]:
        return [alarm for quantity in quantities for alarm in self._by_quantity[quantity]]

    def _drive(self, quantity: str, sample: Sample) -> list[AlarmEvent]:
        events: list[AlarmEvent] = []
        for alarm in self._by_quantity[quantity]:
            events += alarm.sample(sample)
        return events
