# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From raw surface EMG to envelopes that can be laid beside muscle activations.

The dissertation's section 4.3: band-pass of 10 to 450 Hz, rectified, low-pass of 5 Hz, divided by
the reading of the same channel in a maximum voluntary contraction (MVC). Its filters are those of
Visual3D, whose documentation (page "Lowpass Filter") describes them as second-order Butterworth
filters run forwards and backwards: no delay. Cut-off frequencies are those of one pass here, as in
the project's other filters.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from muscle_analyzer.core.exceptions import EmgError

#: Pass band and cut-off of the envelope [Hz] (dissertation, section 4.3).
PASS_BAND, ENVELOPE_CUTOFF = (10.0, 450.0), 5.0
#: Of one pass (Visual3D's documentation).
FILTER_ORDER = 2
#: Lowest sampling rate [Hz]: the pass band must end clearly below half of it.
LOWEST_RATE = 1000.0
#: Time steps may differ from their median by this fraction.
EVEN = 0.01
#: Kept of a maximum's name in reports.
OWN_MAXIMUM, GIVEN_MVC = 'maximum of the recording', 'MVC'


@dataclass(frozen=True, eq=False)
class EmgRecording:
    """Raw EMG.

    Attributes
    ----------
    channels, units : tuples of str
        One a channel.
    time : (n,) array
        s, even steps, same clock as the motion.
    values : (n, n_channels) array
        In `units`.
    """

    channels: tuple[str, ...]
    units: tuple[str, ...]
    time: Array
    values: Array


@dataclass(frozen=True, eq=False)
class Envelopes:
    """Normalised envelopes.

    Attributes
    ----------
    channels : tuple of str
    time : (n,) array
        s.
    values : (n, n_channels) array
        Fraction of the reference: 1 at the maximum voluntary contraction.
    reference : (n_channels,) array
        Divisor, in the channels' units.
    normalised_by : tuple of str
        `GIVEN_MVC` or `OWN_MAXIMUM` for each channel; with the latter, amplitudes cannot be
        compared.
    """

    channels: tuple[str, ...]
    time: Array
    values: Array
    reference: Array
    normalised_by: tuple[str, ...]


def sampling_rate(recording: EmgRecording) -> float:
    """Return the sampling rate, Hz.

    Raises
    ------
    EmgError
        If shapes do not fit, steps are not even, a value is not finite, or the rate is too low
        for the pass band.
    """
    n, m = recording.time.size, len(recording.channels)
    if recording.values.shape != (n, m) or len(recording.units) != m or m == 0:
        raise EmgError(
            f'EMG: {n} times, {m} channels and {len(recording.units)} units do not fit values of '
            f'shape {recording.values.shape}'
        )
    if n < 2:
        raise EmgError(f'EMG: {n} samples have no sampling rate')
    steps = np.diff(recording.time)
    step = float(np.median(steps))
    worst = int(np.argmax(np.abs(steps - step)))
    if not (step > 0.0 and abs(steps[worst] - step) <= EVEN * step):
        raise EmgError(
            f'EMG: step of {steps[worst]:.6g} s at {recording.time[worst]:.6g} s, '
            f'{step:.6g} s elsewhere'
        )
    bad = np.argwhere(~np.isfinite(recording.values))
    if bad.size:
        row, column = bad[0]
        raise EmgError(
            f'EMG channel {recording.channels[column]!r} is {recording.values[row, column]} at '
            f'{recording.time[row]:.6g} s'
        )
    rate = (n - 1) / float(recording.time[-1] - recording.time[0])
    if rate < LOWEST_RATE * (1.0 - EVEN):
        raise EmgError(
            f'EMG: sampled at {rate:.6g} Hz; a pass band up to {PASS_BAND[1]:g} Hz needs '
            f'{LOWEST_RATE:g} Hz at least'
        )
    return rate


def linear_envelopes(recording: EmgRecording) -> Array:
    """Return band-passed, rectified and low-passed channels (n, n_channels), in their units.

    Raises
    ------
    EmgError
        As for `sampling_rate`, or if the recording is shorter than a period of the low-pass.
    """
    # Slow to import, and needed only with EMG.
    from scipy.signal import butter, sosfiltfilt

    rate = sampling_rate(recording)
    period = int(np.ceil(rate / ENVELOPE_CUTOFF))
    if recording.time.size <= period:
        raise EmgError(
            f'EMG: {recording.time.size} samples are shorter than one period of '
            f'{ENVELOPE_CUTOFF:g} Hz ({period} samples)'
        )
    band = butter(FILTER_ORDER, PASS_BAND, btype='bandpass', fs=rate, output='sos')
    low = butter(FILTER_ORDER, ENVELOPE_CUTOFF, fs=rate, output='sos')
    passed = sosfiltfilt(band, recording.values, axis=0, padlen=period)
    smooth = sosfiltfilt(low, np.abs(passed), axis=0, padlen=period)
    # A low-pass swings below zero beside steep flanks; an envelope does not.
    envelopes: Array = np.maximum(smooth, 0.0)
    return envelopes


def normalised_envelopes(
    recording: EmgRecording, mvc: Mapping[str, float] | None = None
) -> Envelopes:
    """Return envelopes as fractions of the maximum voluntary contraction.

    Parameters
    ----------
    recording : EmgRecording
    mvc : mapping of str to float, optional
        Envelope in the maximum voluntary contraction of each channel, in its unit. Channels that
        are not in it are divided by their own maximum in the recording.

    Raises
    ------
    EmgError
        As for `linear_envelopes`, if an MVC is not positive or of no channel, or if a channel is
        silent.
    """
    mvc = mvc or {}
    for name, value in mvc.items():
        if name not in recording.channels:
            known = ', '.join(recording.channels)
            raise EmgError(f'MVC of {name!r}: no such EMG channel; channels: {known}')
        if not (np.isfinite(value) and value > 0.0):
            raise EmgError(f'MVC of EMG channel {name!r}: {value} is not positive')
    envelopes = linear_envelopes(recording)
    own = envelopes.max(axis=0)
    for name, top in zip(recording.channels, own, strict=True):
        if name not in mvc and not top > 0.0:
            raise EmgError(f'EMG channel {name!r} is silent throughout')
    reference = np.array(
        [mvc.get(name, top) for name, top in zip(recording.channels, own, strict=True)]
    )
    return Envelopes(
        channels=recording.channels,
        time=recording.time,
        values=envelopes / reference,
        reference=reference,
        normalised_by=tuple(
            GIVEN_MVC if name in mvc else OWN_MAXIMUM for name in recording.channels
        ),
    )
