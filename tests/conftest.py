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
    """Results of the motion tracker for a recording, with its person and task.

    Attributes
    ----------
    subject, task : messages
    start : float
        Stamp at which the recording starts [s].
    frames, events, lifts, notices : list
        `TrackedFrame`, `DetectedEvent`, `MeasuredLift` and `Notice` in order.
    calibrated : Subject
        The subject, scaled by its calibration.
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
    """Run a recording through the motion tracker alone, as the graph does."""
    from lifting_cli.recording_summary import summarise
    from lifting_recordings.reader import BagReader
    from motion_tracker.core import tracked
    from motion_tracker.station import TrackerStation

    summary = summarise(bag)
    station = TrackerStation()
    outputs = []
    with BagReader(bag) as reader:
        entered = {n.strip('/'): m for n, _, m in reader.messages(['/subject', '/task'])}
        names = [name for name in reader.topics if name.strip('/') in summary.inputs]
        for topic, message in entered.items():
            outputs += station.track(topic, message)
        for topic, _, message in reader.messages(names):
            outputs += station.track(topic.strip('/'), message)
        calibrated = station.tracker.subject
        outputs += station.end()

    def of(kind):
        return [output for output in outputs if isinstance(output, kind)]

    frames = of(tracked.TrackedFrame)
    return Tracked(
        entered['subject'],
        entered['task'],
        summary.start,
        frames,
        of(tracked.DetectedEvent),
        of(tracked.MeasuredLift),
        of(tracked.Notice),
        calibrated,
        frames[0].filter_delay,
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
