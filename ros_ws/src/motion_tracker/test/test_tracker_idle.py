# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Streams that stop: memory stays bounded, and a lift out of sight is given up by name."""

from motion_tracker.core.tracked import MeasuredLift, Notice
from motion_tracker.core.tracker import MotionTracker

WRENCH = [0.0, 0.0, 400.0], [0.0, 0.0, 0.0]


def test_plates_without_cameras_keep_a_bounded_history(person, marker_set):
    """Five minutes of plates at 100 Hz, before any marker."""
    tracker = MotionTracker(person, marker_set)
    most = 0.0
    for k in range(30_000):
        for side in ('right', 'left'):
            tracker.push_wrench(side, 0.01 * k, *WRENCH)
        most = max(most, tracker._wrenches['right'].span)
    assert most < 41.0
    assert len(tracker._wrenches['right']._raw) <= 8192


def test_a_lift_that_the_cameras_lose_is_given_up(person, marker_set, lift, solver):
    """The clock leaps by an hour in the lift: no lift of 360 000 samples is built."""
    tracker = MotionTracker(person, marker_set, 10.0, (0.3, 0.3, 0.2))
    outputs = []
    for kind, stamp, *values in sorted((m for one in lift for m in one), key=lambda m: m[1]):
        at = stamp + (3600.0 if stamp > 1.7e9 + 1.5 else 0.0)
        if kind == 'markers':
            outputs += tracker.push_markers(at, solver.model.names, *values)
        elif kind == 'box':
            outputs += tracker.push_box(at, *values)
        else:
            outputs += tracker.push_wrench(kind, at, *values)
    outputs += tracker.flush()
    notices = [output.text for output in outputs if isinstance(output, Notice)]
    assert any('lift_001' in text and 'is not assessed' in text for text in notices)
    lifts = [output for output in outputs if isinstance(output, MeasuredLift)]
    assert all(len(one.status) < 400 for one in lifts)
