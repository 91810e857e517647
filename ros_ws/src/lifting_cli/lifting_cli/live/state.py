# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What happens while a recording runs, in words and numbers; no terminal, no process."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Final

import numpy as np

from lifting_messages import Message, message_type
from lifting_messages.stamps import to_seconds

#: Topics of the live view.
FOLLOWED: Final = (
    'subject',
    'task',
    'lift_event',
    'predicted_lift',
    'lift_comparison',
    'spine_load',
    'alarms',
    'risk_assessment',
)

_SUBJECT = message_type('Subject')
_LIFT_EVENT = message_type('LiftEvent')
_SPINE_LOAD = message_type('SpineLoad')
_ALARM_EVENT = message_type('AlarmEvent')
_RISK_ASSESSMENT = message_type('RiskAssessment')


class Kind(Enum):
    """How a line is to be read."""

    PLAIN = 'plain'
    GOOD = 'good'
    WARNING = 'warning'
    ALARM = 'alarm'


@dataclass(frozen=True)
class Line:
    """One thing that happened.

    Attributes
    ----------
    time : float
        Time of the data [s] since the recording began; NaN if it has none.
    text : str
        In words.
    kind : Kind
        How to read it.
    """

    time: float
    text: str
    kind: Kind = Kind.PLAIN


@dataclass
class LiveState:
    """State of the run, updated by one message at a time.

    Attributes
    ----------
    start : float
        Stamp at which the recording begins [s].
    now : float
        Latest time of the data [s] since the start.
    compression, shear : float
        Latest live load on L5-S1 [N]; NaN before the first.
    lines : list of Line
        What happened, in order of arrival.
    lifts_ended, lifts_assessed : set of str
        Lifts whose end was seen, and whose assessment arrived.
    """

    start: float
    now: float = 0.0
    compression: float = float('nan')
    shear: float = float('nan')
    lines: list[Line] = field(default_factory=list)
    lifts_ended: set[str] = field(default_factory=set)
    lifts_assessed: set[str] = field(default_factory=set)

    @property
    def complete(self) -> bool:
        """Whether every lift that ended has been assessed."""
        return self.lifts_ended <= self.lifts_assessed

    def update(self, message: Message) -> list[Line]:
        """Take one message; return the lines it adds."""
        time = to_seconds(message.header.stamp) - self.start
        lines = [
            Line(time if abs(time) < 1e6 else float('nan'), text, kind)
            for text, kind in self._describe(message, time)
        ]
        self.lines += lines
        return lines

    def _describe(self, message: Message, time: float) -> list[tuple[str, Kind]]:
        # Of rclpy's class or of rosbags'.
        match type(message).__name__.rpartition('__')[2]:
            case 'Subject':
                sex = 'male' if message.sex == _SUBJECT.SEX_MALE else 'female'
                return [
                    (
                        f'subject {message.pseudonym}: {sex}, {message.mass:.1f} kg, '
                        f'{message.stature:.2f} m',
                        Kind.PLAIN,
                    )
                ]
            case 'Task':
                origin = 'SIMULATED recording' if message.simulated else 'recording'
                text = f'task {message.task_id}: box of {message.box_mass:g} kg ({origin})'
                return [(text, Kind.PLAIN)]
            case 'LiftEvent':
                return [self._lift_event(message)]
            case 'PredictedLift':
                return [_prediction(message)]
            case 'LiftComparison':
                return _comparison(message)
            case 'SpineLoad':
                return self._spine_load(message, time)
            case 'AlarmEvent':
                return [_alarm(message)]
            case 'RiskAssessment':
                self.lifts_assessed.add(message.lift_id)
                return [_assessment(message)]
        return []

    def _lift_event(self, message: Message) -> tuple[str, Kind]:
        source = 'box' if message.detected_from == _LIFT_EVENT.FROM_BOX else 'hands'
        if message.event == _LIFT_EVENT.END:
            self.lifts_ended.add(message.lift_id)
        verb = 'begins' if message.event == _LIFT_EVENT.START else 'ends'
        return f'{message.lift_id} {verb}, {source} at {message.height:.2f} m', Kind.PLAIN

    def _spine_load(self, message: Message, time: float) -> list[tuple[str, Kind]]:
        if message.source == _SPINE_LOAD.LIVE:
            self.now = max(self.now, time)
            if message.status[-1] == 0:
                self.compression = message.compression[-1]
                self.shear = message.anterior_shear[-1]
            return []
        name = 'measured' if message.source == _SPINE_LOAD.MEASURED else 'predicted'
        good = np.asarray(message.status) == 0
        if not good.any():
            text = f'{message.lift_id} {name}: no sample solved: {message.report.message}'
            return [(text, Kind.WARNING)]
        compression = np.asarray(message.compression)[good].max()
        shear = np.asarray(message.anterior_shear)[good].max()
        text = (
            f'{message.lift_id} {name}: peak L5-S1 compression {compression:.0f} N '
            f'({compression / message.body_mass:.1f} N/kg), anterior shear {shear:.0f} N'
        )
        left_out = int((~good).sum())
        if left_out:
            text += f'; {left_out} of {good.size} samples not solved'
        return [(text, Kind.WARNING if left_out else Kind.PLAIN)]


def _prediction(message: Message) -> tuple[str, Kind]:
    report = message.report
    if report.status != 0:
        return f'{message.lift_id} prediction failed: {report.message}', Kind.WARNING
    return (
        f'{message.lift_id} optimal lift solved in {report.solve_time:.2f} s '
        f'({report.iterations} iterations)',
        Kind.GOOD,
    )


def _comparison(message: Message) -> list[tuple[str, Kind]]:
    if message.report.status != 0:
        return []
    angles = ', '.join(
        f'{name} {value:.0f}'
        for name, value in zip(message.joint_names, message.joint_rmse, strict=True)
    )
    text = (
        f'{message.lift_id} recorded against optimal: effort {message.measured_effort:.3g} '
        f'against {message.predicted_effort:.3g}; RMSE [deg] {angles}'
    )
    return [(text, Kind.PLAIN)]


def _alarm(message: Message) -> tuple[str, Kind]:
    active = message.state in (
        _ALARM_EVENT.UNACKNOWLEDGED_ACTIVE,
        _ALARM_EVENT.ACKNOWLEDGED_ACTIVE,
        _ALARM_EVENT.LATCHED_UNACKNOWLEDGED,
        _ALARM_EVENT.LATCHED_ACKNOWLEDGED,
    )
    unit = '' if message.unit == '1' else f' {message.unit}'
    text = (
        f'{"ALARM" if active else "alarm returned"} {message.alarm_id}: '
        f'{message.value:.4g}{unit}, limit {message.limit:.4g}{unit}, '
        f'margin {message.margin:.4g}{unit}'
    )
    return text, Kind.ALARM if active else Kind.GOOD


def _assessment(message: Message) -> tuple[str, Kind]:
    kind = {
        _RISK_ASSESSMENT.ZONE_NOMINAL: Kind.GOOD,
        _RISK_ASSESSMENT.ZONE_ACTION: Kind.WARNING,
        _RISK_ASSESSMENT.ZONE_HAZARDOUS: Kind.ALARM,
    }.get(message.zone, Kind.WARNING)
    text = f'{message.lift_id} assessed: {message.summary}'
    return text, kind
