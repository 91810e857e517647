# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""One lifecycle transition of one node, asked for until the node is seen to have made it."""

from __future__ import annotations

import time
from typing import Any

from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.node import Node

#: Primary state before and after each transition that a start makes.
STATES = {
    Transition.TRANSITION_CONFIGURE: (
        State.PRIMARY_STATE_UNCONFIGURED,
        State.PRIMARY_STATE_INACTIVE,
    ),
    Transition.TRANSITION_ACTIVATE: (State.PRIMARY_STATE_INACTIVE, State.PRIMARY_STATE_ACTIVE),
}

#: Time [s] without an answer after which the node is asked for its state.
UNANSWERED = 2.0


class LifecycleChange:
    """Request a transition, and its outcome where the answer is lost.

    A service drops its answer to a client that it has not discovered yet, and the client is never
    told.  So a node that does not answer is asked for its state: in the state after the transition
    it has made it, in the state before it the transition is requested again.

    Parameters
    ----------
    node : Node
        Node of this process, through which the services are called.
    name : str
        Full name of the node to change.
    transition : int
        `Transition.TRANSITION_CONFIGURE` or `TRANSITION_ACTIVATE`.
    unanswered : float
        Time [s] without an answer after which the node is asked for its state.

    Attributes
    ----------
    success : bool or None
        Whether the node made the transition; None until this is known.
    """

    def __init__(
        self, node: Node, name: str, transition: int, unanswered: float = UNANSWERED
    ) -> None:
        self.success: bool | None = None
        self._node = node
        self._before, self._after = STATES[transition]
        self._request = ChangeState.Request(transition=Transition(id=transition))
        self._unanswered = unanswered
        self._change = node.create_client(ChangeState, f'{name}/change_state')
        self._state = node.create_client(GetState, f'{name}/get_state')
        self._pending: list[Any] = []
        self._states: list[Any] = []
        self._requests = 0
        self._refused = False
        self._asked = 0.0

    def poll(self) -> None:
        """Take what was answered and ask what is to be asked; the caller spins the node."""
        if self._requests == 0:
            if self._change.service_is_ready():
                self._ask_change()
            return
        for answer in _taken(self._pending):
            if answer.success:
                self.success = True
            else:
                self._refused = True
        if self._refused and self._requests == 1:
            self.success = False
        for answer in _taken(self._states):
            self._judge(answer.current_state.id)
        if self.success is None and time.monotonic() > self._asked + self._unanswered:
            self._ask_state()

    def close(self) -> None:
        """Destroy the clients."""
        self._node.destroy_client(self._change)
        self._node.destroy_client(self._state)

    def _judge(self, state: int) -> None:
        if state == self._after:
            self.success = True
        elif state == State.PRIMARY_STATE_FINALIZED or (self._refused and state == self._before):
            self.success = False
        elif state == self._before:
            self._ask_change()

    def _ask_change(self) -> None:
        self._requests += 1
        self._asked = time.monotonic()
        self._pending.append(self._change.call_async(self._request))

    def _ask_state(self) -> None:
        self._asked = time.monotonic()
        if self._state.service_is_ready():
            self._states.append(self._state.call_async(GetState.Request()))


def _taken(futures: list[Any]) -> list[Any]:
    """Remove the futures that are done; return their results."""
    done = [future for future in futures if future.done()]
    futures[:] = [future for future in futures if future not in done]
    return [future.result() for future in done]
