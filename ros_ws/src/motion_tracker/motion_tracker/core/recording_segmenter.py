# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Where one recording ends and the next begins, when each stream arrives in its own time.

A recording that is played again starts with stamps of the past. Each stream keeps its own order,
but streams overtake each other: when the markers begin anew, plate samples of the recording
before may still come. So every stream counts its own beginnings, and samples of a later recording
wait until no stream is left in the earlier one.
"""

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Generic, TypeVar

T = TypeVar('T')

#: A stamp this much before the newest one of its own stream begins another recording [s]: more
#: than samples of one stream are ever out of order, less than any recording lasts.
RESTART = 1.0


@dataclass
class _Stream:
    newest: float = -float('inf')
    recording: int = 0


@dataclass
class RecordingSegmenter(Generic[T]):
    """Sorts the samples of several streams by recording.

    Attributes
    ----------
    restart : float
        See `RESTART` [s].
    current : int
        Number of the recording whose samples pass.
    """

    restart: float = RESTART
    current: int = 0
    _streams: dict[str, _Stream] = field(default_factory=dict)
    _waiting: deque[tuple[int, T]] = field(default_factory=deque)

    @property
    def idle(self) -> bool:
        """Whether no stream is known yet."""
        return not self._streams

    def expect(self, streams: Iterable[str]) -> None:
        """Name the streams that will come, so that a late one is not left behind."""
        for name in streams:
            self._streams.setdefault(name, _Stream(recording=self.current))

    def push(self, stream: str, stamp: float, sample: T) -> list[tuple[int, T]]:
        """Take one sample; return the samples that may pass now, with their recording.

        Parameters
        ----------
        stream
            Name of the stream.
        stamp
            [s].
        sample
            Anything.
        """
        state = self._streams.get(stream)
        if state is None:
            state = self._streams[stream] = _Stream(recording=self.current)
        if stamp < state.newest - self.restart:
            state.recording += 1
            state.newest = stamp
        else:
            state.newest = max(state.newest, stamp)
        if state.recording == self.current:
            return [(self.current, sample)]
        self._waiting.append((state.recording, sample))
        earliest = min(stream.recording for stream in self._streams.values())
        if earliest == self.current:
            return []
        self.current = earliest
        passed = [entry for entry in self._waiting if entry[0] == earliest]
        self._waiting = deque(entry for entry in self._waiting if entry[0] != earliest)
        return passed

    def end(self) -> list[tuple[int, T]]:
        """Return everything that waits, recording by recording: nothing more will come."""
        passed = sorted(self._waiting, key=lambda entry: entry[0])
        self.current += 1
        self._waiting.clear()
        self._streams.clear()
        return passed
