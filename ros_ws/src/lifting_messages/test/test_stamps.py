# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps and seconds go both ways."""

import pytest

from lifting_messages.stamps import to_seconds, to_stamp


@pytest.mark.parametrize('seconds', [0.0, 0.01, 1.999999, 1_763_000_000.123456])
def test_seconds_survive_a_stamp(seconds):
    """Microseconds of this century come back."""
    assert to_seconds(to_stamp(seconds)) == pytest.approx(seconds, abs=5e-7)


def test_a_stamp_that_rounds_up_carries_into_the_seconds():
    """0.9999999 s is one second, not a million microseconds."""
    stamp = to_stamp(4.9999999)
    assert (stamp.sec, stamp.nanosec) == (5, 0)
