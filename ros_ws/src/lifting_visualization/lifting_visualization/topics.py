# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of the visualization."""

from __future__ import annotations

from typing import Final

from lifting_messages.topics import SUBJECT, TASK, Quality, Topic

INPUTS: Final[tuple[Topic, ...]] = (
    SUBJECT,
    TASK,
    Topic('body_motion', 'lifting_interfaces/BodyMotion', Quality.FRAMES),
    Topic('box/pose', 'geometry_msgs/PoseStamped', Quality.FRAMES),
    Topic('spine_load', 'lifting_interfaces/SpineLoad', Quality.FRAMES),
    Topic('measured_lift', 'lifting_interfaces/MeasuredLift', Quality.RESULTS),
    Topic('predicted_lift', 'lifting_interfaces/PredictedLift', Quality.RESULTS),
)
OUTPUTS: Final[tuple[Topic, ...]] = (
    Topic('visualization', 'visualization_msgs/MarkerArray', Quality.VIEW),
    Topic('robot_description', 'std_msgs/String', Quality.LATCHED),
    Topic('/tf', 'tf2_msgs/TFMessage', Quality.TRANSFORMS),
    Topic('/tf_static', 'tf2_msgs/TFMessage', Quality.LATCHED),
)
