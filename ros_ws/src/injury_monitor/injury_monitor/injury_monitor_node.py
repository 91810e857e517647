# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node round the injury monitor: live loads in, alarms and assessments out."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

from lifting_interfaces.msg import (
    AlarmEvent,
    AlarmStates,
    JointTorques,
    MeasuredLift,
    MuscleAnalysis,
    PredictedLift,
    RiskAssessment,
    SpineLoad,
    Subject,
    Task,
)
from lifting_interfaces.srv import AcknowledgeAlarm, ResetAlarm, ShelveAlarm
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn

from injury_monitor import conversions
from injury_monitor.core import alarm_event
from injury_monitor.core.alarm import Trigger
from injury_monitor.core.exceptions import (
    AlarmCommandError,
    InjuryMonitorError,
    JournalError,
    OperatorError,
    ShelveDurationError,
    UnknownAlarmError,
)
from injury_monitor.core.journal import AlarmJournal
from injury_monitor.core.lift_parts import MEASURED, PREDICTED, LiftCollector, LiftParts
from injury_monitor.core.monitor import InjuryMonitor
from lifting_messages import Message, encode
from lifting_messages.stamps import to_seconds
from lifting_node import qos
from lifting_node.pipeline_node import PipelineNode
from lifting_node.run import run_node


class InjuryMonitorNode(PipelineNode):
    """Alarms and assessments of one station; the namespace is the station."""

    PACKAGE = 'injury_monitor'
    INPUT_ERRORS = (InjuryMonitorError,)

    def __init__(self) -> None:
        self._journal: AlarmJournal | None = None
        super().__init__()

    def build(self) -> None:
        """Create the monitor, its publishers, subscriptions and services."""
        if self.values['journal']:
            self._journal = AlarmJournal(self.values['journal'])
        if self._journal is not None and self._journal.damage:
            self.report_error(self._journal.damage)
        self.monitor = InjuryMonitor(
            self.get_namespace().strip('/') or 'station',
            max_gap=self.values['max_gap'],
            activation_window=self.values['activation_window'],
            max_shelve=self.values['max_shelve'],
            history=self._journal.events() if self._journal is not None else (),
        )
        self._collector = LiftCollector(self.values['result_wait'])
        self._subject: Message | None = None
        self._task: Message | None = None
        self._early: deque[Callable[[], None]] = deque(maxlen=qos.FRAME_DEPTH)
        self.filter_delay = math.nan
        self._alarms = self.advertise(AlarmEvent, 'alarms', qos.RESULTS)
        self._states = self.advertise(AlarmStates, 'alarm_states', qos.LATCHED)
        self._assessments = self.advertise(RiskAssessment, 'risk_assessment', qos.RESULTS)
        self.subscribe(Subject, 'subject', self._on_subject, qos.LATCHED)
        self.subscribe(Task, 'task', self._on_task, qos.LATCHED)
        self.subscribe(SpineLoad, 'spine_load', self._on_spine_load, qos.FRAMES)
        self.subscribe(JointTorques, 'joint_torques', self._on_joint_torques, qos.FRAMES)
        self.subscribe(MuscleAnalysis, 'muscle_analysis', self._on_muscle_analysis, qos.FRAMES)
        self.subscribe(MeasuredLift, 'measured_lift', self._on_measured_lift, qos.RESULTS)
        self.subscribe(PredictedLift, 'predicted_lift', self._on_predicted_lift, qos.RESULTS)
        self._operator_services = [
            self.create_service(AcknowledgeAlarm, '~/acknowledge_alarm', self._acknowledge),
            self.create_service(ResetAlarm, '~/reset_alarm', self._reset),
            self.create_service(ShelveAlarm, '~/shelve_alarm', self._shelve),
        ]
        self._housekeeping = self.create_timer(1.0, self._each_second_active)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start publishing, with the states that an earlier process recorded."""
        result = super().on_activate(state)
        self._publish_states()
        return result

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the services and the timer with the rest."""
        for service in self._operator_services:
            self.destroy_service(service)
        self.destroy_timer(self._housekeeping)
        self._close_journal()
        return super().on_cleanup(state)

    def destroy_node(self) -> None:
        """Close the journal, so that another process may write, and destroy the node."""
        self._close_journal()
        super().destroy_node()

    def _close_journal(self) -> None:
        if self._journal is not None:
            self._journal.close()
            self._journal = None

    def _on_subject(self, message: Message) -> None:
        self._subject = message
        self._configure()

    def _on_task(self, message: Message) -> None:
        self._task = message
        self._configure()

    def _configure(self) -> None:
        if self._subject is None or self._task is None:
            return
        limits = self.monitor.configure(conversions.assignment_from_msg(self._subject, self._task))
        self.get_logger().info(
            f'limits: compression {limits.compression_action.value:g} and '
            f'{limits.compression_maximum.value:g} N, anterior shear {limits.shear.value:g} N '
            f'({limits.loads_per_day:g} loads a day)'
        )
        self._publish_states()
        while self._early:
            self._early.popleft()()

    def _on_spine_load(self, message: Message) -> None:
        source = conversions.lift_source(message)
        series = conversions.spine_from_msg(message)
        if not source:
            self.filter_delay = message.filter_delay
        if source:
            self._collect(message.lift_id, lambda parts: parts.spine.update({source: series}))
        elif self._ready_for_samples(partial(self._on_spine_load, message)):
            for time, compression, shear, solved in zip(
                series.time, series.compression, series.anterior_shear, series.solved, strict=True
            ):
                self._announce(
                    self.monitor.update_spine_load(
                        float(time),
                        float(compression),
                        float(shear),
                        bool(solved),
                        message.lift_id,
                        self.values['stored_data'],
                    )
                )

    def _on_joint_torques(self, message: Message) -> None:
        source = conversions.lift_source(message)
        series = conversions.torques_from_msg(message)
        if source:
            self._collect(message.lift_id, lambda parts: parts.torques.update({source: series}))
        elif self._ready_for_samples(partial(self._on_joint_torques, message)):
            for k, stamp in enumerate(series.time):
                self._announce(
                    self.monitor.update_joint_torques(
                        float(stamp),
                        series.joints,
                        series.torque[k],
                        series.lower[k],
                        series.upper[k],
                        bool(series.solved[k]),
                        message.lift_id,
                        self.values['stored_data'],
                    )
                )

    def _on_muscle_analysis(self, message: Message) -> None:
        source = conversions.lift_source(message)
        series = conversions.activations_from_msg(message)
        if source:
            self._collect(
                message.lift_id, lambda parts: parts.activations.update({source: series})
            )
        elif self._ready_for_samples(partial(self._on_muscle_analysis, message)):
            for k, stamp in enumerate(series.time):
                self._announce(
                    self.monitor.update_activations(
                        float(stamp),
                        series.muscles,
                        series.activation[k],
                        bool(series.solved[k]),
                        message.lift_id,
                        self.values['stored_data'],
                    )
                )

    def _on_measured_lift(self, message: Message) -> None:
        ends = conversions.ends_from_msg(message)
        start = to_seconds(message.header.stamp)

        def take(parts: LiftParts) -> None:
            parts.start, parts.ends = start, ends

        self._collect(message.lift_id, take)

    def _on_predicted_lift(self, message: Message) -> None:
        if message.report.status != 0:
            reason = f'prediction failed: {message.report.message}'

            def take(parts: LiftParts) -> None:
                parts.no_prediction = reason

            self._collect(message.lift_id, take)

    def _ready_for_samples(self, later: Callable[[], None]) -> bool:
        """Return whether live samples can be judged; keep those that overtake person and task."""
        if self.active and self.monitor.assignment is not None:
            return True
        self.counts['samples before person and task or while not active'] += 1
        if self.active:
            self._early.append(later)
        return False

    def _collect(self, lift_id: str, take: Any) -> None:
        parts = self._collector.parts(lift_id, time.monotonic())
        if parts is None:
            self.counts['late parts of assessed lifts'] += 1
            return
        take(parts)
        self._assess_ready()

    def _assess_ready(self) -> None:
        if not self.active or self.monitor.assignment is None:
            return
        for parts in self._collector.ready(time.monotonic()):
            try:
                self._assess(parts)
            except InjuryMonitorError as error:
                self.report_error(f'{parts.lift_id} not assessed: {error}')

    def _assess(self, parts: LiftParts) -> None:
        measured = parts.loads(MEASURED)
        if measured is None:
            self.report_error(
                f'{parts.lift_id} not assessed: no measured spine load came within '
                f'{self._collector.wait:g} s'
            )
            return
        predicted = parts.loads(PREDICTED)
        reason = parts.no_prediction or f'none came within {self._collector.wait:g} s'
        if predicted is None:
            self.get_logger().warning(f'{parts.lift_id}: no predicted lift: {reason}')
        result = self.monitor.assess(measured, predicted, parts.ends, reason)
        message = conversions.assessment_to_msg(result, measured.start)
        self._assessments.publish(encode(message))

    def _announce(self, events: list[alarm_event.AlarmEvent]) -> None:
        """Write events into the journal, then publish them: also those that cannot be written."""
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
            self.get_logger().warning(event.message())
            message = conversions.alarm_to_msg(event, self.filter_delay, unjournaled)
            self._alarms.publish(encode(message))
        self._publish_states()

    def _publish_states(self) -> None:
        unwritten = self._journal.unwritten if self._journal is not None else 0
        events = self.monitor.last_events()
        message = conversions.states_to_msg(events, self.filter_delay, unwritten)
        self._states.publish(encode(message))

    def _each_second_active(self) -> None:
        self._assess_ready()
        if self.active:
            self._announce(self.monitor.tick())

    def _acknowledge(
        self, request: AcknowledgeAlarm.Request, response: AcknowledgeAlarm.Response
    ) -> AcknowledgeAlarm.Response:
        return self._command(Trigger.ACKNOWLEDGE, request, response)

    def _reset(
        self, request: ResetAlarm.Request, response: ResetAlarm.Response
    ) -> ResetAlarm.Response:
        return self._command(Trigger.RESET, request, response)

    def _shelve(
        self, request: ShelveAlarm.Request, response: ShelveAlarm.Response
    ) -> ShelveAlarm.Response:
        return self._command(Trigger.SHELVE, request, response, request.duration)

    def _command(
        self, trigger: Trigger, request: Any, response: Any, duration: float = math.nan
    ) -> Any:
        codes: dict[type[InjuryMonitorError], Any] = {
            UnknownAlarmError: ShelveAlarm.Response.UNKNOWN_ALARM,
            AlarmCommandError: ShelveAlarm.Response.NOT_IN_THIS_STATE,
            ShelveDurationError: ShelveAlarm.Response.DURATION_REFUSED,
            OperatorError: ShelveAlarm.Response.OPERATOR_MISSING,
        }
        if not self.active:
            response.error_code = ShelveAlarm.Response.NOT_ACTIVE
            response.error_message = 'the monitor is not active'
            return response
        try:
            events = self.monitor.command(
                trigger, request.alarm_id, request.operator_id, duration=duration
            )
        except tuple(codes) as error:
            response.error_code = codes[type(error)]
            response.error_message = str(error)
            return response
        self._announce(events)
        return response


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    run_node(InjuryMonitorNode, args)


if __name__ == '__main__':
    main()
