# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The injury monitor's node that says when it has judged a live sample: for latencies only.

The monitor itself speaks only when an alarm changes. Here it also publishes, on `judged`, the
stamp of each live sample of which spine load, joint torques and activations have been judged: an
alarm of that sample would have been published by then.
"""

from __future__ import annotations

from collections import Counter

from lifting_interfaces.msg import SpineLoad
from std_msgs.msg import Header

from injury_monitor.injury_monitor_node import InjuryMonitorNode
from lifting_messages import Message, encode, make
from lifting_node import qos
from lifting_node.run import run_node

#: Messages that the monitor judges of a live sample.
PARTS = 3


class ProbedMonitorNode(InjuryMonitorNode):
    """The node with one publisher more."""

    def build(self) -> None:
        """Build the node and the publisher."""
        super().build()
        self._parts: Counter[tuple[int, int]] = Counter()
        self._judged = self.advertise(Header, 'judged', qos.FRAMES)

    def _on_spine_load(self, message: Message) -> None:
        super()._on_spine_load(message)
        self._part(message)

    def _on_joint_torques(self, message: Message) -> None:
        super()._on_joint_torques(message)
        self._part(message)

    def _on_muscle_analysis(self, message: Message) -> None:
        super()._on_muscle_analysis(message)
        self._part(message)

    def _part(self, message: Message) -> None:
        if message.source != SpineLoad.LIVE:
            return
        stamp = message.header.stamp
        key = (stamp.sec, stamp.nanosec)
        self._parts[key] += 1
        if self._parts[key] == PARTS:
            del self._parts[key]
            self._judged.publish(encode(make('std_msgs/Header', stamp=stamp)))


if __name__ == '__main__':
    run_node(ProbedMonitorNode)
