# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lifecycle node around a station: its declared topics as publishers and subscriptions."""

from __future__ import annotations

import importlib
import inspect
import math
import threading
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any, ClassVar, Final, Generic, TypeVar

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock, ClockType
from rclpy.lifecycle import (
    LifecycleNode,
    LifecyclePublisher,
    LifecycleState,
    TransitionCallbackReturn,
)
from rclpy.service import Service
from rclpy.subscription import Subscription

from human_model.exceptions import LiftingError
from lifting_messages import Message, decode, encode
from lifting_messages.input_watch import InputWatch
from lifting_messages.message_types import full_name
from lifting_messages.parameters import load_table
from lifting_messages.station import Output, Station
from lifting_messages.topics import Topic
from lifting_node import qos
from lifting_node.garbage import TimedSearch
from lifting_node.lifecycle_guard import refuse_unfit_requests
from lifting_node.parameters import declare

S = TypeVar('S', bound=Station)

ERROR_SHOWN: Final = 10.0
"""Time [s] for which /diagnostics names an error after it came; the counts remain."""

DEFECT: Final = 500
"""Error code of a service whose callback failed unexpectedly."""

PAUSE: Final = 0.002
"""Time [s] from a live sample to work on whole lifts: the nodes that wait for the results of the
sample have the cores until then."""

LIFT_STEP: Final = 0.001
"""Time [s] of work on whole lifts between two live samples, or one step of it."""

QUIET: Final = 0.02
"""Time [s] without a live sample after which whole lifts are worked on continuously."""

QUIET_STEP: Final = 0.004
"""Time [s] of that work before the node looks for messages again."""


class PipelineNode(LifecycleNode, Generic[S]):
    """Managed node: declared parameters, guarded and counted inputs, health on /diagnostics.

    A subclass sets `STATION`, whose inputs it subscribes to and whose outputs it publishes.
    Live samples come first: whole lifts are worked on between them, in bounded steps. While the
    node is not active, samples are dropped and latched inputs are kept. `LATER` names modules
    that load for long and are first needed at the end of a lift.
    """

    STATION: type[S]
    LATER: ClassVar[tuple[str, ...]] = ()

    def __init__(self) -> None:
        super().__init__(self.STATION.PACKAGE)
        refuse_unfit_requests(self)
        self.values: dict[str, Any] = declare(self, load_table(self.STATION.PACKAGE))
        self.active = False
        self._station: S | None = None
        self._search = TimedSearch()
        self._inputs: list[Subscription] = []
        self._outputs: dict[str, LifecyclePublisher] = {}
        self._last_live = -math.inf
        self._worked = False
        self._watch = InputWatch(self.STATION.INPUTS, time.monotonic)
        self._defects = 0
        self._errors = 0
        self._error_came = -math.inf
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', 10)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._turn = self.create_timer(PAUSE, self._work, clock=steady, autostart=False)
        self.create_timer(1.0, self._each_second, clock=steady)

    @property
    def station(self) -> S:
        """The station of a configured node."""
        assert self._station is not None, 'the node is not configured'
        return self._station

    def build(self) -> None:
        """Create the station (the slow part), publishers and subscriptions."""
        station = self.STATION(
            self.values, self.get_namespace(), self.get_logger(), clock=time.monotonic
        )
        station.warm_up()
        station.has_subscribers = lambda name: bool(self._outputs[name].get_subscription_count())
        station.has_publishers = lambda name: bool(self.count_publishers(name))
        self._station = station
        for topic in station.OUTPUTS:
            self._outputs[topic.name] = self.create_lifecycle_publisher(
                _message_class(topic), topic.name, qos.profile(topic.quality)
            )
        for topic in station.INPUTS:
            subscription = self.create_subscription(
                _message_class(topic),
                topic.name,
                self._receiver(topic),
                qos.profile(topic.quality),
                raw=True,
            )
            self._inputs.append(subscription)

    def publish(self, topic: str, message: Message) -> None:
        """Publish a message; nothing is sent unless the node is active."""
        self._outputs[topic].publish(encode(message))

    def publish_all(self, outputs: Iterable[Output]) -> None:
        """Publish each output as soon as it is there."""
        for topic, message in outputs:
            self.publish(topic, message)

    def _receiver(self, topic: Topic) -> Callable[[Any], None]:
        """Return the function that takes the serialised messages of an input.

        `lifting_messages` decodes them: rclpy takes four times as long for arrays of numbers.
        """
        station, name, kind = self.station, topic.name, full_name(topic.type)
        live = not topic.quality.latched

        def receive(data: Any) -> None:
            self._watch.note(name)
            if live and not self.active:
                station.counts['samples while not active'] += 1
                return
            with self.survive(name), station.guard(name):
                self.publish_all(station.receive(name, decode(data, kind)))
            if live:
                self._last_live = time.monotonic()
                self._worked = False
            self._plan_work()

        return receive

    @contextmanager
    def survive(self, what: str) -> Iterator[None]:
        """Report an unexpected exception as a defect, and go on.

        A defect in the processing of one message must not end the alarms of a station.
        """
        try:
            yield
        except Exception:
            self._defects += 1
            self.get_logger().error(f'defect at {what}:\n{traceback.format_exc()}')

    def serve(self, kind: Any, name: str, callback: Callable[[Any, Any], Any]) -> Service:
        """Create a service; a defect in its callback is reported in its answer."""

        def answer(request: Any, response: Any) -> Any:
            with self.survive(name):
                return callback(request, response)
            for field in ('message', 'error_message'):
                if hasattr(response, field):
                    setattr(response, field, 'defect of the node; see its log')
            if hasattr(response, 'error_code'):
                response.error_code = DEFECT
            return response

        return self.create_service(kind, name, answer)

    def _plan_work(self) -> None:
        if self.active and self.station.pending:
            self._turn.reset()

    def _work(self) -> None:
        if self._station is None:
            self._turn.cancel()
            return
        with self.survive('whole lifts'):
            if time.monotonic() - self._last_live > QUIET:
                self.publish_all(self.station.work(QUIET_STEP))
            elif not self._worked:
                self.publish_all(self.station.work(LIFT_STEP))
                self._worked = True
        if not self.station.pending:
            self._turn.cancel()

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Build the pipeline; a refused parameter or model file is a failure, not a crash."""
        try:
            self.build()
        except (LiftingError, ValueError, OSError) as error:
            self.get_logger().error(f'not configured: {error}')
            return TransitionCallbackReturn.FAILURE
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start publishing and the work on lifts that came before; load `LATER`."""
        self.active = True
        self._watch.begin()
        # A first log message looks for its caller in all modules, for tens of milliseconds: now,
        # not at the first lift.
        inspect.getmodule(self.on_activate.__code__)
        self._search.begin()
        threading.Thread(target=self._load_later, name='load later').start()
        result = super().on_activate(state)
        self.publish_all(self.station.start())
        self._plan_work()
        return result

    def _load_later(self) -> None:
        for name in self.LATER:
            importlib.import_module(name)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Finish the lifts that are being worked on, then stop publishing."""
        self.publish_all(self.station.finish())
        self._turn.cancel()
        self.active = False
        self._search.end()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the station, its publishers and subscriptions."""
        while self._inputs:
            self.destroy_subscription(self._inputs.pop())
        while self._outputs:
            self.destroy_publisher(self._outputs.popitem()[1])
        self._close()
        return TransitionCallbackReturn.SUCCESS

    def destroy_node(self) -> None:
        """Close the files of the station, so that another process can use them."""
        self._close()
        super().destroy_node()

    def _close(self) -> None:
        if self._station is not None:
            self._station.close()
            self._station = None

    def _each_second(self) -> None:
        if self.active:
            self._search.step()
            with self.survive('the clock'):
                self.publish_all(self.station.tick())
            self._plan_work()
        self._publish_health()

    def _publish_health(self) -> None:
        station = self._station
        counts = Counter[str]() if station is None else station.counts
        problems = self._problems(counts['errors'])
        level = DiagnosticStatus.WARN if problems else DiagnosticStatus.OK
        if self._defects:
            counts = counts + Counter(defects=self._defects)
            problems.append(f'{self._defects} defects, see the log')
            level = DiagnosticStatus.ERROR
        status = DiagnosticStatus(
            level=level,
            name=self.get_fully_qualified_name(),
            message='; '.join(problems) or ('active' if self.active else 'not active'),
            values=[KeyValue(key=key, value=str(n)) for key, n in sorted(counts.items())],
        )
        array = DiagnosticArray(status=[status])
        array.header.stamp = self.get_clock().now().to_msg()
        self._diagnostics.publish(array)

    def _problems(self, errors: int) -> list[str]:
        """Return the missing inputs, and the last error while it is recent."""
        now = time.monotonic()
        if errors > self._errors:
            self._error_came = now
        # A station that was configured again counts from 0.
        self._errors = errors
        problems = self._watch.problems() if self.active else []
        if self._station is not None and now - self._error_came < ERROR_SHOWN:
            problems.append(self._station.last_error)
        return problems


def _message_class(topic: Topic) -> type:
    """Return the class that rosidl generated for the type of a topic."""
    package, _, name = topic.type.partition('/')
    found: type = getattr(importlib.import_module(f'{package}.msg'), name)
    return found
