# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Load the compiled functions before the first marker frame needs them."""

import numpy as np

from motion_tracker.core.forces.force_plates import PlateGeometry, ground_reaction
from motion_tracker.core.lifts.lift_events import detect_lifts
from motion_tracker.core.markers.marker_set import REFERENCE_SUBJECT, load_marker_set
from motion_tracker.core.tracker import MotionTracker

#: Any set with positions will do.
_MARKER_SET = 'plug_in_gait_58'

#: More than a stretch of quiet standing.
_FRAMES = 60


def warm_up() -> None:
    """Track a few frames of a standing reference person with one box on the floor; see it rise."""
    tracker = MotionTracker(REFERENCE_SUBJECT, load_marker_set(_MARKER_SET), 1.0, (0.3, 0.3, 0.3))
    positions = tracker.inverse_kinematics.predict(tracker.skeleton.standing())
    for i in range(_FRAMES):
        stamp = 0.01 * i
        for side in ('right', 'left'):
            tracker.push_wrench(side, stamp, (0.0, 0.0, 360.0), np.zeros(3))
        tracker.push_box(stamp, (0.5, 0.0, 0.15))
        tracker.push_markers(stamp, tracker.model.names, positions)
    tracker.flush()
    # Functions that only a lift needs.
    ground_reaction(np.zeros((2, 3)), np.zeros((2, 3)), PlateGeometry('plate'), 20.0)
    times = np.arange(100) / 100.0
    detect_lifts(times, 0.15 + np.clip(times - 0.5, 0.0, 0.3))
