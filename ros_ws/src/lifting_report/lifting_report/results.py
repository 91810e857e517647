# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a results file to the data of the report page."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from human_model import __version__
from human_model.exceptions import HumanModelError
from human_model.report import SolveStatus
from injury_monitor.core.alarm import AlarmState
from lift_predictor.core.exceptions import LiftPredictorError
from lift_predictor.core.models.sagittal.person import Person
from lifting_messages import message_type
from lifting_messages.conversions import subject_from_msg
from lifting_recordings.exceptions import BagError
from lifting_report import results_curves as curves
from lifting_report.assessed import lifting_from_assessment, risk_from_assessment
from lifting_report.page import build_report
from lifting_report.recorded_emg import emg_of_lift, has_emg, recorded_emg
from lifting_report.report_data import (
    AlarmRow,
    Header,
    Lifting,
    LiftReport,
    Missing,
    Pair,
    QualityRow,
    ReportData,
    Risk,
    SolveRow,
)
from lifting_report.results_file import (
    MEASURED,
    PREDICTED,
    LiftMessages,
    Results,
    read_results,
    seconds,
)
from muscle_analyzer.core.emg.envelopes import EmgRecording

#: Stages whose solve reports are shown: name, topic, source.
_STAGES = (
    ('motion tracker', 'measured_lift', None),
    ('lift predictor', 'predicted_lift', None),
    ('comparison', 'lift_comparison', None),
    ('muscle analyzer, recorded lift', 'muscle_analysis', MEASURED),
    ('muscle analyzer, optimal lift', 'muscle_analysis', PREDICTED),
)


@dataclass(frozen=True)
class RunFacts:
    """What the results file does not say of the run that made it.

    Attributes
    ----------
    run : str
        How it was computed.
    recording : str
        Name of the recording.
    start : float
        Stamp of the start of the recording [s]; NaN: the first live sample.
    bag : Path or None
        The recording itself, for what the graph does not read: its EMG.
    """

    run: str = 'not stated'
    recording: str = 'not stated'
    start: float = math.nan
    bag: Path | None = None


def write_report(results: Path, page: Path, facts: RunFacts | None = None) -> Path:
    """Write the report page of a results file; return its path."""
    return build_report(report_data(read_results(results), facts or RunFacts()), page)


def report_data(results: Results, facts: RunFacts) -> ReportData:
    """Return the data of the report page."""
    if not math.isnan(facts.start):
        results = replace(results, start=facts.start)
    remarks = [f'The results file is incomplete: {results.lost}.'] if results.lost else []
    person: Person | Missing
    try:
        person = Person.of(subject_from_msg(results.subject))
    except (HumanModelError, LiftPredictorError) as error:
        person = Missing(f'the subject of the results file is refused: {error}')
    emg = _emg(facts.bag, results.start)
    lifts = tuple(
        _with_emg(_lift(lift_id, entry, results, person), emg)
        for lift_id, entry in results.lifts.items()
        if 'measured_lift' in entry.single
    )
    remarks += [
        f'{lift_id}: the start of a lift was seen, but no complete lift followed.'
        for lift_id, entry in results.lifts.items()
        if 'measured_lift' not in entry.single
    ]
    return ReportData(
        header=_header(results, facts),
        lifts=lifts or Missing('no lift was found in this recording'),
        alarms=tuple(_alarm(message, results) for message in results.alarms),
        recording_quality=_recording_quality(results),
        remarks=tuple(remarks),
    )


def _emg(bag: Path | None, start: float) -> EmgRecording | Missing | None:
    """Return the EMG of a recording on its clock; None where there is none."""
    if bag is None or not has_emg(bag):
        return None
    try:
        return recorded_emg(bag, start)
    except BagError as error:
        return Missing(str(error))


def _with_emg(lift: LiftReport, emg: EmgRecording | Missing | None) -> LiftReport:
    if emg is None or isinstance(emg, Missing):
        return replace(lift, emg=emg)
    found = emg_of_lift(emg, lift.lift_id, lift.activations.measured, lift.start)
    return replace(lift, emg=found)


def _header(results: Results, facts: RunFacts) -> Header:
    subject, task = results.subject, results.task
    return Header(
        subject=subject.pseudonym,
        sex='male' if subject.sex == message_type('Subject').SEX_MALE else 'female',
        mass=subject.mass,
        stature=subject.stature,
        age=subject.age,
        task=task.task_id,
        description=task.description,
        recording=facts.recording,
        source=task.source,
        simulated=bool(task.simulated),
        box_mass=task.box_mass,
        lifts_per_day=task.lifts_per_day,
        lifts_per_minute=task.lifts_per_minute,
        duration_hours=task.duration_hours,
        run=facts.run,
        created=datetime.now(UTC).strftime('%Y-%m-%d %H:%M UTC'),
        version=__version__,
    )


def _lift(
    lift_id: str, entry: LiftMessages, results: Results, person: Person | Missing
) -> LiftReport:
    measured = entry.single['measured_lift']
    start = seconds(measured.header.stamp)
    box_size = results.task.box_size
    motions = _motions(entry)
    return LiftReport(
        lift_id=lift_id,
        start=start - results.start,
        duration=measured.duration,
        angles=_pair(motions, lambda lift: curves.joint_angles(lift, person)),
        comparison=_comparison(entry),
        ground=_pair(motions, curves.ground_forces),
        torques=_torques(entry),
        activations=_blocks(entry, 'muscle_analysis', curves.activations),
        spine=_blocks(entry, 'spine_load', curves.spine_curves),
        joints=_blocks(entry, 'joint_reactions', curves.joint_loads),
        points=_pair(motions, lambda lift: curves.body_points(lift, box_size)),
        risk=_risk(entry),
        lifting=_lifting(entry, results),
        solves=_solves(entry),
        quality=_quality(entry),
    )


def _motions(entry: LiftMessages) -> Pair[Any]:
    predicted = entry.single.get('predicted_lift')
    return Pair(
        measured=entry.single['measured_lift'],
        predicted=_prediction_missing(predicted) or predicted,
    )


def _prediction_missing(predicted: Any) -> Missing | None:
    if predicted is None:
        return Missing('no prediction came')
    if predicted.report.status != 0:
        return Missing(f'the prediction failed: {predicted.report.message}')
    return None


def _pair(motions: Pair[Any], convert: Any) -> Pair[Any]:
    return Pair(
        *(
            part if isinstance(part, Missing) else convert(part)
            for part in (motions.measured, motions.predicted)
        )
    )


def _blocks(entry: LiftMessages, topic: str, convert: Any) -> Pair[Any]:
    parts = []
    for source in (MEASURED, PREDICTED):
        message = entry.blocks.get((topic, source))
        if message is not None:
            parts.append(convert(message, seconds(entry.single['measured_lift'].header.stamp)))
            continue
        missing = _prediction_missing(entry.single.get('predicted_lift'))
        parts.append(
            missing if source == PREDICTED and missing else Missing(f'no {topic} came for it')
        )
    return Pair(*parts)


def _torques(entry: LiftMessages) -> Pair[Any]:
    """Return the torques of both lifts by the same sagittal model."""
    comparison = entry.single.get('lift_comparison')
    predicted: Any = entry.single.get('predicted_lift')
    missing = _prediction_missing(predicted)
    measured = (
        Missing('no comparison with a predicted lift came')
        if comparison is None or not comparison.torque_names
        else curves.torques(comparison, comparison.time_from_start)
    )
    return Pair(measured, missing or curves.torques(predicted, predicted.motion.time_from_start))


def _comparison(entry: LiftMessages) -> Any:
    message = entry.single.get('lift_comparison')
    if message is None or message.report.status != 0:
        missing = _prediction_missing(entry.single.get('predicted_lift'))
        return missing or Missing('no comparison came')
    return curves.comparison(message)


def _risk(entry: LiftMessages) -> Risk | Missing:
    message = entry.single.get('risk_assessment')
    return Missing('no assessment came') if message is None else risk_from_assessment(message)


def _lifting(entry: LiftMessages, results: Results) -> Lifting | Missing:
    message = entry.single.get('risk_assessment')
    if message is None:
        return Missing('no assessment came')
    return lifting_from_assessment(
        message, results.subject, results.task, entry.single['measured_lift']
    )


def _solves(entry: LiftMessages) -> tuple[SolveRow, ...] | Missing:
    rows = []
    for stage, topic, source in _STAGES:
        message = entry.blocks.get((topic, source)) if source else entry.single.get(topic)
        if message is None:
            continue
        report = message.report
        rows.append(
            SolveRow(
                stage, report.status, SolveStatus(report.status).name, report.message,
                report.iterations, report.primal_residual, report.dual_residual,
                report.solve_time,
            )
        )  # fmt: skip
    return tuple(rows) or Missing('no solve report came')


def _quality(entry: LiftMessages) -> tuple[QualityRow, ...]:
    measured = entry.single['measured_lift'].motion
    rows = [
        QualityRow(
            'marker distance, rms', 1e3 * curves.root_mean_square(measured.marker_rms),
            math.nan, 'mm', 'markers from the tracked skeleton',
        ),
        QualityRow(
            'marker distance, largest', 1e3 * curves.largest(measured.marker_max), math.nan, 'mm',
            'markers from the tracked skeleton',
        ),
    ]  # fmt: skip

    def both(topic: str, field: str, scale: float, reduce: Any) -> tuple[float, float]:
        measured, predicted = (
            math.nan if message is None else scale * reduce(getattr(message, field))
            for message in (entry.blocks.get((topic, s)) for s in (MEASURED, PREDICTED))
        )
        return measured, predicted

    rows += [
        QualityRow(
            'transfer, hands and feet',
            *both('muscle_analysis', 'transfer_position_error', 1e3, curves.largest),
            'mm',
            'largest distance between the two skeletons',
        ),
        QualityRow(
            'transfer, trunk and feet',
            *both('muscle_analysis', 'transfer_angle_error', 180.0 / math.pi, curves.largest),
            'deg',
            'largest angle between the two skeletons',
        ),
        QualityRow(
            'L5-S1 moment, from above against from below',
            *both('spine_load', 'moment_difference', 1.0, curves.root_mean_square),
            'N m',
            'rms over the lift; no reference is needed for it',
        ),
        QualityRow(
            'balance of the static optimisation',
            *both('muscle_analysis', 'primal_residual', 1.0, curves.largest),
            'N m',
            'largest residual over the lift',
        ),
        QualityRow(
            'largest reserve torque',
            *both('muscle_analysis', 'reserve', 1.0, curves.largest_size),
            'N m',
            'what no muscle could give',
        ),
    ]
    return tuple(rows)


def _alarm(message: Any, results: Results) -> AlarmRow:
    stamp = seconds(message.header.stamp)
    return AlarmRow(
        stamp=stamp - results.start,
        alarm=message.alarm_id,
        previous_state=AlarmState(message.previous_state).name,
        state=AlarmState(message.state).name,
        value=message.value,
        limit=message.limit,
        margin=message.margin,
        unit=message.unit,
        limit_source=message.limit_source,
        lift_id=message.lift_id or _lift_at(stamp, results),
        historical=bool(message.historical),
    )


def _lift_at(stamp: float, results: Results) -> str:
    """Return the lift during which something happened: live, its start is known too late."""
    for lift_id, entry in results.lifts.items():
        measured = entry.single.get('measured_lift')
        if measured is None:
            continue
        since = stamp - seconds(measured.header.stamp)
        if 0.0 <= since <= measured.duration:
            return lift_id
    return ''


def _recording_quality(results: Results) -> tuple[QualityRow, ...] | Missing:
    if not results.live_samples:
        return Missing('no live sample of the spine load came')
    share = 100.0 * results.live_unsolved / results.live_samples
    return (
        QualityRow(
            'live samples not solved', share, math.nan, '%',
            f'{results.live_unsolved} of {results.live_samples}; they raise and clear no alarm',
        ),
    )  # fmt: skip
