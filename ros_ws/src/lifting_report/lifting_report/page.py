# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The report page: one HTML file that needs nothing else."""

from __future__ import annotations

import math
from pathlib import Path

from lifting_report.html_parts import absent, amount, facts, pill, table, text
from lifting_report.lift_section import (
    LEVELS,
    ZONES,
    lift_figures,
    lift_tables,
    quality_table,
    verdict_cards,
)
from lifting_report.model_limits import MODEL_LIMITS
from lifting_report.page_style import CSS, SCRIPT
from lifting_report.report_data import AlarmRow, Header, LiftReport, Missing, ReportData


def build_report(data: ReportData, path: str | Path) -> Path:
    """Write the report.

    Parameters
    ----------
    data : ReportData
    path : path
        Of the HTML file; its folder is made if it is not there.

    Returns
    -------
    Path
    """
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(render(data), encoding='utf-8')
    return target


def render(data: ReportData) -> str:
    """Return the page as HTML text."""
    title = f'Lift report: {data.header.task}, {data.header.subject}'
    body = ''.join(
        (
            _header(data.header),
            _remarks(data),
            _overview(data),
            _lifts(data),
            _alarms(data),
            _recording_quality(data),
            _model_limits(),
        )
    )
    return (
        f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<title>{text(title)}</title><style>{CSS}</style></head>'
        f'<body><main>{body}</main><script>{SCRIPT}</script></body></html>\n'
    )


def _header(header: Header) -> str:
    banner = (
        '<p class="simulated"><strong>SIMULATED RECORDING.</strong> These data were made by a '
        'simulation, not recorded from a person. They show what the system does, not what a '
        'person is exposed to.</p>'
        if header.simulated
        else ''
    )
    return (
        f'<h1>Lift report: {text(header.task)}</h1><p class="lead">{text(header.description)}</p>'
        + banner
        + facts(
            (
                ('Person (pseudonym)', text(header.subject)),
                (
                    'Body',
                    f'{text(header.sex)}, {amount(header.age, "years")}, '
                    f'{amount(header.mass, "kg", 1)}, {amount(header.stature, "m", 2)}',
                ),
                ('Box', amount(header.box_mass, 'kg', 1) if header.box_mass > 0.0 else 'no box'),
                (
                    'Work',
                    f'{header.lifts_per_day:g} lifts a day, {header.lifts_per_minute:g} a '
                    f'minute, {header.duration_hours:g} h',
                ),
                ('Recording', text(header.recording)),
                ('Kind', 'simulated' if header.simulated else 'recorded from a person'),
                ('Computed', text(header.run)),
                ('Report', f'{text(header.created)}, version {text(header.version)}'),
            )
        )
        + f'<p class="note">{text(header.source)}</p>'
        '<p class="note"><span class="measured">Recorded</span> is what the person did, '
        '<span class="predicted">optimal</span> the lift with the least joint effort for the '
        'same person, box, feet and places.</p>'
    )


def _remarks(data: ReportData) -> str:
    if not data.remarks:
        return ''
    return (
        '<h2>Remarks on this run</h2><ul class="plain">'
        + ''.join(f'<li>{text(remark)}</li>' for remark in data.remarks)
        + '</ul>'
    )


def _overview(data: ReportData) -> str:
    title = '<h2>Lifts</h2>'
    if isinstance(data.lifts, Missing):
        return title + absent('Lifts', data.lifts.reason)
    rows = [_overview_row(lift, data) for lift in data.lifts]
    return title + table(
        (
            'lift',
            'start',
            'lasts',
            'peak compression',
            'optimal',
            'not necessary',
            'peak shear',
            'optimal',
            'lifting index',
            'NIOSH 1981 zone',
            'alarms',
        ),
        rows,
        (1, 2, 3, 4, 5, 6, 7, 8, 10),
    )


def _overview_row(lift: LiftReport, data: ReportData) -> list[str]:
    if isinstance(data.alarms, Missing):
        alarms = '–'
    else:
        alarms = str(
            sum(
                1
                for alarm in data.alarms
                if alarm.lift_id == lift.lift_id and alarm.state == 'UNACKNOWLEDGED_ACTIVE'
            )
        )
    index = (
        '–' if isinstance(lift.lifting, Missing) else amount(lift.lifting.lifting_index, digits=2)
    )
    row = [text(lift.lift_id), amount(lift.start, 's', 2), amount(lift.duration, 's', 2)]
    if isinstance(lift.risk, Missing):
        return [*row, '–', '–', '–', '–', '–', index, pill('not assessed', ''), alarms]
    risk = lift.risk
    for name, unnecessary in (
        ('compression_action', risk.unnecessary_compression),
        ('shear_', None),
    ):
        for source in ('measured', 'predicted'):
            found = risk.find(name, source)
            row.append('–' if found is None else amount(found.value, 'N'))
        if unnecessary is not None:
            row.append(amount(unnecessary, 'N'))
    return [*row, index, pill(ZONES[risk.zone], LEVELS[risk.zone]), alarms]


def _lifts(data: ReportData) -> str:
    if isinstance(data.lifts, Missing):
        return ''
    worst = _worst(data.lifts)
    parts = []
    for k, lift in enumerate(data.lifts):
        zone = 'unknown' if isinstance(lift.risk, Missing) else lift.risk.zone
        parts.append(
            f'<details{" open" if k == worst else ""}><summary>{text(lift.lift_id)}'
            f'{pill(ZONES[zone], LEVELS[zone])}</summary>'
            + verdict_cards(lift, data.header)
            + lift_figures(lift, data.header, f'lift{k}')
            + lift_tables(lift)
            + '</details>'
        )
    return ''.join(parts)


def _worst(lifts: tuple[LiftReport, ...]) -> int:
    """Return the number of the lift with the highest recorded compression."""
    peaks: list[float] = []
    for lift in lifts:
        found = (
            None
            if isinstance(lift.risk, Missing)
            else lift.risk.find('compression_action', 'measured')
        )
        peaks.append(-math.inf if found is None or math.isnan(found.value) else found.value)
    return peaks.index(max(peaks)) if peaks else 0


def _alarms(data: ReportData) -> str:
    title = '<h2>Alarms</h2>'
    if isinstance(data.alarms, Missing):
        return title + absent('Alarms', data.alarms.reason)
    if not data.alarms:
        return title + '<p>No alarm was raised in this recording.</p>'
    rows = [_alarm_row(alarm) for alarm in data.alarms]
    return (
        title
        + table(
            ('time', 'alarm', 'change', 'value', 'limit', 'margin', 'lift', 'source of the limit'),
            rows,
            (0, 3, 4, 5),
        )
        + (
            '<p class="note">Times since the start of the recording, of the sample that caused '
            'the change. Alarms come from the live stream with its causal filters, the peaks '
            'above from the whole lift; short peaks below the on-delay raise no alarm.</p>'
        )
    )


def _alarm_row(alarm: AlarmRow) -> list[str]:
    digits = 2 if alarm.unit == '1' else 0
    level = 'hazard' if alarm.state.endswith('ACTIVE') else ''
    change = f'{text(_state(alarm.previous_state))} → {pill(_state(alarm.state), level)}' + (
        ' (stored data)' if alarm.historical else ''
    )
    return [
        amount(alarm.stamp, 's', 2),
        text(alarm.alarm.replace('_', ' ')),
        change,
        amount(alarm.value, alarm.unit, digits),
        amount(alarm.limit, alarm.unit, digits),
        amount(alarm.margin, alarm.unit, digits),
        text(alarm.lift_id) or '–',
        f'<span class="source">{text(alarm.limit_source)}</span>',
    ]


def _state(name: str) -> str:
    return name.replace('_', ' ').lower()


def _recording_quality(data: ReportData) -> str:
    title = '<h2>Quality of the recording</h2>'
    if isinstance(data.recording_quality, Missing):
        return title + absent('Quality of the recording', data.recording_quality.reason)
    return title + quality_table(data.recording_quality)


def _model_limits() -> str:
    return (
        '<h2>Limits of the models</h2><ul class="plain">'
        + ''.join(f'<li>{text(limit)}</li>' for limit in MODEL_LIMITS)
        + '</ul>'
    )
