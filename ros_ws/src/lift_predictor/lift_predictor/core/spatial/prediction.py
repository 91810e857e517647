# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The result of a spatial prediction: motion, torques, and the certificate of the optimum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from human_model.motion import Lift
from human_model.report import SolveReport
from human_model.typing import Array
from lift_predictor.core.nearest_lift import NearestLift
from lift_predictor.core.solvers.solution import Solution
from lift_predictor.core.spatial.evaluation import SpatialLoads
from lift_predictor.core.spatial.parameters import N_SCALARS, N_SPLINED
from lift_predictor.core.spatial.verify import SpatialVerification

HANDS: Final = ('(3.11)', '(3.12)', '(3.13)')
"""Equations that say where the hands are, as rows name them."""


@dataclass(frozen=True, eq=False)
class SpatialOptimum:
    """Where the solver ended from one start.

    Attributes
    ----------
    start : str
        Name of the start.
    solution : Solution
        Variables: free control values, box mass, duration.
    """

    start: str
    solution: Solution

    @property
    def converged(self) -> bool:
        """Whether it is a solution."""
        return self.solution.ok

    @property
    def violated(self) -> str:
        """Name of the limit that is violated most; empty: none.

        Places of the hands (3.11 to 3.13) are the task: they count where no limit is violated.
        """
        names = [name for name, _ in self.solution.violated]
        limits = [name for name in names if not any(eq in name for eq in HANDS)]
        return limits[0] if limits else 'reach of the hands' if names else ''


@dataclass(frozen=True, eq=False)
class PredictedLift3D:
    """Result of one prediction; without a good solution it holds the report only.

    Attributes
    ----------
    lift_id : str
        Of the lift.
    box_mass, duration : float
        [kg], [s].
    report : SolveReport
        Status 0: good data.
    lift : Lift or None
        The predicted motion on the 3D skeleton, in the laboratory.
    torque_names : tuple of str
        All joints of the skeleton.
    torque, torque_lower, torque_upper : array, shape (n, 34)
        Joint torques and dynamic limits [N m].
    zmp : array, shape (n,)
        Zero-moment point along the mean direction of the feet, from between the ankles [m].
    support : array, shape (2,)
        Rear and front edge of the feet along the same direction [m].
    loads : SpatialLoads or None
        The same by the model, in the stance frame.
    optima : tuple of SpatialOptimum
        All runs, the one kept first.
    verification : SpatialVerification or None
        Dense-grid check.
    notes : tuple of str
        Adaptations of the task, and how the functions were run.
    nearest : NearestLift or None
        What can be done instead of an infeasible task, if anything.
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
    loads: SpatialLoads | None
    optima: tuple[SpatialOptimum, ...]
    verification: SpatialVerification | None
    notes: tuple[str, ...]
    nearest: NearestLift[PredictedLift3D] | None = None

    @property
    def control(self) -> Array:
        """Free control values (n_free, 26) of the run that was kept."""
        return self.optima[0].solution.x[:-N_SCALARS].reshape(-1, N_SPLINED)

    @classmethod
    def failed(
        cls,
        lift_id: str,
        box_mass: float,
        duration: float,
        report: SolveReport,
        optima: tuple[SpatialOptimum, ...] = (),
        verification: SpatialVerification | None = None,
        notes: tuple[str, ...] = (),
    ) -> PredictedLift3D:
        """Make a result that carries a report and no data."""
        none = np.zeros((0, 0))
        return cls(
            lift_id, box_mass, duration, report, None, (), none, none, none, np.zeros(0),
            np.full(2, np.nan), None, optima, verification, notes,
        )  # fmt: skip
