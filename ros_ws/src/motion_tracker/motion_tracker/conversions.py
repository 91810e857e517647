# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the tracker's outputs."""

from __future__ import annotations

import numpy as np

from human_model.report import SolveStatus
from human_model.subject import Subject
from lifting_messages.conversions import (
    LABORATORY,
    MotionQuality,
    lift_to_msg,
    motion_to_msg,
    point,
    vector,
)
from lifting_messages.message_types import Message, make, message_type
from lifting_messages.stamps import header
from motion_tracker.core.lifts.lift_events import LiftPhase
from motion_tracker.core.tracked import FROM_BOX, DetectedEvent, TrackedFrame
from motion_tracker.core.tracked import MeasuredLift as TrackedLift

_EVENT = message_type('LiftEvent')


def joint_state_to_msg(frame: TrackedFrame) -> Message:
    """Return names, positions and velocities of all coordinates."""
    motion = frame.motion
    return make(
        'sensor_msgs/JointState',
        header=header(float(motion.time[0]), LABORATORY),
        name=list(motion.coordinates),
        position=motion.position,
        velocity=motion.velocity,
    )


def body_motion_to_msg(frame: TrackedFrame) -> Message:
    """Return the live block of one sample."""
    quality = MotionQuality(
        frame.filter_delay,
        np.array([int(frame.status)], dtype=np.int64),
        np.array([frame.solution.rms]),
        np.array([frame.solution.maximum]),
    )
    return motion_to_msg(frame.motion, quality)


def cop_to_msg(frame: TrackedFrame, side: int | None = None) -> Message | None:
    """Return the centre of pressure of the right (0), left (1) or both feet (None).

    None while unloaded.
    """
    at = (
        frame.total_centre_of_pressure
        if side is None
        else frame.motion.centre_of_pressure[0, side]
    )
    if not np.all(np.isfinite(at)):
        return None
    return make(
        'geometry_msgs/PointStamped',
        header=header(float(frame.motion.time[0]), LABORATORY),
        point=point(at),
    )


def ground_reaction_to_msg(frame: TrackedFrame) -> Message | None:
    """Return the force of the ground on both feet, at their common centre of pressure.

    None without plates; the moment about that point is that of the body motion's feet.
    """
    if frame.status == SolveStatus.TRACKER_NO_GROUND_FORCE:
        return None
    return make(
        'geometry_msgs/WrenchStamped',
        header=header(float(frame.motion.time[0]), LABORATORY),
        wrench=make('geometry_msgs/Wrench', force=vector(frame.total_force)),
    )


def event_to_msg(detected: DetectedEvent) -> Message:
    """Return the message of a lift's start or end."""
    event = detected.event
    return make(
        'LiftEvent',
        header=header(event.time, LABORATORY),
        lift_id=detected.lift_id,
        event=_EVENT.START if event.phase is LiftPhase.START else _EVENT.END,
        detected_from=(
            _EVENT.FROM_BOX if detected.detected_from == FROM_BOX else _EVENT.FROM_HANDS
        ),
        height=event.height,
        detection_delay=event.detection_delay,
    )


def measured_lift_to_msg(measured: TrackedLift, subject: Subject) -> Message:
    """Return the message of a whole lift; its filters have no delay."""
    quality = MotionQuality(0.0, measured.status, measured.marker_rms, measured.marker_max)
    return lift_to_msg(measured.lift, quality, subject)
