# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which inputs an active station lacks, by the clock of the machine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from lifting_messages.topics import Quality, Topic

#: Time [s] without an input after which it is reported; engineering choice.
PATIENCE: Final = 1.5

_STREAMS: Final = (Quality.FRAMES, Quality.PLATES)


class InputWatch:
    """Times at which the inputs of a station came.

    Person and task are needed by every station that subscribes to them.  A stream is needed once
    it has come; a station with streams needs at least one of them.  Results of lifts may be
    absent for any time.

    Parameters
    ----------
    inputs : sequence of Topic
        Of the station.
    clock : callable
        Time of the machine [s].
    patience : float
        Time [s] without an input after which it is reported.
    """

    def __init__(
        self,
        inputs: Sequence[Topic],
        clock: Callable[[], float],
        patience: float = PATIENCE,
    ) -> None:
        self._latched = [topic.name for topic in inputs if topic.quality is Quality.LATCHED]
        self._streams = [topic.name for topic in inputs if topic.quality in _STREAMS]
        self._clock = clock
        self._patience = patience
        self._came: dict[str, float] = {}
        self._began = clock()

    def begin(self) -> None:
        """Note that the station became active: it is given time for its first inputs."""
        self._began = self._clock()

    def note(self, topic: str) -> None:
        """Note that a message came."""
        self._came[topic] = self._clock()

    def problems(self) -> list[str]:
        """Return the inputs that are missing, each in words; empty if there are none."""
        now = self._clock()
        if now - self._began < self._patience:
            return []
        found = [f'no {name} yet' for name in self._latched if name not in self._came]
        streams = [name for name in self._streams if name in self._came]
        if self._streams and not streams:
            found.append(f'no {" or ".join(self._streams)} yet')
        for name in streams:
            silent = now - max(self._came[name], self._began)
            if silent >= self._patience:
                found.append(f'no {name} for {silent:.0f} s')
        return found
