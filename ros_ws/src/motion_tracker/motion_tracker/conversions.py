# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the tracker's inputs and outputs; the only file that knows both."""

from __future__ import annotations

import struct

import numpy as np
from geometry_msgs.msg import PointStamped, WrenchStamped
from lifting_interfaces.msg import BodyMotion, LiftEvent, MeasuredLift
from sensor_msgs.msg import JointState

from human_model.report import SolveStatus
from human_model.subject import Subject
from lifting_node.conversions import LABORATORY, MotionQuality, flat, lift_to_msg, motion_to_msg
from lifting_node.stamps import to_stamp
from motion_tracker.core.exceptions import TrackerError
from motion_tracker.core.lift_events import LiftPhase
from motion_tracker.core.tracked import FROM_BOX, DetectedEvent, TrackedFrame
from motion_tracker.core.tracked import MeasuredLift as TrackedLift

# Common data representation: head of a message, stamp with the length of the frame's name.
_CDR_HEAD = 4
_LITTLE_ENDIAN = 1
_STAMP = struct.Struct('<iII')
_DOUBLE = 8
_WRENCH = struct.Struct('<6d')
_POSE = struct.Struct('<7d')


def wrench_from_cdr(data: bytes) -> tuple[float, tuple[float, ...], tuple[float, ...]]:
    """Return the same of a serialised message as plain numbers, without building the message.

    Two plates send thousands of samples a second; the message objects would cost more than the
    whole tracker.

    Raises
    ------
    TrackerError
        If the data are no little-endian WrenchStamped.
    """
    stamp, values = _stamped_from_cdr('wrench', data, _WRENCH)
    return stamp, values[:3], values[3:]


def box_from_cdr(data: bytes) -> tuple[float, tuple[float, ...]]:
    """Return the same of a serialised PoseStamped as plain numbers; raises TrackerError."""
    stamp, values = _stamped_from_cdr('box', data, _POSE)
    return stamp, values[:3]


def _stamped_from_cdr(
    name: str, data: bytes, numbers: struct.Struct
) -> tuple[float, tuple[float, ...]]:
    """Return the stamp [s] of a serialised message and the numbers behind its header."""
    if len(data) < _CDR_HEAD + _STAMP.size or data[1] != _LITTLE_ENDIAN:
        raise TrackerError(f'{name}: {len(data)} bytes are no little-endian message')
    seconds, nanoseconds, length = _STAMP.unpack_from(data, _CDR_HEAD)
    begin = _STAMP.size + length
    begin += _CDR_HEAD + (-begin) % _DOUBLE
    if len(data) < begin + numbers.size:
        raise TrackerError(f'{name}: cut off after {len(data)} bytes')
    return seconds + nanoseconds / 1e9, numbers.unpack_from(data, begin)


def joint_state_to_msg(frame: TrackedFrame) -> JointState:
    """Return names, positions and velocities of all coordinates."""
    motion = frame.motion
    message = JointState(
        name=list(motion.coordinates),
        position=flat(motion.position),
        velocity=flat(motion.velocity),
    )
    message.header.stamp = to_stamp(float(motion.time[0]))
    message.header.frame_id = LABORATORY
    return message


def body_motion_to_msg(frame: TrackedFrame) -> BodyMotion:
    """Return the live block of one sample."""
    quality = MotionQuality(
        frame.filter_delay,
        np.array([int(frame.status)], dtype=np.int64),
        np.array([frame.solution.rms]),
        np.array([frame.solution.maximum]),
    )
    return motion_to_msg(frame.motion, quality)


def cop_to_msg(frame: TrackedFrame, side: int | None = None) -> PointStamped | None:
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
    message = PointStamped()
    message.header.stamp = to_stamp(float(frame.motion.time[0]))
    message.header.frame_id = LABORATORY
    message.point.x, message.point.y, message.point.z = (float(value) for value in at)
    return message


def ground_reaction_to_msg(frame: TrackedFrame) -> WrenchStamped | None:
    """Return the force of the ground on both feet, at their common centre of pressure.

    None without plates; the moment about that point is that of the body motion's feet.
    """
    if frame.status == SolveStatus.TRACKER_NO_GROUND_FORCE:
        return None
    message = WrenchStamped()
    message.header.stamp = to_stamp(float(frame.motion.time[0]))
    message.header.frame_id = LABORATORY
    force = message.wrench.force
    force.x, force.y, force.z = (float(value) for value in frame.total_force)
    return message


def event_to_msg(detected: DetectedEvent) -> LiftEvent:
    """Return the message of a lift's start or end."""
    event = detected.event
    message = LiftEvent(
        lift_id=detected.lift_id,
        event=LiftEvent.START if event.phase is LiftPhase.START else LiftEvent.END,
        detected_from=(
            LiftEvent.FROM_BOX if detected.detected_from == FROM_BOX else LiftEvent.FROM_HANDS
        ),
        height=event.height,
        detection_delay=event.detection_delay,
    )
    message.header.stamp = to_stamp(event.time)
    message.header.frame_id = LABORATORY
    return message


def measured_lift_to_msg(measured: TrackedLift, subject: Subject) -> MeasuredLift:
    """Return the message of a whole lift; its filters have no delay."""
    quality = MotionQuality(0.0, measured.status, measured.marker_rms, measured.marker_max)
    return lift_to_msg(measured.lift, quality, subject)
