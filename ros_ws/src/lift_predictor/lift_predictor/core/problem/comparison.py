# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Distance of the recorded lift from the predicted one (tables 2.4, 2.5; figures 3.4, 5.3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from human_model.typing import Array
from lift_predictor.core.problem.loads import Loads


class Pair(NamedTuple):
    """A recorded and a predicted curve at the same instants, shape (n,) each."""

    recorded: Array
    predicted: Array


@dataclass(frozen=True, eq=False)
class ComparedCurves:
    """Curves of a recorded lift and of its prediction.

    Attributes
    ----------
    joints : dict of Pair
        Joint angles by name [rad].
    feet : tuple of Pair
        Vertical ground reaction of right and left foot [N]; empty: not known by foot.
    vertical, horizontal : Pair
        Ground reaction of both feet [N].
    time : ndarray, shape (n,)
        Samples of the recorded lift from its start [s].
    torque_names : tuple of str
        Columns of the loads' torques.
    recorded_loads : Loads
        Torques, limits and effort of the recorded lift by the same model at these samples.
    predicted_effort : float
        Effort of the prediction [s].
    """

    joints: dict[str, Pair]
    feet: tuple[Pair, ...]
    vertical: Pair
    horizontal: Pair
    time: Array
    torque_names: tuple[str, ...]
    recorded_loads: Loads
    predicted_effort: float


@dataclass(frozen=True, eq=False)
class LiftComparison:
    """Recorded against predicted lift over normalised time.

    Attributes
    ----------
    joint_names : tuple of str
        Compared joints.
    joint_rmse, joint_pearson : ndarray, shape (n_joints,)
        Root mean square difference [deg], Pearson r; NaN where a curve is constant.
    foot_force_rmse, foot_force_pearson : ndarray, shape (2,) or (0,)
        Vertical ground reaction of right and left foot [N], Pearson r.
    vertical_force_rmse, horizontal_force_rmse : float
        Ground reaction of both feet, up and forward [N].
    vertical_force_pearson, horizontal_force_pearson : float
        Pearson r.
    measured_effort, predicted_effort : float
        Integral of the squared normalised torques by the same model (first term of equations 2.11
        and 3.9) [s].
    time : ndarray, shape (n,)
        Samples of the recorded lift from its start [s].
    torque_names : tuple of str
        Columns of `measured.torque`.
    measured : Loads
        Torques and limits of the recorded lift by the same model at these samples.
    """

    joint_names: tuple[str, ...]
    joint_rmse: Array
    joint_pearson: Array
    foot_force_rmse: Array
    foot_force_pearson: Array
    vertical_force_rmse: float
    vertical_force_pearson: float
    horizontal_force_rmse: float
    horizontal_force_pearson: float
    measured_effort: float
    predicted_effort: float
    time: Array
    torque_names: tuple[str, ...]
    measured: Loads


def compare(curves: ComparedCurves) -> LiftComparison:
    """Compare a recorded lift with its prediction."""
    joints = curves.joints.values()
    return LiftComparison(
        joint_names=tuple(curves.joints),
        joint_rmse=np.degrees([rms_difference(*pair) for pair in joints]),
        joint_pearson=np.array([pearson(*pair) for pair in joints]),
        foot_force_rmse=np.array([rms_difference(*pair) for pair in curves.feet]),
        foot_force_pearson=np.array([pearson(*pair) for pair in curves.feet]),
        vertical_force_rmse=rms_difference(*curves.vertical),
        vertical_force_pearson=pearson(*curves.vertical),
        horizontal_force_rmse=rms_difference(*curves.horizontal),
        horizontal_force_pearson=pearson(*curves.horizontal),
        measured_effort=float(np.trapezoid(curves.recorded_loads.effort, curves.time)),
        predicted_effort=curves.predicted_effort,
        time=curves.time,
        torque_names=curves.torque_names,
        measured=curves.recorded_loads,
    )


def rms_difference(a: Array, b: Array) -> float:
    """Root mean square difference of two curves."""
    return float(np.sqrt(np.mean((a - b) ** 2)))


def pearson(a: Array, b: Array) -> float:
    """Pearson correlation coefficient; NaN if a curve is constant."""
    da, db = a - a.mean(), b - b.mean()
    scale = float(np.linalg.norm(da) * np.linalg.norm(db))
    return float(da @ db) / scale if scale > 0.0 else float('nan')
