# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The measured lifts of a recording: the motion tracker alone, without graph or predictions."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from human_model.exceptions import LiftingError
from human_model.subject import Subject
from lifting_cli.graph_errors import SessionError
from lifting_cli.recording_summary import summarise
from lifting_messages.conversions import subject_from_msg
from lifting_recordings.reader import BagReader
from motion_tracker.core.tracked import MeasuredLift, Output
from motion_tracker.station import TrackerStation


@dataclass(frozen=True)
class RecordedLifts:
    """Lifts that the tracker finds in a recording.

    Attributes
    ----------
    start : float
        Stamp at which the recording starts [s].
    subject : Subject
    lifts : tuple of MeasuredLift
        In the order in which they ended.
    """

    start: float
    subject: Subject
    lifts: tuple[MeasuredLift, ...]

    def lift(self, number: int) -> MeasuredLift:
        """Return a lift, counted from 1; raise SessionError if there is no such."""
        if not 1 <= number <= len(self.lifts):
            raise SessionError(f'lift {number} is not there: the recording has {len(self.lifts)}')
        return self.lifts[number - 1]


def recorded_lifts(bag: Path) -> RecordedLifts:
    """Track a recording.

    Raises
    ------
    BagError
        If the recording cannot be read.
    SessionError
        If subject or task are missing, or the tracker refuses what it holds.
    """
    summary = summarise(bag)
    station = TrackerStation()
    outputs: list[Output] = []
    with BagReader(bag) as reader:
        entered = {n.strip('/'): m for n, _, m in reader.messages(['/subject', '/task'])}
        if missing := {'subject', 'task'} - entered.keys():
            raise SessionError(f'{bag}: nothing in topic {sorted(missing)[0]!r}')
        names = [name for name in reader.topics if name.strip('/') in summary.inputs]
        try:
            for topic, message in entered.items():
                outputs += station.track(topic, message)
            for topic, _, message in reader.messages(names):
                outputs += station.track(topic.strip('/'), message)
            outputs += station.end()
            subject = subject_from_msg(entered['subject'])
        except LiftingError as error:
            raise SessionError(f'{bag}: {error}') from error
    found = tuple(output for output in outputs if isinstance(output, MeasuredLift))
    return RecordedLifts(summary.start, subject, found)
