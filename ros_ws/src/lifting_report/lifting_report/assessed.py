# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Assessment messages, live or decoded from a file, as parts of the report."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from injury_monitor import conversions
from injury_monitor.core.assessment import Criterion
from injury_monitor.core.exceptions import InjuryMonitorError
from injury_monitor.core.limits import Zone
from injury_monitor.core.rnle_assessment import assess_lifting
from lifting_report.report_data import Lifting, Missing, Risk


def risk_from_assessment(message: Any) -> Risk:
    """Return the assessment with the joint or muscle that each index belongs to.

    Parameters
    ----------
    message : RiskAssessment
        Of ``lifting_interfaces``, or decoded with the same fields.
    """
    columns = (
        message.criterion,
        message.source,
        message.value,
        message.limit,
        message.margin,
        message.unit,
        message.limit_source,
        message.time_from_start,
    )
    rows = []
    for name, source, value, limit, margin, unit, limit_source, time in zip(*columns, strict=True):
        rows.append(
            Criterion(
                name,
                source,
                float(value),
                float(limit),
                float(margin),
                unit,
                limit_source,
                float(time),
                float(value) / message.body_mass if unit == 'N' else math.nan,
                _detail(message, name, source),
            )
        )
    return Risk(
        tuple(rows),
        float(message.avoidable_compression),
        float(message.avoidable_shear),
        Zone(message.zone).name.lower(),
        message.summary,
        int(message.samples_left_out),
    )


def _detail(message: Any, criterion: str, source: str) -> str:
    if criterion == 'activation_index' and source == 'measured':
        return str(message.activation_index_muscle)
    if criterion == 'torque_index':
        peaks = np.asarray(getattr(message, f'torque_index_{source}'), np.float64)
        if np.any(np.isfinite(peaks)):
            return str(message.torque_index_joints[int(np.nanargmax(peaks))])
    return ''


def lifting_from_assessment(
    message: Any, subject: Any, task: Any, measured_lift: Any
) -> Lifting | Missing:
    """Return the lifting equation of an assessment with the task variables behind it.

    Parameters
    ----------
    message : RiskAssessment
    subject, task, measured_lift : Subject, Task, MeasuredLift
        From which the task variables are formed as the injury monitor forms them; a difference
        to the index of the message would be a defect and leaves the variables out.
    """
    if math.isnan(message.lifting_index):
        return Missing(message.lifting_index_note or 'no reason was given')
    return Lifting(
        tuple(float(value) for value in message.multipliers),
        float(message.recommended_weight_limit),
        float(message.lifting_index),
        message.limiting_multiplier,
        '',
        _variables(float(message.lifting_index), subject, task, measured_lift),
    )


def _variables(index: float, subject: Any, task: Any, measured_lift: Any) -> dict[str, str]:
    try:
        assessed = assess_lifting(
            conversions.assignment_from_msg(subject, task),
            conversions.ends_from_msg(measured_lift),
        )
    except InjuryMonitorError as error:
        return {'task variables': f'not available: {error}'}
    result = assessed.result()
    if result is None or not math.isclose(assessed.lifting_index, index, rel_tol=1e-6):
        return {'task variables': 'not those of this index'}
    task_variables = result.task
    return {
        'end': assessed.governing,
        'H [cm]': f'{task_variables.horizontal:.0f}',
        'V [cm]': f'{task_variables.vertical:.0f}',
        'D [cm]': f'{task_variables.distance:.0f}',
        'A [deg]': f'{task_variables.asymmetry:.0f}',
        'F [1/min]': f'{task_variables.lifts_per_minute:g}',
        'coupling': task_variables.coupling.name.lower(),
    }
