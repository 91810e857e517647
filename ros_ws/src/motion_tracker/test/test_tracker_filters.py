# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Butterworth filters: corner, phase, derivatives, delay, gaps."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from motion_tracker.core.exceptions import FilterError
from motion_tracker.core.filters import CausalFilter, derivatives, zero_phase

HALF_POWER = np.sqrt(0.5)


@pytest.mark.parametrize(('rate', 'cutoff'), [(100.0, 6.0), (1000.0, 25.0), (100.0, 25.0)])
def test_two_passes_together_have_their_corner_at_the_cutoff(rate, cutoff):
    time = np.arange(int(40 * rate / cutoff)) / rate
    wave = np.sin(2 * np.pi * cutoff * time)
    middle = slice(len(time) // 4, 3 * len(time) // 4)
    filtered = zero_phase(wave, rate, cutoff)[middle]
    assert filtered @ wave[middle] / (wave[middle] @ wave[middle]) == pytest.approx(
        HALF_POWER, abs=2e-3
    )


def test_zero_phase_filter_does_not_shift():
    time = np.arange(400) / 100.0
    pulse = np.exp(-0.5 * ((time - 2.0) / 0.15) ** 2)
    filtered = zero_phase(pulse, 100.0, 6.0)
    assert time @ filtered / filtered.sum() == pytest.approx(2.0, abs=1e-6)


@pytest.mark.parametrize(('rate', 'cutoff'), [(100.0, 6.0), (1000.0, 25.0)])
def test_causal_filter_has_its_corner_at_the_cutoff(rate, cutoff):
    impulse = np.zeros((round(200 * rate / cutoff), 1))
    impulse[1] = 1.0
    response = CausalFilter(rate, cutoff, 1).values(impulse)[:, 0]
    angle = 2.0 * np.pi * np.array([0.0, cutoff, 4 * cutoff]) / rate
    gain = np.abs(np.exp(-1j * np.outer(angle, np.arange(len(response)))) @ response)
    assert gain[0] == pytest.approx(1.0, abs=1e-12)
    assert gain[1] == pytest.approx(HALF_POWER, abs=0.01)
    assert gain[2] < 0.01


@pytest.mark.parametrize(('cutoff', 'delay'), [(6.0, 0.0693), (25.0, 0.0166)])
def test_stated_delay_is_that_of_a_ramp(cutoff, delay):
    causal = CausalFilter(1000.0, cutoff, 1)
    assert causal.delay == pytest.approx(delay, abs=1e-4)
    for i in range(2000):
        value, speed, _ = causal.step([0.002 * i])
    assert 1.999 * 2.0 - value[0] == pytest.approx(2.0 * causal.delay, abs=1e-9)
    assert speed[0] == pytest.approx(2.0, abs=1e-9)


def test_derivatives_of_the_causal_filter_belong_to_its_value():
    causal = CausalFilter(100.0, 6.0, 2)
    out = np.array([causal.step([np.sin(0.04 * i), 0.5 * (0.01 * i) ** 2]) for i in range(600)])
    value, speed, acceleration = out[200:, 0], out[200:, 1], out[200:, 2]
    # 0.6 Hz, so that the curvature of the first-order hold between samples is small.
    assert np.gradient(value[:, 0], 0.01)[5:-5] == pytest.approx(speed[5:-5, 0], abs=4e-3)
    assert np.gradient(speed[:, 0], 0.01)[5:-5] == pytest.approx(acceleration[5:-5, 0], abs=2e-2)
    # Between samples the parabola is a polygon, whose corners at 100 Hz pass with 3e-5.
    assert acceleration[:, 1] == pytest.approx(np.ones(400), abs=1e-4)


@given(st.lists(st.integers(0, 7), max_size=8))
@settings(deadline=None)
def test_a_block_passes_a_filter_with_the_bits_of_its_samples(sizes):
    samples = np.random.default_rng(3).normal(size=(sum(sizes), 2))
    single, block = CausalFilter(1000.0, 25.0, 2), CausalFilter(1000.0, 25.0, 2)
    expected = [single.step(sample)[0] for sample in samples]
    parts = np.split(samples, np.cumsum(sizes))[:-1]
    passed = [row for part in parts for row in block.values(part)]
    assert np.array_equal(passed, expected)


def test_causal_filter_starts_at_rest_in_its_first_sample():
    causal = CausalFilter(100.0, 6.0, 1)
    value, speed, acceleration = causal.step([3.7])
    assert value[0] == pytest.approx(3.7)
    assert speed[0] == pytest.approx(0.0, abs=1e-9)
    assert acceleration[0] == pytest.approx(0.0, abs=1e-6)


def test_derivatives_of_a_polynomial_of_fifth_order_are_exact():
    time = np.arange(30) / 100.0
    first, second = derivatives(time**5 - time**2, 100.0)
    assert first == pytest.approx(5 * time**4 - 2 * time, abs=1e-10)
    assert second == pytest.approx(20 * time**3 - 2, abs=1e-7)


@pytest.mark.parametrize(('rate', 'cutoff'), [(100.0, 50.0), (100.0, 0.0), (-1.0, 6.0)])
def test_impossible_cutoffs_are_refused(rate, cutoff):
    with pytest.raises(FilterError, match=r'cutoff|rate'):
        zero_phase(np.zeros(50), rate, cutoff)
    with pytest.raises(FilterError, match=r'cutoff|rate'):
        CausalFilter(rate, cutoff, 1)


def test_nan_never_enters_a_filter():
    with pytest.raises(FilterError, match='index 3'):
        zero_phase([0.0, 1.0, 2.0, np.nan, 4.0], 100.0, 6.0)
    causal = CausalFilter(100.0, 6.0, 2)
    with pytest.raises(FilterError, match='channel 1'):
        causal.step([0.0, np.nan])
    assert np.isfinite(causal.step([0.0, 1.0])[0]).all()
