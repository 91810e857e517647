# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the core types that all packages share, and back."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from human_model.motion import BodyMotion, Lift
from human_model.report import SolveReport, SolveStatus
from human_model.subject import Calibration, Subject
from human_model.typing import Array
from lifting_messages.exceptions import MessageValueError
from lifting_messages.message_types import Message, make, message_type
from lifting_messages.names import join, split
from lifting_messages.stamps import header, to_seconds

#: Frame of all Cartesian values: x forward, y left, z up, on the floor.
LABORATORY = 'world'

_SUBJECT = message_type('Subject')
_SEX = {'male': _SUBJECT.SEX_MALE, 'female': _SUBJECT.SEX_FEMALE}
_SEX_NAME = {code: name for name, code in _SEX.items()}


@dataclass(frozen=True, eq=False)
class MotionQuality:
    """What the tracker says of each sample of a block, beside the motion itself.

    Attributes
    ----------
    filter_delay : float
        [s].
    status : ndarray of int (n,)
        SolveStatus per sample.
    marker_rms, marker_max : ndarray (n,)
        [m]; NaN where not tracked.
    """

    filter_delay: float
    status: npt.NDArray[np.int64]
    marker_rms: Array
    marker_max: Array

    @classmethod
    def exact(cls, n: int) -> MotionQuality:
        """Return the quality of a block that was computed, not tracked."""
        nothing = np.full(n, np.nan)
        return cls(0.0, np.zeros(n, np.int64), nothing, nothing)


def flat(values: npt.ArrayLike) -> Array:
    """Return values row-major as messages have them, shape (n,)."""
    return np.asarray(values, np.float64).reshape(-1)


def point(values: Array) -> Message:
    """Return a place [m] (3,) as a message."""
    x, y, z = values.tolist()
    return make('geometry_msgs/Point', x=x, y=y, z=z)


def vector(values: Array) -> Message:
    """Return a vector (3,) as a message."""
    x, y, z = values.tolist()
    return make('geometry_msgs/Vector3', x=x, y=y, z=z)


def report_to_msg(report: SolveReport) -> Message:
    """Return the message of a solve report."""
    return make(
        'SolveReport',
        status=int(report.status),
        message=report.message,
        iterations=int(report.iterations),
        objective=float(report.objective),
        primal_residual=float(report.primal_residual),
        dual_residual=float(report.dual_residual),
        build_time=float(report.build_time),
        solve_time=float(report.solve_time),
    )


def report_from_msg(message: Message) -> SolveReport:
    """Return the solve report of a message.

    Raises
    ------
    MessageValueError
        If the status is unknown.
    """
    try:
        status = SolveStatus(message.status)
    except ValueError as error:
        raise MessageValueError(
            'SolveReport.status', message.status, 'is none of its constants'
        ) from error
    return SolveReport(
        status,
        message.message,
        message.iterations,
        message.objective,
        message.primal_residual,
        message.dual_residual,
        message.build_time,
        message.solve_time,
    )


def subject_from_msg(message: Message) -> Subject:
    """Return the subject of a message.

    Raises
    ------
    human_model.exceptions.SubjectError
        If a value is out of range or arrays do not belong together.
    MessageValueError
        If there is not one length for each name of a segment.
    """
    names, lengths = message.segment_length_names, message.segment_lengths
    if len(names) != len(lengths):
        raise MessageValueError(
            'Subject.segment_lengths', len(lengths), f'{len(names)} segment_length_names'
        )
    measured = dict(zip(names, lengths, strict=True))
    calibration = None
    if message.marker_names:
        offsets = np.asarray(message.marker_offsets, np.float64)
        names = tuple(message.marker_names)
        shape = (len(names), 3) if offsets.size == 3 * len(names) else offsets.shape
        calibration = Calibration(
            names,
            tuple(message.marker_segments),
            offsets.reshape(shape),
            measured,
            0.0 if np.isnan(message.calibration_rms) else message.calibration_rms,
        )
    return Subject(
        pseudonym=message.pseudonym,
        sex=_SEX_NAME.get(message.sex, f'code {message.sex}'),
        mass=message.mass,
        stature=message.stature,
        age=message.age,
        strength_z=message.strength_z,
        lengths=measured,
        calibration=calibration,
    )


def subject_to_msg(subject: Subject, stamp: float, marker_set: str, source: str) -> Message:
    """Return the message of a subject, its calibration included."""
    calibration = subject.calibration
    lengths = {**(calibration.lengths if calibration else {}), **subject.lengths}
    message = make(
        'Subject',
        pseudonym=subject.pseudonym,
        sex=_SEX[subject.sex],
        mass=subject.mass,
        stature=subject.stature,
        age=subject.age,
        strength_z=subject.strength_z,
        segment_length_names=list(lengths),
        segment_lengths=flat(list(lengths.values())),
        marker_set=marker_set,
        calibration_rms=float('nan'),
        source=source,
    )
    message.header = header(stamp)
    if calibration is not None:
        message.marker_names = list(calibration.marker_names)
        message.marker_segments = list(calibration.segments)
        message.marker_offsets = flat(calibration.local_offsets)
        message.calibration_rms = calibration.residual_rms
    return message


def motion_to_msg(motion: BodyMotion, quality: MotionQuality) -> Message:
    """Return the message of a block of body motion."""
    return make(
        'BodyMotion',
        header=header(float(motion.time[0]), LABORATORY),
        skeleton=motion.skeleton,
        time_from_start=flat(motion.time - motion.time[0]),
        coordinate_names=join(motion.coordinates),
        position=flat(motion.position),
        velocity=flat(motion.velocity),
        acceleration=flat(motion.acceleration),
        point_names=join(motion.point_names),
        points=flat(motion.points),
        frame_names=join(motion.frame_names),
        frames=flat(motion.frames),
        ground_force=flat(motion.ground_force),
        centre_of_pressure=flat(motion.centre_of_pressure),
        free_moment=flat(motion.free_moment),
        hand_force=flat(motion.hand_force),
        box_position=flat(motion.box_position),
        filter_delay=float(quality.filter_delay),
        status=np.asarray(quality.status, np.uint16),
        marker_rms=flat(quality.marker_rms),
        marker_max=flat(quality.marker_max),
    )


def motion_from_msg(message: Message) -> BodyMotion:
    """Return the block of body motion of a message.

    Raises
    ------
    human_model.exceptions.MotionError
        If arrays do not have the sizes that the names and the time call for, or are not finite.
    """
    time = to_seconds(message.header.stamp) + np.asarray(message.time_from_start)
    n = time.size

    def shaped(values: npt.ArrayLike, *tail: int) -> Array:
        data = np.asarray(values, np.float64)
        shape = (n, *tail)
        return data.reshape(shape) if data.size == math.prod(shape) else data

    coordinates = split(message.coordinate_names)
    points = split(message.point_names)
    frames = split(message.frame_names)
    return BodyMotion(
        time=time,
        skeleton=message.skeleton,
        coordinates=coordinates,
        position=shaped(message.position, len(coordinates)),
        velocity=shaped(message.velocity, len(coordinates)),
        acceleration=shaped(message.acceleration, len(coordinates)),
        point_names=points,
        points=shaped(message.points, len(points), 3),
        frame_names=frames,
        frames=shaped(message.frames, len(frames), 4),
        ground_force=shaped(message.ground_force, 2, 3),
        centre_of_pressure=shaped(message.centre_of_pressure, 2, 3),
        free_moment=shaped(message.free_moment, 2, 3),
        hand_force=shaped(message.hand_force, 2, 3),
        box_position=shaped(message.box_position, 3),
    )


def quality_from_msg(message: Message) -> MotionQuality:
    """Return what the tracker said of each sample of a block."""
    return MotionQuality(
        message.filter_delay,
        np.asarray(message.status, np.int64),
        np.asarray(message.marker_rms, np.float64),
        np.asarray(message.marker_max, np.float64),
    )


def lift_to_msg(lift: Lift, quality: MotionQuality, subject: Subject) -> Message:
    """Return the message of a measured lift."""
    return make(
        'MeasuredLift',
        header=header(lift.start, LABORATORY),
        lift_id=lift.lift_id,
        subject=subject.pseudonym,
        body_mass=subject.mass,
        box_mass=lift.box_mass,
        duration=lift.end - lift.start,
        motion=motion_to_msg(lift.motion, quality),
        report=report_to_msg(lift.report),
    )


def lift_from_msg(message: Message) -> Lift:
    """Return the measured lift of a message."""
    start = to_seconds(message.header.stamp)
    return Lift(
        lift_id=message.lift_id,
        source='measured',
        start=start,
        end=start + message.duration,
        box_mass=message.box_mass,
        motion=motion_from_msg(message.motion),
        report=report_from_msg(message.report),
    )
