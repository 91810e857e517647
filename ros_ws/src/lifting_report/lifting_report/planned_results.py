# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscle and L5-S1 loads of a planned lift, and its files: `plan.json` and `results.mcap`."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from injury_monitor.core.limits import LimitSet, limits_for, zone_meaning
from lift_predictor import conversions as predictor_messages
from lift_predictor.core.planning.plan_task import Placement
from lift_predictor.core.planning.planned_lift import PlannedLift
from lift_predictor.core.planning.summary import PlanSummary, summarise
from lift_predictor.core.planning.task_file import TaskFile
from lift_predictor.core.problem.run import SolverRun
from lifting_messages import Message, make
from lifting_messages.conversions import LABORATORY, point, subject_to_msg
from lifting_messages.stamps import header
from lifting_report.exceptions import ReportError
from lifting_report.results_writer import ResultsWriter
from muscle_analyzer import conversions as muscle_messages
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

STATION = 'planned'


@dataclass(frozen=True)
class SpinePeak:
    """Largest load on L5-S1 of a planned lift, with the limits in force.

    Attributes
    ----------
    compression, anterior_shear : float
        Peaks over the solved samples [N].
    solved, samples : int
        How many samples of the muscle analysis are good data, of how many.
    zone : str
        What the NIOSH 1981 zone of the compression means.
    limits : dict
        Name: value [N] and source.
    """

    compression: float
    anterior_shear: float
    solved: int
    samples: int
    zone: str
    limits: dict[str, tuple[float, str]]


@dataclass(frozen=True)
class PlanFiles:
    """What was written, and the numbers in it."""

    json: Path
    results: Path | None
    summary: PlanSummary | None
    spine: SpinePeak | None


def write_plan(planned: PlannedLift, entry: TaskFile, output: Path) -> PlanFiles:
    """Analyse a planned lift and write its files; without a lift, the report alone.

    Raises
    ------
    MuscleAnalyzerError, HumanModelError
        The musculoskeletal model cannot be scaled to the person.
    """
    output.mkdir(parents=True, exist_ok=True)
    summary = summarise(planned)
    results, spine = None, None
    if summary is not None:
        results = output / 'results.mcap'
        spine = _write_results(planned, entry, results)
    path = output / 'plan.json'
    path.write_text(
        json.dumps(_plain(planned, summary, spine), indent=2, allow_nan=False) + '\n',
        encoding='utf-8',
    )
    return PlanFiles(path, results, summary, spine)


def task_message(entry: TaskFile, box_mass: float) -> Message:
    """Return a planned task as recordings have it."""
    task, work = entry.task, entry.work
    start, end = (point(np.asarray(place)) for place in (task.start, task.end))
    return make(
        'Task',
        header=header(0.0, LABORATORY),
        task_id=task.name,
        description=f'planned: {entry.path.name}',
        box_mass=box_mass,
        box_size=list(task.box_size),
        box_start=start,
        box_end=end,
        coupling=int(work.coupling),
        lifts_per_minute=work.lifts_per_minute,
        lifts_per_day=work.lifts_per_day,
        duration_hours=work.duration_hours,
        control_at_destination=work.control_at_destination,
        simulated=True,
        source='planned without a recording',
    )


def _write_results(planned: PlannedLift, entry: TaskFile, path: Path) -> SpinePeak:
    prediction, subject = planned.prediction, planned.subject
    if prediction.lift is None:
        raise ReportError('lift', None, f'{entry.task.name} has no predicted lift')
    motion = prediction.lift.motion
    analyzer = MuscleAnalyzer(subject)
    analysis = analyzer.analyze(motion, prediction.lift_id, 'predicted')
    torques = analyzer.joint_torques(analysis, motion)
    lift = predictor_messages.prediction_to_msg(prediction, None, subject)
    lift.maximum_weight = entry.task.box_mass is None
    disc = muscle_messages.disc_frame_id(STATION)
    spine = muscle_messages.spine_load_to_msg(analysis, prediction.box_mass, disc)
    with ResultsWriter(path, STATION) as writer:
        for topic, message in (
            ('subject', subject_to_msg(subject, 0.0, '', 'task file')),
            ('task', task_message(entry, prediction.box_mass)),
            ('predicted_lift', lift),
            ('predicted_lift/joint_trajectory', predictor_messages.trajectory_to_msg(prediction)),
            ('muscle_analysis', muscle_messages.analysis_to_msg(analysis)),
            ('spine_load', spine),
            ('joint_torques', muscle_messages.torques_to_msg(torques)),
        ):
            writer.write(topic, message)
    limits = limits_for(entry.work.lifts_per_day)
    good = analysis.spine_status == 0
    if not good.any():
        return SpinePeak(math.nan, math.nan, 0, len(good), analysis.spine_report.message, {})
    compression = float(np.max(analysis.compression[good]))
    return SpinePeak(
        compression=compression,
        anterior_shear=float(np.max(analysis.anterior_shear[good])),
        solved=int(good.sum()),
        samples=len(good),
        zone=zone_meaning(limits.zone(compression)),
        limits=_limits(limits),
    )


def _limits(limits: LimitSet) -> dict[str, tuple[float, str]]:
    used = (limits.compression_action, limits.compression_maximum, limits.shear)
    return {limit.name: (limit.value, limit.source) for limit in used}


def _plain(
    planned: PlannedLift, summary: PlanSummary | None, spine: SpinePeak | None
) -> dict[str, Any]:
    """Return everything as JSON can have it: NaN and infinity become null."""
    verification = planned.prediction.verification
    whole = {
        'subject': planned.subject.to_dict(),
        'task': asdict(planned.task),
        'report': {**planned.report.to_dict(), 'status_name': planned.report.status.name},
        'summary': None if summary is None else summary.to_dict(),
        'l5_s1': None if spine is None else asdict(spine),
        'verification': None if verification is None else verification.violation,
        'placements': [_placement(placement) for placement in planned.placements],
        'runs': [_run(run) for run in planned.prediction.runs],
    }
    cleaned: dict[str, Any] = _finite(whole)
    return cleaned


def _placement(placement: Placement) -> dict[str, Any]:
    """Return one place of the feet that was tried."""
    feet = placement.feet
    return {
        'ankle': feet.forward,
        'value': placement.value,
        'message': placement.message,
        'left': feet.left,
        'heading': feet.heading,
    }


def _run(run: SolverRun) -> dict[str, Any]:
    """Return one run of the solver."""
    solution = run.solution
    return {
        'start': run.start,
        'converged': run.converged,
        'outcome': str(run.status),
        'objective': solution.objective,
        'iterations': solution.iterations,
        'violation': solution.primal,
        'solve_time': solution.solve_time,
    }


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
