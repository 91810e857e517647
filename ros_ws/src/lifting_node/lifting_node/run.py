# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Entry point of a node process."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node

from lifting_messages.exceptions import ParameterError
from lifting_node.discovery import STAY_ON_MACHINE


def run_node(factory: Callable[[], Node], args: list[str] | None = None) -> None:
    """Create a node and spin it until it is told to stop.

    One event-driven executor a process, stepped with a time-out: it takes a third of the
    processor time of the waiting executors at a thousand messages a second, and stepping keeps
    signals served.

    Discovery stays on this machine unless `ROS_AUTOMATIC_DISCOVERY_RANGE` is set, however the
    process is started.

    Parameters
    ----------
    factory : callable
        Makes the node.
    args : list of str, optional
        Command line, with `--ros-args`; that of the process if absent.

    Raises
    ------
    SystemExit
        With code 2 if a parameter was refused.
    """
    os.environ.setdefault(*STAY_ON_MACHINE)
    rclpy.init(args=args)
    try:
        node = factory()
    except ParameterError as error:
        rclpy.try_shutdown()
        print(error, file=sys.stderr)
        raise SystemExit(2) from error
    executor = EventsExecutor()
    executor.add_node(node)
    try:
        while rclpy.ok():
            executor.spin_once(timeout_sec=0.2)
    except (KeyboardInterrupt, ExternalShutdownException):
        return
    except rclpy_implementation.RCLError:
        # A signal ends the context at once, also under a callback that is about to publish.
        if rclpy.ok():
            raise
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
