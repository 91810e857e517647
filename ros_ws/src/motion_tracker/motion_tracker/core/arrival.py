# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""When a marker frame may be worked off: all streams have come up to it, or are given up."""

from collections.abc import Callable, Sequence

from motion_tracker.core.streams import SAME, SampledStream
from motion_tracker.core.tracked import Notice, Output


class Arrival:
    """Which streams have been given up, and whether a frame still has to wait for one.

    A stream is given up when a frame has waited for it for `wait` by the clock, which counts only
    while markers keep coming: what delays a sample on its way are machines, and those take no
    notice of how fast a recording is played or whether it is paused.

    Parameters
    ----------
    wait
        [s].
    longest_gap
        Longest step of the clock between two marker frames that counts in full; how far a
        stream may end before the markers do without a word [s].
    clock
        Time now [s] from any origin. None where recordings are read without waiting for anyone:
        then a stream that is behind is given up at the end of the recording only.

    Attributes
    ----------
    absent : set of str
        Streams given up. The results do not depend on when that was decided: what a frame lacks,
        it lacks.
    """

    def __init__(self, wait: float, longest_gap: float, clock: Callable[[], float] | None) -> None:
        self.absent: set[str] = set()
        self._wait = wait
        self._longest_gap = longest_gap
        self._clock = clock
        self._last: float | None = None
        self._elapsed = 0.0

    def arrive(self) -> float:
        """Take note of a marker frame; return the time in which markers came until now [s]."""
        if self._clock is not None:
            now = self._clock()
            if self._last is not None:
                self._elapsed += min(now - self._last, self._longest_gap)
            self._last = now
        return self._elapsed

    def ready(
        self,
        stamp: float,
        arrived: float,
        newest: float,
        streams: Sequence[SampledStream],
        final: bool,
    ) -> tuple[bool, list[Output]]:
        """Whether a frame may be worked off, and what is to be said of the streams.

        Parameters
        ----------
        stamp, arrived
            Of the frame: its stamp, and what `arrive` said when it came [s].
        newest
            Stamp of the last marker frame that came [s].
        streams
            What the frame waits for.
        final
            Nothing more will come.
        """
        said: list[Output] = []
        for stream in streams:
            if stream.last >= stamp - SAME and stream.rate > 0:
                if stream.name in self.absent:
                    self.absent.discard(stream.name)
                    said.append(Notice(f'{stream.name}: samples are back', True))
                continue
            if stream.name in self.absent:
                continue
            if not final and self._elapsed - arrived < self._wait:
                return False, said
            if final and newest - stream.last <= self._longest_gap:
                continue
            self.absent.add(stream.name)
            said.append(
                Notice(
                    f'{stream.name}: no samples {"at all" if stream.empty else "any more"} at '
                    f'{stamp:.3f} s; going on without'
                )
            )
        return True, said
