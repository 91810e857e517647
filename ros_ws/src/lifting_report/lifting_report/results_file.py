# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A results file read back: what the graph said, sorted by lift."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lifting_messages import message_type
from lifting_recordings.exceptions import BagError
from lifting_recordings.reader import BagReader

MEASURED, PREDICTED = 'measured', 'predicted'
_SPINE_LOAD, _LIFT_EVENT = message_type('SpineLoad'), message_type('LiftEvent')
_SOURCE = {_SPINE_LOAD.MEASURED: MEASURED, _SPINE_LOAD.PREDICTED: PREDICTED}
#: Blocks that come once for the recorded and once for the predicted lift.
_BLOCKS = ('muscle_analysis', 'spine_load', 'joint_reactions', 'joint_torques')
_SINGLE = ('measured_lift', 'predicted_lift', 'lift_comparison', 'risk_assessment')


class ResultsError(BagError):
    """A results file lacks what a report needs; names file and topic."""


@dataclass
class LiftMessages:
    """Messages about one lift.

    Attributes
    ----------
    single : dict
        By topic: measured_lift, predicted_lift, lift_comparison, risk_assessment.
    blocks : dict
        By (topic, source): muscle_analysis, spine_load, joint_reactions, joint_torques.
    """

    single: dict[str, Any] = field(default_factory=dict)
    blocks: dict[tuple[str, str], Any] = field(default_factory=dict)


@dataclass
class Results:
    """Everything in a results file that a report shows.

    Attributes
    ----------
    path : Path
    start : float
        Stamp [s] of the first live sample.
    subject, task : message
    lifts : dict of str to LiftMessages
        In the order in which they began.
    alarms : list of message
    live_samples, live_unsolved : int
        Live samples of the spine load, and those of them that did not solve.
    lost : str
        What of the file could not be read; empty if it is whole.
    """

    path: Path
    start: float
    subject: Any
    task: Any
    lifts: dict[str, LiftMessages]
    alarms: list[Any]
    live_samples: int
    live_unsolved: int
    lost: str


def seconds(stamp: Any) -> float:
    """Return a stamp of a decoded message [s]."""
    return float(stamp.sec + stamp.nanosec * 1e-9)


def read_results(path: Path) -> Results:
    """Read a results file.

    Raises
    ------
    ResultsError
        It holds no subject or no task.
    lifting_recordings.exceptions.BagError
        It cannot be read.
    """
    latest: dict[str, Any] = {}
    lifts: dict[str, LiftMessages] = {}
    alarms: list[Any] = []
    samples = unsolved = 0
    start = float('inf')
    with BagReader(path) as bag:
        wanted = {
            name: _short(name)
            for name in bag.topics
            if _short(name) in {*_BLOCKS, *_SINGLE, 'subject', 'task', 'lift_event', 'alarms'}
        }
        for name, _, message in bag.messages(list(wanted)):
            topic = wanted[name]
            if topic in ('subject', 'task'):
                latest[topic] = message
            elif topic == 'alarms':
                alarms.append(message)
            elif topic == 'lift_event':
                if message.event == _LIFT_EVENT.START:
                    lifts.setdefault(message.lift_id, LiftMessages())
            elif topic in _SINGLE:
                lifts.setdefault(message.lift_id, LiftMessages()).single[topic] = message
            elif message.source in _SOURCE:
                entry = lifts.setdefault(message.lift_id, LiftMessages())
                entry.blocks[topic, _SOURCE[message.source]] = message
            elif topic == 'spine_load':
                samples += len(message.status)
                unsolved += int((message.status != 0).sum())
                start = min(start, seconds(message.header.stamp))
        lost = '' if bag.loss is None else str(bag.loss)
    for topic in ('subject', 'task'):
        if topic not in latest:
            raise ResultsError(f'{path}: no message on topic {topic}')
    return Results(
        path, start, latest['subject'], latest['task'], lifts, alarms, samples, unsolved, lost
    )


def _short(topic: str) -> str:
    """Return a topic without the station's namespace."""
    return topic.rsplit('/', 1)[-1]
