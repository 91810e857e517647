# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings as they are on disk: person, task and streams of samples."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from human_model.constants import SIDES
from human_model.subject import Calibration, Subject
from human_model.typing import Array
from injury_monitor.core.lifting_equation import Coupling
from injury_monitor.core.work import Work
from lift_predictor.core.problem.task import Box
from lifting.exceptions import IncompleteRecordingError
from lifting_messages import Message
from lifting_recordings.reader import BagReader

_PLATES = [f'force_plates/{side}/{kind}' for side in SIDES for kind in ('wrench', 'wrench_block')]
_STREAMS = ('markers', 'box/pose', *_PLATES)
_SEX = {1: 'male', 2: 'female'}


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


def _seconds(stamp: Message) -> float:
    """Return the stamp of a message in seconds."""
    return float(stamp.sec) + float(stamp.nanosec) / 1e9


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
    places = [np.array([at.x, at.y, at.z]) for at in (task.box_start, task.box_end)]
    start, end = (None if np.isnan(place).all() else place for place in places)
    box = Box(task.box_mass, float(task.box_size[0]) if task.box_mass > 0 else 0.0, start, end)
    work = Work(
        f'{task.task_id}@{_seconds(task.header.stamp):.3f}',
        subject.pseudonym,
        subject.mass,
        task.box_mass,
        task.lifts_per_day,
        task.lifts_per_minute,
        task.duration_hours,
        Coupling(task.coupling),
        task.control_at_destination,
    )
    size = np.asarray(task.box_size, np.float64)
    return Recording(path, _subject(subject), subject.marker_set, box, size, work)


def _subject(message: Message) -> Subject:
    lengths = dict(
        zip(message.segment_length_names, message.segment_lengths.tolist(), strict=True)
    )
    calibration = None
    if message.marker_names:
        calibration = Calibration(
            tuple(message.marker_names),
            tuple(message.marker_segments),
            np.asarray(message.marker_offsets).reshape(-1, 3),
            lengths,
            float(np.nan_to_num(message.calibration_rms)),
        )
    return Subject(
        message.pseudonym,
        _SEX.get(message.sex, f'code {message.sex}'),
        message.mass,
        message.stature,
        message.age,
        message.strength_z,
        lengths,
        calibration,
    )
