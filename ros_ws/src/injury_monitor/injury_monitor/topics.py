# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of the injury monitor."""

from __future__ import annotations

from typing import Final

from lifting_messages.topics import SUBJECT, TASK, Quality, Topic

INPUTS: Final[tuple[Topic, ...]] = (
    SUBJECT,
    TASK,
    Topic('spine_load', 'lifting_interfaces/SpineLoad', Quality.FRAMES),
    Topic('joint_torques', 'lifting_interfaces/JointTorques', Quality.FRAMES),
    Topic('muscle_analysis', 'lifting_interfaces/MuscleAnalysis', Quality.FRAMES),
    Topic('measured_lift', 'lifting_interfaces/MeasuredLift', Quality.RESULTS),
    Topic('predicted_lift', 'lifting_interfaces/PredictedLift', Quality.RESULTS),
)
OUTPUTS: Final[tuple[Topic, ...]] = (
    Topic('alarms', 'lifting_interfaces/AlarmEvent', Quality.RESULTS),
    Topic('alarm_states', 'lifting_interfaces/AlarmStates', Quality.LATCHED, recorded=False),
    Topic('risk_assessment', 'lifting_interfaces/RiskAssessment', Quality.RESULTS),
)
