# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the predictor's results, and of the task it reads."""

from __future__ import annotations

import math

import numpy as np

from human_model.motion import Lift
from human_model.subject import Subject
from human_model.task import Box
from lift_predictor.core.problem.comparison import LiftComparison
from lift_predictor.core.problem.prediction import Prediction
from lifting_messages.conversions import (
    LABORATORY,
    MotionQuality,
    lift_from_msg,
    motion_to_msg,
    report_to_msg,
    subject_from_msg,
)
from lifting_messages.message_types import Message, make
from lifting_messages.stamps import header

__all__ = [
    'box_from_msg',
    'comparison_to_msg',
    'lift_from_msg',
    'prediction_to_msg',
    'subject_from_msg',
    'trajectory_to_msg',
]


def box_from_msg(task: Message, mass: float) -> Box:
    """Return what was lifted: the task's box with a given mass [kg].

    Raises
    ------
    BoxError
        If mass or size is negative, or a value is not finite.
    """
    start, end = (
        None if all(map(math.isnan, place)) else place
        for place in ((point.x, point.y, point.z) for point in (task.box_start, task.box_end))
    )
    depth, width, height = task.box_size if mass > 0.0 else (0.0, 0.0, 0.0)
    return Box(mass, (depth, width, height), start, end)


def prediction_to_msg(prediction: Prediction, lift: Lift | None, subject: Subject) -> Message:
    """Return the message of a prediction; without a solution its arrays are empty.

    `lift` is the recorded one that gives the stamp; None: planned, the stamps begin at 0.
    """
    verified = {} if prediction.verification is None else prediction.verification.violation
    message = make(
        'PredictedLift',
        header=header(0.0 if lift is None else lift.start, LABORATORY),
        verified_names=list(verified),
        verified_violation=list(verified.values()),
        lift_id=prediction.lift_id,
        subject=subject.pseudonym,
        body_mass=subject.mass,
        box_mass=prediction.box_mass,
        maximum_weight=False,
        duration=prediction.duration,
        torque_names=list(prediction.torque_names),
        torque=prediction.torque,
        torque_lower=prediction.torque_lower,
        torque_upper=prediction.torque_upper,
        zero_moment_point=prediction.zmp,
        support_rear=float(prediction.support[0]),
        support_front=float(prediction.support[1]),
        report=report_to_msg(prediction.report),
    )
    if prediction.lift is not None:
        motion = prediction.lift.motion
        message.motion = motion_to_msg(motion, MotionQuality.exact(len(motion)))
    return message


def trajectory_to_msg(prediction: Prediction) -> Message:
    """Return the joint trajectory of a solved prediction, all coordinates of its skeleton.

    Efforts are the joint torques [N m]; the free pelvis has none.
    """
    assert prediction.lift is not None
    motion = prediction.lift.motion
    effort = np.zeros((len(motion), len(motion.coordinates)))
    for column, name in enumerate(prediction.torque_names):
        effort[:, motion.coordinates.index(name)] = prediction.torque[:, column]
    points = []
    for row, time in enumerate(motion.time - motion.time[0]):
        fraction, whole = math.modf(time)
        passed = make(
            'builtin_interfaces/Duration', sec=int(whole), nanosec=round(fraction * 1e6) * 1000
        )
        points.append(
            make(
                'trajectory_msgs/JointTrajectoryPoint',
                positions=motion.position[row],
                velocities=motion.velocity[row],
                accelerations=motion.acceleration[row],
                effort=effort[row],
                time_from_start=passed,
            )
        )
    return make(
        'trajectory_msgs/JointTrajectory',
        header=header(prediction.lift.start, LABORATORY),
        joint_names=list(motion.coordinates),
        points=points,
    )


def comparison_to_msg(comparison: LiftComparison, prediction: Prediction, lift: Lift) -> Message:
    """Return the message of a comparison."""
    loads = comparison.measured
    return make(
        'LiftComparison',
        header=header(lift.start, LABORATORY),
        lift_id=prediction.lift_id,
        joint_names=list(comparison.joint_names),
        joint_rmse=comparison.joint_rmse,
        joint_pearson=comparison.joint_pearson,
        vertical_force_rmse=comparison.vertical_force_rmse,
        vertical_force_pearson=comparison.vertical_force_pearson,
        horizontal_force_rmse=comparison.horizontal_force_rmse,
        horizontal_force_pearson=comparison.horizontal_force_pearson,
        measured_effort=comparison.measured_effort,
        predicted_effort=comparison.predicted_effort,
        torque_names=list(comparison.torque_names),
        time_from_start=comparison.time,
        torque=loads.torque,
        torque_lower=loads.lower,
        torque_upper=loads.upper,
        report=report_to_msg(prediction.report),
    )
