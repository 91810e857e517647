# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""How far away a process may be to discover the nodes of a station."""

from __future__ import annotations

from typing import Final

STAY_ON_MACHINE: Final = ('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
"""Variable and its default: a worker's data do not leave the station unless the user sets it."""
