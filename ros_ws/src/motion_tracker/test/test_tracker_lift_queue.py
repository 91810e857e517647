# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Naming, building and memory of lifts; the builder itself is tested with the tracker."""

import pytest

from motion_tracker.core.forces.mass_watch import MassWatch
from motion_tracker.core.lifts.lift_events import LiftEvent, LiftPhase
from motion_tracker.core.lifts.lift_queue import LiftQueue
from motion_tracker.core.live_status import LiveStatus
from motion_tracker.core.tracked import FROM_BOX, FROM_HANDS


class Builder:
    """Builder of three steps a lift, which returns its arguments and records what it forgets."""

    def __init__(self):
        self.forgotten = []

    def forget(self, before):
        self.forgotten.append(before)

    def build(self, lift_id, start, end, records, rate, estimator, support, doubt):
        yield None
        yield None
        yield lift_id, [record.stamp for record in records], support


def event(phase, time):
    return LiftEvent(phase, 1, time, 0.3, 0.2)


@pytest.fixture
def builder():
    return Builder()


@pytest.fixture
def queue(builder):
    return LiftQueue(builder, 0.5, 7, None, LiveStatus(MassWatch(70.0, 0.05), 0.5))


def lift(queue, start, end, source=FROM_BOX):
    """Let a lift begin and end; return its names."""
    named = queue.take([event(LiftPhase.START, start)], source)
    assert queue.lifting
    named += queue.take([event(LiftPhase.END, end)], source)
    assert not queue.lifting
    return [output.lift_id for output in named]


def test_lifts_are_built_step_by_step_from_the_frames_round_them(queue):
    for i in range(50):
        queue.record(0.1 * i, None)
    assert lift(queue, 1.0, 2.0) == ['lift_007', 'lift_007']
    assert queue.end_known == 2.2
    assert lift(queue, 3.0, 4.0, FROM_HANDS) == ['lift_008', 'lift_008']
    queue.begin(2.4, 10.0)
    assert queue.finish() == []
    queue.begin(4.6, 10.0)
    done = [queue.work(False) for _ in range(6)]
    assert [len(some) for some in done] == [0, 0, 1, 0, 0, 1]
    ((name, stamps, support),) = done[2]
    assert (name, support) == ('lift_007', 0.3)
    assert stamps == pytest.approx([0.1 * i for i in range(5, 26)])
    assert done[5][0][2] is None


def test_lifts_of_two_sessions_have_different_names(builder):
    names = set()
    for session in ('3f9a7c2e', '51b0d844'):
        status = LiveStatus(MassWatch(70.0, 0.05), 0.5)
        names.update(lift(LiftQueue(builder, 0.5, 1, None, status, session), 1.0, 2.0))
    assert names == {'lift_001_3f9a7c2e', 'lift_001_51b0d844'}


def test_an_end_without_a_start_is_no_lift(queue):
    assert queue.take([event(LiftPhase.END, 2.0)], FROM_BOX) == []
    assert queue.end_known is None


def test_a_step_waits_for_a_sample_that_completes_no_frame(queue):
    """The builder takes three steps: done with the fourth frame, or the sample after the third."""
    for i in range(26):
        queue.record(0.1 * i, None)
        assert queue.work(False) == []
    lift(queue, 1.0, 2.0)
    queue.begin(2.5, 10.0)
    assert queue.work(False) == []
    for i in range(26, 29):
        queue.record(0.1 * i, None)
        assert queue.work(True) == []
    assert len(queue.work(False)) == 1


def test_old_frames_are_forgotten_but_not_those_of_a_lift(queue, builder):
    kept = []
    for i in range(2000):
        stamp = 0.1 * i
        queue.record(stamp, None)
        if i == 1000:
            queue.take([event(LiftPhase.START, stamp)], FROM_BOX)
        if i == 1800:
            queue.take([event(LiftPhase.END, stamp)], FROM_BOX)
        queue.work(False)
        kept += [(stamp, before) for before in builder.forgotten]
        builder.forgotten.clear()
    assert all(stamp - before == pytest.approx(15.0) for stamp, before in kept if stamp < 100.0)
    assert kept
    assert [before for stamp, before in kept if stamp > 120.0] == []
    queue.begin(190.0, 10.0)
    # The frames of a lift that is being built are needed as well.
    queue.record(199.9, None)
    assert queue.work(False) == []
    assert builder.forgotten == []
    ((_, stamps, _),) = queue.finish()
    assert (stamps[0], stamps[-1]) == pytest.approx((99.5, 180.5))
    queue.record(199.9, None)
    queue.work(False)
    assert builder.forgotten == [pytest.approx(184.9)]
