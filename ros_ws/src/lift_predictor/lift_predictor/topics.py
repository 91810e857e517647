# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of the lift predictor."""

from __future__ import annotations

from typing import Final

from lifting_messages.topics import SUBJECT, TASK, Quality, Topic

INPUTS: Final[tuple[Topic, ...]] = (
    SUBJECT,
    TASK,
    Topic('measured_lift', 'lifting_interfaces/MeasuredLift', Quality.RESULTS),
)
OUTPUTS: Final[tuple[Topic, ...]] = (
    Topic('predicted_lift', 'lifting_interfaces/PredictedLift', Quality.RESULTS),
    Topic('predicted_lift/joint_trajectory', 'trajectory_msgs/JointTrajectory', Quality.RESULTS),
    Topic('lift_comparison', 'lifting_interfaces/LiftComparison', Quality.RESULTS),
)
