# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the tracker's inputs and outputs; the only file that knows both."""

from __future__ import annotations

import math
import struct

import numpy as np
from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped
from lifting_interfaces.msg import BodyMotion, LiftEvent, Markers, MeasuredLift, Task
from sensor_msgs.msg import JointState

from human_model.report import SolveStatus
from human_model.subject import Subject
from human_model.typing import Array
from lifting_node.conversions import LABORATORY, MotionQuality, flat, lift_to_msg, motion_to_msg
from lifting_node.stamps import to_seconds, to_stamp
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


def markers_from_msg(message: Markers) -> tuple[float, list[str], Array]:
    """Return stamp [s], names and positions (n, 3) [m] of a marker frame."""
    names = [marker.marker_name for marker in message.markers]
    positions = np.array(
        [
            (marker.translation.x, marker.translation.y, marker.translation.z)
            for marker in message.markers
        ],
        dtype=np.float64,
    ).reshape(-1, 3)
    return to_seconds(message.header.stamp), names, positions


def wrench_from_msg(message: WrenchStamped) -> tuple[float, Array, Array]:
    """Return stamp [s], force [N] and moment about the laboratory's origin [N m] (3,)."""
    force, moment = message.wrench.force, message.wrench.torque
    return (
        to_seconds(message.header.stamp),
        np.array([force.x, force.y, force.z]),
        np.array([moment.x, moment.y, moment.z]),
    )


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


def box_from_msg(message: PoseStamped) -> tuple[float, Array]:
    """Return stamp [s] and centre of the box (3,) [m]."""
    at = message.pose.position
    return to_seconds(message.header.stamp), np.array([at.x, at.y, at.z])


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


def task_from_msg(message: Task) -> tuple[float, Array]:
    """Return mass [kg] and size (3,) [m] of the box.

    Raises
    ------
    TrackerError
        If the mass is negative or not finite.
    """
    if not (math.isfinite(message.box_mass) and message.box_mass >= 0):
        raise TrackerError(f'task.box_mass: {message.box_mass} kg is no mass')
    return float(message.box_mass), np.asarray(message.box_size, dtype=np.float64)


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
