# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift play`: publish a bag in its own time, at a rate, without losing a message.

Serialised messages are forwarded as they are, those of earlier definitions in today's form. A
message that is late is sent at once; none is dropped: streams are reliable and keep all, so a
subscriber that cannot follow slows the player.
"""

from __future__ import annotations

import time
from array import array
from collections.abc import Callable, Iterable
from itertools import chain
from typing import Any

import numpy as np
from rclpy.duration import Duration
from rclpy.executors import Executor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rosbags.interfaces import QosDurability
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool

from lifting_cli.transport.play_options import PlayControl, PlayOptions, PlayReport
from lifting_cli.transport.qos import message_class, publisher_profile
from lifting_cli.transport.ros_context import own_node
from lifting_messages.current_form import MARKERS, current_type
from lifting_messages.plate_blocks import BLOCK, block_topic, in_blocks, is_plate
from lifting_recordings.exceptions import PlaybackError
from lifting_recordings.reader import BagReader, BagTopic

# Alarms in a bag are history: played again they would raise the plant's alarms a second time.
HISTORY_TYPES = ('lifting_interfaces/msg/AlarmEvent',)
# A block of plate samples ends with a message of these.
FRAME_TYPES = (MARKERS,)
_CLOCK_TOPIC = '/clock'
_EARLY_NS = 100_000
_POLL_SECONDS = 0.02
# Files up to this size are held in memory [bytes].
_HELD_IN_MEMORY = 100_000_000


def play(
    options: PlayOptions,
    control: PlayControl | None = None,
    say: Callable[[str], None] = lambda text: None,
) -> PlayReport:
    """Play a bag to its end.

    Parameters
    ----------
    options : PlayOptions
        What and how.
    control : PlayControl, optional
        To pause and stop from elsewhere; the service `~/pause` (std_srvs/SetBool) works on it.
    say : callable, optional
        Receives one line per remarkable event (lost data, skipped topics).

    Raises
    ------
    UnreadableBagError
        The bag.
    PlaybackError
        Nothing to play, expected subscribers missing, or a subscriber that takes nothing more.
    """
    control = control or PlayControl(paused=options.start_paused)
    with BagReader(options.bag) as bag, own_node('player', options.namespace) as (node, executor):
        return _Playback(options, control, say, bag, node, executor).run()


class _Playback:
    """One run of the player on an open bag and a node."""

    def __init__(
        self,
        options: PlayOptions,
        control: PlayControl,
        say: Callable[[str], None],
        bag: BagReader,
        node: Node,
        executor: Executor,
    ) -> None:
        self._options, self._control, self._bag, self._node = options, control, bag, node
        self._skipped: dict[str, str] = {}
        self._plates = {
            name
            for name, topic in bag.topics.items()
            if options.plate_blocks and is_plate(name, topic.msgtype)
        }
        if bag.loss is not None:
            say(f'{bag.path}: {bag.loss}')
        self._publishers = self._make_publishers(say)
        if not self._publishers:
            raise PlaybackError(f'{bag.path}: no topic to play: {self._skipped}')
        self._counts = dict.fromkeys(self._publishers, 0)
        self._lateness = array('q')
        self._clock = (
            node.create_publisher(Clock, _CLOCK_TOPIC, 10) if options.clock_hz > 0.0 else None
        )
        node.create_service(SetBool, '~/pause', self._on_pause)
        self._executor = executor

    def _make_publishers(self, say: Callable[[str], None]) -> dict[str, Any]:
        wanted = {'/' + name.lstrip('/') for name in self._options.topics}
        stored = {'/' + name.lstrip('/') for name in self._bag.topics}
        if wanted - stored:
            raise PlaybackError(f'{self._bag.path}: has no topic {sorted(wanted - stored)}')
        publishers = {}
        for name, topic in self._bag.topics.items():
            full = '/' + name.lstrip('/')
            if wanted and full not in wanted:
                continue
            reason = self._reason_to_skip(full, topic)
            if reason:
                self._skipped[name] = reason
                say(f'{name} is not played: {reason}')
                continue
            msgtype = current_type(topic.msgtype)
            if name in self._plates:
                full, msgtype = block_topic(full), BLOCK
            publishers[name] = self._node.create_publisher(
                message_class(msgtype), self._resolve(full), publisher_profile(topic.qos)
            )
        return publishers

    def _reason_to_skip(self, full: str, topic: BagTopic) -> str:
        if topic.count == 0:
            return 'holds no messages'
        if full == _CLOCK_TOPIC and self._options.clock_hz > 0.0:
            return 'the player publishes its own clock'
        if topic.msgtype in HISTORY_TYPES and not self._options.play_alarms:
            return 'alarms of stored data are not raised again'
        if message_class(current_type(topic.msgtype)) is None:
            return f'message type {topic.msgtype} is not installed'
        return ''

    def _resolve(self, full: str) -> str:
        prefix = self._options.namespace.strip('/')
        return f'/{prefix}{full}' if prefix else full

    def _on_pause(self, request: Any, response: Any) -> Any:
        self._control.pause(request.data)
        response.success = True
        response.message = 'paused' if request.data else 'playing'
        return response

    def run(self) -> PlayReport:
        """Wait for subscribers, play all loops, wait for the acknowledgements."""
        self._wait_for_subscribers()
        begin = time.monotonic()
        source = self._source()
        done = 0
        while not self._control.stopped and (self._options.loop == 0 or done < self._options.loop):
            self._play_once(source())
            done += 1
        acknowledged = all(
            p.wait_for_all_acked(Duration(seconds=self._options.ack_timeout))
            for p in self._publishers.values()
        )
        late = np.array(self._lateness if self._lateness else [0]) * 1e-9
        return PlayReport(
            messages=dict(self._counts),
            skipped=self._skipped,
            loss=self._bag.loss,
            lateness_p50=float(np.percentile(late, 50)),
            lateness_p99=float(np.percentile(late, 99)),
            lateness_max=float(late.max()),
            wall_time=time.monotonic() - begin,
            acknowledged=acknowledged,
            stopped=self._control.stopped,
        )

    def _wait_for_subscribers(self) -> None:
        end = time.monotonic() + self._options.wait_timeout
        wanted = {'/' + k.lstrip('/'): n for k, n in self._options.wait_for.items()}
        played = {'/' + name.lstrip('/'): p for name, p in self._publishers.items()}
        for name in wanted:
            if name not in played:
                raise PlaybackError(f'option wait_for: topic {name} is not played')
        while not self._control.stopped:
            missing = {
                name: f'{played[name].get_subscription_count()} of {number}'
                for name, number in wanted.items()
                if played[name].get_subscription_count() < number
            }
            if not missing:
                return
            if time.monotonic() > end:
                raise PlaybackError(
                    f'subscribers missing after {self._options.wait_timeout:g} s: {missing}'
                )
            self._executor.spin_once(timeout_sec=_POLL_SECONDS)

    def _source(self) -> Callable[[], Iterable[tuple[str, int, bytes]]]:
        """Return what yields the messages of one turn: latched ones from before the start first.

        A bag of ordinary size is held in memory, so that nothing is decompressed while it plays.
        """
        start = self._bag.start_ns + round(self._options.start * 1e9)
        topics = list(self._publishers)
        latched = [
            name
            for name in topics
            if (qos := self._bag.topics[name].qos)
            and all(q.durability == QosDurability.TRANSIENT_LOCAL for q in qos)
        ]
        before: dict[str, tuple[str, int, bytes]] = {}
        for name, stamp, data in self._bag.current_messages(latched):
            if stamp >= start:
                break
            before[name] = (name, start, data)
        if next(iter(self._bag.current_messages(topics, start)), None) is None:
            raise PlaybackError(
                f'{self._bag.path}: no message after {self._options.start:g} s '
                f'(the bag is {(self._bag.end_ns - self._bag.start_ns) * 1e-9:g} s long)'
            )
        types = {name: current_type(self._bag.topics[name].msgtype) for name in topics}
        frames = [name for name, kind in types.items() if kind in FRAME_TYPES]

        def turn() -> Iterable[tuple[str, int, bytes]]:
            messages = chain(before.values(), self._bag.current_messages(topics, start))
            return in_blocks(messages, self._plates, frames) if self._plates else messages

        if self._bag.size > _HELD_IN_MEMORY:
            return turn
        held = list(turn())
        return lambda: held

    def _play_once(self, messages: Iterable[tuple[str, int, bytes]]) -> None:
        control, rate = self._control, self._options.rate
        bag_start = self._bag.start_ns
        publishers, counts, lateness = self._publishers, self._counts, self._lateness
        now = time.monotonic_ns
        first = last = None
        tick = round(1e9 / self._options.clock_hz) if self._clock else 10_000_000
        epoch = next_tick = now()
        for name, stamp, data in messages:
            if first is None:
                first = stamp
            last = stamp
            due = epoch + int((stamp - first) / rate)
            while True:
                clock = now()
                if clock >= next_tick:
                    self._tick(first + int((min(clock, due) - epoch) * rate))
                    if control.stopped:
                        return
                    if control.paused:
                        waited = self._wait_while_paused()
                        epoch, due = epoch + waited, due + waited
                    # Between frames that come at the ticks' rate: their messages stay together.
                    next_tick = epoch + ((now() - epoch) // tick + 1) * tick + tick // 2
                    continue
                ahead = due - clock
                if ahead <= _EARLY_NS:
                    break
                time.sleep(min(ahead, max(next_tick - clock, 0) + 1) * 1e-9)
            self._publish(publishers[name], name, data)
            counts[name] += 1
            lateness.append(max(0, now() - due))
            control.position = (stamp - bag_start) * 1e-9
        if last is not None:
            self._tick(last)

    def _publish(self, publisher: Any, name: str, data: bytes) -> None:
        """Publish; when a subscriber's history is full, wait for it instead of dropping."""
        try:
            publisher.publish(data)
            return
        except rclpy_implementation.RCLError:
            end = time.monotonic() + self._options.ack_timeout
        while not self._control.stopped:
            try:
                publisher.publish(data)
                return
            except rclpy_implementation.RCLError as error:
                if time.monotonic() > end:
                    raise PlaybackError(
                        f'{name}: a subscriber has taken no message for '
                        f'{self._options.ack_timeout:g} s'
                    ) from error
                time.sleep(_POLL_SECONDS)

    def _tick(self, bag_ns: int) -> None:
        if self._clock is not None:
            message = Clock()
            message.clock.sec, message.clock.nanosec = divmod(bag_ns, 1_000_000_000)
            self._clock.publish(message)
        self._executor.spin_once(timeout_sec=0.0)

    def _wait_while_paused(self) -> int:
        begin = time.monotonic_ns()
        while self._control.paused and not self._control.stopped:
            self._executor.spin_once(timeout_sec=_POLL_SECONDS)
        return time.monotonic_ns() - begin
