# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Times of evenly sampled data whose stamps are not even.

Cameras expose evenly. Stamps that are set on arrival carry the delays of the way, and a derivative
that takes them for the time of exposure is wrong: 3 ms at 1 m/s are 3 mm. A phase-locked loop of
first order gives the even times: each sample comes one period after the one before, corrected by a
share of the difference to its stamp (Gardner 2005, Phaselock Techniques, chapter 2).
"""

from collections.abc import Sequence

import numpy as np

#: Deviation from the period that is none, as a share of the period: then the stamp is kept.
EXACT = 0.05

#: Share of the deviation by which the phase is corrected: it follows in 20 samples. An
#: engineering choice: 3 ms of jitter leave 0.5 ms, a tenth of what 6 Hz let pass at 100 Hz.
GAIN = 0.05

#: Jitter is followed by its mean over this many samples; a sample within `WIDE` means of the
#: expected time is the next one. A normal distribution has 0.007 % beyond 5 mean deviations.
MEMORY = 50
WIDE = 5.0


#: Samples from which the rate of jittering stamps is taken: the slope of their line then has a
#: standard deviation of 0.1 % at 3 ms and 100 Hz (Draper & Smith 1998, section 1.4).
JITTER_SAMPLES = 100


def jitters(stamps: Sequence[float]) -> bool:
    """Whether the steps of stamps [s] differ from their median, and not by whole multiples."""
    steps = np.diff(stamps)
    period = float(np.median(steps))
    shares = steps / period
    return bool(np.mean(np.abs(shares - np.maximum(np.round(shares), 1.0))) > EXACT)


def mean_rate(stamps: Sequence[float]) -> float:
    """Rate [Hz] of evenly sampled data by the line through their stamps [s]."""
    index = np.arange(len(stamps)) - 0.5 * (len(stamps) - 1)
    return float(index @ index / (index @ (np.asarray(stamps) - stamps[0])))


def mean_deviation(stamps: Sequence[float]) -> float:
    """Return the mean deviation of stamps from the line through them [s]."""
    index = np.arange(len(stamps)) - 0.5 * (len(stamps) - 1)
    offset = np.asarray(stamps) - stamps[0]
    return float(np.mean(np.abs(offset - offset.mean() - index / mean_rate(stamps))))


class SampleClock:
    """Even times of one stream.

    Parameters
    ----------
    rate
        Of the stream [Hz].
    longest_gap
        Gaps beyond it start anew [s].
    spread
        Mean deviation of the stamps from even times, as far as it is known [s].
    """

    def __init__(self, rate: float, longest_gap: float, spread: float = 0.0) -> None:
        self._period = 1.0 / rate
        self._longest_gap = longest_gap
        self._time: float | None = None
        self._spread = spread

    @property
    def jitters(self) -> bool:
        """Whether the stamps deviate from even times."""
        return self._spread > EXACT * self._period

    def even(self, stamp: float) -> float:
        """Return the time of the next sample by its stamp [s]; times increase as stamps do."""
        if self._time is None:
            self._time = stamp
            return stamp
        error = stamp - self._time - self._period
        lost = max(0, round(error / self._period))
        if lost and error <= min(WIDE * self._spread, self._longest_gap):
            lost = 0
        if lost * self._period > self._longest_gap:
            self._time, self._spread = stamp, 0.0
            return stamp
        error -= lost * self._period
        self._spread += (min(abs(error), self._period) - self._spread) / MEMORY
        if abs(error) <= EXACT * self._period and not self.jitters:
            self._time = stamp
        else:
            self._time += (1 + lost) * self._period + GAIN * error
        return self._time
