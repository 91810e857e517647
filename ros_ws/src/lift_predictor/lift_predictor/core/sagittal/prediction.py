# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The result of a prediction: motion, torques, and the certificate of the optimum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.motion import Lift
from human_model.report import SolveReport
from human_model.typing import Array
from lift_predictor.core.nearest_lift import NearestLift
from lift_predictor.core.sagittal.parameters import JOINTS
from lift_predictor.core.sagittal.verify import Verification
from lift_predictor.core.solvers.solver_run import SolverRun

TORQUE_NAMES: Final = (*JOINTS, 'mtp_angle')


@dataclass(frozen=True, eq=False)
class PredictedLift2D:
    """Result of one prediction; without a good solution it holds the report only.

    Attributes
    ----------
    lift_id : str
        Of the recorded lift.
    box_mass, duration : float
        [kg], [s].
    report : SolveReport
        Status 0: good data.
    lift : Lift or None
        The predicted motion on the 2D skeleton, Cartesian values in the laboratory.
    torque_names : tuple of str
        `TORQUE_NAMES`.
    torque, torque_lower, torque_upper : array, shape (n, 7)
        Joint torques and dynamic limits, both limbs together [N m].
    zmp : array, shape (n,)
        Zero-moment point along the sagittal plane [m].
    support : array, shape (2,)
        Rear and front edge of the foot support region along the plane [m].
    optima : tuple of SolverRun
        All runs, the one kept first; `optima[0].start` names the start that won.
    verification : Verification or None
        Dense-grid check.
    notes : tuple of str
        Adaptations of the task, and how the functions were run.
    nearest : NearestLift or None
        The nearest feasible lift, where the task is infeasible and there is one.
    """

    lift_id: str
    box_mass: float
    duration: float
    report: SolveReport
    lift: Lift | None
    torque_names: tuple[str, ...]
    torque: Array
    torque_lower: Array
    torque_upper: Array
    zmp: Array
    support: Array
    optima: tuple[SolverRun, ...]
    verification: Verification | None
    notes: tuple[str, ...]
    nearest: NearestLift[PredictedLift2D] | None = None

    @classmethod
    def failed(
        cls,
        lift_id: str,
        box_mass: float,
        duration: float,
        report: SolveReport,
        optima: tuple[SolverRun, ...] = (),
        verification: Verification | None = None,
        notes: tuple[str, ...] = (),
    ) -> PredictedLift2D:
        """Make a result that carries a report and no data."""
        none = np.zeros((0, len(TORQUE_NAMES)))
        return cls(
            lift_id, box_mass, duration, report, None, TORQUE_NAMES, none, none, none,
            np.zeros(0), np.full(2, np.nan), optima, verification, notes,
        )  # fmt: skip
