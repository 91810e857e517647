# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift run`: one recording through the whole graph, each node a process, results recorded."""

from __future__ import annotations

import faulthandler
import math
import os
import shutil
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import rclpy
from rclpy.client import Client
from rclpy.executors import Executor
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import SetBool, Trigger

from lifting_cli.graph import Graph
from lifting_cli.graph_errors import SessionError
from lifting_cli.interruption import SignalMask
from lifting_cli.live.state import FOLLOWED, LiveState
from lifting_cli.live.view import LiveView
from lifting_cli.node_process import (
    NodeProcess,
    discovery,
    node_processes,
    start_module,
    stop_all,
)
from lifting_cli.recording_summary import NO_LIFT, BagSummary, gauge_limits, summarise
from lifting_cli.topics import RESULT_TOPICS, TOPICS, VISUALIZATION_TOPICS
from lifting_cli.transport.qos import message_class
from lifting_messages.message_types import full_name
from lifting_node import qos

#: Time [s] that closing this process's own node may take.
CLOSING = 10.0

#: Time [s] without any message after which the graph counts as quiet.
QUIET = 1.0


@dataclass(frozen=True)
class RunOptions:
    """What to run and how.

    Attributes
    ----------
    bag : Path
        The recording.
    output : Path
        Folder for results.mcap, report.html and logs; files of an earlier run are replaced.
    rate : float
        Times real time.
    station : str
        Namespace of the graph.
    settle_timeout : float
        Time [s] the graph has after the recording's end to finish all lifts.
    visualize : bool
        Also start the node that draws for RViz and Foxglove.
    record_visualization : bool
        Also put what it draws into the results file.
    """

    bag: Path
    output: Path
    rate: float = 1.0
    station: str = 'station_1'
    settle_timeout: float = 120.0
    visualize: bool = False
    record_visualization: bool = False


@dataclass
class RunReport:
    """What a run left behind.

    Attributes
    ----------
    results : Path
        MCAP file with the results.
    state : LiveState
        What happened.
    ready : float
        When the recording began to play [s of the monotonic clock].
    exit_codes : dict
        Exit code of each process.
    """

    results: Path
    state: LiveState
    ready: float
    exit_codes: dict[str, int] = field(default_factory=dict)


def run_online(
    options: RunOptions,
    say: Callable[[str], None] = print,
    processes: list[NodeProcess] | None = None,
) -> RunReport:
    """Run a recording through the graph.

    Parameters
    ----------
    options : RunOptions
        What to run and how.
    say : callable
        Takes a line for the user.
    processes : list of NodeProcess, optional
        The nodes, if they have been started already (`node_process.node_processes`).

    Raises
    ------
    lifting_cli.graph_errors.GraphError
        If the graph does not come up, dies or does not finish.
    lifting_recordings.exceptions.BagError
        If the recording cannot be read.
    """
    logs = options.output / 'logs'
    mask = SignalMask()
    with ExitStack() as stack:
        stack.callback(mask.end)
        if processes is None:
            processes = stack.enter_context(
                node_processes(logs, options.station, options.visualize)
            )
        summary = summarise(options.bag)
        shutil.rmtree(options.output / 'recording', ignore_errors=True)
        helpers = _start_helpers(options, logs, summary)
        stack.callback(stop_all, helpers)
        recorder, player = helpers
        os.environ.update(discovery())
        stack.callback(faulthandler.cancel_dump_traceback_later)
        # A signal is Python's: the context must live until all that is in it has been destroyed.
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        stack.callback(rclpy.try_shutdown)
        node = Node('lift_run', namespace=options.station)
        stack.callback(node.destroy_node)
        executor = EventsExecutor()
        stack.callback(executor.shutdown)
        # The processes end before this one's node does, whatever happens to that: after an
        # interruption rclpy can wait for ever in destroy_node.
        stack.callback(
            faulthandler.dump_traceback_later,
            CLOSING,
            exit=True,
            file=sys.__stderr__ or sys.stderr,
        )
        stack.callback(stop_all, [*helpers, *processes])
        stack.callback(mask.begin)
        executor.add_node(node)
        graph = Graph(node, executor, options.station, processes, say)
        say(f'starting the graph: {", ".join(process.name for process in processes)}')
        graph.bring_up()
        session = _Session(options, summary, node, executor, graph)
        session.wait_for_service(SetBool, 'player/pause', [recorder, player])
        ready = time.monotonic()
        say(f'playing {options.bag.name} at {options.rate:g} times real time')
        session.play(player, recorder)
        codes = {'recorder': recorder.stop(), **graph.stop()}
        return RunReport(_collect(options.output), session.state, ready, codes)


def _start_helpers(options: RunOptions, logs: Path, summary: BagSummary) -> list[NodeProcess]:
    wanted = RESULT_TOPICS + (VISUALIZATION_TOPICS if options.record_visualization else ())
    topics = [
        topic if topic.startswith('/') else f'/{options.station}/{topic}' for topic in wanted
    ]
    recorder = start_module(
        'recorder',
        'lifting_cli.cli',
        logs,
        arguments=('record', str(options.output / 'recording'), '--topics', *topics),
    )
    player = start_module(
        'player',
        'lifting_cli.cli',
        logs,
        arguments=(
            'play',
            str(options.bag),
            '--rate',
            str(options.rate),
            '--station',
            options.station,
            '--start-paused',
            '--plate-blocks',
            '--wait-timeout',
            '600',
            '--wait-for',
            *summary.inputs,
        ),
        terminal=True,
    )
    return [recorder, player]


def _collect(output: Path) -> Path:
    """Move the recorded file to its place and drop the folder around it."""
    files = sorted((output / 'recording').glob('*.mcap'))
    if len(files) != 1:
        raise SessionError(f'{output / "recording"} holds {len(files)} MCAP files, not one')
    results = output / 'results.mcap'
    files[0].replace(results)
    shutil.rmtree(output / 'recording')
    return results


class _Session:
    """Playing and settling of one run, with its live view."""

    def __init__(
        self,
        options: RunOptions,
        summary: BagSummary,
        node: Node,
        executor: Executor,
        graph: Graph,
    ) -> None:
        self._options = options
        self._node = node
        self._executor = executor
        self._graph = graph
        self.state = LiveState(summary.start)
        self._view = LiveView(self.state, summary.duration, gauge_limits(summary))
        self._last = time.monotonic()
        self._clients: dict[str, Client] = {}
        # A server drops the answer to a client that it has not heard of yet: known from the start.
        self._client(Trigger, 'motion_tracker/flush')
        for topic in (TOPICS[name] for name in FOLLOWED):
            kind = message_class(full_name(topic.type))
            node.create_subscription(kind, topic.name, self._take, qos.profile(topic.quality))

    def _take(self, message: Any) -> None:
        self._last = time.monotonic()
        self._view.add(self.state.update(message))

    def wait_for_service(
        self, service: type, name: str, processes: list[NodeProcess], timeout: float = 30.0
    ) -> None:
        """Wait until a helper process offers its service."""
        client = self._client(service, name)
        deadline = time.monotonic() + timeout
        while not client.service_is_ready():
            self._check(processes)
            if time.monotonic() > deadline:
                raise SessionError(f'{name} did not appear within {timeout:g} s')
            self._executor.spin_once(timeout_sec=0.02)

    def _client(self, service: type, name: str) -> Client:
        if name not in self._clients:
            self._clients[name] = self._node.create_client(service, name)
        return self._clients[name]

    def play(self, player: NodeProcess, recorder: NodeProcess) -> None:
        """Play to the end, have the last frames flushed and wait for all results."""
        with self._view:
            self._call(SetBool, 'player/pause', SetBool.Request(data=False), again=1.0)
            while player.process.poll() is None:
                self._check([recorder])
                self._step()
            if player.process.returncode != 0:
                player.check()
            response = self._call(Trigger, 'motion_tracker/flush', Trigger.Request(), again=5.0)
            if not response.success:
                self._view.warn(response.message)
            deadline = time.monotonic() + self._options.settle_timeout
            while not (self.state.complete and time.monotonic() - self._last > QUIET):
                self._check([recorder])
                self._step()
                if time.monotonic() > deadline:
                    missing = sorted(self.state.lifts_ended - self.state.lifts_assessed)
                    raise SessionError(
                        f'no assessment of {", ".join(missing) or "the last frames"} within '
                        f'{self._options.settle_timeout:g} s'
                    )
            if not self.state.lifts_ended:
                self._view.warn(NO_LIFT)

    def _check(self, processes: list[NodeProcess]) -> None:
        self._graph.check()
        for process in processes:
            process.check()

    def _step(self) -> None:
        self._executor.spin_once(timeout_sec=0.1)
        self._view.refresh()

    def _call(
        self,
        service: type,
        name: str,
        request: Any,
        timeout: float = 30.0,
        again: float = math.inf,
    ) -> Any:
        """Call a service; ask once more each `again` seconds if that does no harm."""
        client = self._client(service, name)
        began = asked = time.monotonic()
        futures = [client.call_async(request)]
        while not any(future.done() for future in futures):
            self._graph.check()
            now = time.monotonic()
            if now > began + timeout:
                raise SessionError(f'{name} did not answer within {timeout:g} s')
            if now > asked + again:
                asked = now
                futures.append(client.call_async(request))
            self._step()
        return next(future.result() for future in futures if future.done())
