# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Facts of a recording that are needed before its first message; no ROS here."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from injury_monitor.core.limits import limits_for
from lifting_recordings.reader import BagReader
from motion_tracker.topics import STREAMS

#: Topics with samples for the motion tracker.
INPUTS = tuple(topic.name for topic in STREAMS)

#: Said when a recording ends without a lift.
NO_LIFT = 'no lift found: nothing rose as motion_tracker asks for'


@dataclass(frozen=True)
class BagSummary:
    """Start [s], duration [s], loads per day and input topics of a recording."""

    start: float
    duration: float
    lifts_per_day: float
    inputs: tuple[str, ...]


def summarise(path: Path) -> BagSummary:
    """Read what the live view must know before the first message."""
    with BagReader(path) as bag:
        tasks = [name for name in bag.topics if name.strip('/') == 'task']
        per_day = [m.lifts_per_day for _, _, m in bag.messages(tasks)] if tasks else []
        return BagSummary(
            start=bag.start_ns * 1e-9,
            duration=(bag.end_ns - bag.start_ns) * 1e-9,
            lifts_per_day=per_day[-1] if per_day else 0.0,
            inputs=tuple(name.strip('/') for name in bag.topics if name.strip('/') in INPUTS),
        )


def gauge_limits(summary: BagSummary) -> dict[str, float]:
    """Return the limits [N] that the gauges of the live view show."""
    limits = limits_for(summary.lifts_per_day)
    return {'compression': limits.compression_action.value, 'shear': limits.shear.value}
