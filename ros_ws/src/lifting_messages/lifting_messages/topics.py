# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Declarations of topics: name, type and quality of service, without ROS."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Final


class Quality(Enum):
    """Quality of service of a topic; all are reliable and keep the last `depth` messages.

    The graph analyses recordings as well as live streams, and an analysis with a missing plate
    sample is wrong without a visible sign. So streams are reliable, with a history deep enough
    for the slowest subscriber at ten times real time, not best effort.

    Attributes
    ----------
    depth : int
        Messages kept.
    latched : bool
        Whether a late subscriber receives the kept messages (transient local).
    """

    PLATES = 40_000, False
    """Samples of a force plate: 16 s at 2500 Hz, the lag that a subscriber may have."""
    FRAMES = 20_000, False
    """One message per camera frame: 200 s at 100 Hz."""
    LATCHED = 1, True
    """Subject and task: sent once."""
    RESULTS = 100, True
    """Whole lifts, events and alarms: the recent ones for a late subscriber."""
    VIEW = 10, False
    """Markers for display. Reliable, because RViz requests it; a late viewer loses older ones."""
    TRANSFORMS = 100, False
    """`/tf`, as all broadcasters of ROS 2."""

    @property
    def depth(self) -> int:
        """Number of messages kept."""
        return self.value[0]

    @property
    def latched(self) -> bool:
        """Whether a late subscriber receives the kept messages."""
        return self.value[1]


@dataclass(frozen=True)
class Topic:
    """A topic of the graph.

    Attributes
    ----------
    name : str
        Relative to the station; absolute with a leading slash.
    type : str
        'package/Name'.
    quality : Quality
    recorded : bool
        Whether the results of a run contain it.
    """

    name: str
    type: str
    quality: Quality
    recorded: bool = True


#: Person and task, the inputs of nearly every package.
SUBJECT: Final = Topic('subject', 'lifting_interfaces/Subject', Quality.LATCHED)
TASK: Final = Topic('task', 'lifting_interfaces/Task', Quality.LATCHED)
