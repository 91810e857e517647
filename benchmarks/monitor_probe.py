# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The injury monitor with one output more, for latencies only.

The monitor publishes only when an alarm changes. Here it also publishes, on `judged`, the stamp
of each live sample whose spine load, joint torques and activations have been processed: an alarm
of that sample has been published before.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import ClassVar

from injury_monitor.injury_monitor_node import InjuryMonitorNode
from injury_monitor.station import MonitorStation
from lifting_messages import Message, make, message_type
from lifting_messages.station import Output
from lifting_messages.topics import Quality, Topic
from lifting_node.run import run_node

#: Topics with the loads of a live sample.
PARTS = ('spine_load', 'joint_torques', 'muscle_analysis')

LIVE = message_type('SpineLoad').LIVE


class ProbedStation(MonitorStation):
    """The station with the additional output."""

    OUTPUTS = (*MonitorStation.OUTPUTS, Topic('judged', 'std_msgs/Header', Quality.FRAMES))

    parts: ClassVar[Counter[tuple[int, int]]] = Counter()

    def receive(self, topic: str, message: Message) -> Iterator[Output]:
        """Take a message; yield the stamp of a sample after its last load."""
        yield from super().receive(topic, message)
        if topic not in PARTS or message.source != LIVE:
            return
        stamp = message.header.stamp
        key = (stamp.sec, stamp.nanosec)
        self.parts[key] += 1
        if self.parts[key] == len(PARTS):
            del self.parts[key]
            yield 'judged', make('std_msgs/Header', stamp=stamp)


class ProbedMonitorNode(InjuryMonitorNode):
    """The node of the probed station."""

    STATION = ProbedStation


if __name__ == '__main__':
    run_node(ProbedMonitorNode)
