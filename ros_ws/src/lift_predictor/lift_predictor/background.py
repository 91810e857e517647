# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Work of an action goal on a thread, so that the node still hears a request to cancel."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cached_property
from typing import Any, Final

from rclpy.action import CancelResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node
from rclpy.task import Future

from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.solvers.stop import StopFlag

CLOSED: Final = 'the node is being shut down'
CANCELLED: Final = 'cancelled by the client'


class Background:
    """Runs the work of goals one after the other.

    Parameters
    ----------
    node : Node
        Whose executor goes on when the work is done.
    options : PredictorOptions
        Of the predictor that works here.
    """

    def __init__(self, node: Node, options: PredictorOptions) -> None:
        self._node = node
        self._options = options
        self._turn = threading.Lock()
        self._guard = threading.Lock()
        self._closed = False
        self._current: bytes | None = None
        self._cancelled: set[bytes] = set()
        self._stop = StopFlag()

    @cached_property
    def predictor(self) -> LiftPredictor:
        """A predictor beside that of the recorded lifts, for the goals of actions."""
        return LiftPredictor(self._options, self._stop)

    def close(self) -> None:
        """Have all work end, the one at hand before the solver's next iteration."""
        with self._guard:
            self._closed = True
            self._stop.set(CLOSED)

    def cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        """Have the work of a goal end, before the solver's next iteration if it is at hand."""
        with self._guard:
            self._cancelled.add(_name(handle))
            if self._current == _name(handle):
                self._stop.set(CANCELLED)
        return CancelResponse.ACCEPT

    def check(self) -> None:
        """End the work at hand here if its goal was cancelled or the node is being cleaned up.

        Raises
        ------
        CancelledError
            Ends the work.
        """
        self._stop.check()

    async def run(self, handle: ServerGoalHandle, work: Callable[[], Any]) -> Any:
        """Return what `work` returns, or raise what it raises, without holding up the node.

        Raises
        ------
        CancelledError
            The goal was cancelled, or the node is being cleaned up.
        """
        done = Future(executor=self._node.executor)

        def target() -> None:
            with self._turn:
                try:
                    self._begin(_name(handle))
                    done.set_result(work())
                except Exception as error:  # handed to whoever awaits
                    done.set_exception(error)
                finally:
                    self._end(_name(handle))

        # A daemon: a process that is told to stop does not wait for an optimiser.
        threading.Thread(target=target, name='action', daemon=True).start()
        return await done

    def _begin(self, name: bytes) -> None:
        with self._guard:
            self._current = name
            self._stop.clear()
            if self._closed:
                self._stop.set(CLOSED)
            elif name in self._cancelled:
                self._stop.set(CANCELLED)
        self._stop.check()

    def _end(self, name: bytes) -> None:
        with self._guard:
            self._current = None
            self._cancelled.discard(name)


def _name(handle: ServerGoalHandle) -> bytes:
    return bytes(handle.goal_id.uuid)
