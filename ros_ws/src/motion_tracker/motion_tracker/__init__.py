# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint states, ground reaction, centre of pressure and lifts from markers and force plates.

Names are imported when they are first used, so that a node starts fast.

Examples
--------
>>> tracker = MotionTracker(subject, load_marker_set('plug_in_gait_58'))
>>> outputs = []
>>> for stamp, positions in frames:
...     outputs += tracker.push_markers(stamp, marker_names, positions)
>>> outputs += tracker.flush()
>>> lifts = [output for output in outputs if isinstance(output, MeasuredLift)]
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from motion_tracker.core.calibration import calibrate
    from motion_tracker.core.exceptions import MotionTrackerError
    from motion_tracker.core.forces.force_plates import PlateGeometry, ground_reaction
    from motion_tracker.core.inverse_kinematics.inverse_kinematics import InverseKinematics
    from motion_tracker.core.lifts.lift_events import LiftEvent, detect_lifts
    from motion_tracker.core.markers.marker_set import MarkerSet, load_marker_set
    from motion_tracker.core.tracked import (
        DetectedEvent,
        MeasuredLift,
        Notice,
        TrackedFrame,
        TrackerSettings,
    )
    from motion_tracker.core.tracker import MotionTracker

__all__ = [
    'DetectedEvent',
    'InverseKinematics',
    'LiftEvent',
    'MarkerSet',
    'MeasuredLift',
    'MotionTracker',
    'MotionTrackerError',
    'Notice',
    'PlateGeometry',
    'TrackedFrame',
    'TrackerSettings',
    'calibrate',
    'detect_lifts',
    'ground_reaction',
    'load_marker_set',
]

_MODULES = {
    'DetectedEvent': 'tracked',
    'InverseKinematics': 'inverse_kinematics.inverse_kinematics',
    'LiftEvent': 'lifts.lift_events',
    'MarkerSet': 'markers.marker_set',
    'MeasuredLift': 'tracked',
    'MotionTracker': 'tracker',
    'MotionTrackerError': 'exceptions',
    'Notice': 'tracked',
    'PlateGeometry': 'forces.force_plates',
    'TrackedFrame': 'tracked',
    'TrackerSettings': 'tracked',
    'calibrate': 'calibration',
    'detect_lifts': 'lifts.lift_events',
    'ground_reaction': 'forces.force_plates',
    'load_marker_set': 'markers.marker_set',
}


def __getattr__(name: str) -> object:
    """Import a name of `__all__` when it is first used."""
    if name not in _MODULES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    return getattr(import_module(f'{__name__}.core.{_MODULES[name]}'), name)
