# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of the whole graph, as the packages declare them; imports nothing that loads long."""

from __future__ import annotations

from itertools import chain
from typing import Final

import injury_monitor.topics
import lift_predictor.topics
import lifting_visualization.topics
import motion_tracker.topics
import muscle_analyzer.topics
from lifting_messages.topics import SUBJECT, TASK, Topic

#: Person, task and everything that the packages of the computation publish, by name.
TOPICS: Final[dict[str, Topic]] = {
    topic.name: topic
    for topic in chain(
        (SUBJECT, TASK),
        motion_tracker.topics.OUTPUTS,
        lift_predictor.topics.OUTPUTS,
        muscle_analyzer.topics.OUTPUTS,
        injury_monitor.topics.OUTPUTS,
    )
}
#: Topics of the results file.
RESULT_TOPICS: Final = tuple(name for name, topic in TOPICS.items() if topic.recorded)
#: Topics for RViz and Foxglove, recorded on request.
VISUALIZATION_TOPICS: Final = tuple(topic.name for topic in lifting_visualization.topics.OUTPUTS)
