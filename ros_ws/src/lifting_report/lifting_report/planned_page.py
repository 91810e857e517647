# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The page of a lift that was planned from a task: one HTML file that needs nothing else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from human_model.constants import GRAVITY
from lifting_report.figures import curves, loads, stick_figures
from lifting_report.figures.loads import LimitLine
from lifting_report.html_parts import (
    Card,
    absent,
    amount,
    cards,
    facts,
    figure,
    pill,
    table,
    text,
)
from lifting_report.model_limits import MODEL_LIMITS
from lifting_report.page_style import CSS, SCRIPT
from lifting_report.report_data import (
    Activations,
    BodyPoints,
    GroundForces,
    Header,
    JointAngles,
    Missing,
    Pair,
    SpineCurves,
    T,
    Torques,
)

_NOBODY = Missing('nobody was recorded')


@dataclass(frozen=True)
class PlannedCurves:
    """What is drawn of a planned lift; muscles are only analysed where the task can be done."""

    points: BodyPoints
    angles: JointAngles | Missing
    ground: GroundForces
    torques: Torques
    spine: SpineCurves | Missing
    activations: Activations | Missing


@dataclass(frozen=True)
class PlannedReport:
    """Everything on the page of a planned lift.

    Attributes
    ----------
    header : Header
        Person, box and work.
    good : bool
        Whether the task can be done.
    status, message : str
        Of the solve.
    facts : tuple of (str, str)
        Names and values of the plan, plain text.
    cards : tuple of Card
        Peaks beside their limits.
    peaks : tuple of (joint, torque, limit, share, time)
        Joints, the one nearest to its dynamic limit first [N m], [N m], [1], [s].
    binding : tuple of str
        Limits that the lift touches.
    shown : str
        What the figures show.
    drawn : PlannedCurves or None
        None: there is no lift to draw.
    compression_limits, shear_limits : tuple of LimitLine
        Lines in the figure of the spine.
    solves : tuple of (str, str)
        Names and values of the solve report, plain text.
    """

    header: Header
    good: bool
    status: str
    message: str
    facts: tuple[tuple[str, str], ...]
    cards: tuple[Card, ...]
    peaks: tuple[tuple[str, float, float, float, float], ...]
    binding: tuple[str, ...]
    shown: str
    drawn: PlannedCurves | None
    compression_limits: tuple[LimitLine, ...]
    shear_limits: tuple[LimitLine, ...]
    solves: tuple[tuple[str, str], ...]


def build_planned(report: PlannedReport, path: Path) -> Path:
    """Write the page; its folder is made if it is not there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(render_planned(report), encoding='utf-8')
    return path


def render_planned(report: PlannedReport) -> str:
    """Return the page as HTML text."""
    title = f'Planned lift: {report.header.task}, {report.header.subject}'
    body = ''.join((_header(report), _verdict(report), _figures(report), _tables(report)))
    return (
        f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<title>{text(title)}</title><style>{CSS}</style></head>'
        f'<body><main>{body}</main><script>{SCRIPT}</script></body></html>\n'
    )


def _header(report: PlannedReport) -> str:
    header = report.header
    return (
        f'<h1>Planned lift: {text(header.task)}</h1><p class="lead">{text(header.description)}</p>'
        '<p class="simulated"><strong>NOBODY LIFTED THIS.</strong> The lift was computed from the '
        'task and the person alone: the one with the least joint effort that keeps all limits of '
        'the model.</p>'
        + facts(
            (
                ('Person (pseudonym)', text(header.subject)),
                (
                    'Body',
                    f'{text(header.sex)}, {amount(header.age, "years")}, '
                    f'{amount(header.mass, "kg", 1)}, {amount(header.stature, "m", 2)}',
                ),
                (
                    'Work',
                    f'{header.lifts_per_day:g} lifts a day, {header.lifts_per_minute:g} a '
                    f'minute, {header.duration_hours:g} h',
                ),
                *((name, text(value)) for name, value in report.facts),
                ('Report', f'{text(header.created)}, version {text(header.version)}'),
            )
        )
    )


def _verdict(report: PlannedReport) -> str:
    label = pill(
        'can be done' if report.good else 'cannot be done', 'good' if report.good else 'hazard'
    )
    lead = f'<p class="lead">{label} {text(report.status)}: {text(report.message)}</p>'
    return '<h2>Result</h2>' + lead + (cards(report.cards) if report.cards else '')


def _figures(report: PlannedReport) -> str:
    if report.drawn is None:
        return absent('Figures', 'there is no lift to draw')
    drawn, weight = report.drawn, report.header.mass * GRAVITY
    spine, muscles, angles = drawn.spine, drawn.activations, drawn.angles
    parts = [
        _figure(
            'The lift, step by step',
            drawn.points,
            lambda pair: stick_figures.stick_sequence(pair, 'planned-stick'),
            'Seen from the right; right limbs dark, left limbs light.',
        ),
        _figure(
            'Joint angles',
            angles,
            lambda pair: curves.joint_angles(pair, 'planned-angles'),
            'Mean of right and left; the band spans both sides.',
        ),
        _figure(
            'Ground reaction',
            drawn.ground,
            lambda pair: curves.ground_forces(pair, 'planned-ground', weight),
            'Both feet together.',
        ),
        _figure(
            'Joint torques and dynamic strength',
            drawn.torques,
            lambda pair: curves.joint_torques(pair, 'planned-torques'),
            'Dotted: dynamic strength at the angle and speed of that moment; none where no '
            'strength is published. In the sagittal plane paired joints count both limbs.',
        ),
        _figure(
            'Torque index',
            drawn.torques,
            lambda pair: curves.torque_indices(pair, 'planned-index'),
            'Torque over dynamic strength in its direction (eq. 4.12 of the dissertation).',
        ),
        _figure(
            'L5-S1 compression and shear',
            spine,
            lambda pair: loads.spine_load(
                pair, report.compression_limits, report.shear_limits, 'planned-spine'
            ),
            'Force of S1 on L5 in the frame of the disc. Gaps: samples that did not solve.',
        ),
        _figure(
            'Muscle activations',
            muscles,
            lambda pair: loads.muscle_activations(pair, 'planned-muscles'),
            'Share of the strength of the muscle in use. Thick: mean over all fascicles of '
            'both sides; thin: the most active fascicle.',
        ),
    ]
    return f'<h2>{text(report.shown)}</h2>' + ''.join(parts)


def _figure(title: str, part: T | Missing, draw: Callable[[Pair[T]], str], caption: str) -> str:
    if isinstance(part, Missing):
        return absent(title, part.reason)
    return figure(title, draw(Pair(_NOBODY, part)), caption)


def _tables(report: PlannedReport) -> str:
    parts = []
    if report.peaks:
        rows = [
            [
                text(joint),
                amount(torque, 'N m', 1),
                amount(limit, 'N m', 1),
                amount(100.0 * share, '%', 1),
                amount(time, 's', 2),
            ]
            for joint, torque, limit, share, time in report.peaks
        ]
        parts.append(
            '<h2>Joints nearest to their limits</h2>'
            + table(('joint', 'torque', 'dynamic strength', 'share', 'at'), rows, (1, 2, 3, 4))
        )
        touched = ''.join(f'<li>{text(name)}</li>' for name in report.binding) or '<li>none</li>'
        parts.append(f'<h3>Limits that the lift touches</h3><ul class="plain">{touched}</ul>')
    parts.append(
        '<h2>Solve report</h2>' + facts((name, text(value)) for name, value in report.solves)
    )
    parts.append(
        '<h2>Limits of the models</h2><ul class="plain">'
        + ''.join(f'<li>{text(limit)}</li>' for limit in MODEL_LIMITS)
        + '</ul>'
    )
    return ''.join(parts)
