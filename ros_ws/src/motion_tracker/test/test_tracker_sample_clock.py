# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Even times from stamps that jitter; exact stamps stay as they are."""

import numpy as np
import pytest

from motion_tracker.core.sample_clock import SampleClock, jitters, mean_deviation, mean_rate

TRUE = 1.7e9 + np.arange(500) / 100.0


def even(stamps, spread=0.0):
    clock = SampleClock(100.0, 0.1, spread)
    return np.array([clock.even(float(stamp)) for stamp in stamps])


@pytest.mark.parametrize('lost', [(), (100,), (100, 101, 102), range(100, 150)])
def test_exact_stamps_are_kept_bit_by_bit(lost):
    stamps = np.delete(TRUE, list(lost))
    assert np.array_equal(even(stamps), stamps)
    assert not jitters(stamps)


@pytest.mark.parametrize('rms', [0.001, 0.003])
def test_jitter_is_taken_off(rms):
    """What is left changes slowly: its second difference, which loads are made of, is small."""
    stamps = TRUE + np.random.default_rng(3).normal(0.0, rms, len(TRUE))
    assert jitters(stamps[:100])
    found = even(stamps, mean_deviation(stamps[:100]))
    assert np.all(np.diff(found) > 0.0)
    left = (found - TRUE)[50:]
    assert left.std() < 0.35 * rms
    assert np.diff(left, 2).std() < 0.1 * np.diff(stamps - TRUE, 2).std()
    assert mean_rate(stamps[:100]) == pytest.approx(100.0, rel=0.005)


def test_a_long_gap_starts_anew():
    stamps = np.concatenate([TRUE[:100], TRUE[100:200] + 3.0037])
    assert np.array_equal(even(stamps), stamps)
