# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Synchronization of marker frames with the other streams, which may arrive late or not at all."""

from collections.abc import Callable, Sequence

from motion_tracker.core.streams import SAME, SampledStream
from motion_tracker.core.tracked import Notice, Output


class StreamSynchronizer:
    """Decision whether the samples of all streams up to a marker frame have arrived.

    A stream is declared lost when a frame has waited for it for `wait` by the clock. The clock
    counts only while markers arrive: a transport delay depends on the machines, not on the speed
    at which a recording is played or on a pause.

    Parameters
    ----------
    wait
        [s].
    longest_gap
        Longest step of the clock between two marker frames that counts in full, and longest time
        by which a stream may end before the markers without a notice [s].
    clock
        Current time [s] from any origin. None where recordings are read from files: a stream that
        is behind is then declared lost only at the end of the recording.

    Attributes
    ----------
    lost : set of str
        Streams declared lost. The results do not depend on when a stream is declared lost:
        missing data are not interpolated later.
    """

    def __init__(self, wait: float, longest_gap: float, clock: Callable[[], float] | None) -> None:
        self.lost: set[str] = set()
        self._wait = wait
        self._longest_gap = longest_gap
        self._clock = clock
        self._last: float | None = None
        self._elapsed = 0.0

    def register(self) -> float:
        """Register the arrival of a marker frame; return the time with markers until now [s]."""
        if self._clock is not None:
            now = self._clock()
            if self._last is not None:
                self._elapsed += min(now - self._last, self._longest_gap)
            self._last = now
        return self._elapsed

    def synchronized(
        self,
        stamp: float,
        arrival: float,
        newest: float,
        streams: Sequence[SampledStream],
        final: bool,
    ) -> tuple[bool, list[Output]]:
        """Return whether a frame can be processed, and notices of lost and recovered streams.

        Parameters
        ----------
        stamp, arrival
            Stamp of the frame, and result of `register` at its arrival [s].
        newest
            Stamp of the newest marker frame [s].
        streams
            Streams whose samples the frame needs.
        final
            Whether the recording is over.
        """
        notices: list[Output] = []
        for stream in streams:
            if stream.last >= stamp - SAME and stream.rate > 0:
                if stream.name in self.lost:
                    self.lost.discard(stream.name)
                    notices.append(Notice(f'{stream.name}: samples are back', True))
                continue
            if stream.name in self.lost:
                continue
            if not final and self._elapsed - arrival < self._wait:
                return False, notices
            if final and newest - stream.last <= self._longest_gap:
                continue
            self.lost.add(stream.name)
            notices.append(
                Notice(
                    f'{stream.name}: no samples {"at all" if stream.empty else "any more"} at '
                    f'{stamp:.3f} s; going on without'
                )
            )
        return True, notices
