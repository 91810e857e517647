# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A falling slope's zero by hand, and where plain false position would hardly move."""

import pytest

from muscle_analyzer.core.recruitment.false_position import crossing, narrowed, whole_step


def test_a_straight_slope_is_zero_at_the_first_crossing():
    assert crossing(whole_step(3.0, -1.0, 0)) == pytest.approx(0.75)


def test_the_end_with_the_sign_of_the_slope_is_moved():
    bracket = whole_step(4.0, -4.0, 0)
    assert narrowed(bracket, 0.5, 1.0) == (0.5, 1.0, 1.0, -4.0, 1)
    assert narrowed(bracket, 0.5, -1.0) == (0.0, 4.0, 0.5, -1.0, -1)


def test_an_end_that_stays_twice_counts_half():
    once = narrowed(whole_step(4.0, -4.0, 0), 0.5, 1.0)
    assert narrowed(once, 0.6, 0.5) == (0.6, 0.5, 1.0, -2.0, 1)
    once = narrowed(whole_step(4.0, -4.0, 0), 0.5, -1.0)
    assert narrowed(once, 0.4, -0.5) == (0.0, 2.0, 0.4, -0.5, -1)


def test_a_bent_slope_is_closed_in_on_from_both_sides():
    bracket = whole_step(1.0, -999.0, 0)
    for _ in range(20):
        place = crossing(bracket)
        bracket = narrowed(bracket, place, 1.0 - 1000.0 * place**5)
    assert crossing(bracket) == pytest.approx(1e-3**0.2, abs=1e-9)
