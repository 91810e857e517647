# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Streams that come late, never come, or end early, by a clock that the test sets."""

import numpy as np
import pytest

from motion_tracker.core.tracked import DetectedEvent, Notice, TrackedFrame
from motion_tracker.core.tracker import MotionTracker

# Of the lift in conftest.
START = 1.7e9
MASS, SIZE = 10.0, (0.3, 0.3, 0.2)


def feed_one(tracker, message, names):
    if message[0] == 'markers':
        return tracker.push_markers(message[1], names, message[2])
    if message[0] == 'box':
        return tracker.push_box(*message[1:])
    return tracker.push_wrench(*message)


def feed(tracker, messages, names):
    outputs = [output for message in messages for output in feed_one(tracker, message, names)]
    return outputs + tracker.flush()


def in_order(*streams):
    return sorted((m for stream in streams for m in stream), key=lambda m: m[1])


def of(kind, outputs):
    return [output for output in outputs if isinstance(output, kind)]


class Clock:
    """A clock that is set by hand."""

    def __init__(self):
        self.time = 100.0

    def __call__(self):
        return self.time


def pushed(tracker, markers, names, clock, rate):
    """Feed marker frames at a rate times real time; return what came out of each."""
    outputs = []
    for _, stamp, positions in markers:
        clock.time += 0.01 / rate
        outputs.append(tracker.push_markers(stamp, names, positions))
    return outputs


@pytest.mark.parametrize(('rate', 'frames'), [(0.25, 50), (1.0, 200), (10.0, None)])
def test_a_plate_that_never_comes_is_given_up_by_the_clock(
    marker_set, lift, solver, person, rate, frames
):
    clock = Clock()
    tracker = MotionTracker(person, marker_set, clock=clock)
    outputs = pushed(tracker, lift[0], solver.model.names, clock, rate)
    first = next((i for i, some in enumerate(outputs) if of(TrackedFrame, some)), None)
    if frames is None:
        assert first is None
        return
    assert first == pytest.approx(frames, abs=1)
    said = [n.text for n in of(Notice, outputs[first])]
    assert said == [
        f'{side} plate: no samples at all at {START:.3f} s; going on without'
        for side in ('right', 'left')
    ]


def test_a_late_plate_is_waited_for_at_ten_times_real_time_and_through_a_pause(
    marker_set, lift, sides, solver, person
):
    """The left plate comes 2.5 s of stamps late, 0.25 s by the clock, and after a pause."""
    clock = Clock()
    names = solver.model.names
    tracker = MotionTracker(person, marker_set, clock=clock)
    outputs = []
    late = list(sides[1])
    for _, stamp, positions in lift[0]:
        clock.time += 0.001 if stamp != lift[0][20][1] else 30.0
        while late and late[0][1] < stamp - 2.5:
            outputs += tracker.push_wrench(*late.pop(0))
        outputs += tracker.push_markers(stamp, names, positions)
    for sample in [*late, *sides[0]]:
        outputs += tracker.push_wrench(*sample)
    outputs += tracker.flush()
    assert not [n for n in of(Notice, outputs) if 'going on without' in n.text]
    reference = feed(MotionTracker(person, marker_set), in_order(lift[0], *sides), names)
    for one, other in zip(of(TrackedFrame, outputs), of(TrackedFrame, reference), strict=True):
        assert np.array_equal(one.motion.ground_force, other.motion.ground_force)
        assert one.status is other.status


def test_giving_up_early_or_at_the_end_gives_the_same(marker_set, lift, sides, solver, person):
    """Online by the clock, or a file without one: the left plate and the box fall silent."""
    clock = Clock()
    names = solver.model.names
    plates = [*sides[0], *(m for m in sides[1] if m[1] < START + 0.6)]
    box = [m for m in lift[1] if m[1] < START + 0.5]
    live = MotionTracker(person, marker_set, MASS, SIZE, clock=clock)
    outputs = []
    for message in in_order(lift[0], plates, box):
        clock.time = message[1]
        outputs += feed_one(live, message, names)
    before_end = len(of(TrackedFrame, outputs))
    outputs += live.flush()
    reference = feed(
        MotionTracker(person, marker_set, MASS, SIZE), in_order(lift[0], plates, box), names
    )
    assert before_end > 200
    assert [(e.lift_id, e.event.time, e.detected_from) for e in of(DetectedEvent, outputs)] == [
        (e.lift_id, e.event.time, e.detected_from) for e in of(DetectedEvent, reference)
    ]
    for one, other in zip(of(TrackedFrame, outputs), of(TrackedFrame, reference), strict=True):
        assert np.array_equal(one.motion.ground_force, other.motion.ground_force)
        assert one.status is other.status
