# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What to play and how, what was played, and how to pause it; no ROS here."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from lifting_recordings.exceptions import PlaybackError
from lifting_recordings.reader import BagLoss


@dataclass(frozen=True)
class PlayOptions:
    """What to play and how.

    Attributes
    ----------
    bag : Path
        Any rosbag2 bag.
    rate : float
        Bag seconds per second.
    loop : int
        How often to play; 0: until stopped.
    start : float
        Offset into the bag [s]. The last transient-local messages before it are still sent.
    namespace : str
        Prefix of all topics and of the node.
    topics : tuple of str
        Topics to play (as stored, the leading slash may be left out); empty: all.
    clock_hz : float
        `/clock` messages per second of wall time; 0: none.
    start_paused : bool
        Wait for resume.
    wait_for : Mapping of str to int
        Topic to number of subscribers to wait for.
    wait_timeout : float
        [s] for the above.
    ack_timeout : float
        [s] to wait at the end for the subscribers' acknowledgements, and in the middle for one
        that has stopped taking messages.
    play_alarms : bool
        Also play stored alarms.
    plate_blocks : bool
        Send the samples of a force plate in blocks, one for each camera frame, on the topic
        beside that of single samples (`lifting_interfaces/WrenchBlock`).
    """

    bag: Path
    rate: float = 1.0
    loop: int = 1
    start: float = 0.0
    namespace: str = ''
    topics: tuple[str, ...] = ()
    clock_hz: float = 100.0
    start_paused: bool = False
    wait_for: Mapping[str, int] = field(default_factory=dict)
    wait_timeout: float = 20.0
    ack_timeout: float = 30.0
    play_alarms: bool = False
    plate_blocks: bool = False

    def __post_init__(self) -> None:
        """Refuse impossible numbers."""
        if not self.rate > 0.0:
            raise PlaybackError(f'option rate: {self.rate} is not positive')
        if self.loop < 0:
            raise PlaybackError(f'option loop: {self.loop} is negative')
        if self.start < 0.0:
            raise PlaybackError(f'option start: {self.start} s is negative')


@dataclass(frozen=True)
class PlayReport:
    """What was played.

    Attributes
    ----------
    messages : dict
        Messages per topic, over all loops.
    skipped : dict
        Topic to reason.
    loss : BagLoss or None
        What was missing in the bag.
    lateness_p50, lateness_p99, lateness_max : float
        How much later than due messages were handed to the middleware [s].
    wall_time : float
        [s], pauses included.
    acknowledged : bool
        Every subscriber has acknowledged every message.
    stopped : bool
        The control stopped it before the end.
    """

    messages: dict[str, int]
    skipped: dict[str, str]
    loss: BagLoss | None
    lateness_p50: float
    lateness_p99: float
    lateness_max: float
    wall_time: float
    acknowledged: bool
    stopped: bool


class PlayControl:
    """Pause, resume and stop from another thread or from a service.

    Parameters
    ----------
    paused : bool
        State to begin with.
    """

    def __init__(self, *, paused: bool = False) -> None:
        self._paused = threading.Event()
        self._stopped = threading.Event()
        if paused:
            self._paused.set()
        self.position = 0.0
        """Bag time since the start of the bag [s]."""

    @property
    def paused(self) -> bool:
        """Whether playing is paused."""
        return self._paused.is_set()

    @property
    def stopped(self) -> bool:
        """Whether playing is to end."""
        return self._stopped.is_set()

    def pause(self, value: bool = True) -> None:
        """Pause (True) or resume (False)."""
        if value:
            self._paused.set()
        else:
            self._paused.clear()

    def toggle(self) -> None:
        """Pause if playing, resume if paused."""
        self.pause(not self.paused)

    def stop(self) -> None:
        """End playing."""
        self._stopped.set()
