# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Settings and results of the inverse kinematics."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from human_model.report import SolveStatus
from human_model.typing import Array


@dataclass(frozen=True)
class IKSettings:
    """Weights and limits of the fit.

    Attributes
    ----------
    neutral_weight : float
        Of the neutral posture [m^2/rad^2].
    spine_weight, blind_spine_weight : float
        Of the lumbar rhythm [m^2/rad^2] with and without a marker on the lumbar segment; the
        first is the ratio of the variances of a trunk marker (5 mm of soft tissue, weight 2) and
        of the departure from the rhythm (4 deg).
    unobserved_weight : float
        Of the previous value of a coordinate that the markers of this frame do not determine
        [m^2/rad^2].
    observed_curvature : float
        A coordinate counts as observed when the curvature of the fit about it, all others free to
        follow, exceeds this [m^2/rad^2]: a marker 3 cm off the axis.
    max_residual, rms_residual : float
        A frame whose largest or root mean square distance exceeds this is not good data [m].
    max_iterations : int
    tolerance : float
        Largest last step of a converged fit [rad or m].
    """

    neutral_weight: float = 1e-5
    spine_weight: float = 1e-2
    blind_spine_weight: float = 0.3
    unobserved_weight: float = 1e-2
    observed_curvature: float = 1e-3
    max_residual: float = 0.08
    rms_residual: float = 0.03
    max_iterations: int = 100
    tolerance: float = 1e-7


@dataclass(frozen=True, eq=False)
class IKSolution:
    """Fit of one frame.

    Attributes
    ----------
    q : ndarray (n_q,)
        Joint coordinates [rad or m].
    residuals : ndarray (n_markers,)
        Distance of each marker from the model [m]; NaN where not seen or not used.
    rms, maximum : float
        Of the residuals [m]; NaN without markers.
    used : int
        Markers used.
    unobserved : tuple of str
        Coordinates that the markers of this frame do not determine.
    rejected : tuple of str
        Markers left out as swapped or wrongly labelled.
    status : SolveStatus
    message : str
        Names what is wrong; empty when nothing is.
    iterations : int
    objective, stationarity : float
        Final value [m^2] and largest free gradient component.
    """

    q: Array
    residuals: Array
    rms: float
    maximum: float
    used: int
    unobserved: tuple[str, ...]
    rejected: tuple[str, ...]
    status: SolveStatus
    message: str
    iterations: int
    objective: float
    stationarity: float

    @property
    def ok(self) -> bool:
        """Whether the frame is good data."""
        return self.status is SolveStatus.OK


@dataclass(frozen=True, eq=False)
class Observed:
    """Coordinates that a set of markers determines.

    Attributes
    ----------
    unobserved : ndarray of bool, shape (n_q,)
        Coordinates that the set does not determine although the full set does.
    names : tuple of str
        Names of the unobserved coordinates.
    lost : bool
        Whether the position or orientation of the pelvis is among them.
    prior_weight : ndarray (n_q,)
        Weight that draws each coordinate to its prior [m^2/rad^2].
    """

    unobserved: npt.NDArray[np.bool_]
    names: tuple[str, ...]
    lost: bool
    prior_weight: Array
