# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Which lifts are named, built and remembered; the builder itself is tested with the tracker."""

import pytest

from motion_tracker.core.lift_events import LiftEvent, LiftPhase
from motion_tracker.core.lift_records import LiftRecords
from motion_tracker.core.live_status import LiveStatus
from motion_tracker.core.mass_watch import MassWatch
from motion_tracker.core.tracked import FROM_BOX, FROM_HANDS


class Builder:
    """Takes three steps for each lift and gives out what it was told."""

    def build(self, lift_id, start, end, records, rate, estimator, support, doubt):
        yield None
        yield None
        yield lift_id, [record.stamp for record in records], support


def event(phase, time):
    return LiftEvent(phase, 1, time, 0.3, 0.2)


@pytest.fixture
def records():
    return LiftRecords(Builder(), 0.5, 7)


@pytest.fixture
def status():
    return LiveStatus(MassWatch(70.0, 0.05), 0.5)


def lift(records, start, end, source=FROM_BOX):
    """Let a lift begin and end; return its names."""
    named = records.take([event(LiftPhase.START, start)], source)
    assert records.lifting
    named += records.take([event(LiftPhase.END, end)], source)
    assert not records.lifting
    return [output.lift_id for output in named]


def test_lifts_are_built_step_by_step_from_the_frames_round_them(records, status):
    for i in range(50):
        records.record(0.1 * i, None)
    assert lift(records, 1.0, 2.0) == ['lift_007', 'lift_007']
    assert records.end_known == 2.2
    assert lift(records, 3.0, 4.0, FROM_HANDS) == ['lift_008', 'lift_008']
    records.begin_builds(2.4, 10.0, None, status)
    assert records.build() == []
    records.begin_builds(4.6, 10.0, None, status)
    done = [records.build(1) for _ in range(6)]
    assert [len(some) for some in done] == [0, 0, 1, 0, 0, 1]
    ((name, stamps, support),) = done[2]
    assert (name, support) == ('lift_007', 0.3)
    assert stamps == pytest.approx([0.1 * i for i in range(5, 26)])
    assert done[5][0][2] is None


def test_an_end_without_a_start_is_no_lift(records):
    assert records.take([event(LiftPhase.END, 2.0)], FROM_BOX) == []
    assert records.end_known is None


def test_old_frames_are_forgotten_but_not_those_of_a_lift(records, status):
    kept = []
    for i in range(2000):
        stamp = 0.1 * i
        records.record(stamp, None)
        if i == 1000:
            records.take([event(LiftPhase.START, stamp)], FROM_BOX)
        if i == 1800:
            records.take([event(LiftPhase.END, stamp)], FROM_BOX)
        before = records.forget(stamp)
        if before is not None:
            kept.append((stamp, before))
    assert all(stamp - before == pytest.approx(15.0) for stamp, before in kept if stamp < 100.0)
    assert [before for stamp, before in kept if stamp > 120.0] == []
    records.begin_builds(190.0, 10.0, None, status)
    # The frames of a lift that is being built are needed as well.
    assert records.forget(199.9) is None
    ((_, stamps, _),) = records.build()
    assert (stamps[0], stamps[-1]) == pytest.approx((99.5, 180.5))
    assert records.forget(199.9) == pytest.approx(184.9)
