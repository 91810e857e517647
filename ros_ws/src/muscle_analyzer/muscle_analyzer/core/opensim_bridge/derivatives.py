# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Velocities and accelerations of recorded coordinates, over a whole recording, without delay.

The same steps as OpenSim's inverse dynamics tool: the signal is continued at both ends by its
point reflection over half its length, filtered by a third-order Butterworth low-pass forwards and
backwards, and interpolated by a natural quintic spline, whose derivatives are taken (quintic
splines: Woltring 1986, A Fortran package for generalized, cross-validatory spline smoothing and
differentiation).
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.signal import butter, lfilter, lfilter_zi

from human_model.typing import Array
from muscle_analyzer.core.exceptions import InputArrayError

FILTER_ORDER = 3
SPLINE_DEGREE = 5


def smooth(time: Array, values: Array, cutoff: float) -> Array:
    """Return values (n, m) filtered by the zero-phase low-pass of the module's header.

    Parameters
    ----------
    time : (n,) array
        Even steps, s.
    values : (n, m) array
    cutoff : float
        Of one pass, Hz; 6 Hz is the usual choice for motion.

    Raises
    ------
    InputArrayError
        If there are too few samples, uneven steps, gaps, or the cutoff is above half the rate.
    """
    step = _checked_step(time, values)
    if not 0.0 < cutoff < 0.5 / step:
        raise InputArrayError(f'cutoff {cutoff} Hz must be between 0 and {0.5 / step:.4g} Hz')
    b, a = butter(FILTER_ORDER, cutoff, fs=1.0 / step)
    n_pad = values.shape[0] // 2
    before = 2.0 * values[0] - values[n_pad:0:-1]
    after = 2.0 * values[-1] - values[-2 : -n_pad - 2 : -1]
    padded = np.vstack([before, values, after])
    start = lfilter_zi(b, a)[:, None]
    for _ in range(2):
        padded = lfilter(b, a, padded, axis=0, zi=start * padded[0])[0][::-1]
    return np.ascontiguousarray(padded[n_pad : n_pad + values.shape[0]])


def differentiate(time: Array, values: Array) -> tuple[Array, Array]:
    """Return first and second time derivative (n, m) of values (n, m) by a natural quintic spline.

    Raises
    ------
    InputArrayError
        As for `smooth`.
    """
    _checked_step(time, values)
    zero = np.zeros(values.shape[1])
    ends = [(3, zero), (4, zero)]
    spline = make_interp_spline(time, values, k=SPLINE_DEGREE, bc_type=(ends, ends))
    return spline.derivative(1)(time), spline.derivative(2)(time)


def _checked_step(time: Array, values: Array) -> float:
    if time.ndim != 1 or values.ndim != 2 or values.shape[0] != time.size:
        raise InputArrayError(f'time {time.shape} and values {values.shape} do not fit together')
    if time.size <= 2 * SPLINE_DEGREE:
        raise InputArrayError(f'{time.size} samples are too few to differentiate')
    if not (np.all(np.isfinite(time)) and np.all(np.isfinite(values))):
        raise InputArrayError('time or values hold numbers that are not finite')
    steps = np.diff(time)
    step = float(np.median(steps))
    if step <= 0.0 or np.max(np.abs(steps - step)) > 0.01 * step:
        raise InputArrayError(
            f'time steps from {steps.min():.6g} to {steps.max():.6g} s are not even'
        )
    return step
