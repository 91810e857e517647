# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lifecycle shell that every node of the graph puts round its pipeline."""

from __future__ import annotations

import importlib
import inspect
import threading
from collections import Counter
from collections.abc import Callable
from typing import Any, ClassVar

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock, ClockType
from rclpy.lifecycle import (
    LifecycleNode,
    LifecyclePublisher,
    LifecycleState,
    TransitionCallbackReturn,
)
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from lifting_messages import LiftingMessagesError, Message, decode
from lifting_messages.parameters import load_table
from lifting_node.garbage import TimedSearch
from lifting_node.parameters import declare


class PipelineNode(LifecycleNode):
    """Managed node: parameters declared, inputs guarded and counted, health on /diagnostics.

    A subclass sets `PACKAGE` (whose `data/parameters.yaml` it declares) and `INPUT_ERRORS`
    (exceptions of its core that mean bad input: they are logged and counted, and the node goes
    on; any other exception is a defect and ends the process), and implements `build`. `LATER`
    names modules that load for long and are first needed at the end of a lift.
    """

    PACKAGE: ClassVar[str]
    INPUT_ERRORS: ClassVar[tuple[type[Exception], ...]] = ()
    LATER: ClassVar[tuple[str, ...]] = ()

    def __init__(self) -> None:
        super().__init__(self.PACKAGE)
        self.values: dict[str, Any] = declare(self, load_table(self.PACKAGE))
        self.counts: Counter[str] = Counter()
        self.last_error = ''
        self.active = False
        self._search = TimedSearch()
        self._inputs: list[Subscription] = []
        self._outputs: list[LifecyclePublisher] = []
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self.create_timer(1.0, self._each_second, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def build(self) -> None:
        """Load the model, create the pipeline, publishers and subscriptions (the slow part)."""
        raise NotImplementedError

    def subscribe(
        self,
        message_type: type,
        topic: str,
        callback: Callable[[Message], None],
        qos: QoSProfile,
    ) -> None:
        """Subscribe with bad input reported and counted instead of ending the node.

        The callback gets the message as `lifting_messages` decodes it: rclpy takes four times as
        long for arrays of numbers.
        """
        refused: tuple[type[Exception], ...] = (LiftingMessagesError, *self.INPUT_ERRORS)
        name = f'{message_type.__module__.partition(".")[0]}/msg/{message_type.__name__}'

        def guarded(data: Any) -> None:
            self.counts[topic] += 1
            try:
                callback(decode(data, name))
            except refused as error:
                self.report_error(f'{topic}: {error}')

        self._inputs.append(self.create_subscription(message_type, topic, guarded, qos, raw=True))

    def advertise(self, message_type: type, topic: str, qos: QoSProfile) -> LifecyclePublisher:
        """Create a publisher that is silent unless the node is active."""
        publisher: LifecyclePublisher = self.create_lifecycle_publisher(message_type, topic, qos)
        self._outputs.append(publisher)
        return publisher

    def report_error(self, text: str) -> None:
        """Log an input error once per text in a row and count it for /diagnostics."""
        self.counts['errors'] += 1
        if text != self.last_error:
            self.get_logger().error(text)
        self.last_error = text

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Build the pipeline; a refused parameter or model file is a failure, not a crash."""
        refused: tuple[type[Exception], ...] = (ValueError, OSError, *self.INPUT_ERRORS)
        try:
            self.build()
        except refused as error:
            self.get_logger().error(f'not configured: {error}')
            return TransitionCallbackReturn.FAILURE
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start publishing; load in the background what is needed later."""
        self.active = True
        # A first log message looks for its caller in all modules, for tens of milliseconds: now,
        # not at the first lift.
        inspect.getmodule(self.on_activate.__code__)
        self._search.begin()
        threading.Thread(target=self._load_later, name='load later').start()
        return super().on_activate(state)

    def _load_later(self) -> None:
        for name in self.LATER:
            importlib.import_module(name)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop publishing; the pipeline keeps its state."""
        self.active = False
        self._search.end()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop publishers and subscriptions of the pipeline."""
        while self._inputs:
            self.destroy_subscription(self._inputs.pop())
        while self._outputs:
            self.destroy_publisher(self._outputs.pop())
        return TransitionCallbackReturn.SUCCESS

    def _each_second(self) -> None:
        if self.active:
            self._search.step()
        self._publish_health()

    def _publish_health(self) -> None:
        status = DiagnosticStatus(
            level=DiagnosticStatus.WARN if self.counts['errors'] else DiagnosticStatus.OK,
            name=self.get_fully_qualified_name(),
            message=self.last_error or ('active' if self.active else 'not active'),
            values=[KeyValue(key=key, value=str(n)) for key, n in sorted(self.counts.items())],
        )
        array = DiagnosticArray(status=[status])
        array.header.stamp = self.get_clock().now().to_msg()
        self._diagnostics.publish(array)
