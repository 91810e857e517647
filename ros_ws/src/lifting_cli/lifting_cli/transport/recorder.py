# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift record`: serialised messages of running topics into an MCAP bag, definitions included."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rclpy.executors import Executor
from rclpy.node import Node
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from lifting_cli.transport.qos import message_class, recorded_quality, subscription_profile
from lifting_cli.transport.ros_context import own_node
from lifting_messages import typestore
from lifting_messages.stamps import stamp_of
from lifting_recordings.bag_writer import BAG_VERSION, quality
from lifting_recordings.exceptions import BagError

_DISCOVERY_SECONDS = 0.1
_SPIN_SECONDS = 0.05
# Housekeeping of every node, not data of the graph.
_HOUSEKEEPING = ('/rosout', '/parameter_events', '/clock')


@dataclass(frozen=True)
class RecordOptions:
    """What to record.

    Attributes
    ----------
    output : Path
        Bag folder to create.
    topics : tuple of str
        Topic names; empty: all except housekeeping and hidden ones.
    exclude : tuple of str
        Topics to leave out.
    duration : float or None
        Wall seconds after which to end; None: until the control stops it.
    compress : bool
        zstd inside the MCAP file.
    """

    output: Path
    topics: tuple[str, ...] = ()
    exclude: tuple[str, ...] = ()
    duration: float | None = None
    compress: bool = True


@dataclass(frozen=True)
class RecordReport:
    """What was recorded.

    Attributes
    ----------
    bag : Path
        The bag.
    messages : dict
        Messages per topic.
    skipped : dict
        Topic to reason.
    """

    bag: Path
    messages: dict[str, int]
    skipped: dict[str, str]


class RecordControl:
    """Stop a recording from another thread or a signal handler; know when topics are joined."""

    def __init__(self) -> None:
        self._stop = threading.Event()
        self.joined: frozenset[str] = frozenset()
        """Topics that are being recorded."""

    @property
    def stopped(self) -> bool:
        """Whether the recording is to end."""
        return self._stop.is_set()

    def stop(self) -> None:
        """End the recording; what has arrived is written."""
        self._stop.set()


def record(
    options: RecordOptions,
    control: RecordControl | None = None,
    say: Callable[[str], None] = lambda text: None,
) -> RecordReport:
    """Record until stopped.

    A message is stored under the stamp of its own header, or of its first part's (so that results
    line up with the recording they came from); one without a stamp, or with 0, under the latest
    stamp so far, or under the wall time of its arrival where there was none.

    Raises
    ------
    BagError
        The output exists.
    """
    control = control or RecordControl()
    if options.output.exists():
        raise BagError(f'{options.output} exists already; it is not overwritten')
    writer = Writer(options.output, version=BAG_VERSION, storage_plugin=StoragePlugin.MCAP)
    if options.compress:
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer, own_node('recorder') as (node, executor):
        return _Recording(options, control, say, writer, node, executor).run()


class _Recording:
    """One run of the recorder on an open writer and a node."""

    def __init__(
        self,
        options: RecordOptions,
        control: RecordControl,
        say: Callable[[str], None],
        writer: Writer,
        node: Node,
        executor: Executor,
    ) -> None:
        self._options, self._control, self._say = options, control, say
        self._writer, self._node = writer, node
        self._counts: dict[str, int] = {}
        self._skipped: dict[str, str] = {}
        self._executor = executor
        self._latest = 0

    def run(self) -> RecordReport:
        """Join topics as they appear and write what arrives."""
        begin = time.monotonic()
        next_look = begin
        while not self._control.stopped:
            now = time.monotonic()
            if self._options.duration is not None and now - begin > self._options.duration:
                break
            if now >= next_look:
                self._join_new_topics()
                next_look = now + _DISCOVERY_SECONDS
            self._executor.spin_once(timeout_sec=_SPIN_SECONDS)
        self._drain()
        return RecordReport(self._options.output, dict(self._counts), dict(self._skipped))

    def _drain(self) -> None:
        """Take what has arrived but was not yet handled."""
        while True:
            before = sum(self._counts.values())
            end = time.monotonic() + _SPIN_SECONDS
            while time.monotonic() < end:
                self._executor.spin_once(timeout_sec=_SPIN_SECONDS)
            if sum(self._counts.values()) == before:
                return

    def _join_new_topics(self) -> None:
        wanted = {'/' + t.lstrip('/') for t in self._options.topics}
        left_out = {'/' + t.lstrip('/') for t in self._options.exclude}
        for name, types in self._node.get_topic_names_and_types():
            if name in self._counts or name in self._skipped or name in left_out:
                continue
            if (wanted and name not in wanted) or (not wanted and name in _HOUSEKEEPING):
                continue
            if '/_' in name:
                continue
            offered = self._node.get_publishers_info_by_topic(name)
            if offered:
                self._join(name, types[0], [info.qos_profile for info in offered])

    def _join(self, name: str, msgtype: str, offered: list[Any]) -> None:
        store = typestore()
        cls = message_class(msgtype)
        if cls is None or msgtype not in store.fielddefs:
            self._skipped[name] = f'no definition of {msgtype}'
            self._say(f'{name} is not recorded: {self._skipped[name]}')
            return
        profile = subscription_profile(offered)
        latched = quality(transient_local=True)
        connection = self._writer.add_connection(
            name,
            msgtype,
            typestore=store,
            offered_qos_profiles=[recorded_quality(latched, p) for p in offered],
        )
        self._counts[name] = 0
        write, counts = self._writer.write, self._counts

        def on_message(data: bytes) -> None:
            stamp = stamp_of(data, msgtype)
            if stamp:
                self._latest = max(self._latest, stamp)
            write(connection, stamp or self._latest or time.time_ns(), data)
            counts[name] += 1

        self._node.create_subscription(cls, name, on_message, profile, raw=True)
        self._control.joined = frozenset(self._counts)
