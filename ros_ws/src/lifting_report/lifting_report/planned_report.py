# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From a planned lift to the data of its page."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from human_model import __version__
from human_model.exceptions import HumanModelError
from lift_predictor import conversions as predictor_messages
from lift_predictor.core.exceptions import LiftPredictorError
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.planning.planned_lift import PlannedLift
from lift_predictor.core.planning.task_file import TaskFile
from lifting_report import results_curves as curves
from lifting_report.figures.loads import LimitLine
from lifting_report.pages import Card, amount
from lifting_report.planned_page import PlannedCurves, PlannedReport, build_planned
from lifting_report.planned_results import PlanFiles, SpinePeak
from lifting_report.report_data import Header, Missing
from lifting_report.results_file import PREDICTED, read_results, seconds


def write_planned_report(
    planned: PlannedLift, entry: TaskFile, files: PlanFiles, page: Path
) -> Path:
    """Write the page of a planned lift; where it cannot be done, of the nearest that can.

    Parameters
    ----------
    planned : PlannedLift
        The answer.
    entry : TaskFile
        The question.
    files : PlanFiles
        From `planned_results.write_plan`.
    page : Path
        HTML file to write.
    """
    return build_planned(planned_report(planned, entry, files), page)


def planned_report(planned: PlannedLift, entry: TaskFile, files: PlanFiles) -> PlannedReport:
    """Return the data of the page."""
    report, summary, spine = planned.report, files.summary, files.spine
    nearest = planned.prediction.nearest
    shown = planned.prediction
    title = 'The lift'
    if not report.ok and nearest is not None:
        shown, title = nearest.prediction, f'The nearest lift that can be done: {nearest.change}'
    drawn = None
    if shown.lift is not None:
        message = predictor_messages.prediction_to_msg(shown, None, planned.subject)
        drawn = _curves(planned, message, files.results)
    peaks = () if summary is None else tuple(
        (p.joint, p.torque, p.limit, p.share, p.time)
        for p in sorted(summary.peaks, key=lambda peak: -peak.share)
    )  # fmt: skip
    compression, shear = _lines(spine)
    return PlannedReport(
        header=_header(planned, entry),
        good=report.ok,
        status=report.status.name,
        message=report.message,
        facts=_facts(planned, files),
        cards=() if summary is None else (*_spine_cards(spine, planned), _torque_card(peaks)),
        peaks=peaks,
        binding=() if summary is None else summary.active_constraints,
        shown=title,
        drawn=drawn,
        compression_limits=compression,
        shear_limits=shear,
        solves=(
            ('Status', report.status.name),
            ('Iterations', f'{report.iterations} in {len(planned.prediction.runs)} runs'),
            ('Largest violation', f'{report.primal_residual:.1e}'),
            ('Optimality', f'{report.dual_residual:.1e}'),
            ('Time', f'{report.solve_time:.2f} s'),
        ),
    )


def _header(planned: PlannedLift, entry: TaskFile) -> Header:
    subject, task, work = planned.subject, planned.task, entry.work
    return Header(
        subject=subject.pseudonym, sex=subject.sex, mass=subject.mass, stature=subject.stature,
        age=subject.age, task=task.name, description=f'Planned from {entry.path.name}.',
        recording='none', source='planned without a recording', simulated=True,
        box_mass=planned.prediction.box_mass, lifts_per_day=work.lifts_per_day,
        lifts_per_minute=work.lifts_per_minute, duration_hours=work.duration_hours,
        run='lift predict', created=datetime.now(UTC).strftime('%Y-%m-%d %H:%M UTC'),
        version=__version__,
    )  # fmt: skip


def _facts(planned: PlannedLift, files: PlanFiles) -> tuple[tuple[str, str], ...]:
    task, summary = planned.task, files.summary
    places = ' to '.join(f'({x:.2f}, {y:.2f}, {z:.2f}) m' for x, y, z in (task.start, task.end))
    asked = 'the largest' if task.box_mass is None else f'{task.box_mass:.2f} kg'
    given = (('Box', asked), ('Centre of the box, forward, left, up', places))
    if summary is None:
        return given
    feet = ' (searched)' if task.feet is None else ''
    heaviest = ' (the largest)' if task.box_mass is None else ''
    return (
        ('Box', f'{summary.box_mass:.2f} kg{heaviest}'),
        given[1],
        ('Feet', f'forward {summary.ankle:.3f} m, left {summary.left:.3f} m, facing '
         f'{math.degrees(summary.heading):.0f} deg to the left{feet}'),
        ('Technique', f'asked for: {task.technique}; Stoop-Squat-Index '
         f'{summary.technique_index:.0f} at the start'),
        ('Effort, time', f'{summary.effort:.4f} s in {summary.duration:.2f} s'),
    )  # fmt: skip


def _curves(planned: PlannedLift, message: Any, results: Path | None) -> PlannedCurves:
    person: Person | Missing
    try:
        person = Person.of(planned.subject)
    except (HumanModelError, LiftPredictorError) as error:
        person = Missing(str(error))
    none = Missing('muscles are analysed only where the task can be done')
    blocks = {}
    if results is not None:
        found = read_results(results)
        blocks = found.lifts[planned.prediction.lift_id].blocks
    start = seconds(message.header.stamp)
    spine = blocks.get(('spine_load', PREDICTED))
    muscles = blocks.get(('muscle_analysis', PREDICTED))
    return PlannedCurves(
        points=curves.body_points(message, planned.task.box_size),
        angles=curves.joint_angles(message, person),
        ground=curves.ground_forces(message),
        torques=curves.torques(message, message.motion.time_from_start),
        spine=none if spine is None else curves.spine_curves(spine, start),
        activations=none if muscles is None else curves.activations(muscles, start),
    )


def _lines(spine: SpinePeak | None) -> tuple[tuple[LimitLine, ...], tuple[LimitLine, ...]]:
    """Limits of compression, action limit first, and of shear."""
    if spine is None or not spine.limits:
        return (), ()
    (action, low), (largest, high), (shear, limit) = (
        (name, value) for name, (value, _) in spine.limits.items()
    )
    compression = (LimitLine(low, action, False), LimitLine(high, largest, True))
    return compression, (LimitLine(limit, shear, False),)


def _spine_cards(spine: SpinePeak | None, planned: PlannedLift) -> tuple[Card, ...]:
    if spine is None or math.isnan(spine.compression):
        reason = 'no sample of the muscle analysis is good data'
        return (Card('Peak L5-S1 compression', '–', reason, ''),)
    (action, largest), (shear,) = _lines(spine)
    level = 'good' if spine.compression < action.value else (
        'action' if spine.compression < largest.value else 'hazard')  # fmt: skip
    beyond = spine.anterior_shear >= shear.value
    return (
        Card(
            'Peak L5-S1 compression', amount(spine.compression, 'N'), spine.zone, level,
            tuple((line.name, amount(line.value, 'N')) for line in (action, largest)),
            _per_kilogram(spine.compression, planned),
        ),
        Card(
            'Peak L5-S1 anterior shear', amount(spine.anterior_shear, 'N'),
            'at or above the limit' if beyond else 'below the limit',
            'action' if beyond else 'good', ((shear.name, amount(shear.value, 'N')),),
            _per_kilogram(spine.anterior_shear, planned),
        ),
    )  # fmt: skip


def _per_kilogram(value: float, planned: PlannedLift) -> str:
    return amount(value / planned.subject.mass, 'N/kg', 1)


def _torque_card(peaks: tuple[tuple[str, float, float, float, float], ...]) -> Card:
    joint, torque, limit, share, time = peaks[0]
    # The check between the nodes lets 0.5 N m through.
    verdict = 'at its dynamic strength' if share >= 0.995 else 'below its dynamic strength'
    return Card(
        'Joint nearest to its limit',
        amount(100.0 * share, '%'),
        verdict,
        'action' if share >= 0.995 else 'good',
        (
            ('torque', amount(torque, 'N m', 1)),
            ('dynamic strength', amount(limit, 'N m', 1)),
            ('reached', f'{amount(time, "s", 2)} after the start'),
        ),
        joint,
    )
