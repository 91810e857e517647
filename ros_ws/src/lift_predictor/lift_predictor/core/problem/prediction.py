# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The result of a prediction: motion, torques, and the certificate of the optimum."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from human_model.motion import Lift
from human_model.report import SolveReport
from human_model.typing import Array
from lift_predictor.core.problem.comparison import LiftComparison
from lift_predictor.core.problem.run import SolverRun
from lift_predictor.core.problem.verification import Verification


def _no_data() -> Array:
    return np.zeros((0, 0))


@dataclass(frozen=True, eq=False, kw_only=True)
class Prediction:
    """Result of one prediction; without a good solution it holds the report and the runs only.

    Attributes
    ----------
    model : str
        'sagittal' or 'spatial'.
    lift_id : str
        Name of the lift.
    box_mass, duration : float
        [kg], [s].
    report : SolveReport
        Status 0: good data.
    lift : Lift or None
        The predicted motion on the model's skeleton, in the laboratory.
    torque_names : tuple of str
        Joint coordinates.
    torque, torque_lower, torque_upper : ndarray, shape (n, n_joints)
        Joint torques and dynamic limits [N m]; of both limbs together in the sagittal model.
    zmp : ndarray, shape (n,)
        Zero-moment point along the mean direction of the feet [m]: from the laboratory's origin in
        the sagittal model, from between the ankles in the spatial one.
    support : ndarray, shape (2,)
        Rear and front edge of the feet along the same direction [m].
    ground_force : ndarray, shape (n, 2 or 2, 3)
        Ground reaction in the model's axes [N]: of both feet, or of right and left foot.
    effort, sampled_effort : float
        Integral of the squared normalised torques (first term of equations 2.11 and 3.9) [s], by
        the rule of the model and by the trapezoidal rule over the samples of the lift.
    active_constraints : tuple of str
        Limits that hold the objective back, the strongest first.
    runs : tuple of SolverRun
        All runs of the solver, the one that was kept first.
    verification : Verification or None
        Check between the nodes.
    notes : tuple of str
        Adaptations of the task, and the backend of the functions.
    comparison : LiftComparison or None
        With the recorded lift, where there is one.
    nearest : NearestLift or None
        The nearest feasible lift, where the task is infeasible and there is one.
    """

    model: str
    lift_id: str
    box_mass: float
    duration: float
    report: SolveReport
    lift: Lift | None = None
    torque_names: tuple[str, ...] = ()
    torque: Array = field(default_factory=_no_data)
    torque_lower: Array = field(default_factory=_no_data)
    torque_upper: Array = field(default_factory=_no_data)
    zmp: Array = field(default_factory=lambda: np.zeros(0))
    support: Array = field(default_factory=lambda: np.full(2, np.nan))
    ground_force: Array = field(default_factory=_no_data)
    effort: float = float('nan')
    sampled_effort: float = float('nan')
    active_constraints: tuple[str, ...] = ()
    runs: tuple[SolverRun, ...] = ()
    verification: Verification | None = None
    notes: tuple[str, ...] = ()
    comparison: LiftComparison | None = None
    nearest: NearestLift | None = None


@dataclass(frozen=True, eq=False)
class NearestLift:
    """The nearest feasible lift of an infeasible task.

    Attributes
    ----------
    limit : str
        Name of the first constraint to become infeasible.
    change : str
        Difference from the task, in words.
    prediction : Prediction
        The changed lift, solved and checked.
    """

    limit: str
    change: str
    prediction: Prediction
