# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""EMG: envelopes of signals whose envelope is known, normalisation, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from muscle_analyzer.core.emg.envelopes import (
    GIVEN_MVC,
    OWN_MAXIMUM,
    EmgRecording,
    linear_envelopes,
    normalised_envelopes,
    sampling_rate,
)
from muscle_analyzer.core.exceptions import EmgError

RATE = 2000.0


def recording(*columns, rate=RATE, start=0.0):
    values = np.stack(columns, axis=1)
    time = start + np.arange(len(values)) / rate
    names = tuple(f'EMG{k}' for k in range(1, len(columns) + 1))
    return EmgRecording(names, ('V',) * len(columns), time, values)


def tone(frequency, seconds=4.0, rate=RATE):
    return np.sin(2.0 * np.pi * frequency * np.arange(round(seconds * rate)) / rate)


def gain(frequency, rate=RATE):
    """Return what two passes of a second-order Butterworth band-pass leave of a tone.

    1 / (1 + W^4) with W = (w^2 - w_1 w_2) / (w (w_2 - w_1)) and w = tan(pi f / rate): the
    low-pass prototype, turned into a band-pass and sampled by the bilinear transform.
    """
    w, low, high = np.tan(np.pi * np.array([frequency, 10.0, 450.0]) / rate)
    return 1.0 / (1.0 + ((w * w - low * high) / (w * (high - low))) ** 4)


@pytest.mark.parametrize('frequency', [1.0, 3.0, 10.0, 50.0, 120.0, 300.0, 450.0, 700.0, 900.0])
def test_envelope_of_a_tone_is_its_mean_size(frequency):
    """The mean of a rectified sine is 2 / pi of its height, and the band-pass leaves its gain."""
    envelope = linear_envelopes(recording(3.0 * tone(frequency, 8.0)))[:, 0]
    want = gain(frequency) * 3.0 * 2.0 / np.pi
    assert envelope[4000:-4000].mean() == pytest.approx(want, rel=0.02, abs=0.002)


def test_the_band_is_that_of_the_dissertation():
    """At its ends each pass leaves 1 / sqrt(2); in its middle next to everything."""
    assert gain(10.0) == pytest.approx(0.5)
    assert gain(450.0) == pytest.approx(0.5)
    assert gain(70.0) == pytest.approx(1.0, abs=0.01)


def test_a_slow_course_comes_back_without_delay():
    """Noise whose size follows a known course; a million random numbers leave a per cent."""
    rng = np.random.default_rng(3)
    time = np.arange(round(6.0 * RATE)) / RATE
    course = 0.2 + np.exp(-(((time - 3.2) / 0.6) ** 2))
    channels = [course * rng.standard_normal(time.size) for _ in range(80)]
    found = linear_envelopes(recording(*channels)).mean(axis=1)
    found *= course.max() / found.max()
    assert time[found.argmax()] == pytest.approx(3.2, abs=0.05)
    np.testing.assert_allclose(found[1000:-1000], course[1000:-1000], atol=0.05)


def test_reversed_signals_have_reversed_envelopes():
    """Forwards and backwards are alike: there is no phase."""
    rng = np.random.default_rng(5)
    signal = rng.standard_normal(6000) * np.linspace(0.1, 1.0, 6000)
    forth = linear_envelopes(recording(signal))[:, 0]
    back = linear_envelopes(recording(signal[::-1]))[::-1, 0]
    np.testing.assert_allclose(forth[500:-500], back[500:-500], atol=2e-3)


def test_given_mvc_and_own_maximum():
    loud = 2.0 * tone(100.0)
    found = normalised_envelopes(recording(loud, loud), {'EMG2': 8.0 / np.pi})
    assert found.normalised_by == (OWN_MAXIMUM, GIVEN_MVC)
    assert found.values[:, 0].max() == 1.0
    assert found.values[4000, 1] == pytest.approx(0.5, rel=0.01)
    assert found.reference[1] == 8.0 / np.pi
    assert (found.values >= 0.0).all()


@pytest.mark.parametrize('rate', [500.0, 900.0, 980.0])
def test_slow_sampling_is_refused(rate):
    with pytest.raises(EmgError, match=rf'sampled at {rate:g} Hz; .* needs 1000 Hz'):
        sampling_rate(recording(tone(50.0, rate=rate), rate=rate))


def test_lowest_rate_is_accepted_late_in_the_day():
    """Stamps of a clock that runs for long, as coarse as they may be."""
    made = recording(tone(50.0, rate=1000.0), rate=1000.0, start=86400.0)
    assert sampling_rate(made) == pytest.approx(1000.0, rel=1e-6)


def test_gaps_missing_values_and_silence_are_named():
    good = recording(tone(50.0), tone(60.0))
    late = good.time.copy()
    late[100:] += 0.01
    with pytest.raises(EmgError, match=r'step of 0\.0105 s at 0\.0495 s, 0\.0005 s elsewhere'):
        linear_envelopes(replace(good, time=late))
    broken = good.values.copy()
    broken[2000, 1] = np.nan
    with pytest.raises(EmgError, match=r"channel 'EMG2' is nan at 1 s"):
        linear_envelopes(replace(good, values=broken))
    with pytest.raises(EmgError, match="channel 'EMG1' is silent"):
        normalised_envelopes(recording(np.zeros(4000)))
    with pytest.raises(EmgError, match=r'300 samples are shorter than one period of 5 Hz'):
        linear_envelopes(recording(tone(50.0)[:300]))
    with pytest.raises(EmgError, match='do not fit values of shape'):
        linear_envelopes(replace(good, channels=('EMG1',)))


@pytest.mark.parametrize(
    ('mvc', 'message'),
    [
        ({'EMG9': 1.0}, "MVC of 'EMG9': no such EMG channel; channels: EMG1"),
        ({'EMG1': 0.0}, "MVC of EMG channel 'EMG1': 0.0 is not positive"),
        ({'EMG1': float('nan')}, 'nan is not positive'),
    ],
)
def test_an_mvc_that_cannot_be_is_refused(mvc, message):
    with pytest.raises(EmgError, match=message):
        normalised_envelopes(recording(tone(50.0)), mvc)
