# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Buffers of sampled streams: checked on entry, filtered on the way, read at any time."""

import math
from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from human_model.typing import Array
from motion_tracker.core import filter_kernel
from motion_tracker.core.exceptions import TrackerError
from motion_tracker.core.filters import CausalFilter, zero_phase

#: Samples from which the rate of a stream is taken.
RATE_SAMPLES = 10

#: Longest step that is bridged by a line, in samples.
LONGEST_BRIDGE = 5

#: Difference of stamps that counts as none [s]; stamps of this century have steps of 0.24 us.
SAME = 1e-9

#: Rows for which a new stream has room.
_ROOM = 1024


def rate_of(stamps: npt.ArrayLike, name: str) -> float:
    """Rate [Hz] of a stream by the median of its steps; a whole number if within 0.05 percent.

    Stamps of this century, stored as seconds in a double, have steps of 0.24 microseconds, which
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

    The causal filter runs when a filtered sample is read: all new samples pass it in one call,
    with the same bits as sample by sample.

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

    def __init__(
        self, name: str, channels: int, counts: Counter[str], cutoff: float | None = None
    ) -> None:
        self.name = name
        self.rate = 0.0
        #: Stamp of the newest sample [s]; minus infinity when there is none.
        self.last = -math.inf
        self._channels = channels
        self._counts = counts
        self._cutoff = cutoff
        self._filter: CausalFilter | None = None
        self._stamps: list[float] = []
        # Rows beyond the number of stamps, and filtered rows from `_passed` on, are free room.
        self._raw = np.empty((_ROOM, channels))
        self._filtered = np.empty((_ROOM if cutoff is not None else 0, channels))
        self._passed = 0

    @property
    def empty(self) -> bool:
        """Whether no sample has come."""
        return not self._stamps

    @property
    def span(self) -> float:
        """Time from the oldest to the newest sample [s]."""
        return self.last - self._stamps[0] if self._stamps else 0.0

    @property
    def delay(self) -> float:
        """Delay of the causal filter [s]."""
        return self._filter.delay if self._filter else 0.0

    def push(self, stamp: float, sample: Sequence[float] | Array) -> bool:
        """Take one sample; False if it was refused and counted."""
        # Thousands a second: plain numbers. A sum is finite only if all its terms are.
        if not math.isfinite(stamp + sum(sample)):
            self._counts[f'{self.name}: not finite'] += 1
            return False
        if stamp <= self.last:
            kind = 'duplicate stamps' if stamp == self.last else 'unsorted stamps'
            self._counts[f'{self.name}: {kind}'] += 1
            return False
        at = len(self._stamps)
        if at == len(self._raw):
            self._raw = _doubled(self._raw)
            self._filtered = _doubled(self._filtered)
        self._raw[at] = sample
        self._stamps.append(stamp)
        if self.rate == 0.0:
            if at == RATE_SAMPLES:
                self._start()
        else:
            self._look_for_gap(at, self.last)
        self.last = stamp
        return True

    def settle(self) -> None:
        """End of the recording: a stream too short for a rate is dropped and counted."""
        if self.rate == 0.0 and self._stamps:
            self._counts[f'{self.name}: too short'] += len(self._stamps)
            self._stamps, self.last = [], -math.inf

    def filtered_at(self, time: float) -> Array | None:
        """Causally filtered sample whose content belongs to ``time``; None if there is none."""
        if self._filter is None:
            return None
        self._pass(len(self._stamps))
        return self._between(self._filtered, time + self.delay)

    def raw_at(self, time: float) -> Array | None:
        """Raw sample at ``time`` by linear interpolation; None outside or in a gap."""
        return self._between(self._raw, time)

    def raw_rows_at(self, times: Array) -> Array:
        """Raw samples (n, channels) as `raw_at` gives them, all at once; NaN outside or in a gap.

        ``times`` (n,) must not decrease.
        """
        rows = np.full((len(times), self._channels), np.nan)
        first = max(0, bisect_left(self._stamps, times[0] - SAME) - 1)
        last = bisect_right(self._stamps, times[-1] + SAME) + 1
        stamps, raw = np.array(self._stamps[first:last]), self._raw[first:last]
        if self.rate == 0.0 or not len(stamps):
            return rows
        after = np.searchsorted(stamps, times - SAME)
        within = after < len(stamps)
        b = np.minimum(after, len(stamps) - 1)
        a = np.maximum(b - 1, 0)
        same = within & (np.abs(stamps[b] - times) <= SAME)
        step = stamps[b] - stamps[a]
        between = within & ~same & (after > 0) & (step <= self._longest_gap())
        share = ((times - stamps[a])[between] / step[between])[:, None]
        rows[between] = (1.0 - share) * raw[a[between]] + share * raw[b[between]]
        rows[same] = raw[b[same]]
        return rows

    def zero_phase_at(self, times: Array, cutoff: float, margin: float) -> Array | None:
        """Zero-phase filtered samples (n, channels) at ``times``; None if not covered.

        Samples up to ``margin`` [s] before and after take part. Gaps are bridged by a line;
        `uncertain` names the times that they spoil.
        """
        first = bisect_left(self._stamps, times[0] - margin)
        last = bisect_right(self._stamps, times[-1] + margin)
        if (
            last - first < 2
            or self._stamps[first] > times[0] + SAME
            or self._stamps[last - 1] < times[-1] - SAME
        ):
            return None
        stamps = np.array(self._stamps[first:last])
        grid = (
            stamps[0]
            + np.arange(int(np.floor((stamps[-1] - stamps[0]) * self.rate + 1e-6)) + 1) / self.rate
        )
        even = columns_at(grid, stamps, self._raw[first:last])
        return columns_at(times, grid, zero_phase(even, self.rate, cutoff))

    def uncertain(self, times: Array, reach: float) -> npt.NDArray[np.bool_]:
        """Whether times (n,) are in a gap of the samples, or nearer to one than ``reach`` [s]."""
        found = np.zeros(len(times), dtype=np.bool_)
        if self.rate == 0.0:
            return found
        first = max(0, bisect_left(self._stamps, times[0] - reach) - 1)
        last = bisect_right(self._stamps, times[-1] + reach) + 1
        stamps = np.array(self._stamps[first:last])
        for k in np.flatnonzero(np.diff(stamps) > self._longest_gap()):
            found |= (times > stamps[k] - reach) & (times < stamps[k + 1] + reach)
        return found

    def forget(self, before: float) -> None:
        """Drop samples older than ``before`` [s]."""
        drop = bisect_left(self._stamps, before)
        if drop == 0:
            return
        self._pass(len(self._stamps))
        del self._stamps[:drop]
        kept = len(self._stamps)
        self._raw[:kept] = self._raw[drop : drop + kept]
        if self._filter is not None:
            self._filtered[:kept] = self._filtered[drop : drop + kept]
            self._passed = kept

    def _longest_gap(self) -> float:
        return (LONGEST_BRIDGE + 0.5) / self.rate

    def _start(self) -> None:
        self.rate = rate_of(self._stamps, self.name)
        if self._cutoff is not None:
            self._filter = CausalFilter(self.rate, self._cutoff, self._channels)
        for at in range(1, len(self._stamps)):
            self._look_for_gap(at, self._stamps[at - 1])

    def _look_for_gap(self, at: int, before: float) -> None:
        """Count samples that the filter misses before row ``at``, and bridge them by a line."""
        if self._filter is None:
            return
        lost = round((self._stamps[at] - before) * self.rate) - 1
        if lost <= 0:
            return
        self._counts[f'{self.name}: lost samples'] += lost
        self._pass(at)
        if lost + 1 > LONGEST_BRIDGE:
            self._filter.reset()
            return
        for i in range(1, lost + 1):
            share = i / (lost + 1)
            self._filter.step((1.0 - share) * self._raw[at - 1] + share * self._raw[at])

    def _pass(self, end: int) -> None:
        """Let the rows before ``end`` that wait for it through the filter."""
        if self._filter is not None and self._passed < end:
            rows = self._filter.values(self._raw[self._passed : end])
            self._filtered[self._passed : end] = rows
            self._passed = end

    def _between(self, rows: Array, time: float) -> Array | None:
        stamps = self._stamps
        after = bisect_left(stamps, time - SAME)
        if self.rate == 0.0 or after >= len(stamps):
            return None
        b = stamps[after]
        if abs(b - time) <= SAME:
            return np.array(rows[after])
        if after == 0 or b - stamps[after - 1] > self._longest_gap():
            return None
        a = stamps[after - 1]
        row: Array = filter_kernel.blended(rows, after, (time - a) / (b - a))
        return row


def columns_at(times: Array, stamps: Array, rows: Array) -> Array:
    """Rows (m, channels) of strictly increasing stamps (m,), linearly interpolated at times (n,).

    As `numpy.interp` channel by channel.
    """
    return np.stack([np.interp(times, stamps, column) for column in rows.T], axis=1)


def _doubled(rows: Array) -> Array:
    """Return the rows with as much free room behind them."""
    return np.concatenate([rows, np.empty_like(rows)])
