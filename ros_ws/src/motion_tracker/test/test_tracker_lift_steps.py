# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A measured lift is built in steps behind the frames that follow it."""

import pytest

from motion_tracker.core.lifts.lift_events import LiftPhase
from motion_tracker.core.tracked import DetectedEvent, MeasuredLift, TrackerSettings
from motion_tracker.core.tracker import MotionTracker


def samples(lift, plates):
    """Return the made-up lift, half a second of standing after it, and perhaps its plates."""
    last = lift[0][-1]
    still = [('markers', last[1] + 0.01 * i, last[2]) for i in range(1, 51)]
    chosen = [*lift[0], *still, *(lift[2] if plates else [])]
    return sorted(chosen, key=lambda sample: sample[1])


@pytest.mark.parametrize('plates', [True, False])
def test_a_measured_lift_comes_while_frames_go_on(person, marker_set, lift, solver, plates):
    """A step with each frame after the margin, whether other samples come between or not."""
    now = 0.0
    tracker = MotionTracker(
        person, marker_set, settings=TrackerSettings(wait=0.1), clock=lambda: now
    )
    known, frames = None, 0
    for kind, stamp, *values in samples(lift, plates):
        now = stamp
        outputs = (
            tracker.push_markers(stamp, solver.model.names, *values)
            if kind == 'markers'
            else tracker.push_wrench(kind, stamp, *values)
        )
        for output in outputs:
            if isinstance(output, DetectedEvent) and output.event.phase is LiftPhase.END:
                known = output.event.time
        frames += known is not None and kind == 'markers' and stamp >= known + 0.5
        if any(isinstance(output, MeasuredLift) for output in outputs):
            break
    else:
        pytest.fail('no lift before the end of the recording')
    assert 5 < frames < 20
    assert not any(isinstance(output, MeasuredLift) for output in tracker.flush())
