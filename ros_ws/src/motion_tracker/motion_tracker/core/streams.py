# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Buffers of sampled streams: checked on entry, filtered on the way, read at any time."""

from bisect import bisect_left, bisect_right
from collections import Counter

import numpy as np
import numpy.typing as npt

from motion_tracker.core.errors import TrackerError
from motion_tracker.core.filters import CausalFilter, zero_phase

Array = npt.NDArray[np.float64]

#: Samples from which the rate of a stream is taken.
RATE_SAMPLES = 10


def rate_of(stamps: npt.ArrayLike, name: str) -> float:
    """Rate [Hz] of a stream by the median of its steps; a whole number if within 0.05 percent.

    Stamps of this century, held as seconds in a double, have steps of 0.24 microseconds, which
    would otherwise show in the rate of a fast plate.

    Raises
    ------
    TrackerError
        If the rate is below 1 Hz or above 100 kHz.
    """
    step = float(np.median(np.diff(np.asarray(stamps, dtype=np.float64))))
    rate = 1.0 / step if step > 0 else np.inf
    if np.isfinite(rate) and abs(rate - round(rate)) < 5e-4 * rate:
        rate = float(round(rate))
    if not 1.0 <= rate <= 1e5:
        raise TrackerError(f'{name}: {rate} Hz is no sampling rate (step {step} s)')
    return rate


class SampledStream:
    """Samples of a fixed number of channels in the order of their stamps.

    Parameters
    ----------
    name
        For messages and counts.
    channels
        Numbers per sample.
    counts
        Where refused samples are counted, shared with the owner.
    cutoff
        Of a causal filter every sample passes [Hz]; None: no filter.
    """

    def __init__(self, name: str, channels: int, counts: Counter[str],
                 cutoff: float | None = None) -> None:
        self.name = name
        self.rate = 0.0
        self._channels = channels
        self._counts = counts
        self._cutoff = cutoff
        self._filter: CausalFilter | None = None
        self._stamps: list[float] = []
        self._raw: list[Array] = []
        self._filtered: list[Array] = []

    @property
    def last(self) -> float:
        """Stamp of the newest sample [s]; minus infinity when there is none."""
        return self._stamps[-1] if self._stamps else -np.inf

    @property
    def empty(self) -> bool:
        """Whether no sample has come."""
        return not self._stamps

    @property
    def delay(self) -> float:
        """Delay of the causal filter [s]."""
        return self._filter.delay if self._filter else 0.0

    def push(self, stamp: float, sample: Array) -> bool:
        """Take one sample; False if it was refused and counted."""
        if not (np.isfinite(stamp) and np.all(np.isfinite(sample))):
            self._counts[f'{self.name}: not finite'] += 1
            return False
        if stamp <= self.last:
            kind = 'duplicate stamps' if stamp == self.last else 'unsorted stamps'
            self._counts[f'{self.name}: {kind}'] += 1
            return False
        self._stamps.append(stamp)
        self._raw.append(sample)
        if self.rate == 0.0:
            if len(self._stamps) > RATE_SAMPLES:
                self._start()
        else:
            self._pass(len(self._stamps) - 1)
        return True

    def settle(self) -> None:
        """End of the recording: a stream too short for a rate is dropped and counted."""
        if self.rate == 0.0 and self._stamps:
            self._counts[f'{self.name}: too short'] += len(self._stamps)
            self._stamps, self._raw = [], []

    def filtered_at(self, time: float) -> Array | None:
        """Causally filtered sample whose content belongs to ``time``; None if there is none."""
        return self._between(self._filtered, time + self.delay, len(self._filtered))

    def raw_at(self, time: float) -> Array | None:
        """Raw sample at ``time`` by linear interpolation; None outside or in a gap."""
        return self._between(self._raw, time, len(self._stamps))

    def zero_phase_at(self, times: Array, cutoff: float, margin: float) -> Array | None:
        """Zero-phase filtered samples (n, channels) at ``times``; None if not covered.

        Samples up to ``margin`` [s] before and after take part.
        """
        first = bisect_left(self._stamps, times[0] - margin)
        last = bisect_right(self._stamps, times[-1] + margin)
        if last - first < 2 or self._stamps[first] > times[0] + 1e-9 \
                or self._stamps[last - 1] < times[-1] - 1e-9:
            return None
        stamps = np.array(self._stamps[first:last])
        if np.diff(stamps).max() > self._longest_gap():
            return None
        rows = np.array(self._raw[first:last])
        grid = stamps[0] + np.arange(int(np.floor((stamps[-1] - stamps[0]) * self.rate + 1e-6)) + 1
                                     ) / self.rate
        even = np.stack([np.interp(grid, stamps, column) for column in rows.T], axis=1)
        smooth = zero_phase(even, self.rate, cutoff)
        return np.stack([np.interp(times, grid, column) for column in smooth.T], axis=1)

    def forget(self, before: float) -> None:
        """Drop samples older than ``before`` [s]."""
        drop = bisect_left(self._stamps, before)
        if drop > 0:
            del self._stamps[:drop], self._raw[:drop], self._filtered[:drop]

    def _longest_gap(self) -> float:
        return 5.5 / self.rate

    def _start(self) -> None:
        self.rate = rate_of(self._stamps, self.name)
        if self._cutoff is not None:
            self._filter = CausalFilter(self.rate, self._cutoff, self._channels)
        for at in range(len(self._stamps)):
            self._pass(at)

    def _pass(self, at: int) -> None:
        if self._filter is None:
            return
        if at > 0:
            lost = round((self._stamps[at] - self._stamps[at - 1]) * self.rate) - 1
            if lost > 0:
                self._counts[f'{self.name}: lost samples'] += lost
                if lost + 1 > 5:
                    self._filter.reset()
                else:
                    for i in range(1, lost + 1):
                        share = i / (lost + 1)
                        self._filter.step((1.0 - share) * self._raw[at - 1]
                                          + share * self._raw[at])
        self._filtered.append(self._filter.step(self._raw[at])[0])

    def _between(self, rows: list[Array], time: float, count: int) -> Array | None:
        after = bisect_left(self._stamps, time - 1e-9, 0, count)
        if self.rate == 0.0 or after >= count:
            return None
        if abs(self._stamps[after] - time) <= 1e-9:
            return rows[after]
        if after == 0 or self._stamps[after] - self._stamps[after - 1] > self._longest_gap():
            return None
        a, b = self._stamps[after - 1], self._stamps[after]
        share = (time - a) / (b - a)
        return np.asarray((1.0 - share) * rows[after - 1] + share * rows[after])
