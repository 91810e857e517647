# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of the motion tracker."""

from __future__ import annotations

from typing import Final

from human_model.constants import SIDES
from lifting_messages.plate_blocks import block_topic
from lifting_messages.topics import SUBJECT, TASK, Quality, Topic

MARKERS: Final = Topic('markers', 'lifting_interfaces/Markers', Quality.FRAMES)
BOX: Final = Topic('box/pose', 'geometry_msgs/PoseStamped', Quality.FRAMES)
#: Single samples of a force plate, and blocks of them; one of both is enough.
PLATES: Final = {
    side: Topic(f'force_plates/{side}/wrench', 'geometry_msgs/WrenchStamped', Quality.PLATES)
    for side in SIDES
}
BLOCKS: Final = {
    side: Topic(block_topic(topic.name), 'lifting_interfaces/WrenchBlock', Quality.PLATES)
    for side, topic in PLATES.items()
}
#: Inputs with samples of a recording.
STREAMS: Final = (MARKERS, BOX, *PLATES.values(), *BLOCKS.values())

INPUTS: Final[tuple[Topic, ...]] = (SUBJECT, TASK, *STREAMS)
OUTPUTS: Final[tuple[Topic, ...]] = (
    Topic('body_motion', 'lifting_interfaces/BodyMotion', Quality.FRAMES, recorded=False),
    Topic('joint_states', 'sensor_msgs/JointState', Quality.FRAMES),
    Topic('lift_event', 'lifting_interfaces/LiftEvent', Quality.RESULTS),
    Topic('measured_lift', 'lifting_interfaces/MeasuredLift', Quality.RESULTS),
    Topic('ground_reaction/wrench', 'geometry_msgs/WrenchStamped', Quality.FRAMES, recorded=False),
    Topic('ground_reaction/cop', 'geometry_msgs/PointStamped', Quality.FRAMES, recorded=False),
    *(
        Topic(
            f'force_plates/{side}/cop',
            'geometry_msgs/PointStamped',
            Quality.FRAMES,
            recorded=False,
        )
        for side in SIDES
    ),
)
