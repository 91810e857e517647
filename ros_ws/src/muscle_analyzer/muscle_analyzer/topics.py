# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of the muscle analyzer."""

from __future__ import annotations

from typing import Final

from lifting_messages.topics import SUBJECT, TASK, Quality, Topic

INPUTS: Final[tuple[Topic, ...]] = (
    SUBJECT,
    TASK,
    Topic('body_motion', 'lifting_interfaces/BodyMotion', Quality.FRAMES),
    Topic('measured_lift', 'lifting_interfaces/MeasuredLift', Quality.RESULTS),
    Topic('predicted_lift', 'lifting_interfaces/PredictedLift', Quality.RESULTS),
)
#: Loads of live samples and of whole lifts, in the order of their urgency.
OUTPUTS: Final[tuple[Topic, ...]] = (
    Topic('spine_load', 'lifting_interfaces/SpineLoad', Quality.FRAMES),
    Topic('joint_torques', 'lifting_interfaces/JointTorques', Quality.FRAMES),
    Topic('muscle_analysis', 'lifting_interfaces/MuscleAnalysis', Quality.FRAMES),
    Topic('joint_reactions', 'lifting_interfaces/JointReactions', Quality.FRAMES),
    Topic('l5_s1/reaction', 'geometry_msgs/WrenchStamped', Quality.FRAMES),
)
