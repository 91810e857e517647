# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A recording played again and again at ten times its speed: no message lost, no node dead."""

import os
import time
from contextlib import ExitStack

import pytest
import rclpy
from lifting_interfaces.msg import AlarmEvent, MeasuredLift, RiskAssessment, SpineLoad
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger

from lifting_cli.graph import Graph
from lifting_cli.node_process import discovery, node_processes, start_module
from lifting_cli.recording_summary import summarise
from lifting_node import qos
from lifting_recordings.reader import BagReader

STATION = 'soak'
BAG = 'symmetric_7kg'
RATE = 10.0
#: Time [s] a play may take: its messages are delivered as fast as the slowest node takes them.
PLAY_TIMEOUT = 60.0


class Listener:
    """Counts what the graph says of live frames and lifts."""

    def __init__(self, node):
        self.live = self.lifts = self.measured = self.alarms = self.unsolved = 0
        self.last = time.monotonic()
        node.create_subscription(SpineLoad, 'spine_load', self.spine, qos.FRAMES)
        node.create_subscription(MeasuredLift, 'measured_lift', self.lift, qos.RESULTS)
        node.create_subscription(RiskAssessment, 'risk_assessment', self.assessed, qos.RESULTS)
        node.create_subscription(AlarmEvent, 'alarms', self.alarm, qos.RESULTS)

    def spine(self, message):
        if message.source == SpineLoad.LIVE:
            self.live += len(message.status)
            self.unsolved += sum(1 for status in message.status if status != 0)
            self.last = time.monotonic()

    def lift(self, _):
        self.measured += 1

    def assessed(self, _):
        self.lifts += 1
        self.last = time.monotonic()

    def alarm(self, _):
        self.alarms += 1


def soak(bag, rounds, loops, folder, say=print):
    """Play a recording in rounds of loops through one graph; return what was heard and sent."""
    summary = summarise(bag)
    with BagReader(bag) as reader:
        frames = reader.topics['/markers'].count
    os.environ.update(discovery())
    rclpy.init()
    node = Node('listener', namespace=STATION)
    executor = EventsExecutor()
    executor.add_node(node)
    heard = Listener(node)
    player = None
    stack = ExitStack()
    began = time.monotonic()
    try:
        processes = stack.enter_context(node_processes(folder / 'logs', STATION))
        graph = Graph(node, executor, STATION, processes)
        graph.bring_up()
        flush = node.create_client(Trigger, 'motion_tracker/flush')
        for play in range(loops, rounds * loops + 1, loops):
            player = start_module(
                'player', 'lifting_cli.cli', folder / 'logs',
                arguments=(
                    'play', str(bag), '--rate', str(RATE), '--loop', str(loops),
                    '--station', STATION, '--wait-for', *summary.inputs,
                ),
            )  # fmt: skip
            deadline = time.monotonic() + loops * PLAY_TIMEOUT
            while player.process.poll() is None:
                graph.check()
                assert time.monotonic() < deadline, f'play {play} has not ended'
                executor.spin_once(timeout_sec=0.05)
            assert player.process.returncode == 0, player.log.read_text()
            answer = flush.call_async(Trigger.Request())
            deadline = time.monotonic() + loops * PLAY_TIMEOUT
            while (
                not (answer.done() and heard.live >= play * frames and heard.lifts >= play)
                and time.monotonic() < deadline
            ):
                graph.check()
                executor.spin_once(timeout_sec=0.05)
            say(
                f'{play} plays, {time.monotonic() - began:.0f} s: {heard.live} live samples '
                f'of {play * frames}, {heard.lifts} lifts assessed'
            )
            assert (heard.live, heard.lifts) == (play * frames, play)
        codes = graph.stop()
    finally:
        if player is not None:
            player.stop()
        stack.close()
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
    return heard, codes, frames


def check(bag, rounds, loops, folder):
    heard, codes, frames = soak(bag, rounds, loops, folder)
    plays = rounds * loops
    assert heard.live == plays * frames
    assert heard.lifts == heard.measured == plays
    # Of a recording's frames only those before the first plate sample's time do not solve.
    assert heard.unsolved <= 10 * plays
    assert set(codes.values()) <= {0, -15}


@pytest.mark.timeout(280)
def test_four_plays(bags, tmp_path):
    check(bags / BAG, 2, 2, tmp_path)


@pytest.mark.long
@pytest.mark.timeout(2400)
def test_two_hundred_plays(bags, tmp_path):
    check(bags / BAG, 10, 20, tmp_path)
