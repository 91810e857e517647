# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Butterworth low-pass filters: zero-phase for whole recordings, causal for the live stream.

The thesis filters motion at 6 Hz and plates at 25 Hz (section 3.4) without naming order or number
of passes. Here both filters are of fourth order in effect and have their -3 dB point at the named
cutoff: offline a second-order filter runs forward and backward, with its own cutoff raised so
that the two passes together have -3 dB at the cutoff (Robertson & Dowling 2003; Winter 2009,
section 2.2.4.4); live one causal fourth-order filter runs, whose delay is known and stated.
"""

from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

from human_model.typing import Array
from motion_tracker.core import filter_kernel
from motion_tracker.core.exceptions import FilterError

#: Cutoffs of the thesis, section 3.4 [Hz].
MOTION_CUTOFF = 6.0
PLATE_CUTOFF = 25.0


def _check(rate: float, cutoff: float) -> None:
    if not (np.isfinite(rate) and rate > 0):
        raise FilterError(f'rate: a positive number of hertz is needed, got {rate}')
    if not (np.isfinite(cutoff) and 0 < cutoff < rate / 2):
        raise FilterError(f'cutoff: {cutoff} Hz is not between 0 and half of the rate {rate} Hz')


def zero_phase(samples: npt.ArrayLike, rate: float, cutoff: float) -> Array:
    """Fourth-order zero-phase Butterworth low-pass (second order, forward and backward).

    Parameters
    ----------
    samples
        Shape (n,) or (n, channels), without gaps; any unit.
    rate, cutoff
        Samples per second and the -3 dB frequency of the two passes together [Hz].

    Returns
    -------
    ndarray
        Filtered copy of the same shape.

    Raises
    ------
    FilterError
        If a sample is not finite, or there are fewer than two samples.

    Notes
    -----
    Each pass is designed for ``cutoff / (2**(1/2) - 1)**(1/4)`` (Winter 2009, equation 2.31 with
    two passes). The ends are extended by odd reflection over one cutoff period and a half.
    """
    _check(rate, cutoff)
    array = np.asarray(samples, dtype=np.float64)
    if array.ndim == 0 or array.shape[0] < 2:
        raise FilterError(f'samples: at least two are needed, got shape {array.shape}')
    if not np.all(np.isfinite(array)):
        where = int(np.argwhere(~np.isfinite(array))[0][0])
        raise FilterError(f'samples: not finite at index {where}')
    # Loads for longer than all else here; needed only at the end of a lift.
    from scipy.signal import sosfiltfilt

    sections = _single_pass(rate, cutoff)
    pad = min(array.shape[0] - 1, round(1.5 * rate / cutoff))
    return np.asarray(sosfiltfilt(sections, array, axis=0, padtype='odd', padlen=pad))


@lru_cache(maxsize=16)
def _single_pass(rate: float, cutoff: float) -> Array:
    """Sections of one of the two passes that together have -3 dB at the cutoff [Hz]."""
    from scipy.signal import butter

    # Pre-warped, so that the correction holds for the digital filter, not only for its prototype.
    warped = np.tan(np.pi * cutoff / rate) / (np.sqrt(2.0) - 1.0) ** 0.25
    single = float(np.arctan(warped) * rate / np.pi)
    return np.asarray(butter(2, single, fs=rate, output='sos'))


def derivatives(samples: npt.ArrayLike, rate: float) -> tuple[Array, Array]:
    """First and second time derivative of smooth samples, by an interpolating quintic spline.

    Parameters
    ----------
    samples
        Shape (n,) or (n, channels), evenly spaced, already filtered; n >= 6.
    rate
        Samples per second [Hz].

    Returns
    -------
    ndarray, ndarray
        Per second and per second squared, same shape.
    """
    from scipy.interpolate import make_interp_spline

    array = np.asarray(samples, dtype=np.float64)
    if array.shape[0] < 6:
        raise FilterError(f'samples: six or more are needed for derivatives, got {array.shape[0]}')
    time = np.arange(array.shape[0]) / rate
    spline = make_interp_spline(time, array, k=5)
    return np.asarray(spline.derivative(1)(time)), np.asarray(spline.derivative(2)(time))


def settling_time(cutoff: float) -> float:
    """Time [s] until a causal fourth-order Butterworth filter has forgotten its start.

    Its slowest pair of poles lies at ``2 pi cutoff (-sin(pi/8) +- i cos(pi/8))``: what it brings
    in has fallen to a thousandth after ``ln(1000)`` of its time constants, 0.48 s at 6 Hz.
    """
    return float(np.log(1000.0) / (2.0 * np.pi * cutoff * np.sin(np.pi / 8.0)))


def _butterworth_polynomial(order: int) -> Array:
    """Denominator of the low-pass of cutoff 1 rad/s, highest power first, shape (order + 1,)."""
    angle = np.pi * (2.0 * np.arange(order) + order + 1.0) / (2.0 * order)
    return np.asarray(np.poly(np.exp(1j * angle)).real, dtype=np.float64)


def _first_order_hold(a: Array, b: Array, step: float) -> tuple[Array, Array, Array]:
    """Make ``x' = a x + b u`` discrete for an input that is linear between the samples.

    Returns
    -------
    ndarray, ndarray, ndarray
        Matrices F, G, H of ``z[k + 1] = F z[k] + G u[k]``, ``x[k] = z[k] + H u[k]`` (Franklin,
        Powell & Workman 1998, Digital Control of Dynamic Systems, section 6.3.2).
    """
    n, m = b.shape
    block = np.zeros((n + 2 * m, n + 2 * m))
    block[:n, :n] = a * step
    block[:n, n : n + m] = b * step
    block[n : n + m, n + m :] = np.eye(m)
    power = expm(block)
    transition, constant, ramp = power[:n, :n], power[:n, n : n + m], power[:n, n + m :]
    return transition, constant - ramp + transition @ ramp, ramp


class CausalFilter:
    """Causal fourth-order Butterworth low-pass with the first two derivatives.

    The analogue filter is kept in the form whose states are the output and its derivatives, so
    value, velocity and acceleration come from one filter and share one delay: no difference
    quotient is taken. Between samples the input is taken as linear (first-order hold), which adds
    no delay of its own.

    Parameters
    ----------
    rate, cutoff
        Samples per second and -3 dB frequency [Hz].
    channels
        Number of signals filtered side by side.

    Attributes
    ----------
    delay : float
        Group delay at low frequency [s]: 2.6131 / (2 pi cutoff) for order four, 69.3 ms at 6 Hz
        and 16.6 ms at 25 Hz. It is stated with every result and taken off its time stamp.
    """

    ORDER = 4

    def __init__(self, rate: float, cutoff: float, channels: int) -> None:
        _check(rate, cutoff)
        if channels < 1:
            raise FilterError(f'channels: at least one is needed, got {channels}')
        self.rate = rate
        self.cutoff = cutoff
        self.channels = channels
        self._omega = 2.0 * np.pi * cutoff
        # Prototype 1 / (1 + a1 s + a2 s^2 + a3 s^3 + s^4) of cutoff 1 rad/s: time in 1 / omega.
        polynomial = _butterworth_polynomial(self.ORDER)
        a = np.diag(np.ones(self.ORDER - 1), 1)
        a[-1] = -polynomial[:0:-1]
        b = np.zeros((self.ORDER, 1))
        b[-1, 0] = 1.0
        transition, gain, hold = _first_order_hold(a, b, self._omega / rate)
        self._a, self._b = np.ascontiguousarray(transition), gain[:, 0].copy()
        self._d = hold[:3, 0].copy()
        self._scale = np.array([1.0, self._omega, self._omega**2])
        self._rest = np.linalg.solve(np.eye(self.ORDER) - self._a, self._b)[:, None]
        self.delay = float(polynomial[-2] / polynomial[-1] / self._omega)
        self._state: Array | None = None

    def reset(self) -> None:
        """Reset to the steady state of the next sample."""
        self._state = None

    def follow(self, other: 'CausalFilter', offset: Array) -> None:
        """Take the state of another filter of the same design, moved by an offset (channels,)."""
        if other._state is not None:
            self._state = other._state + self._rest * offset

    def step(self, sample: npt.ArrayLike) -> tuple[Array, Array, Array]:
        """Filter one sample (channels,); return value, first and second derivative.

        Raises
        ------
        FilterError
            If the sample has the wrong length or is not finite. The state of the filter does not
            change then; the caller handles gaps.
        """
        u = np.asarray(sample, dtype=np.float64)
        if u.shape != (self.channels,):
            raise FilterError(f'sample: shape ({self.channels},) is needed, got {u.shape}')
        value, first, second = self._run(u[None], 3)[0]
        return value, first, second

    def values(self, samples: npt.ArrayLike) -> Array:
        """Filter samples (n, channels) in their order; return their values (n, channels).

        Raises
        ------
        FilterError
            As `step`.
        """
        u = np.asarray(samples, dtype=np.float64)
        if u.ndim != 2 or u.shape[1] != self.channels:
            raise FilterError(f'samples: shape (n, {self.channels}) is needed, got {u.shape}')
        return self._run(u, 1)[:, 0]

    def _run(self, samples: Array, kinds: int) -> Array:
        """Values and ``kinds`` - 1 derivatives (n, kinds, channels)."""
        out = np.empty((len(samples), kinds, self.channels))
        if not len(samples):
            return out
        state = self._rest * samples[0] if self._state is None else self._state
        bad = filter_kernel.run(
            self._a, self._b, self._d, self._scale, state, np.ascontiguousarray(samples), out
        )
        if bad >= 0:
            raise FilterError(f'sample: channel {bad} is not finite')
        self._state = state
        return out
