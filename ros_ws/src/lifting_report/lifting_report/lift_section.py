# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The part of the report about one lift: peaks beside limits, figures."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from human_model.constants import GRAVITY
from injury_monitor.core.assessment import Criterion
from lifting_report.emg_page import emg_drawing
from lifting_report.figures import curves, joint_peaks, loads, stick_figures
from lifting_report.figures.loads import LimitLine
from lifting_report.pages import LIFT_NAMES, Card, Drawing, amount, criterion_name, drawing
from lifting_report.report_data import (
    Header,
    LiftReport,
    Missing,
    Pair,
    ReportData,
    Risk,
    T,
)

LEVELS = {'nominal': 'good', 'action': 'action', 'hazardous': 'hazard', 'unknown': ''}
ZONES = {
    'nominal': 'below the NIOSH action limit',
    'action': 'above the NIOSH action limit',
    'hazardous': 'above the NIOSH maximum permissible limit',
    'unknown': 'not assessed',
}


@dataclass(frozen=True)
class ShownLift:
    """A lift as the page shows it.

    Attributes
    ----------
    lift : LiftReport
    zone, level : str
        Zone of NIOSH 1981 in words, and its colour.
    overview : list of str
        Cells of its row in the table of all lifts.
    cards : tuple of Card
        Peaks beside their limits; empty without assessment.
    drawings : tuple of Drawing
    emg_drawing : Drawing or None
    """

    lift: LiftReport
    zone: str
    level: str
    overview: list[str]
    cards: tuple[Card, ...]
    drawings: tuple[Drawing, ...]
    emg_drawing: Drawing | None


def shown_lift(lift: LiftReport, data: ReportData, name: str) -> ShownLift:
    """Return a lift as the page shows it; ``name`` makes the ids of its figures unique."""
    risk = lift.risk
    zone = 'unknown' if isinstance(risk, Missing) else risk.zone
    emg = None if lift.emg is None or isinstance(lift.emg, Missing) else lift.emg
    return ShownLift(
        lift,
        ZONES[zone],
        LEVELS[zone],
        _overview(lift, data, ZONES[zone]),
        () if isinstance(risk, Missing) else _cards(risk),
        _drawings(lift, data.header, name),
        None if emg is None else emg_drawing(emg.matches, f'{name}-emg'),
    )


def _overview(lift: LiftReport, data: ReportData, zone: str) -> list[str]:
    row = [lift.lift_id, amount(lift.start, 's', 2), amount(lift.duration, 's', 2)]
    if isinstance(lift.risk, Missing):
        row += ['–'] * 5
    else:
        risk = lift.risk
        peaks = [
            '–' if found is None else amount(found.value, 'N')
            for name in ('compression_action', 'shear_')
            for found in (risk.find(name, source) for source in LIFT_NAMES)
        ]
        row += [*peaks[:2], amount(risk.avoidable_compression, 'N'), *peaks[2:]]
    lifting = lift.lifting
    row.append('–' if isinstance(lifting, Missing) else amount(lifting.lifting_index, digits=2))
    if isinstance(data.alarms, Missing):
        return [*row, zone, '–']
    active = (a for a in data.alarms if a.state == 'UNACKNOWLEDGED_ACTIVE')
    return [*row, zone, str(sum(alarm.lift_id == lift.lift_id for alarm in active))]


def _cards(risk: Risk) -> tuple[Card, ...]:
    """Return the cards: compression, shear, torque index, activation index."""
    compression, shear = risk.avoidable_compression, risk.avoidable_shear
    return (
        _force_card('Peak L5-S1 compression', risk, 'compression_action', compression),
        _force_card('Peak L5-S1 anterior shear', risk, 'shear_', shear),
        _index_card('Joint torque index', risk, 'torque_index'),
        _index_card('Activation index', risk, 'activation_index'),
    )


def _judged(margin: float) -> tuple[str, str]:
    return ('action', 'at or above the limit') if margin <= 0.0 else ('good', 'below the limit')


def _force_card(what: str, risk: Risk, name: str, avoidable: float) -> Card:
    measured, predicted = risk.find(name, 'measured'), risk.find(name, 'predicted')
    if measured is None or math.isnan(measured.value):
        return Card(what, '–', 'not available: no solved sample of the recorded lift', '')
    level, verdict = _judged(measured.margin)
    if name == 'compression_action':
        level, verdict = LEVELS[risk.zone], ZONES[risk.zone]
    rows = (
        (criterion_name(measured), amount(measured.limit, measured.unit)),
        ('margin', amount(measured.margin, measured.unit)),
        ('reached', f'{amount(measured.time, "s", 2)} after the start'),
        *_optimal_rows(predicted, avoidable),
    )
    per_kilogram = amount(measured.per_kilogram, 'N/kg', 1)
    value = amount(measured.value, measured.unit)
    return Card(what, value, verdict, level, rows, per_kilogram, 'avoidable')


def _optimal_rows(predicted: Criterion | None, avoidable: float) -> list[tuple[str, str]]:
    if predicted is None or math.isnan(predicted.value):
        return [('optimal lift', 'not available')]
    per_kilogram = amount(predicted.per_kilogram, 'N/kg', 1)
    rows = [('optimal lift', f'{amount(predicted.value, predicted.unit)} ({per_kilogram})')]
    if avoidable > 0.0:
        rows.append(('avoidable', amount(avoidable, predicted.unit)))
    elif not math.isnan(avoidable):
        rows.append(('optimal lift is higher by', amount(-avoidable, predicted.unit)))
    return rows


def _index_card(what: str, risk: Risk, name: str) -> Card:
    measured, predicted = risk.find(name, 'measured'), risk.find(name, 'predicted')
    shown = measured if measured is not None and not math.isnan(measured.value) else predicted
    if shown is None or math.isnan(shown.value):
        return Card(what, '–', 'not available', '')
    level, verdict = _judged(shown.margin)
    if shown is predicted:
        verdict += ' (optimal lift; none for the recorded one)'
    rows = [
        ('where', shown.detail or '–'),
        ('limit', amount(shown.limit, digits=2)),
        ('margin', amount(shown.margin, digits=2)),
    ]
    if shown is measured and predicted is not None and not math.isnan(predicted.value):
        where = f' ({predicted.detail})' if predicted.detail else ''
        rows.append(('optimal lift', amount(predicted.value, digits=2) + where))
    return Card(what, amount(shown.value, digits=2), verdict, level, tuple(rows))


def _drawings(lift: LiftReport, header: Header, name: str) -> tuple[Drawing, ...]:
    weight = header.mass * GRAVITY
    compression, shear = _limits(lift)
    return (
        _drawn(
            'Both lifts, step by step',
            lift.points,
            lambda: stick_figures.stick_sequence(lift.points, f'{name}-stick'),
            'View from the right; right limbs dark, left limbs light. Same scale, same course '
            'of the lift.',
        ),
        _drawn(
            'L5-S1 compression and shear',
            lift.spine,
            lambda: loads.spine_load(lift.spine, compression, shear, f'{name}-spine'),
            'Force of S1 on L5 in the frame of the disc. ' + _disc_frame(lift),
        ),
        _drawn(
            'Lumbar levels, hips and knees',
            lift.joints,
            lambda: joint_peaks.joint_peaks(lift.joints, f'{name}-joints'),
            'Largest force of the lower segment on the upper one, muscles included: along the '
            'axis of the disc, femur or tibia, and across it. Samples in which muscles are too '
            'weak are left out.',
        ),
        _drawn(
            'Joint angles',
            lift.angles,
            lambda: curves.joint_angles(lift.angles, f'{name}-angles'),
            'Mean of right and left; the band spans both sides. ' + _agreement(lift),
        ),
        _drawn(
            'Ground reaction',
            lift.ground,
            lambda: curves.ground_forces(lift.ground, f'{name}-ground', weight),
            _ground_agreement(lift),
        ),
        _drawn(
            'Joint torques and dynamic strength',
            lift.torques,
            lambda: curves.joint_torques(lift.torques, f'{name}-torques'),
            'Both lifts by the same planar model; paired joints count both limbs. Dotted: '
            'dynamic strength at the angle and speed of that moment; none where no strength is '
            'published.',
        ),
        _drawn(
            'Torque index',
            lift.torques,
            lambda: curves.torque_indices(lift.torques, f'{name}-index'),
            'Torque over dynamic strength in its direction (eq. 4.12 of the dissertation).',
        ),
        _drawn(
            'Muscle activations',
            lift.activations,
            lambda: loads.muscle_activations(lift.activations, f'{name}-muscles'),
            'Fraction of the strength of the muscle in use. Thick: mean over all fascicles of '
            'both sides; thin: the most active fascicle. Gaps: samples that did not solve.',
        ),
    )


def _drawn(title: str, pair: Pair[T], draw: Callable[[], str], caption: str) -> Drawing:
    missing = pair.missing().items()
    if not pair.present():
        reasons = '; '.join(f'{LIFT_NAMES[source]}: {reason}' for source, reason in missing)
        return Drawing(title, '', reasons)
    reasons = ' '.join(
        f'{LIFT_NAMES[source].capitalize()} not available: {reason}.' for source, reason in missing
    )
    return drawing(title, draw, f'{caption} {reasons}'.strip())


def _limits(lift: LiftReport) -> tuple[tuple[LimitLine, ...], tuple[LimitLine, ...]]:
    if isinstance(lift.risk, Missing):
        return (), ()
    lines: dict[str, dict[float, LimitLine]] = {'compression': {}, 'shear': {}}
    for row in lift.risk.criteria:
        group = lines.get(row.criterion.split('_')[0])
        if group is not None:
            hazardous = row.criterion == 'compression_maximum'
            group[row.limit] = LimitLine(row.limit, criterion_name(row), hazardous)
    return tuple(lines['compression'].values()), tuple(lines['shear'].values())


def _disc_frame(lift: LiftReport) -> str:
    frames = sorted({curve.disc_frame for curve in lift.spine.present().values()})
    return (
        f'Disc frame: {", ".join(frames)}. Band: the same load with the frame turned by up to '
        f'{loads.DISC_FRAME_BAND:.0f}°. Gaps: samples that did not solve.'
    )


def _agreement(lift: LiftReport) -> str:
    result = lift.comparison
    if isinstance(result, Missing):
        return f'Agreement not available: {result.reason}'
    each = '; '.join(
        f'{joint} {amount(rmse, "°", 1)} (r {amount(r, digits=2)})'
        for joint, rmse, r in zip(result.joints, result.rmse, result.pearson, strict=True)
    )
    return f'Root mean square difference and correlation: {each}.'


def _ground_agreement(lift: LiftReport) -> str:
    result = lift.comparison
    if isinstance(result, Missing):
        return f'Agreement not available: {result.reason}'
    return (
        'Root mean square difference and correlation: vertical '
        f'{amount(result.vertical_rmse, "N")} (r {amount(result.vertical_pearson, digits=2)}), '
        f'forward {amount(result.horizontal_rmse, "N")} '
        f'(r {amount(result.horizontal_pearson, digits=2)}).'
    )
