# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Graphs of real node processes with a player each, and the time their frames take.

The latency of a frame begins when the player's middleware is handed its `markers` message and ends
when the monitor's word on it has reached another process: DDS stamps both, with the clock of this
machine. So the plate samples that the tracker needs for the frame, inverse kinematics, muscle
analysis, the monitor and every hop between are in it; the delay of the live filters, which is
known and said in every message, is not: it is taken off the stamps. This process lets what it
hears lie until a recording is over, so that it takes no time from what it measures.
"""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Iterable
from pathlib import Path
from types import TracebackType
from typing import Any, Final

import numpy as np
import rclpy
from lifting_interfaces.msg import Markers
from rclpy.client import Client
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.subscription import Subscription
from std_msgs.msg import Header
from std_srvs.srv import SetBool

from human_model.typing import Array
from lifting_cli.graph import Graph
from lifting_cli.node_process import PARAMETERS, NodeProcess, discovery, start_module
from lifting_cli.recording_summary import summarise
from lifting_messages.stamps import stamp_of
from lifting_node import qos

ROOT: Final = Path(__file__).resolve().parents[1]
CHAIN: Final = ('muscle_analyzer', 'motion_tracker', 'injury_monitor')
WHOLE: Final = ('muscle_analyzer', 'lift_predictor', 'motion_tracker', 'injury_monitor')
MODULES: Final = {'injury_monitor': 'benchmarks.monitor_probe'}
"""Modules that stand for a node's own."""
SETTLE: Final = 1.0
"""Beginning of a play that is not counted: the filters settle, the processes wake up [s]."""
PLAYER_LIMIT: Final = 30.0
"""Time [s] for players to appear, and beyond a recording's length for them to end."""
ACQUAINTED: Final = 3.5
"""Time [s] for processes to hear of all of each other's topics: what they miss of them at first
comes again after three."""
AGAIN: Final = 1.0
"""Time [s] after which a player is asked again: it drops the answer to who it has not heard of."""
LATE: Final = 10.0
"""Time [s] after the recording's end in which a frame may still be judged."""
GENTLE: Final = 3.0
"""Time [s] a process has to end before it is killed."""
STAMPS: Final = 1e-4
"""Differences [s] of stamps below which they are of the same frame."""


class Station:
    """One namespaced graph and what was heard of it.

    Parameters
    ----------
    name
        Namespace.
    nodes
        Names of its nodes.
    node
        Node of this process that hears the station; nobody spins it.
    logs
        Folder of the processes' output.
    """

    def __init__(self, name: str, nodes: Iterable[str], node: Node, logs: Path) -> None:
        self.name = name
        self._logs = logs / name
        self.processes = [
            start_module(
                n, MODULES.get(n, f'{n}.{n}_node'), self._logs, name, parameters=PARAMETERS.get(n)
            )
            for n in nodes
        ]
        self.player: NodeProcess | None = None
        self.sent: list[tuple[float, float]] = []
        self.judged: list[tuple[float, float]] = []
        self._markers = node.create_subscription(
            Markers, f'/{name}/markers', _nobody, qos.FRAMES, raw=True
        )
        self._judgements = node.create_subscription(
            Header, f'/{name}/judged', _nobody, qos.FRAMES, raw=True
        )

    def listen(self) -> None:
        """Take what has come: stamps of frames with DDS' times of sending and of arrival [s]."""
        self.sent += _taken(self._markers, 'Markers', 'source_timestamp')
        self.judged += _taken(self._judgements, 'std_msgs/Header', 'received_timestamp')

    def start_player(self, bag: Path) -> None:
        """Start a paused player of a recording."""
        inputs = summarise(bag).inputs
        arguments = (
            'play', str(bag), '--station', self.name, '--start-paused', '--plate-blocks',
            '--wait-timeout', '60',
            '--wait-for', *inputs,
        )  # fmt: skip
        self.player = start_module('player', 'lifting_cli.cli', self._logs, arguments=arguments)

    @property
    def waiting(self) -> bool:
        """Whether frames have been sent that are not judged."""
        return len(self.judged) < len(self.sent)

    def latencies(self) -> Array:
        """Give the latencies [s] of the frames heard since the last call, less the first second.

        Those that were not judged in time are infinite.

        Raises
        ------
        RuntimeError
            If frames cannot be told from each other.
        """
        sent, judged = np.array(self.sent), np.full((len(self.sent), 2), np.inf)
        judged[: len(self.judged)] = self.judged
        in_time = len(self.judged)
        self.sent, self.judged = [], []
        delay = (sent - judged)[:in_time, 0]
        if not in_time or np.ptp(delay) > STAMPS:
            raise RuntimeError(f'{self.name}: frames were lost or came in another order than sent')
        later = sent[:, 0] >= sent[0, 0] + SETTLE
        latency: Array = (judged[:, 1] - sent[:, 1])[later]
        return latency


def _nobody(_message: bytes) -> None:
    """Stand for the callback of a subscription that is never spun."""


def _taken(subscription: Subscription, name: str, time_of: str) -> list[tuple[float, float]]:
    """Stamps of the messages that lie in a subscription, each with a time that DDS has noted."""
    taken = []
    with subscription.handle:
        while (one := subscription.handle.take_message(subscription.msg_type, True)) is not None:
            data, info = one
            taken.append((1e-9 * stamp_of(data, name), 1e-9 * info[time_of]))
    return taken


class Stations:
    """Stations that are measured together; every process of them ends with this context.

    Parameters
    ----------
    nodes
        Names of the nodes of each station.
    logs
        Folder of the processes' output.
    """

    def __init__(self, nodes: tuple[str, ...], logs: Path) -> None:
        self._nodes = nodes
        self._logs = logs
        self._stations: list[Station] = []

    def __enter__(self) -> Stations:
        """Start ROS in this process."""
        os.environ.update(discovery())
        # The probe is a module of the benchmarks.
        os.environ['PYTHONPATH'] = os.pathsep.join(
            [str(ROOT), *filter(None, [os.environ.get('PYTHONPATH')])]
        )
        rclpy.init()
        self._node = Node('latency_bench')
        self._ears = Node('latency_bench_ears')
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End all processes, hard if they do not."""
        processes = [p for station in self._stations for p in station.processes]
        processes += [s.player for s in self._stations if s.player is not None]
        for process in processes:
            process.terminate()
        end = time.monotonic() + GENTLE
        for process in processes:
            try:
                process.process.wait(max(0.0, end - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.process.kill()
                process.process.wait()
        self._executor.shutdown()
        self._node.destroy_node()
        self._ears.destroy_node()
        rclpy.try_shutdown()

    def add(self) -> None:
        """Start one station more and bring it up."""
        name = f'bench_{os.getpid()}_{len(self._stations) + 1}'
        station = Station(name, self._nodes, self._ears, self._logs)
        self._stations.append(station)
        Graph(self._node, self._executor, name, station.processes).bring_up()

    def play(self, bag: Path) -> list[Array]:
        """Play a recording in all stations at once; give the latencies [s] of each.

        Raises
        ------
        RuntimeError
            If a player fails or frames are lost.
        """
        services = [f'/{station.name}/player/pause' for station in self._stations]
        for station in self._stations:
            station.start_player(bag)
        clients = [self._node.create_client(SetBool, name) for name in services]
        self._spin(lambda: all(client.service_is_ready() for client in clients), PLAYER_LIMIT)
        acquainted = time.monotonic() + ACQUAINTED
        self._spin(lambda: time.monotonic() > acquainted, PLAYER_LIMIT)
        self._set_going(clients)
        duration = summarise(bag).duration
        players = [station.player for station in self._stations]
        self._spin(
            lambda: all(p is not None and p.process.poll() is not None for p in players),
            duration + PLAYER_LIMIT,
        )
        for player in players:
            if player is not None and player.process.returncode:
                player.check()
        for client in clients:
            self._node.destroy_client(client)
        end = time.monotonic() + LATE
        while True:
            for station in self._stations:
                station.listen()
            if time.monotonic() > end or not any(s.waiting for s in self._stations):
                break
            time.sleep(0.05)
        return [station.latencies() for station in self._stations]

    def _set_going(self, clients: list[Client]) -> None:
        """Have all players begin; ask those again whose answer was lost."""
        waiting = {client: [client.call_async(SetBool.Request(data=False))] for client in clients}
        end = time.monotonic() + PLAYER_LIMIT
        while waiting and time.monotonic() < end:
            asked = time.monotonic()
            while waiting and time.monotonic() < asked + AGAIN:
                self._executor.spin_once(timeout_sec=0.05)
                waiting = {
                    client: futures
                    for client, futures in waiting.items()
                    if not any(future.done() for future in futures)
                }
            for client, futures in waiting.items():
                futures.append(client.call_async(SetBool.Request(data=False)))
        if waiting:
            raise RuntimeError(f'{len(waiting)} players do not answer')

    def _spin(self, done: Any, limit: float) -> None:
        end = time.monotonic() + limit
        while not done():
            self._executor.spin_once(timeout_sec=0.05)
            for station in self._stations:
                for process in station.processes:
                    process.check()
            if time.monotonic() > end:
                raise RuntimeError(f'not done within {limit:g} s')
