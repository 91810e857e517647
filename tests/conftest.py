# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What several tests across packages use: recordings, the tracker alone, runs of the graph."""

import os
import zlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[1]
BAGS = ROOT / 'bags'
SQUATS = ROOT.parent / 'shared' / 'data' / 'squats_bodyweight'

# Graphs of tests that run at the same time must not hear each other; 0 is everyone's default
# and above 101 the ports reach those the kernel gives away.
os.environ['ROS_DOMAIN_ID'] = str(1 + zlib.crc32(str(os.getpid()).encode()) % 100)


@dataclass(frozen=True, eq=False)
class Tracked:
    """All that the motion tracker said of a recording, with what it was asked to do.

    Attributes
    ----------
    subject, task : messages
    start : float
        Stamp at which the recording starts [s].
    frames, events, lifts, notices : list
        `TrackedFrame`, `DetectedEvent`, `MeasuredLift` and `Notice` in order.
    calibrated : Subject
        The subject as the tracker scaled it.
    filter_delay : float
        Of the live frames [s].
    """

    subject: object
    task: object
    start: float
    frames: list
    events: list
    lifts: list
    notices: list
    calibrated: object
    filter_delay: float

    def live(self, name):
        """Return one field of the live motion, stacked (n, ...)."""
        return np.concatenate([getattr(frame.motion, name) for frame in self.frames])


@cache
def track(bag: Path) -> Tracked:
    """Drive the motion tracker alone, as the graph does, through a recording."""
    from lifting_cli.recording_summary import summarise
    from lifting_messages.conversions import subject_from_msg
    from lifting_messages.parameters import defaults
    from lifting_recordings.reader import BagReader
    from motion_tracker import inputs
    from motion_tracker.core import tracked
    from motion_tracker.core.configuration import tracker_from

    summary = summarise(bag)
    outputs = []
    with BagReader(bag) as reader:
        latched = {n.strip('/'): m for n, _, m in reader.messages(['/subject', '/task'])}
        subject, task = latched['subject'], latched['task']
        tracker = tracker_from(
            defaults('motion_tracker'),
            subject_from_msg(subject),
            subject.marker_set,
            *inputs.task_from_msg(task),
        )
        names = [name for name in reader.topics if name.strip('/') in summary.inputs]
        for topic, _, message in reader.messages(names):
            outputs += inputs.push(tracker, topic.strip('/'), message)
        outputs += tracker.flush()

    def of(kind):
        return [output for output in outputs if isinstance(output, kind)]

    return Tracked(
        subject,
        task,
        summary.start,
        of(tracked.TrackedFrame),
        of(tracked.DetectedEvent),
        of(tracked.MeasuredLift),
        of(tracked.Notice),
        tracker.subject,
        tracker.filter_delay,
    )


@pytest.fixture(scope='session')
def bags():
    """Return the folder of the simulated recordings."""
    return BAGS


@pytest.fixture(scope='session')
def tracked():
    """Return a function that drives the motion tracker through a recording, once each."""
    return track


@pytest.fixture(scope='session')
def offline(tmp_path_factory):
    """Return a function that runs a recording through all pipelines, once each: its results."""
    from lifting_cli.offline import run_offline

    @cache
    def run(bag: Path) -> Path:
        return run_offline(bag, tmp_path_factory.mktemp(f'{bag.name}_offline'))

    return run


@pytest.fixture(scope='session')
def squats_files():
    """Return the folder of the real squats."""
    if not SQUATS.is_dir():
        pytest.skip(f'the real recording is not beside the repository ({SQUATS})')
    return SQUATS
