# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recording to lifts: the motion tracker over a whole recording."""

from __future__ import annotations

from dataclasses import dataclass, replace

from human_model.subject import Subject
from lifting.lift import Lift
from lifting.recording import Recording
from motion_tracker import inputs
from motion_tracker.core.markers.marker_set import load_marker_set
from motion_tracker.core.tracked import MeasuredLift, Notice, Output, TrackerSettings
from motion_tracker.core.tracker import MotionTracker


@dataclass(frozen=True, eq=False)
class Tracking:
    """Result of the motion tracker for a recording.

    Attributes
    ----------
    subject : Subject
        With the segment lengths of the tracker.
    lifts : tuple of Lift
        In the order in which they ended.
    notices : tuple of str
        Warnings about streams and samples.
    """

    subject: Subject
    lifts: tuple[Lift, ...]
    notices: tuple[str, ...]


def track(recording: Recording, settings: TrackerSettings | None = None) -> Tracking:
    """Track a recording.

    Raises
    ------
    MotionTrackerError
        If marker set, masses or samples are refused.
    """
    name, box = recording.marker_set, recording.box
    tracker = MotionTracker(
        recording.subject,
        load_marker_set(name) if name else None,
        box.mass,
        recording.box_size,
        settings=settings,
    )
    outputs: list[Output] = []
    for topic, message in recording.samples():
        outputs += inputs.push(tracker, topic, message)
    outputs += tracker.flush()
    lifts = tuple(
        Lift.of(
            found.lift,
            tracker.subject,
            replace(box, mass=found.lift.box_mass),
            recording.work,
            found.status,
        )
        for found in outputs
        if isinstance(found, MeasuredLift)
    )
    notices = (found for found in outputs if isinstance(found, Notice) and not found.information)
    return Tracking(tracker.subject, lifts, tuple(notice.text for notice in notices))
