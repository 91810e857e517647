# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Work of an action goal on a thread, so that the node still hears a request to cancel."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cached_property
from typing import Any

from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node
from rclpy.task import Future

from lift_predictor.core.exceptions import CancelledError
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.predictor import LiftPredictor


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
        self._closed = False

    @cached_property
    def predictor(self) -> LiftPredictor:
        """A predictor beside that of the recorded lifts, configured anew by each piece of work."""
        return LiftPredictor(self._options)

    def close(self) -> None:
        """Have all work end at its next step."""
        self._closed = True

    def check(self, handle: ServerGoalHandle) -> None:
        """End the work here if the goal was cancelled or the node is being cleaned up.

        Raises
        ------
        CancelledError
            Ends the work.
        """
        if self._closed:
            raise CancelledError('the node is being shut down')
        if handle.is_cancel_requested:
            raise CancelledError('cancelled by the client')

    async def run(self, work: Callable[[], Any]) -> Any:
        """Return what `work` returns, or raise what it raises, without holding up the node."""
        done = Future(executor=self._node.executor)

        def target() -> None:
            with self._turn:
                try:
                    done.set_result(work())
                except Exception as error:  # handed to whoever awaits
                    done.set_exception(error)

        # A daemon: a process that is told to stop does not wait for an optimiser.
        threading.Thread(target=target, name='action', daemon=True).start()
        return await done
