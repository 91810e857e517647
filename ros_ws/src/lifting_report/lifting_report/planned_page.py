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
from lifting_report.pages import Card, Drawing, drawing, render_page, write_page
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

_NOT_RECORDED = Missing('no lift was recorded')


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
    """Write the page; the folder is created if necessary."""
    return write_page(path, render_planned(report))


def render_planned(report: PlannedReport) -> str:
    """Return the page as HTML text."""
    title = f'Planned lift: {report.header.task}, {report.header.subject}'
    drawings = () if report.drawn is None else _drawings(report, report.drawn)
    return render_page('planned.html', title=title, report=report, drawings=drawings)


def _drawings(report: PlannedReport, drawn: PlannedCurves) -> tuple[Drawing, ...]:
    weight = report.header.mass * GRAVITY
    spine, muscles, angles = drawn.spine, drawn.activations, drawn.angles
    return (
        _figure(
            'The lift, step by step',
            drawn.points,
            lambda pair: stick_figures.stick_sequence(pair, 'planned-stick'),
            'View from the right; right limbs dark, left limbs light.',
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
            'Fraction of the strength of the muscle in use. Thick: mean over all fascicles of '
            'both sides; thin: the most active fascicle.',
        ),
    )


def _figure(
    title: str, part: T | Missing, draw: Callable[[Pair[T]], str], caption: str
) -> Drawing:
    if isinstance(part, Missing):
        return Drawing(title, '', part.reason)
    return drawing(title, lambda: draw(Pair(_NOT_RECORDED, part)), caption)
