# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the tracker's inputs, of a running graph or of a recording."""

from __future__ import annotations

import math

import numpy as np

from human_model.typing import Array
from lifting_messages import Message
from lifting_messages.names import split
from motion_tracker.core.exceptions import TrackerError


def markers_from_msg(message: Message) -> tuple[float, tuple[str, ...], Array]:
    """Return stamp [s], names and positions (n, 3) [m] of a marker frame; NaN: not seen.

    Raises
    ------
    TrackerError
        If there are not three coordinates for each name.
    """
    names = split(message.names)
    positions = np.asarray(message.positions, np.float64)
    if positions.size != 3 * len(names):
        raise TrackerError(f'markers.positions: {positions.size} numbers for {len(names)} names')
    return _seconds(message), names, positions.reshape(-1, 3)


def wrench_from_msg(message: Message) -> tuple[float, Array, Array]:
    """Return stamp [s], force [N] and moment about the laboratory's origin [N m] (3,)."""
    force, moment = message.wrench.force, message.wrench.torque
    return (
        _seconds(message),
        np.array([force.x, force.y, force.z]),
        np.array([moment.x, moment.y, moment.z]),
    )


def box_from_msg(message: Message) -> tuple[float, Array]:
    """Return stamp [s] and centre of the box (3,) [m]."""
    at = message.pose.position
    return _seconds(message), np.array([at.x, at.y, at.z])


def task_from_msg(message: Message) -> tuple[float, Array]:
    """Return mass [kg] and size (3,) [m] of the box.

    Raises
    ------
    TrackerError
        If the mass is negative or not finite.
    """
    if not (math.isfinite(message.box_mass) and message.box_mass >= 0):
        raise TrackerError(f'task.box_mass: {message.box_mass} kg is no mass')
    return float(message.box_mass), np.asarray(message.box_size, dtype=np.float64)


def _seconds(message: Message) -> float:
    stamp = message.header.stamp
    return float(stamp.sec) + float(stamp.nanosec) / 1e9
