# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Delays, deadband, unsolved samples and gaps of one condition."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from injury_monitor.core.condition import EdgeKind, LimitCondition
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.limits import Limit

LIMIT = Limit('l', 'q', 100.0, 'N', 0.0, math.inf, 'a test')


def condition(on_delay=0.05, off_delay=0.2, deadband=0.02):
    return LimitCondition(LIMIT, on_delay, off_delay, deadband, max_gap=0.1)


def feed(target, values, start=0.0, step=0.01):
    edges = [target.sample(start + k * step, value) for k, value in enumerate(values)]
    return [edge for edge in edges if edge is not None]


def test_raise_and_clear_wait_for_their_delays():
    edges = feed(condition(), [0.0] * 10 + [150.0] * 20 + [0.0] * 40)
    assert [edge.kind for edge in edges] == [EdgeKind.RAISE, EdgeKind.CLEAR]
    assert edges[0].onset == pytest.approx(0.10)
    assert edges[0].stamp == pytest.approx(0.15)
    assert edges[1].onset == pytest.approx(0.30)
    assert edges[1].stamp == pytest.approx(0.50)


def test_at_the_limit_counts_as_beyond():
    assert feed(condition(on_delay=0.0), [99.999]) == []
    assert feed(condition(on_delay=0.0), [100.0])[0].kind is EdgeKind.RAISE


def test_a_spike_shorter_than_the_delay_raises_nothing():
    assert feed(condition(), ([150.0] * 5 + [50.0]) * 10) == []


def test_inside_the_deadband_it_stays_active():
    target = condition(off_delay=0.0)
    feed(target, [150.0] * 10)
    assert feed(target, [98.0, 98.5, 99.9] * 20, start=1.0) == []
    assert feed(target, [97.9], start=2.0)[0].kind is EdgeKind.CLEAR


def test_unsolved_samples_stop_the_clock_but_do_not_reset_it():
    target = condition()
    assert feed(target, [150.0] * 4) == []
    target.interrupt()
    # The step over the unsolved sample (0.03 to 0.05 s) is not seen time.
    assert target.sample(0.05, 150.0) is None
    assert target.sample(0.06, 150.0) is None
    assert target.sample(0.07, 150.0).kind is EdgeKind.RAISE


def test_a_gap_is_not_seen_time():
    target = condition()
    assert target.sample(0.0, 150.0) is None
    assert target.sample(10.0, 150.0) is None
    assert target.sample(10.05, 150.0).kind is EdgeKind.RAISE


def test_restart_forgets_pending_delays_only():
    target = condition()
    feed(target, [150.0] * 10)
    assert target.active
    feed(target, [0.0] * 10, start=0.1)
    target.restart()
    assert target.active
    assert feed(target, [0.0] * 10, start=0.0) == []
    assert feed(target, [0.0] * 20, start=0.1)[0].kind is EdgeKind.CLEAR


@given(st.lists(st.floats(0.0, 200.0), max_size=300), st.floats(0.0, 0.1), st.floats(0.0, 0.1))
def test_edges_alternate_and_are_justified(values, on_delay, off_delay):
    target = condition(on_delay, off_delay)
    edges = feed(target, values)
    kinds = [edge.kind for edge in edges]
    assert kinds == [EdgeKind.RAISE, EdgeKind.CLEAR] * (len(kinds) // 2) + [EdgeKind.RAISE] * (
        len(kinds) % 2
    )
    for edge in edges:
        stretch = values[round(edge.onset * 100) : round(edge.stamp * 100) + 1]
        delay = on_delay if edge.kind is EdgeKind.RAISE else off_delay
        assert edge.stamp - edge.onset >= delay - 1e-6
        assert all(
            value >= 100.0 if edge.kind is EdgeKind.RAISE else value < 98.0 for value in stretch
        )


@pytest.mark.parametrize(
    ('change', 'field'),
    [
        ({'on_delay': -0.1}, 'on_delay'),
        ({'off_delay': math.nan}, 'off_delay'),
        ({'deadband': 1.0}, 'deadband'),
    ],
)
def test_bad_settings_are_refused(change, field):
    with pytest.raises(InvalidInputError, match=field):
        condition(**change)
