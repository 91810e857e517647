# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Curves of the report from decoded messages of a results file."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from human_model.exceptions import HumanModelError
from human_model.motion import BodyMotion
from human_model.typing import Array
from lift_predictor.core.exceptions import LiftPredictorError
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.sagittal.plane import SagittalPlane, sagittal_motion
from lifting_messages.conversions import motion_from_msg
from lifting_messages.names import split
from lifting_report.report_data import (
    Activations,
    BodyPoints,
    Comparison,
    GroundForces,
    JointAngles,
    JointLoads,
    Missing,
    SpineCurves,
    Torques,
)

#: Spine flexion is shown positive; the sagittal model's first coordinate is extension.
_SIGNS = np.array([-1.0, 1.0, 1.0, 1.0, 1.0, 1.0])


def window(lift: Any) -> tuple[Array, BodyMotion]:
    """Return the time since the start [s] and the motion between start and end of a lift."""
    motion = motion_from_msg(lift.motion)
    start = lift.header.stamp.sec + lift.header.stamp.nanosec * 1e-9
    time = motion.time - start
    inside = np.flatnonzero((time >= -1e-6) & (time <= lift.duration + 1e-6))
    chosen = slice(int(inside[0]), int(inside[-1]) + 1)
    return time[chosen], motion[chosen]


def joint_angles(lift: Any, person: Person | Missing) -> JointAngles | Missing:
    """Return the six sagittal angles of a lift, both lifts by the same projection."""
    if isinstance(person, Missing):
        return person
    time, motion = window(lift)
    try:
        side = sagittal_motion(
            motion, float(motion.time[0]), person.neutral, SagittalPlane.of(motion)
        )
    except (LiftPredictorError, HumanModelError) as error:
        return Missing(f'no sagittal angles: {error}')
    return JointAngles(
        time,
        _SIGNS * (side.q + 0.5 * side.side_difference),
        _SIGNS * (side.q - 0.5 * side.side_difference),
    )


def ground_forces(lift: Any) -> GroundForces:
    """Return the ground reactions of a lift."""
    time, motion = window(lift)
    return GroundForces(time, motion.ground_force)


def body_points(lift: Any, box_size: npt.ArrayLike) -> BodyPoints:
    """Return the points for the stick figures."""
    time, motion = window(lift)
    return BodyPoints(
        time, motion.point_names, motion.points, motion.box_position,
        np.asarray(box_size, np.float64),
    )  # fmt: skip


def torques(message: Any, time: npt.ArrayLike) -> Torques:
    """Return the torques and limits of a prediction or a comparison."""
    names = tuple(message.torque_names)
    clock = np.asarray(time, np.float64)
    shape = (clock.size, len(names))
    return Torques(
        clock,
        names,
        np.reshape(message.torque, shape),
        np.reshape(message.torque_lower, shape),
        np.reshape(message.torque_upper, shape),
    )


def block_time(message: Any, start: float) -> Array:
    """Return the time of each sample of a block since the start of its lift [s]."""
    stamp = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
    return np.asarray(stamp - start + message.time_from_start, np.float64)


def activations(message: Any, start: float) -> Activations:
    """Return the muscle activations of a block of a lift that starts at `start` [s]."""
    time = block_time(message, start)
    muscles = split(message.muscle_names)
    return Activations(
        time,
        muscles,
        np.reshape(message.activation, (time.size, len(muscles))),
        np.asarray(message.status) == 0,
    )


def spine_curves(message: Any, start: float) -> SpineCurves:
    """Return the L5-S1 load of a block of a lift that starts at `start` [s]."""
    return SpineCurves(
        block_time(message, start),
        np.asarray(message.compression, np.float64),
        np.asarray(message.anterior_shear, np.float64),
        np.asarray(message.lateral_shear, np.float64),
        np.asarray(message.status) == 0,
        np.asarray(message.compression_per_degree, np.float64),
        np.asarray(message.anterior_shear_per_degree, np.float64),
        message.disc_frame,
    )


def joint_loads(message: Any, start: float) -> JointLoads:
    """Return the loads of all joints of a block; only peaks are shown, so `start` is not used."""
    del start
    names = split(message.joint_names)
    force = np.asarray(message.force, np.float64).reshape(-1, len(names), 3)
    everywhere = np.asarray(message.status) == 0
    lumbar = np.asarray(message.lumbar_status) == 0
    limbs = [name.startswith(('hip', 'knee')) for name in names]
    return JointLoads(
        names,
        force[:, :, 2],
        np.hypot(force[:, :, 0], force[:, :, 1]),
        np.where(limbs, everywhere[:, None], lumbar[:, None]),
    )


def comparison(message: Any) -> Comparison:
    """Return the errors and correlations of a comparison."""
    return Comparison(
        tuple(message.joint_names),
        np.asarray(message.joint_rmse, np.float64),
        np.asarray(message.joint_pearson, np.float64),
        message.vertical_force_rmse,
        message.vertical_force_pearson,
        message.horizontal_force_rmse,
        message.horizontal_force_pearson,
    )


def largest(values: npt.ArrayLike) -> float:
    """Return the largest value, NaN if there is none."""
    finite = _finite(values)
    return float(finite.max()) if finite.size else float('nan')


def largest_size(values: npt.ArrayLike) -> float:
    """Return the largest absolute value, NaN if there is none."""
    return largest(np.abs(np.asarray(values, np.float64)))


def root_mean_square(values: npt.ArrayLike) -> float:
    """Return the root mean square, NaN if there is no value."""
    finite = _finite(values)
    return float(np.sqrt(np.mean(finite**2))) if finite.size else float('nan')


def _finite(values: npt.ArrayLike) -> Array:
    array = np.asarray(values, np.float64)
    return array[np.isfinite(array)]
