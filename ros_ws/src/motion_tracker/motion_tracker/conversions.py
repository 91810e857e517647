# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of recordings to the tracker's input, and its outputs to messages."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped
from lifting_interfaces.msg import BodyMotion as BodyMotionMsg
from lifting_interfaces.msg import LiftEvent as LiftEventMsg
from lifting_interfaces.msg import Markers
from lifting_interfaces.msg import MeasuredLift as MeasuredLiftMsg
from lifting_interfaces.msg import Task as TaskMsg
from sensor_msgs.msg import JointState

from human_model.subject import Subject
from lifting_node.conversions import (
    LABORATORY,
    MotionQuality,
    flat,
    lift_to_msg,
    motion_to_msg,
    subject_from_msg,
)
from lifting_node.stamps import to_seconds, to_stamp
from motion_tracker.core.errors import TrackerError
from motion_tracker.core.lift_events import LiftEventSettings
from motion_tracker.core.marker_set import load_marker_set
from motion_tracker.core.tracked import (
    FROM_BOX,
    DetectedEvent,
    MeasuredLift,
    TrackedFrame,
    TrackerSettings,
)
from motion_tracker.core.tracker import MotionTracker

Array = npt.NDArray[np.float64]

_CDR_LITTLE_ENDIAN = 1
_CDR_HEADER = 4
_STAMP_AND_LENGTH = struct.Struct('<iII')
_WRENCH = struct.Struct('<6d')


def tracker_for(subject_message: Any, task: TaskMsg, values: Mapping[str, Any]) -> MotionTracker:
    """Return the tracker of one recording.

    Parameters
    ----------
    subject_message : lifting_interfaces.msg.Subject
    task : lifting_interfaces.msg.Task
    values : mapping
        Parameters of the node.

    Raises
    ------
    MotionTrackerError, human_model.errors.HumanModelError
        If person, marker set or task cannot be used.
    """
    subject: Subject = subject_from_msg(subject_message)
    calibrated = subject.calibration is not None and subject.calibration.marker_names
    name = subject_message.marker_set or ('' if calibrated else values['marker_set'])
    settings = TrackerSettings(
        motion_cutoff=values['motion_cutoff'],
        plate_cutoff=values['plate_cutoff'],
        force_threshold=values['force_threshold'],
        wait=values['wait'],
        longest_gap=values['longest_gap'],
        mass_tolerance=values['mass_tolerance'],
        events=LiftEventSettings(
            minimum_rise=values['minimum_rise'], rest_speed=values['rest_speed']
        ),
    )
    return MotionTracker(
        subject,
        load_marker_set(name) if name else None,
        task.box_mass,
        np.asarray(task.box_size, np.float64),
        settings=settings,
    )


def markers_from_msg(message: Markers) -> tuple[float, list[str], Array]:
    """Return stamp [s], names and positions (n, 3) [m] of a camera frame."""
    places = [marker.translation for marker in message.markers]
    positions = np.array([(place.x, place.y, place.z) for place in places], np.float64)
    names = [marker.marker_name for marker in message.markers]
    return to_seconds(message.header.stamp), names, positions.reshape(-1, 3)


def wrench_from_cdr(data: bytes) -> tuple[float, tuple[float, ...], tuple[float, ...]]:
    """Return stamp [s], force [N] and moment [N m] of a serialised WrenchStamped.

    A plate sends thousands a second; reading the 48 bytes that count is ten times faster than
    building the message.

    Raises
    ------
    TrackerError
        If the data are not a little-endian WrenchStamped.
    """
    if len(data) < _CDR_HEADER + _STAMP_AND_LENGTH.size or data[1] != _CDR_LITTLE_ENDIAN:
        raise TrackerError(f'wrench: {len(data)} bytes are no little-endian WrenchStamped')
    seconds, nanoseconds, length = _STAMP_AND_LENGTH.unpack_from(data, _CDR_HEADER)
    begin = _STAMP_AND_LENGTH.size + length
    begin = _CDR_HEADER + begin + (-begin) % 8
    if len(data) < begin + _WRENCH.size:
        raise TrackerError(f'wrench: cut off after {len(data)} bytes')
    values = _WRENCH.unpack_from(data, begin)
    return seconds + nanoseconds / 1e9, values[:3], values[3:]


def wrench_from_msg(message: WrenchStamped) -> tuple[float, tuple[float, ...], tuple[float, ...]]:
    """Return stamp [s], force [N] and moment [N m]."""
    force, moment = message.wrench.force, message.wrench.torque
    return (
        to_seconds(message.header.stamp),
        (force.x, force.y, force.z),
        (moment.x, moment.y, moment.z),
    )


def box_from_msg(message: PoseStamped) -> tuple[float, tuple[float, float, float]]:
    """Return stamp [s] and position of the box's centre [m]."""
    place = message.pose.position
    return to_seconds(message.header.stamp), (place.x, place.y, place.z)


def frame_to_msg(frame: TrackedFrame) -> BodyMotionMsg:
    """Return the live block of one frame."""
    quality = MotionQuality(
        frame.filter_delay,
        np.array([int(frame.status)]),
        np.array([frame.solution.rms]),
        np.array([frame.solution.maximum]),
    )
    return motion_to_msg(frame.motion, quality)


def frame_to_joint_state(frame: TrackedFrame) -> JointState:
    """Return the joint coordinates of one frame."""
    motion = frame.motion
    message = JointState(
        name=list(motion.coordinates),
        position=flat(motion.position[0]),
        velocity=flat(motion.velocity[0]),
    )
    message.header.stamp = to_stamp(float(motion.time[0]))
    message.header.frame_id = LABORATORY
    return message


def point_to_msg(time: float, point: npt.ArrayLike) -> PointStamped | None:
    """Return a centre of pressure, None where there is none."""
    place = np.asarray(point, np.float64)
    if not np.all(np.isfinite(place)):
        return None
    message = PointStamped()
    message.header.stamp = to_stamp(time)
    message.header.frame_id = LABORATORY
    message.point.x, message.point.y, message.point.z = (float(value) for value in place)
    return message


def total_to_msg(frame: TrackedFrame) -> WrenchStamped:
    """Return the ground reaction of both feet as a force; its point is the total COP."""
    message = WrenchStamped()
    message.header.stamp = to_stamp(float(frame.motion.time[0]))
    message.header.frame_id = LABORATORY
    force = message.wrench.force
    force.x, force.y, force.z = (float(value) for value in frame.total_force)
    return message


def event_to_msg(detected: DetectedEvent) -> LiftEventMsg:
    """Return the message of the start or end of a lift."""
    event = detected.event
    message = LiftEventMsg(
        lift_id=detected.lift_id,
        event=int(event.phase),
        detected_from=(
            LiftEventMsg.FROM_BOX
            if detected.detected_from == FROM_BOX
            else LiftEventMsg.FROM_HANDS
        ),
        height=float(event.height),
        detection_delay=float(event.detection_delay),
    )
    message.header.stamp = to_stamp(event.time)
    message.header.frame_id = LABORATORY
    return message


def measured_to_msg(measured: MeasuredLift, subject: Subject) -> MeasuredLiftMsg:
    """Return the message of a whole lift."""
    quality = MotionQuality(0.0, measured.status, measured.marker_rms, measured.marker_max)
    return lift_to_msg(measured.lift, quality, subject)
