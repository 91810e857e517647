# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Activation index: how high a muscle's activation stays (thesis section 4.2.2).

The thesis says that the risk grows as an activation stays near 1 for a period and gives neither a
period nor a formula. The index here is the largest mean activation over a sliding window. The
window is an engineering choice, not a published number: half a second, a little more than a
third of the 1.32 s the thesis' asymmetric lift takes (chapter III), so that a short peak does not
count and a hold within one lift does.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np

from human_model.typing import Array, BoolArray
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.validation import array, positive

DEFAULT_WINDOW = 0.5
DEFAULT_MAX_GAP = 0.1


class SlidingMean:
    """Mean of each muscle's activation over the last ``window`` seconds, sample by sample.

    The mean is the integral of the straight lines through the samples, so that it does not depend
    on the sampling rate. It exists as soon as the samples cover the whole window.

    Parameters
    ----------
    window : float
        [s].
    max_gap : float
        A longer time between two samples [s] starts the window anew: what happened in between is
        not known.
    """

    def __init__(self, window: float = DEFAULT_WINDOW, max_gap: float = DEFAULT_MAX_GAP) -> None:
        self.window = positive('window', window)
        self.max_gap = positive('max_gap', max_gap)
        self._samples: deque[tuple[float, Array, Array]] = deque()

    def reset(self) -> None:
        """Forget all samples."""
        self._samples.clear()

    def add(self, stamp: float, activation: Array) -> Array | None:
        """Add one sample.

        Parameters
        ----------
        stamp : float
            [s].
        activation : array (n_m,)
            Activations [0..1].

        Returns
        -------
        array (n_m,) or None
            Mean over the window that ends at this sample; None while the window is not full.
        """
        values = np.array(activation, dtype=np.float64)
        if self._samples:
            last_stamp, last, integral = self._samples[-1]
            step = stamp - last_stamp
            if step <= 0.0 or step > self.max_gap or last.shape != values.shape:
                self._samples.clear()
        if not self._samples:
            self._samples.append((stamp, values, np.zeros_like(values)))
            return None
        self._samples.append((stamp, values, integral + 0.5 * step * (values + last)))
        begin = stamp - self.window
        # A nanosecond of tolerance: stamps of a 100 Hz clock are not exact in binary.
        if self._samples[0][0] > begin + 1e-9:
            return None
        while self._samples[1][0] <= begin + 1e-9:
            self._samples.popleft()
        first_stamp, first, first_integral = self._samples[0]
        second_stamp, second, _ = self._samples[1]
        part = max(begin - first_stamp, 0.0)
        edge = first + (second - first) * part / (second_stamp - first_stamp)
        before = first_integral + 0.5 * part * (first + edge)
        return np.asarray((self._samples[-1][2] - before) / self.window)


@dataclass(frozen=True)
class ActivationIndex:
    """Largest mean activation over a window, of every muscle of a lift.

    Attributes
    ----------
    muscles : tuple of str
    index : array (n_m,)
        [0..1]; NaN where no window of solved samples exists.
    time : array (n_m,)
        End of that window [s], on the clock of the samples.
    window : float
        Length of the window in fact used [s]: the lift's own length if that is shorter.
    """

    muscles: tuple[str, ...]
    index: Array
    time: Array
    window: float

    def worst(self) -> tuple[str, float, float]:
        """Return muscle, index and time of the largest; ('', NaN, NaN) if there is none."""
        if not self.muscles or np.all(np.isnan(self.index)):
            return '', float('nan'), float('nan')
        k = int(np.nanargmax(self.index))
        return self.muscles[k], float(self.index[k]), float(self.time[k])


def activation_index(
    time: Array,
    muscles: Sequence[str],
    activation: Array,
    solved: BoolArray,
    window: float = DEFAULT_WINDOW,
) -> ActivationIndex:
    """Find the activation index of every muscle over a lift.

    Parameters
    ----------
    time : array (n,)
        [s], increasing.
    muscles : sequence of n_m names
    activation : array (n, n_m)
        [0..1]; rows that are not solved may hold anything.
    solved : array of bool (n,)
        Samples whose solve report is good; the others are left out.
    window : float
        See :class:`SlidingMean`; a lift shorter than the window is averaged as a whole. One
        sample that did not solve is bridged, a longer hole starts the window anew.
    """
    values = array('activation', activation, (len(time), len(muscles)))
    stamps = np.asarray(time, dtype=np.float64)[solved]
    if np.any(np.diff(stamps) <= 0.0):
        raise InvalidInputError('time', float(np.min(np.diff(stamps))), 'must increase')
    best = np.full(len(muscles), np.nan)
    when = np.full(len(muscles), np.nan)
    length = float(stamps[-1] - stamps[0]) if len(stamps) > 1 else 0.0
    if length <= 0.0:
        return ActivationIndex(tuple(muscles), best, when, 0.0)
    # Not numpy's median: its first call imports masked arrays, 20 ms between two live samples.
    mean = SlidingMean(min(window, length), 2.5 * median(np.diff(time).tolist()))
    for stamp, row in zip(stamps, values[solved], strict=True):
        current = mean.add(float(stamp), row)
        if current is not None:
            better = np.isnan(best) | (current > best)
            best[better] = current[better]
            when[better] = stamp
    return ActivationIndex(tuple(muscles), best, when, mean.window)
