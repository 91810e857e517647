# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The part of the page about one lift: verdict, figures, tables."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from human_model.constants import GRAVITY
from injury_monitor.core.lifting_equation import lifting_index_band
from lifting_report.emg_page import emg_part
from lifting_report.figures import curves, joint_peaks, loads, stick_figures
from lifting_report.figures.loads import LimitLine
from lifting_report.html_parts import Card, absent, amount, cards, figure, table, text
from lifting_report.report_data import CriterionRow, Header, LiftReport, Missing, Pair, Risk

LEVELS = {'nominal': 'good', 'action': 'action', 'hazardous': 'hazard', 'unknown': ''}
ZONES = {
    'nominal': 'nominal risk',
    'action': 'needs controls',
    'hazardous': 'not acceptable',
    'unknown': 'unknown',
}
CRITERIA = {
    'compression_action': 'NIOSH action limit',
    'compression_maximum': 'NIOSH maximum permissible limit',
    'shear_occasional': 'limit up to 100 loads a day',
    'shear_frequent': 'limit above 100 loads a day',
    'torque_index': 'joint torque index',
    'activation_index': 'activation index',
}
_NAMES = {'measured': 'recorded lift', 'predicted': 'optimal lift'}


def verdict_cards(lift: LiftReport, header: Header) -> str:
    """Return the cards: compression, shear, torque index, activation, lifting index."""
    if isinstance(lift.risk, Missing):
        return absent('Assessment', lift.risk.reason) + _lifting_card(lift)
    risk = lift.risk
    items = [
        _force_card(
            'Peak L5-S1 compression',
            risk,
            'compression_action',
            header,
            risk.unnecessary_compression,
            LEVELS[risk.zone],
            ZONES[risk.zone],
        ),
        _force_card('Peak L5-S1 anterior shear', risk, 'shear_', header, risk.unnecessary_shear),
        _index_card('Joint torque index', risk, 'torque_index'),
        _index_card('Activation index', risk, 'activation_index'),
    ]
    return (
        f'<p class="lead">{text(risk.summary)}</p>'
        + cards(items)
        + _lifting_card(lift)
        + _left_out(risk)
    )


def _left_out(risk: Risk) -> str:
    note = f'{risk.samples_left_out} samples did not solve and are left out of every peak.'
    return f'<p class="note">{note}</p>' if risk.samples_left_out else ''


def _force_card(
    what: str,
    risk: Risk,
    name: str,
    header: Header,
    unnecessary: float,
    level: str = '',
    verdict: str = '',
) -> Card:
    measured, predicted = risk.find(name, 'measured'), risk.find(name, 'predicted')
    if measured is None or math.isnan(measured.value):
        return Card(what, '–', 'not available: no solved sample of the recorded lift', '')
    beyond = measured.margin <= 0.0
    if not verdict:
        level, verdict = (
            ('action', 'at or above the limit') if beyond else ('good', 'below the limit')
        )
    rows = [
        (text(_criterion(measured)), amount(measured.limit, measured.unit)),
        ('margin', amount(measured.margin, measured.unit)),
        ('reached', f'{amount(measured.time, "s", 2)} after the start'),
    ]
    rows += _optimal_rows(predicted, header, unnecessary)
    per_kilogram = amount(measured.value / header.mass, 'N/kg', 1)
    return Card(
        text(what),
        f'{amount(measured.value, measured.unit)} <small>{per_kilogram}</small>',
        text(verdict),
        level,
        tuple(rows),
    )


def _optimal_rows(
    predicted: CriterionRow | None, header: Header, unnecessary: float
) -> list[tuple[str, str]]:
    if predicted is None or math.isnan(predicted.value):
        return [('optimal lift', 'not available')]
    kilogram = amount(predicted.value / header.mass, 'N/kg', 1)
    rows = [('optimal lift', f'{amount(predicted.value, predicted.unit)} ({kilogram})')]
    if unnecessary > 0.0:
        rows.append(('not necessary', f'<strong>{amount(unnecessary, predicted.unit)}</strong>'))
    elif not math.isnan(unnecessary):
        rows.append(('optimal lift is higher by', amount(-unnecessary, predicted.unit)))
    return rows


def _index_card(what: str, risk: Risk, name: str) -> Card:
    measured, predicted = risk.find(name, 'measured'), risk.find(name, 'predicted')
    shown = measured if measured is not None and not math.isnan(measured.value) else predicted
    if shown is None or math.isnan(shown.value):
        return Card(text(what), '–', 'not available', '')
    level, verdict = (
        ('action', 'at or above the limit') if shown.margin <= 0.0 else ('good', 'below the limit')
    )
    if shown is predicted:
        verdict += ' (optimal lift; none for the recorded one)'
    rows = [
        ('where', text(shown.detail) or '–'),
        ('limit', amount(shown.limit, digits=2)),
        ('margin', amount(shown.margin, digits=2)),
    ]
    if shown is measured and predicted is not None and not math.isnan(predicted.value):
        where = f' ({text(predicted.detail)})' if predicted.detail else ''
        rows.append(('optimal lift', amount(predicted.value, digits=2) + where))
    return Card(text(what), amount(shown.value, digits=2), verdict, level, tuple(rows))


def _lifting_card(lift: LiftReport) -> str:
    title = '<h3>Revised NIOSH lifting equation</h3>'
    if isinstance(lift.lifting, Missing):
        return title + absent('Lifting index', lift.lifting.reason)
    lifting = lift.lifting
    names = ('HM', 'VM', 'DM', 'AM', 'FM', 'CM')
    head = [*lifting.variables, *names, 'RWL', 'LI', 'band']
    multipliers = [
        f'<strong>{amount(value, digits=2)}</strong>'
        if name == lifting.limiting_multiplier
        else amount(value, digits=2)
        for name, value in zip(names, lifting.multipliers, strict=True)
    ]
    row = [
        *(text(value) for value in lifting.variables.values()),
        *multipliers,
        amount(lifting.recommended_weight_limit, 'kg', 1),
        f'<strong>{amount(lifting.lifting_index, digits=2)}</strong>',
        text(lifting.band or lifting_index_band(lifting.lifting_index)),
    ]
    limiting = (
        f'The multiplier that limits most is {text(lifting.limiting_multiplier)}. '
        if lifting.limiting_multiplier
        else ''
    )
    return (
        title
        + table(head, [row], range(len(head) - 1))
        + f'<p class="note">{limiting}RWL: recommended weight limit, 23&#8239;kg times all '
        'six multipliers. LI: mass lifted over RWL; above 1 the risk rises '
        '(NIOSH 94-110).</p>'
    )


def lift_figures(lift: LiftReport, header: Header, name: str) -> str:
    """Return all figures of a lift; ``name`` makes their ids unique."""
    weight = header.mass * GRAVITY
    compression, shear = _limits(lift)
    parts = [
        _drawn(
            'Both lifts, step by step',
            lift.points,
            lambda: stick_figures.stick_sequence(lift.points, f'{name}-stick'),
            'Seen from the right; right limbs dark, left limbs light. Same scale, same '
            'course of the lift.',
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
            'axis of the disc, femur or tibia, and across it. Samples in which muscles '
            'are too weak are left out.',
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
            'dynamic strength at the angle and speed of that moment; none where no strength '
            'is published.',
        ),
        _drawn(
            'Torque index',
            lift.torques,
            lambda: curves.torque_indices(lift.torques, f'{name}-index'),
            'Torque over dynamic strength in its direction (eq. 4.12 of the dissertation).',
        ),
        _muscles(lift, name),
        _emg(lift, name),
    ]
    return ''.join(parts)


def _drawn(title: str, pair: Pair[Any], draw: Callable[[], str], caption: str) -> str:
    reasons = ' '.join(
        f'{_NAMES[source].capitalize()} not available: {text(reason)}.'
        for source, reason in pair.missing().items()
    )
    if not pair.present():
        return absent(
            title,
            '; '.join(f'{_NAMES[source]}: {reason}' for source, reason in pair.missing().items()),
        )
    return figure(title, draw(), f'{caption} {reasons}'.strip())


def _muscles(lift: LiftReport, name: str) -> str:
    return _drawn(
        'Muscle activations',
        lift.activations,
        lambda: loads.muscle_activations(lift.activations, f'{name}-muscles'),
        'Share of the strength of the muscle in use. Thick: mean over all fascicles of both '
        'sides; thin: the most active fascicle. Gaps: samples that did not solve.',
    )


def _emg(lift: LiftReport, name: str) -> str:
    """Return the section of the EMG; nothing where none was recorded."""
    if lift.emg is None:
        return ''
    title = '<h3>EMG beside the computed activations</h3>'
    if isinstance(lift.emg, Missing):
        return title + absent('EMG', lift.emg.reason)
    return title + emg_part(lift.emg, f'{name}-emg')


def _limits(lift: LiftReport) -> tuple[tuple[LimitLine, ...], tuple[LimitLine, ...]]:
    if isinstance(lift.risk, Missing):
        return (), ()
    lines: dict[str, dict[float, LimitLine]] = {'compression': {}, 'shear': {}}
    for row in lift.risk.criteria:
        group = lines.get(row.criterion.split('_')[0])
        if group is not None:
            group[row.limit] = LimitLine(
                row.limit, _criterion(row), row.criterion == 'compression_maximum'
            )
    return tuple(lines['compression'].values()), tuple(lines['shear'].values())


def _disc_frame(lift: LiftReport) -> str:
    frames = sorted({curve.disc_frame for curve in lift.spine.present().values()})
    return (
        f'Disc frame: {text(", ".join(frames))}. Band: the same load with the frame turned '
        f'by up to {loads.DISC_FRAME_BAND:.0f}°. Gaps: samples that did not solve.'
    )


def _agreement(lift: LiftReport) -> str:
    if isinstance(lift.comparison, Missing):
        return f'Agreement not available: {text(lift.comparison.reason)}'
    result = lift.comparison
    each = '; '.join(
        f'{text(joint)} {amount(rmse, "°", 1)} (r {amount(r, digits=2)})'
        for joint, rmse, r in zip(result.joints, result.rmse, result.pearson, strict=True)
    )
    return f'Root mean square difference and correlation: {each}.'


def _ground_agreement(lift: LiftReport) -> str:
    if isinstance(lift.comparison, Missing):
        return f'Agreement not available: {text(lift.comparison.reason)}'
    result = lift.comparison
    return (
        'Root mean square difference and correlation: vertical '
        f'{amount(result.vertical_rmse, "N")} (r {amount(result.vertical_pearson, digits=2)})'
        f', forward {amount(result.horizontal_rmse, "N")} '
        f'(r {amount(result.horizontal_pearson, digits=2)}).'
    )


def lift_tables(lift: LiftReport) -> str:
    """Return criteria, quality measures and solve reports of a lift."""
    return _criteria(lift) + _quality(lift) + _solves(lift)


def _criteria(lift: LiftReport) -> str:
    if isinstance(lift.risk, Missing):
        return ''
    rows = [
        [
            text(_criterion(row)),
            _NAMES.get(row.source, text(row.source)),
            amount(row.value, row.unit, _digits(row)),
            amount(row.limit, row.unit, _digits(row)),
            amount(row.margin, row.unit, _digits(row)),
            amount(row.time, 's', 2),
            text(row.detail),
            f'<span class="source">{text(row.limit_source)}</span>',
        ]
        for row in lift.risk.criteria
    ]
    return '<h3>All criteria</h3>' + table(
        ('criterion', 'lift', 'peak', 'limit', 'margin', 'at', 'where', 'source of the limit'),
        rows,
        (2, 3, 4, 5),
    )


def _criterion(row: CriterionRow) -> str:
    return CRITERIA.get(row.criterion, row.criterion.replace('_', ' '))


def _digits(row: CriterionRow) -> int:
    return 2 if row.unit == '1' else 0


def _quality(lift: LiftReport) -> str:
    title = '<h3>Quality of this lift</h3>'
    if isinstance(lift.quality, Missing):
        return title + absent('Quality measures', lift.quality.reason)
    return title + quality_table(lift.quality)


def quality_table(rows: tuple[Any, ...]) -> str:
    """Return a table of quality measures."""
    return table(
        ('measure', 'recorded', 'optimal', 'unit', 'meaning'),
        [
            [
                text(row.name),
                f'{_short(row.measured)}',
                f'{_short(row.predicted)}',
                text(row.unit),
                text(row.meaning),
            ]
            for row in rows
        ],
        (1, 2),
    )


def _short(value: float) -> str:
    if math.isnan(value):
        return '–'
    return f'{value:.3g}'.replace('-', '−')


def _solves(lift: LiftReport) -> str:
    title = '<h3>Solve reports</h3>'
    if isinstance(lift.solves, Missing):
        return title + absent('Solve reports', lift.solves.reason)
    rows = [
        [
            text(row.stage),
            _status(row.status, row.status_name),
            str(row.iterations),
            _short(row.primal_residual),
            _short(row.dual_residual),
            amount(row.solve_time, 's', 2),
            text(row.message),
        ]
        for row in lift.solves
    ]
    return title + table(
        ('stage', 'status', 'iterations', 'primal residual', 'dual residual', 'time', 'message'),
        rows,
        (2, 3, 4, 5),
    )


def _status(status: int, name: str) -> str:
    level = 'good' if status == 0 else 'hazard'
    return f'<span class="pill {level}">{text(name)}{"" if status == 0 else f" {status}"}</span>'
