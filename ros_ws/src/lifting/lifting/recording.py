# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings as they are on disk: person, task and streams of samples."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from human_model.subject import Subject
from human_model.task import Box, Work
from human_model.typing import Array
from injury_monitor.conversions import assignment_from_msg
from lift_predictor.conversions import box_from_msg
from lifting.exceptions import IncompleteRecordingError
from lifting_messages import Message
from lifting_messages.conversions import subject_from_msg
from lifting_recordings.reader import BagReader
from motion_tracker.topics import STREAMS

_STREAMS = {topic.name for topic in STREAMS}


@dataclass(frozen=True, eq=False)
class Recording:
    """A recording: person and task are read, the samples stay in the file.

    Attributes
    ----------
    path : Path
    subject : Subject
    marker_set : str
        Name of the marker set.
    box : Box
        Mass [kg] and, if the recording contains them, start and end [m].
    box_size : ndarray, shape (3,)
        Depth, width between the hands, height [m].
    work : Work
        Frequency and duration of the task.
    """

    path: Path
    subject: Subject
    marker_set: str
    box: Box
    box_size: Array
    work: Work

    def samples(self) -> Iterator[tuple[str, Message]]:
        """Yield topic and decoded message of each sample in the order of the recording."""
        with BagReader(self.path) as reader:
            names = {name: name.strip('/') for name in reader.topics}
            wanted = [name for name, topic in names.items() if topic in _STREAMS]
            for name, _, message in reader.messages(wanted):
                yield names[name], message


def load_recording(path: str | Path) -> Recording:
    """Read person and task of a recording.

    Parameters
    ----------
    path : str or Path
        rosbag2 folder or file (MCAP or SQLite).

    Raises
    ------
    RecordingError
        If the recording cannot be read.
    IncompleteRecordingError
        If person or task is missing.
    HumanModelError, InjuryMonitorError, LiftPredictorError
        If a value of them is out of its range.
    """
    path = Path(path)
    with BagReader(path) as reader:
        entered = {
            name.strip('/'): message for name, _, message in reader.messages(['/subject', '/task'])
        }
    for topic in ('subject', 'task'):
        if topic not in entered:
            raise IncompleteRecordingError(path, topic)
    subject, task = entered['subject'], entered['task']
    box = box_from_msg(task, task.box_mass)
    work = assignment_from_msg(subject, task).work
    size = np.asarray(task.box_size, np.float64)
    return Recording(path, subject_from_msg(subject), subject.marker_set, box, size, work)
