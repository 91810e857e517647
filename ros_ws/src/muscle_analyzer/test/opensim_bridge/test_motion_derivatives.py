# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Filtering and differentiating recorded coordinates."""

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import InputArrayError
from muscle_analyzer.core.opensim_bridge.derivatives import differentiate, smooth

TIME = np.arange(300) * 0.01
WAVE = np.column_stack([np.sin(2.0 * np.pi * 0.7 * TIME), np.cos(2.0 * np.pi * 0.5 * TIME)])


def test_derivatives_of_waves():
    first, second = differentiate(TIME, WAVE)
    inner = slice(30, -30)
    omega = 2.0 * np.pi * np.array([0.7, 0.5])
    np.testing.assert_allclose(second[inner], -(omega**2) * WAVE[inner], atol=1e-6)
    np.testing.assert_allclose(
        first[inner, 0], (omega[0] * np.cos(omega[0] * TIME))[inner], atol=1e-6
    )


def test_filter_has_no_delay_and_the_gain_of_two_passes():
    """|H|^2 of a third-order Butterworth at its cutoff is one half."""
    smoothed = smooth(TIME, np.sin(2.0 * np.pi * 6.0 * TIME)[:, None], 6.0)[100:200, 0]
    wave = np.sin(2.0 * np.pi * 6.0 * TIME)[100:200]
    assert smoothed @ wave / (wave @ wave) == pytest.approx(0.5, abs=1e-3)
    np.testing.assert_allclose(smooth(TIME, WAVE, 6.0)[50:-50], WAVE[50:-50], atol=1e-3)


def test_straight_line_is_kept_to_the_ends():
    line = 0.3 + 0.2 * TIME[:, None]
    np.testing.assert_allclose(smooth(TIME, line, 6.0), line, atol=1e-9)


@pytest.mark.parametrize(
    ('time', 'values', 'cutoff', 'named'),
    [
        (TIME, WAVE[:-1], 6.0, 'do not fit'),
        (TIME[:5], WAVE[:5], 6.0, '5 samples'),
        (TIME, np.where(TIME[:, None] > 1.0, np.nan, WAVE), 6.0, 'not finite'),
        (TIME + 0.004 * (TIME > 1.0), WAVE, 6.0, 'not even'),
        (TIME, WAVE, 60.0, 'cutoff 60.0'),
    ],
)
def test_bad_input_is_named(time, values, cutoff, named):
    with pytest.raises(InputArrayError, match=named):
        smooth(time, values, cutoff)
