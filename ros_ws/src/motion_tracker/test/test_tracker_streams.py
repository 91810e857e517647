# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Sampled streams: refusal, alignment of filtered samples, gaps."""

from collections import Counter

import numpy as np
import pytest

from motion_tracker.core.exceptions import TrackerError
from motion_tracker.core.streams import SampledStream, rate_of

START = 1.7e9


def ramp(cutoff=25.0, rate=1000.0, n=1000, lost=()):
    counts = Counter()
    stream = SampledStream('right plate', 2, counts, cutoff)
    for i in range(n):
        if i not in lost:
            stream.push(START + i / rate, np.array([i / rate, 1.0]))
    return stream, counts


def test_filtered_samples_belong_to_the_time_they_are_asked_for():
    """The delay is taken off: a ramp read at t is t."""
    stream, _ = ramp()
    assert stream.filtered_at(START + 0.5) == pytest.approx([0.5, 1.0], abs=1e-6)
    assert stream.filtered_at(START + 0.50037) == pytest.approx([0.50037, 1.0], abs=1e-6)
    assert stream.filtered_at(START + 0.999) is None
    assert stream.filtered_at(START - 0.1) is None


def test_rows_of_many_times_are_those_of_single_times():
    """Between samples, on one, before and after the stream, in a gap."""
    stream, _ = ramp(lost=range(400, 420))
    times = START + np.array([-0.1, 0.0, 0.0101, 0.02, 0.3985, 0.41, 0.4195, 0.42, 0.999, 0.9995])
    rows = stream.raw_rows_at(times)
    single = [stream.raw_at(float(time)) for time in times]
    nothing = np.full(2, np.nan)
    assert np.array_equal(
        rows, [nothing if row is None else row for row in single], equal_nan=True
    )
    lost = [True, False, False, False, False, True, True, False, False, True]
    assert np.isnan(rows[:, 0]).tolist() == lost
    assert np.isnan(stream.raw_rows_at(np.array([START + 5.0]))).all()


def test_raw_samples_are_interpolated():
    stream, _ = ramp()
    assert stream.raw_at(START + 0.1234) == pytest.approx([0.1234, 1.0], abs=1e-6)
    assert stream.raw_at(START + 2.0) is None


def test_zero_phase_samples_need_the_whole_window():
    stream, _ = ramp()
    times = START + np.arange(0.3, 0.6, 0.01)
    assert stream.zero_phase_at(times, 25.0, 0.2)[:, 0] == pytest.approx(times - START, abs=1e-5)
    assert stream.zero_phase_at(times + 0.5, 25.0, 0.2) is None


def test_refused_samples_are_counted_by_kind():
    stream, counts = ramp(n=20)
    assert not stream.push(START + 0.019, np.zeros(2))
    assert not stream.push(START + 0.001, np.zeros(2))
    assert not stream.push(START + 0.020, np.array([np.nan, 0.0]))
    assert counts == {
        'right plate: duplicate stamps': 1,
        'right plate: unsorted stamps': 1,
        'right plate: not finite': 1,
    }


def test_a_few_lost_samples_are_bridged_and_counted():
    stream, counts = ramp(lost=(400, 401, 402))
    assert counts == {'right plate: lost samples': 3}
    assert stream.filtered_at(START + 0.5) == pytest.approx([0.5, 1.0], abs=1e-6)
    assert stream.raw_at(START + 0.4005) == pytest.approx([0.4005, 1.0], abs=1e-6)


def test_a_long_gap_gives_nothing():
    stream, counts = ramp(lost=range(400, 420))
    assert counts == {'right plate: lost samples': 20}
    assert stream.raw_at(START + 0.41) is None
    times = START + np.arange(0.35, 0.5, 0.01)
    spoiled = times[stream.uncertain(times, 0.015)] - START
    assert spoiled == pytest.approx([0.39, 0.40, 0.41, 0.42, 0.43], abs=1e-6)


def test_forgotten_samples_are_gone_and_the_rest_is_untouched():
    stream, _ = ramp()
    before = stream.filtered_at(START + 0.8)
    stream.forget(START + 0.5)
    assert np.array_equal(stream.filtered_at(START + 0.8), before)
    assert stream.raw_at(START + 0.4) is None


def test_rates_are_whole_where_the_clock_is_only_coarse():
    """Seconds of this century in a double have steps of 0.24 microseconds."""
    for rate in (100.0, 1000.0, 2500.0, 59.94):
        assert rate_of(START + np.arange(11) / rate, 'markers') == pytest.approx(rate, rel=6e-4)
    assert rate_of(START + np.arange(11) / 1000.0, 'plate') == 1000.0
    with pytest.raises(TrackerError, match='left plate'):
        rate_of(np.zeros(11), 'left plate')


def test_a_stream_too_short_for_a_rate_is_dropped_and_counted():
    stream, counts = ramp(n=5)
    stream.settle()
    assert stream.empty
    assert counts == {'right plate: too short': 5}
