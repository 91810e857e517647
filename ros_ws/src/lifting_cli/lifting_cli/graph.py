# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The running graph: its node processes and their lifecycle."""

from __future__ import annotations

import time
from collections.abc import Callable

from lifecycle_msgs.msg import Transition
from rclpy.executors import Executor
from rclpy.node import Node

from lifting_cli.graph_errors import TransitionError
from lifting_cli.lifecycle_change import LifecycleChange
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
        changes = {
            process.name: LifecycleChange(
                self._node, f'/{self._station}/{process.name}', transition
            )
            for process in self.processes
        }
        try:
            while waiting := [n for n, change in changes.items() if change.success is None]:
                self.check()
                now = time.monotonic()
                if now > deadline:
                    raise TransitionError(f'{name}: no answer from {self._logs(waiting)}')
                if patient and now > began + PATIENCE:
                    patient = False
                    self._say(
                        f'waiting for {", ".join(waiting)} to {name}: after a change of the '
                        'code they compile their models, which takes a minute or two'
                    )
                for node_name in waiting:
                    changes[node_name].poll()
                self._executor.spin_once(timeout_sec=0.02)
        finally:
            for change in changes.values():
                change.close()
        refused = [n for n, change in changes.items() if not change.success]
        if refused:
            raise TransitionError(f'refused to {name}: {self._logs(refused)}')

    def _logs(self, names: list[str]) -> str:
        """Return names of nodes, each with its log."""
        return ', '.join(f'{p.name} (see {p.log})' for p in self.processes if p.name in names)
