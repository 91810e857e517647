# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recording to lifts: the motion tracker over a whole recording."""

from __future__ import annotations

from dataclasses import dataclass, replace

from human_model.subject import Subject
from lifting.lift import Lift
from lifting.recording import Recording
from motion_tracker.core.tracked import MeasuredLift, Notice, Output, TrackerSettings
from motion_tracker.station import TrackerStation


@dataclass(frozen=True, eq=False)
class Tracking:
    """Result of the motion tracker for a recording.

    Attributes
    ----------
    subject : Subject
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
    station, box = TrackerStation(settings=settings), recording.box
    outputs: list[Output] = [
        *station.enter_subject(recording.subject, recording.marker_set),
        *station.enter_task(box.mass, recording.box_size),
    ]
    for topic, message in recording.samples():
        outputs += station.track(topic, message)
    outputs += station.end()
    lifts = tuple(
        Lift.of(
            found.lift,
            recording.subject,
            replace(box, mass=found.lift.box_mass),
            recording.work,
            found.status,
        )
        for found in outputs
        if isinstance(found, MeasuredLift)
    )
    notices = (found for found in outputs if isinstance(found, Notice) and not found.information)
    return Tracking(recording.subject, lifts, tuple(notice.text for notice in notices))
