# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The injury monitor in the graph: loads in, alarms and assessments out."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from time import perf_counter
from typing import ClassVar

from human_model.exceptions import LiftingError
from injury_monitor import conversions, topics
from injury_monitor.core.alarm import Trigger
from injury_monitor.core.alarm_event import AlarmEvent
from injury_monitor.core.exceptions import JournalError
from injury_monitor.core.journal import AlarmJournal
from injury_monitor.core.lift_parts import MEASURED, PREDICTED, LiftCollector, LiftParts
from injury_monitor.core.monitor import InjuryMonitor
from lifting_messages import Message
from lifting_messages.stamps import to_seconds
from lifting_messages.station import Output, Station
from lifting_messages.topics import Quality, Topic


class MonitorStation(Station):
    """Raises alarms from live loads and assesses whole lifts.

    Loads that come before the person and the task wait for them. A lift is assessed when its
    parts have come, or after the parameter `result_wait` without its prediction.

    Parameters
    ----------
    values, name, log, clock
        See `Station`.

    Attributes
    ----------
    monitor : InjuryMonitor
    filter_delay : float
        Of the live loads [s].
    """

    PACKAGE = 'injury_monitor'
    INPUTS = topics.INPUTS
    OUTPUTS: ClassVar[tuple[Topic, ...]] = topics.OUTPUTS

    def prepare(self) -> None:
        """Create the pipeline and the functions of the inputs."""
        self.handlers = {
            'subject': self._on_subject,
            'task': self._on_task,
            'spine_load': self._on_spine_load,
            'joint_torques': self._on_joint_torques,
            'muscle_analysis': self._on_muscle_analysis,
            'measured_lift': self._on_measured_lift,
            'predicted_lift': self._on_predicted_lift,
        }
        path = self.values['journal']
        self._journal = AlarmJournal(path) if path else None
        if self._journal is not None and self._journal.damage:
            self.report_error(self._journal.damage)
        self.monitor = InjuryMonitor(
            self.name or 'station',
            max_gap=self.values['max_gap'],
            activation_window=self.values['activation_window'],
            max_shelve=self.values['max_shelve'],
            history=() if self._journal is None else self._journal.events(),
        )
        self.filter_delay = math.nan
        self._historical: bool = self.values['stored_data']
        self._collector = LiftCollector(self.values['result_wait'])
        self._subject: Message | None = None
        self._task: Message | None = None
        self._early: deque[tuple[str, Message]] = deque(maxlen=Quality.FRAMES.depth)

    def start(self) -> Iterator[Output]:
        """Yield the states of the alarms, also those that an earlier process recorded."""
        return self._states()

    def tick(self) -> Iterator[Output]:
        """Yield the alarms that end by the clock, such as shelved ones."""
        return self._announce(self.monitor.tick())

    def close(self) -> None:
        """Close the journal, so that another process can write."""
        if self._journal is not None:
            self._journal.close()
            self._journal = None

    @property
    def pending(self) -> bool:
        """Whether a lift can be assessed."""
        return self.monitor.assignment is not None and self._collector.any_ready(self._now())

    def work(self, duration: float) -> Iterator[Output]:
        """Assess lifts for about this time [s], at least one."""
        end = perf_counter() + duration
        while self.pending:
            parts = self._collector.take(self._now())
            yield from self._assess(parts, f'none came within {self._collector.wait:g} s')
            if perf_counter() > end:
                return

    def flush(self) -> Iterator[Output]:
        """Assess the lifts that still wait for their prediction."""
        while self.monitor.assignment is not None and self._collector.any_ready(math.inf):
            parts = self._collector.take(math.inf)
            yield from self._assess(parts, 'none came before the end')

    def command(
        self, trigger: Trigger, alarm: str, operator: str, duration: float = math.nan
    ) -> Iterator[Output]:
        """Apply an operator's command; see `InjuryMonitor.command`."""
        return self._announce(self.monitor.command(trigger, alarm, operator, duration=duration))

    def _now(self) -> float:
        return 0.0 if self.clock is None else self.clock()

    def _on_subject(self, message: Message) -> Iterator[Output]:
        self._subject = message
        return self._configure()

    def _on_task(self, message: Message) -> Iterator[Output]:
        self._task = message
        return self._configure()

    def _configure(self) -> Iterator[Output]:
        if self._subject is None or self._task is None:
            return
        limits = self.monitor.configure(conversions.assignment_from_msg(self._subject, self._task))
        self.log.info(
            f'limits: compression {limits.compression_action.value:g} and '
            f'{limits.compression_maximum.value:g} N, anterior shear {limits.shear.value:g} N '
            f'({limits.loads_per_day:g} loads a day)'
        )
        yield from self._states()
        while self._early:
            yield from self.receive(*self._early.popleft())

    def _on_spine_load(self, message: Message) -> Iterator[Output]:
        source = conversions.lift_source(message)
        series = conversions.spine_from_msg(message)
        if source:
            self._collect(message.lift_id, lambda parts: parts.spine.update({source: series}))
        elif self._configured('spine_load', message):
            self.filter_delay = message.filter_delay
            for time, compression, shear, solved in zip(
                series.time, series.compression, series.anterior_shear, series.solved, strict=True
            ):
                events = self.monitor.update_spine_load(
                    float(time),
                    float(compression),
                    float(shear),
                    bool(solved),
                    message.lift_id,
                    self._historical,
                )
                yield from self._announce(events)

    def _on_joint_torques(self, message: Message) -> Iterator[Output]:
        source = conversions.lift_source(message)
        series = conversions.torques_from_msg(message)
        if source:
            self._collect(message.lift_id, lambda parts: parts.torques.update({source: series}))
        elif self._configured('joint_torques', message):
            for k, stamp in enumerate(series.time):
                events = self.monitor.update_joint_torques(
                    float(stamp),
                    series.joints,
                    series.torque[k],
                    series.lower[k],
                    series.upper[k],
                    bool(series.solved[k]),
                    message.lift_id,
                    self._historical,
                )
                yield from self._announce(events)

    def _on_muscle_analysis(self, message: Message) -> Iterator[Output]:
        source = conversions.lift_source(message)
        series = conversions.activations_from_msg(message)
        if source:
            self._collect(
                message.lift_id, lambda parts: parts.activations.update({source: series})
            )
        elif self._configured('muscle_analysis', message):
            for k, stamp in enumerate(series.time):
                events = self.monitor.update_activations(
                    float(stamp),
                    series.muscles,
                    series.activation[k],
                    bool(series.solved[k]),
                    message.lift_id,
                    self._historical,
                )
                yield from self._announce(events)

    def _on_measured_lift(self, message: Message) -> Iterator[Output]:
        ends = conversions.ends_from_msg(message)
        start = to_seconds(message.header.stamp)

        def take(parts: LiftParts) -> None:
            parts.start, parts.ends = start, ends

        self._collect(message.lift_id, take)
        return iter(())

    def _on_predicted_lift(self, message: Message) -> Iterator[Output]:
        if message.report.status != 0:
            reason = f'prediction failed: {message.report.message}'

            def take(parts: LiftParts) -> None:
                parts.no_prediction = reason

            self._collect(message.lift_id, take)
        return iter(())

    def _configured(self, topic: str, message: Message) -> bool:
        """Return whether person and task are known; a message that comes before waits."""
        if self.monitor.assignment is not None:
            return True
        self.counts['samples before person and task'] += 1
        self._early.append((topic, message))
        return False

    def _collect(self, lift_id: str, take: Callable[[LiftParts], None]) -> None:
        parts = self._collector.parts(lift_id, self._now())
        if parts is None:
            self.counts['late parts of assessed lifts'] += 1
        else:
            take(parts)

    def _assess(self, parts: LiftParts, not_come: str) -> Iterator[Output]:
        measured, predicted = parts.loads(MEASURED), parts.loads(PREDICTED)
        if measured is None:
            self.report_error(f'{parts.lift_id} not assessed: measured spine load: {not_come}')
            return
        reason = parts.no_prediction or not_come
        if predicted is None:
            self.log.info(f'{parts.lift_id}: no predicted lift: {reason}')
        try:
            result = self.monitor.assess(measured, predicted, parts.ends, reason)
        except LiftingError as error:
            self.report_error(f'{parts.lift_id} not assessed: {error}')
            return
        yield 'risk_assessment', conversions.assessment_to_msg(result, measured.start)

    def _announce(self, events: list[AlarmEvent]) -> Iterator[Output]:
        """Write events into the journal, then yield them: also those that cannot be written."""
        if not events:
            return
        unjournaled = False
        if self._journal is not None:
            try:
                self._journal.append(events)
            except JournalError as error:
                unjournaled = True
                self.report_error(f'alarms go out without a journal: {error}')
        for event in events:
            yield 'alarms', conversions.alarm_to_msg(event, self.filter_delay, unjournaled)
        yield from self._states()

    def _states(self) -> Iterator[Output]:
        unwritten = 0 if self._journal is None else self._journal.unwritten
        events = self.monitor.last_events()
        yield 'alarm_states', conversions.states_to_msg(events, self.filter_delay, unwritten)
