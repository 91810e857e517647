# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Largest mean activation over a window, thesis section 4.2.2."""

import os
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from injury_monitor.core.activation_index import SlidingMean, activation_index
from injury_monitor.core.exceptions import InvalidInputError


def test_a_hold_of_the_window_counts_fully_and_a_short_peak_does_not():
    time = np.arange(0.0, 2.001, 0.01)
    hold = ((time >= 0.5) & (time <= 1.0)).astype(float)
    spike = ((time >= 0.5) & (time < 0.545)).astype(float)
    result = activation_index(
        time,
        ('hold', 'spike'),
        np.column_stack([hold, spike]),
        np.ones(len(time), bool),
        window=0.5,
    )
    assert result.index[0] == pytest.approx(1.0)
    assert result.time[0] == pytest.approx(1.0)
    # Five samples of 1 with straight flanks: area 0.05 s of a 0.5 s window.
    assert result.index[1] == pytest.approx(0.1)
    assert result.worst()[0] == 'hold'


@settings(max_examples=30, deadline=None)
@given(st.sampled_from([50.0, 100.0, 333.0]), st.floats(0.2, 0.6))
def test_mean_of_a_ramp_is_exact_at_any_rate(rate, window):
    time = np.arange(0.0, 1.0, 1.0 / rate)
    mean = SlidingMean(window)
    for stamp in time:
        value = mean.add(float(stamp), np.array([stamp]))
        if stamp < window - 1e-9:
            assert value is None
        elif value is not None:
            assert value[0] == pytest.approx(stamp - window / 2.0, abs=1e-7)
    assert value is not None


def test_gap_and_return_in_time_empty_the_window():
    mean = SlidingMean(0.1, max_gap=0.05)
    for stamp in np.arange(0.0, 0.2, 0.01):
        last = mean.add(float(stamp), np.array([1.0]))
    assert last is not None
    assert mean.add(0.5, np.array([1.0])) is None
    assert mean.add(0.0, np.array([1.0])) is None


def test_a_lift_shorter_than_the_window_is_averaged_as_a_whole():
    time = np.array([0.0, 0.1, 0.2])
    result = activation_index(time, ('m',), np.array([[0.0], [0.5], [1.0]]), np.ones(3, bool))
    assert result.window == pytest.approx(0.2)
    assert result.index[0] == pytest.approx(0.5)


def test_unsolved_samples_are_left_out():
    time = np.arange(0.0, 1.0, 0.02)
    activation = np.full((len(time), 1), 0.3)
    solved = np.ones(len(time), bool)
    activation[10], solved[10] = 1e6, False
    result = activation_index(time, ('m',), activation, solved)
    assert result.index[0] == pytest.approx(0.3)
    nothing = activation_index(time, ('m',), activation, np.zeros(len(time), bool))
    assert nothing.worst()[0] == '' and np.isnan(nothing.index[0])


def test_one_unsolved_sample_is_bridged_and_a_longer_hole_is_not():
    time = np.arange(0.0, 1.2, 0.1)
    activation = np.full((len(time), 1), 0.3)
    for hole, expected in ((slice(5, 6), 0.3), (slice(5, 8), np.nan)):
        solved = np.ones(len(time), bool)
        solved[hole] = False
        result = activation_index(time, ('m',), activation, solved, window=0.7)
        np.testing.assert_allclose(result.index, [expected])


def test_bad_input_is_refused():
    with pytest.raises(InvalidInputError, match='window'):
        SlidingMean(0.0)
    with pytest.raises(InvalidInputError, match='time'):
        activation_index(np.array([0.0, 0.0]), ('m',), np.zeros((2, 1)), np.ones(2, bool))
    with pytest.raises(InvalidInputError, match='activation'):
        activation_index(np.array([0.0, 0.1]), ('m',), np.zeros((2, 2)), np.ones(2, bool))


def test_the_first_lift_imports_nothing():
    """Live samples wait for an import: numpy's median imports masked arrays, for 20 ms."""
    code = (
        'import sys, numpy as np\n'
        'from injury_monitor.core.activation_index import activation_index\n'
        'before = set(sys.modules)\n'
        'time = np.arange(100) / 100\n'
        "activation_index(time, ('a',), np.full((100, 1), 0.5), np.ones(100, bool))\n"
        'print(sorted(set(sys.modules) - before))\n'
    )
    answer = subprocess.run(
        [sys.executable, '-c', code],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)},
    )
    assert answer.stdout.strip() == '[]'
