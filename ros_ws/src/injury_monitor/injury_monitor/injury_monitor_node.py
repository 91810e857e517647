# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node of the injury monitor: its station and the services of the operator."""

from __future__ import annotations

import math
from typing import Any

from lifting_interfaces.srv import AcknowledgeAlarm, ResetAlarm, ShelveAlarm
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn

from injury_monitor.core.alarm import Trigger
from injury_monitor.core.exceptions import (
    AlarmCommandError,
    InjuryMonitorError,
    OperatorError,
    ShelveDurationError,
    UnknownAlarmError,
)
from injury_monitor.station import MonitorStation
from lifting_messages import Message
from lifting_node.pipeline_node import PipelineNode
from lifting_node.run import run_node


class InjuryMonitorNode(PipelineNode[MonitorStation]):
    """Alarms and assessments of one station; the namespace is the station."""

    STATION = MonitorStation

    def build(self) -> None:
        """Create the station, its topics and the services."""
        super().build()
        self._operator_services = [
            self.serve(AcknowledgeAlarm, '~/acknowledge_alarm', self._acknowledge),
            self.serve(ResetAlarm, '~/reset_alarm', self._reset),
            self.serve(ShelveAlarm, '~/shelve_alarm', self._shelve),
        ]

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the services with the rest."""
        for service in self._operator_services:
            self.destroy_service(service)
        return super().on_cleanup(state)

    def publish(self, topic: str, message: Message) -> None:
        """Publish a message; log an alarm."""
        super().publish(topic, message)
        if topic == 'alarms':
            self.get_logger().warning(message.message)

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
            outputs = self.station.command(
                trigger, request.alarm_id, request.operator_id, duration
            )
        except tuple(codes) as error:
            response.error_code = codes[type(error)]
            response.error_message = str(error)
            return response
        self.publish_all(outputs)
        return response


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    run_node(InjuryMonitorNode, args)


if __name__ == '__main__':
    main()
