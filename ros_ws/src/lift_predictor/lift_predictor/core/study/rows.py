# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Solving one case into one row: numbers, solve report, and the reason if there is no lift."""

from __future__ import annotations

import os
import platform
import time
from functools import cache
from typing import Any, Final

from human_model.report import SolveStatus
from lift_predictor.core.options import SPATIAL
from lift_predictor.core.planning.planned_lift import PlannedLift
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.planning.summary import summarise
from lift_predictor.core.study.cases import Case

CRASHED: Final = -1
"""Status of a row whose case ended with an exception or with its process; `message` says how."""

COLUMNS: Final[dict[str, str]] = {
    'case_id': 'string', 'subject': 'string', 'sex': 'string', 'body_mass': 'double',
    'stature': 'double', 'age': 'double', 'strength_z': 'double', 'task': 'string',
    'technique': 'string', 'end_posture': 'string', 'asked_mass': 'double',
    'box_depth': 'double', 'start_forward': 'double', 'start_left': 'double',
    'start_up': 'double', 'end_forward': 'double', 'end_left': 'double', 'end_up': 'double',
    'weight_effort': 'double', 'weight_box': 'double', 'model': 'string', 'status': 'int64',
    'status_name': 'string', 'message': 'string',
    'iterations': 'int64', 'objective': 'double', 'primal_residual': 'double',
    'dual_residual': 'double', 'build_time': 'double', 'solve_time': 'double',
    'case_time': 'double', 'runs': 'int64', 'box_mass': 'double', 'effort': 'double',
    'duration': 'double', 'feet_forward': 'double', 'feet_left': 'double',
    'feet_heading': 'double', 'technique_index': 'double',
    'peak_vertical_force': 'double', 'largest_share': 'double', 'largest_share_joint': 'string',
    'binding': 'string', 'worst_violation': 'string', 'host': 'string', 'process': 'int64',
}  # fmt: skip
"""Columns of a study's table and their types; null: not known, as without a lift. Units: kg, m, s,
N, years, rad; `model` is plane or space; `largest_share` is the largest torque by its limit;
`binding` and `worst_violation` are separated by semicolons."""


@cache
def _planner() -> LiftPlanner:
    """One planner a process: its functions are loaded once."""
    return LiftPlanner()


def solve_case(data: dict[str, Any]) -> dict[str, Any]:
    """Solve one case; whatever happens, there is a row.

    Parameters
    ----------
    data : dict
        `Case.to_dict`.

    Returns
    -------
    dict
        One value for each of `COLUMNS`.
    """
    begin = time.perf_counter()
    case = Case.from_dict(data)
    row = empty_row(case)
    try:
        planned = _planner().plan(case.subject, case.task, weighting=case.weighting)
        row |= _of_plan(planned)
    except Exception as error:  # a defect of one case must not cost the others: it is a row
        row |= crashed(f'{type(error).__name__}: {error}')
    row['case_time'] = time.perf_counter() - begin
    row['host'], row['process'] = platform.node(), os.getpid()
    return row


def empty_row(case: Case) -> dict[str, Any]:
    """Return the row of a case that was not solved yet."""
    subject, task, weighting = case.subject, case.task, case.weighting
    row: dict[str, Any] = dict.fromkeys(COLUMNS)
    return row | {
        'case_id': case.case_id,
        'subject': subject.pseudonym,
        'sex': subject.sex,
        'body_mass': subject.mass,
        'stature': subject.stature,
        'age': subject.age,
        'strength_z': subject.strength_z,
        'task': task.name,
        'technique': task.technique,
        'end_posture': task.end_posture,
        'asked_mass': task.box_mass,
        'box_depth': task.box_size[0],
        'start_forward': task.start[0],
        'start_left': task.start[1],
        'start_up': task.start[2],
        'end_forward': task.end[0],
        'end_left': task.end[1],
        'end_up': task.end[2],
        'weight_effort': None if weighting is None else weighting.effort,
        'weight_box': None if weighting is None else weighting.box,
    }


def crashed(message: str) -> dict[str, Any]:
    """Return the part of a row that says that its case did not come to an end."""
    return {'status': CRASHED, 'status_name': 'CRASHED', 'message': message}


def _of_plan(planned: PlannedLift) -> dict[str, Any]:
    report, verification = planned.report, planned.prediction.verification
    status = SolveStatus(report.status)
    row: dict[str, Any] = {
        'model': 'space' if planned.prediction.model == SPATIAL else 'plane',
        'status': int(status),
        'status_name': status.name,
        'message': report.message,
        'iterations': report.iterations,
        'objective': report.objective,
        'primal_residual': report.primal_residual,
        'dual_residual': report.dual_residual,
        'build_time': report.build_time,
        'solve_time': report.solve_time,
        'runs': len(planned.prediction.runs),
    }
    if verification is not None:
        row['worst_violation'] = '; '.join(
            f'{name} {value:.2g}' for name, value in verification.violation.items()
        )
    summary = summarise(planned)
    if summary is None:
        return row
    worst = max(summary.peaks, key=lambda peak: peak.share)
    return row | {
        'box_mass': summary.box_mass,
        'effort': summary.effort,
        'duration': summary.duration,
        'feet_forward': summary.ankle,
        'feet_left': summary.left,
        'feet_heading': summary.heading,
        'technique_index': summary.technique_index,
        'peak_vertical_force': summary.peak_vertical_force,
        'largest_share': worst.share,
        'largest_share_joint': worst.joint,
        'binding': '; '.join(summary.active_constraints),
    }
