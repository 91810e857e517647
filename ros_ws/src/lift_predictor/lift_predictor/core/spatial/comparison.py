# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""How far the recorded lift is from the predicted one (figures 3.4, 5.3 to 5.5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from lift_predictor.core.sagittal.comparison import pearson, rms_difference
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.spatial.evaluation import SpatialLoads, evaluate
from lift_predictor.core.spatial.parameters import STRONG
from lift_predictor.core.spatial.prediction import PredictedLift3D
from lift_predictor.core.spatial.task import KEY_JOINTS, SpatialTask

DERIVATIVE_DEGREE = 5


@dataclass(frozen=True, eq=False)
class SpatialComparison:
    """Recorded against predicted lift over normalised time.

    Attributes
    ----------
    joint_names : tuple of str
        `task.KEY_JOINTS`.
    joint_rmse : array, shape (12,)
        [deg].
    joint_pearson : array, shape (12,)
        Pearson r; NaN where a curve is constant.
    foot_force_rmse : array, shape (2,)
        Vertical ground reaction of right and left foot [N].
    foot_force_pearson : array, shape (2,)
        Pearson r.
    vertical_force_rmse, horizontal_force_rmse : float
        Ground reaction of both feet, up and forward [N].
    vertical_force_pearson, horizontal_force_pearson : float
        Pearson r.
    measured_effort, predicted_effort : float
        Integral of the squared normalised torques by the same model (first term of equation 3.9)
        [s].
    time : array, shape (n,)
        Samples of the recorded lift from its start [s].
    torque_names : tuple of str
        `parameters.STRONG`.
    measured : SpatialLoads
        Torques and limits of the recorded lift by the same model at these samples.
    """

    joint_names: tuple[str, ...]
    joint_rmse: Array
    joint_pearson: Array
    foot_force_rmse: Array
    foot_force_pearson: Array
    vertical_force_rmse: float
    horizontal_force_rmse: float
    vertical_force_pearson: float
    horizontal_force_pearson: float
    measured_effort: float
    predicted_effort: float
    time: Array
    torque_names: tuple[str, ...]
    measured: SpatialLoads


def compare(
    library: NodeLibrary, task: SpatialTask, predicted: PredictedLift3D
) -> SpatialComparison:
    """Compare the recorded lift of a task with its prediction.

    Parameters
    ----------
    library : NodeLibrary
        Functions.
    task : SpatialTask
        Holds the recorded lift.
    predicted : PredictedLift3D
        With data.
    """
    # Loads for long, and a node that starts does not need it.
    from scipy.interpolate import make_interp_spline

    recorded, lift, own = task.recorded, predicted.lift, predicted.loads
    assert recorded is not None and lift is not None and own is not None
    spline = make_interp_spline(recorded.time, recorded.q, k=DERIVATIVE_DEGREE)
    loads = evaluate(
        library,
        recorded.q,
        spline(recorded.time, nu=1),
        spline(recorded.time, nu=2),
        predicted.box_mass,
        task.parameters,
    )
    motion = lift.motion
    # Both from start to end: the duration may differ.
    at = recorded.time / recorded.time[-1] * predicted.duration + motion.time[0]

    def there(values: Array) -> Array:
        return np.asarray(np.interp(at, motion.time, values))

    angles = [(recorded.key[name], there(motion.coordinate(name))) for name in KEY_JOINTS]
    feet = [(recorded.vertical[:, k], there(own.ground_force[:, k, 2])) for k in range(2)]
    vertical = recorded.vertical.sum(axis=1), there(own.ground_force[:, :, 2].sum(axis=1))
    forward = recorded.forward, there(own.ground_force[:, :, 0].sum(axis=1))
    sampled = motion.time - motion.time[0]
    return SpatialComparison(
        joint_names=KEY_JOINTS,
        joint_rmse=np.degrees([rms_difference(*pair) for pair in angles]),
        joint_pearson=np.array([pearson(*pair) for pair in angles]),
        foot_force_rmse=np.array([rms_difference(*pair) for pair in feet]),
        foot_force_pearson=np.array([pearson(*pair) for pair in feet]),
        vertical_force_rmse=rms_difference(*vertical),
        horizontal_force_rmse=rms_difference(*forward),
        vertical_force_pearson=pearson(*vertical),
        horizontal_force_pearson=pearson(*forward),
        measured_effort=float(np.trapezoid(loads.effort, recorded.time)),
        predicted_effort=float(np.trapezoid(own.effort, sampled)),
        time=recorded.time,
        torque_names=STRONG,
        measured=loads,
    )
