# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint torque index, thesis eq. 4.12."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.torque_index import torque_index, torque_index_peaks, worst_torque_index


def test_the_bound_on_the_side_of_the_torque_is_used():
    index = torque_index(
        np.array([50.0, -50.0, 0.0]),
        np.array([-200.0, -80.0, -1.0]),
        np.array([100.0, 500.0, 1.0]),
    )
    np.testing.assert_allclose(index, [0.5, 0.625, 0.0])


def test_a_torque_without_any_strength_is_infinite():
    index = torque_index(np.array([1.0, -1.0, 0.0]), np.zeros(3), np.zeros(3))
    np.testing.assert_array_equal(index, [np.inf, np.inf, 0.0])


@given(st.floats(-500, 500), st.floats(-500, -1), st.floats(1, 500))
def test_index_is_one_exactly_at_the_bounds_and_below_inside(torque, lower, upper):
    index = float(torque_index(np.array(torque), np.array(lower), np.array(upper)))
    assert index >= 0.0
    assert (index <= 1.0) == (lower <= torque <= upper)
    assert torque_index(np.array(upper), np.array(lower), np.array(upper)) == 1.0
    assert torque_index(np.array(lower), np.array(lower), np.array(upper)) == 1.0


BOUND = st.floats(0, 500) | st.sampled_from([0.0, np.nan])
JOINT = st.tuples(st.floats(-500, 500) | st.sampled_from([0.0, -0.0]), BOUND, BOUND)


@given(st.lists(JOINT, max_size=6))
def test_the_worst_joint_of_a_sample_is_that_of_all_its_indices(joints):
    torque, lower, upper = np.array(joints, np.float64).reshape(-1, 3).T
    index = torque_index(torque, -lower, upper)
    worst = worst_torque_index(torque, -lower, upper)
    if np.all(np.isnan(index)):
        assert worst is None
    else:
        assert worst == (np.nanargmax(index), np.nanmax(index))


@pytest.mark.parametrize(
    ('torque', 'lower', 'upper', 'field'),
    [
        ([1.0], [1.0], [2.0], 'lower'),
        ([1.0], [-1.0], [-2.0], 'upper'),
        ([np.nan], [-1.0], [1.0], 'torque'),
        ([1.0], [-1.0, -1.0], [1.0], 'lower'),
    ],
)
def test_bad_bounds_are_refused(torque, lower, upper, field):
    with pytest.raises(InvalidInputError, match=field):
        torque_index(np.array(torque), np.array(lower), np.array(upper))
    if len(torque) == len(lower):
        with pytest.raises(InvalidInputError, match=field):
            worst_torque_index(np.array(torque), np.array(lower), np.array(upper))


def test_peaks_leave_out_unsolved_samples():
    time = np.array([10.0, 10.1, 10.2])
    torque = np.array([[10.0, -5.0], [np.nan, 1e9], [20.0, -1.0]])
    lower, upper = np.full((3, 2), -10.0), np.full((3, 2), 40.0)
    peaks = torque_index_peaks(
        time, ('hip', 'knee'), torque, lower, upper, np.array([True, False, True])
    )
    np.testing.assert_allclose(peaks.peak, [0.5, 0.5])
    np.testing.assert_allclose(peaks.time, [10.2, 10.0])
    nothing = torque_index_peaks(time, ('hip', 'knee'), torque, lower, upper, np.zeros(3, bool))
    assert nothing.worst()[0] == '' and np.all(np.isnan(nothing.peak))


def test_a_joint_without_published_strength_is_left_out():
    time = np.array([0.0, 0.1])
    torque = np.array([[10.0, 90.0], [20.0, 90.0]])
    lower = np.array([[-40.0, np.nan]] * 2)
    upper = np.array([[40.0, np.nan]] * 2)
    peaks = torque_index_peaks(time, ('hip', 'wrist'), torque, lower, upper, np.ones(2, bool))
    np.testing.assert_allclose(peaks.peak, [0.5, np.nan])
    np.testing.assert_allclose(peaks.time, [0.1, np.nan])
    assert peaks.worst()[0] == 'hip'
