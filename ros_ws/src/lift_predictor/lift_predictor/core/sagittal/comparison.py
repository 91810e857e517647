# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""How far the recorded lift is from the predicted one (tables 2.4 and 2.5)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.sagittal.evaluation import SagittalLoads, evaluate
from lift_predictor.core.sagittal.parameters import JOINTS
from lift_predictor.core.sagittal.report_function import ReportFunction
from lift_predictor.core.sagittal.task import LiftTask2D

COMPARED_JOINTS: Final = ('spine', 'shoulder', 'elbow', 'hip', 'knee', 'ankle')
"""The dissertation's names of `parameters.JOINTS`, in the same order."""


@dataclass(frozen=True)
class LiftComparison:
    """Recorded against predicted lift over normalised time.

    Attributes
    ----------
    joint_rmse : array, shape (6,)
        Of `COMPARED_JOINTS` [deg].
    joint_pearson : array, shape (6,)
        Pearson r; NaN where a curve is constant.
    vertical_force_rmse, horizontal_force_rmse : float
        Ground reaction of both feet [N].
    vertical_force_pearson, horizontal_force_pearson : float
        Pearson r.
    measured_effort, predicted_effort : float
        Integral of the squared normalised torques by the same model (first term of equation 2.11)
        [s].
    time : array, shape (n,)
        Samples of the recorded lift from its start [s].
    measured : SagittalLoads
        Torques and limits of the recorded lift by the same model at these samples.
    """

    joint_rmse: Array
    joint_pearson: Array
    vertical_force_rmse: float
    vertical_force_pearson: float
    horizontal_force_rmse: float
    horizontal_force_pearson: float
    measured_effort: float
    predicted_effort: float
    time: Array
    measured: SagittalLoads


def compare(
    report: ReportFunction,
    task: LiftTask2D,
    predicted_time: Array,
    predicted_q: Array,
    predicted_loads: SagittalLoads,
    predicted_effort: float,
) -> LiftComparison:
    """Compare the recorded lift of a task with its prediction.

    Parameters
    ----------
    report : ReportFunction
        `LiftOptimiser.report`.
    task : LiftTask2D
        Holds the recorded lift.
    predicted_time : array, shape (m,)
        From the start of the lift [s].
    predicted_q : array, shape (m, 6)
        [rad].
    predicted_loads : SagittalLoads
        At the same samples.
    predicted_effort : float
        Objective of the prediction [s].

    Raises
    ------
    TaskError
        A planned lift.
    """
    recorded = task.measured
    if recorded is None:
        raise TaskError(f'{task.lift_id}: nothing was recorded to compare with')
    loads = evaluate(report, recorded.q, recorded.dq, recorded.ddq, task.parameters)

    def at_recorded(values: Array) -> Array:
        return np.stack([np.interp(recorded.time, predicted_time, v) for v in values.T], axis=1)

    angles = at_recorded(predicted_q)
    forces = at_recorded(predicted_loads.ground_force)
    rmse = [rms_difference(recorded.q[:, j], angles[:, j]) for j in range(len(JOINTS))]
    r = [pearson(recorded.q[:, j], angles[:, j]) for j in range(len(JOINTS))]
    measured_force = recorded.ground_force
    return LiftComparison(
        joint_rmse=np.degrees(rmse),
        joint_pearson=np.array(r),
        vertical_force_rmse=rms_difference(measured_force[:, 1], forces[:, 1]),
        vertical_force_pearson=pearson(measured_force[:, 1], forces[:, 1]),
        horizontal_force_rmse=rms_difference(measured_force[:, 0], forces[:, 0]),
        horizontal_force_pearson=pearson(measured_force[:, 0], forces[:, 0]),
        measured_effort=float(np.trapezoid(loads.effort, recorded.time)),
        predicted_effort=predicted_effort,
        time=recorded.time,
        measured=loads,
    )


def rms_difference(a: Array, b: Array) -> float:
    """Root mean square difference of two curves."""
    return float(np.sqrt(np.mean((a - b) ** 2)))


def pearson(a: Array, b: Array) -> float:
    """Pearson correlation coefficient; NaN if a curve is constant."""
    da, db = a - a.mean(), b - b.mean()
    scale = float(np.linalg.norm(da) * np.linalg.norm(db))
    return float(da @ db) / scale if scale > 0.0 else float('nan')
