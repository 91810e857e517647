# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of a prediction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.sagittal.grid import Grid
from lift_predictor.core.sagittal.person import COEFFICIENT_SET
from lift_predictor.core.sagittal.task import POSTURE_TOLERANCE

if TYPE_CHECKING:
    # It imports CasADi, which a lift in the plane does without.
    from lift_predictor.core.spatial.predictor import SpatialOptions

MORE_CONTROL: Final = 2
"""Control points more with rest in acceleration, which merges one more at each end: as many values
remain free."""
IN_THE_PLANE: Final = "static_ends: 'acceleration' is known in the sagittal plane only"


@dataclass(frozen=True)
class PredictorOptions:
    """Settings of the prediction.

    Attributes
    ----------
    n_control : int
        Control points per joint.
    n_nodes : int
        Time nodes; see `nlp.Grid`.
    posture_tolerance : float
        Epsilon of equation 4.8 [rad].
    coefficient_set : str
        Published strength data, a name of `human_model.strength.coefficient_sets`.
    time_limit : float
        Wall time of one run at most, and time after which none is begun any more [s]: a last
        resort, as runs are limited by their iterations.
    refinements : int
        How often the lift is solved again with a margin when the dense grid shows a violation;
        where that does not help, it is solved with more nodes.
    static_ends : str
        What is zero at start and end: 'velocity' (equation 4.7), or 'acceleration' as well, with
        `MORE_CONTROL` more control points; in the sagittal plane only.
    dimension : str
        '2d', '3d', or 'auto': asymmetric lifts on the 3D skeleton are predicted in space.

    Raises
    ------
    TaskError
        Rest in acceleration in space.
    """

    n_control: int = 7
    n_nodes: int = 25
    posture_tolerance: float = POSTURE_TOLERANCE
    coefficient_set: str = COEFFICIENT_SET
    time_limit: float = 10.0
    refinements: int = 6
    static_ends: str = 'velocity'
    dimension: str = 'auto'

    def __post_init__(self) -> None:
        """Refuse what does not fit together."""
        if self.dimension == '3d' and self.static_ends != 'velocity':
            raise TaskError(f"{IN_THE_PLANE}, and dimension is '3d'")

    @property
    def grid(self) -> Grid:
        """Sizes of the sagittal programme.

        Raises
        ------
        SplineError
            Numbers of control points and nodes that do not fit.
        """
        more = MORE_CONTROL if self.static_ends == 'acceleration' else 0
        return Grid(self.n_control + more, self.n_nodes, self.static_ends)

    @property
    def spatial(self) -> SpatialOptions:
        """The same settings for lifts in space; recorded postures have the windows of 3.15.

        Raises
        ------
        TaskError
            Rest in acceleration.
        """
        from lift_predictor.core.spatial.predictor import SpatialOptions

        if self.static_ends != 'velocity':
            raise TaskError(f'{IN_THE_PLANE}, and this lift is predicted in space')
        return SpatialOptions(
            n_control=self.n_control,
            n_nodes=self.n_nodes,
            coefficient_set=self.coefficient_set,
            time_limit=max(self.time_limit, SpatialOptions.time_limit),
            refinements=max(self.refinements, SpatialOptions.refinements),
        )
