# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The running graph: its node processes and their lifecycle."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rclpy.client import Client
from rclpy.executors import Executor
from rclpy.node import Node

from lifting_cli.graph_errors import TransitionError
from lifting_cli.node_process import NodeProcess, stop_all

#: Time [s] a node has for one lifecycle transition; the first start compiles the models.
TRANSITION_TIMEOUT = 300.0

#: Time [s] of silence after which it is told what is being waited for.
PATIENCE = 10.0


class Graph:
    """Configure, activate, check and stop the nodes of a station.

    Parameters
    ----------
    node : Node
        Node of this process, through which the lifecycle services are called.
    executor : Executor
        Executor that spins `node`.
    station : str
        Namespace of the station.
    processes : list of NodeProcess
        The running nodes.
    say : callable, optional
        Takes a line for the user when a start takes long.
    """

    def __init__(
        self,
        node: Node,
        executor: Executor,
        station: str,
        processes: list[NodeProcess],
        say: Callable[[str], None] = lambda text: None,
    ) -> None:
        self._node = node
        self._executor = executor
        self._station = station
        self._say = say
        self.processes = processes

    def bring_up(self) -> None:
        """Configure and activate all nodes.

        Raises
        ------
        TransitionError
            If a node refuses or does not answer in time.
        NodeDiedError
            If a process ended.
        """
        self._transition_all(Transition.TRANSITION_CONFIGURE, 'configure')
        self._transition_all(Transition.TRANSITION_ACTIVATE, 'activate')

    def check(self) -> None:
        """Raise NodeDiedError if a node process has ended."""
        for process in self.processes:
            process.check()

    def stop(self) -> dict[str, int]:
        """End all node processes; return their exit codes."""
        return stop_all(self.processes)

    def _transition_all(self, transition: int, name: str) -> None:
        began = time.monotonic()
        deadline = began + TRANSITION_TIMEOUT
        patient = True
        clients: dict[str, Client] = {
            process.name: self._node.create_client(
                ChangeState, f'/{self._station}/{process.name}/change_state'
            )
            for process in self.processes
        }
        futures: dict[str, Any] = {}
        while len(futures) < len(clients) or not all(f.done() for f in futures.values()):
            self.check()
            for node_name, client in clients.items():
                if node_name not in futures and client.service_is_ready():
                    request = ChangeState.Request(transition=Transition(id=transition))
                    futures[node_name] = client.call_async(request)
            waiting = [n for n in clients if n not in futures or not futures[n].done()]
            if time.monotonic() > deadline:
                raise TransitionError(f'{name}: no answer from {", ".join(waiting)}')
            if patient and waiting and time.monotonic() > began + PATIENCE:
                patient = False
                self._say(
                    f'waiting for {", ".join(waiting)} to {name}: after a change of the '
                    'code they compile their models, which takes a minute or two'
                )
            self._executor.spin_once(timeout_sec=0.02)
        for client in clients.values():
            self._node.destroy_client(client)
        refused = [n for n, future in futures.items() if not future.result().success]
        if refused:
            logs = ', '.join(str(p.log) for p in self.processes if p.name in refused)
            raise TransitionError(f'{", ".join(refused)} refused to {name}; see {logs}')
