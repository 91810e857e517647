# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of a prediction, and the choice of the model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from lift_predictor.core.exceptions import TaskError

SAGITTAL: Final = 'sagittal'
SPATIAL: Final = 'spatial'
MODELS: Final = {'2d': SAGITTAL, '3d': SPATIAL}
"""Models by the value of the parameter `dimension`."""
COEFFICIENT_SET: Final = 'anderson2007_nonneg'
POSTURE_TOLERANCE: Final = 0.15
"""Epsilon of equation 4.8 [rad]."""
_SAGITTAL_ONLY: Final = "static_ends: 'acceleration' is known in the sagittal plane only"


@dataclass(frozen=True)
class Windows:
    """Distance of a spatial prediction from the recorded lift at most; infinite: no window.

    Attributes
    ----------
    posture_ends, posture_middle : float
        Epsilon of equation 3.15 at start and end, and at half time [rad].
    ground : float
        Of the vertical ground reaction of each foot [N] (equations 3.16: 40 N, 5.1: 50 N).
    ground_at : tuple of float
        Times of it, as fractions of the lift (5.1: start, middle, end; 3.16 also the thirds).
    duration : tuple of float
        Least and largest duration, as fractions of the recorded one; equal: given.
    """

    posture_ends: float = float(np.radians(10.0))
    posture_middle: float = float(np.radians(5.0))
    ground: float = 50.0
    ground_at: tuple[float, ...] = (0.0, 0.5, 1.0)
    duration: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True)
class PredictorOptions:
    """Settings of a prediction.

    Attributes
    ----------
    n_control : int
        Control points per joint.
    n_nodes : int
        Time nodes; see `problem.grid.TimeGrid`.
    posture_tolerance : float
        Epsilon of equation 4.8 [rad]; sagittal model.
    coefficient_set : str
        Published strength data, a name of `human_model.strength.coefficient_sets`.
    time_limit : float
        Wall time of one run at most, and time after which no run begins [s]: a last resort, as
        runs are limited by their iterations. The spatial model has `SPATIAL_TIME_LIMIT` at least.
    refinements : int
        Solves with a margin at most, where the dense grid shows a violation.
    static_ends : str
        Derivative that is zero at start and end: 'velocity' (equation 4.7), or 'acceleration' as
        well, with `MORE_CONTROL` more control points; sagittal model only.
    dimension : str
        '2d', '3d', or 'auto': asymmetric lifts on the 3D skeleton are predicted by the spatial
        model.
    windows : Windows
        Distance from a recorded lift; spatial model.
    basin_hops : int
        Runs from the best solution, displaced, in search of a better one; spatial model.

    Raises
    ------
    TaskError
        Rest in acceleration with the spatial model.
    """

    SPATIAL_TIME_LIMIT: Final = 30.0
    MORE_CONTROL: Final = 2
    """Control points more with rest in acceleration, which merges one more at each end: as many
    values remain free."""

    n_control: int = 7
    n_nodes: int = 25
    posture_tolerance: float = POSTURE_TOLERANCE
    coefficient_set: str = COEFFICIENT_SET
    time_limit: float = 10.0
    refinements: int = 6
    static_ends: str = 'velocity'
    dimension: str = 'auto'
    windows: Windows = field(default_factory=Windows)
    basin_hops: int = 3

    def __post_init__(self) -> None:
        """Refuse a combination that does not fit."""
        if self.dimension == '3d' and self.static_ends != 'velocity':
            raise TaskError(f"{_SAGITTAL_ONLY}, and dimension is '3d'")


def choose_model(
    options: PredictorOptions, asymmetry: Callable[[], str], spatial_data: bool = True
) -> str:
    """Return the name of the model for a lift.

    Parameters
    ----------
    options : PredictorOptions
        `dimension` decides, unless it is 'auto'.
    asymmetry : callable
        Returns the reason why the lift does not fit the sagittal model; empty: it fits.
    spatial_data : bool
        Whether the data suffice for the spatial model.

    Raises
    ------
    TaskError
        The lift needs the spatial model, and rest in acceleration is asked for.
    """
    if options.dimension in MODELS:
        return MODELS[options.dimension]
    if not spatial_data or not (reason := asymmetry()):
        return SAGITTAL
    if options.static_ends != 'velocity':
        raise TaskError(f'{reason}; {_SAGITTAL_ONLY}')
    return SPATIAL
