# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of a prediction, and the choice of the model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

import numpy as np

SAGITTAL: Final = 'sagittal'
SPATIAL: Final = 'spatial'
MODELS: Final = {'2d': SAGITTAL, '3d': SPATIAL}
"""Models by the value of the parameter `dimension`."""
COEFFICIENT_SET: Final = 'anderson2007_nonneg'
POSTURE_TOLERANCE: Final = 0.15
"""Epsilon of equation 4.8 [rad]."""


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
        well, with `MORE_CONTROL` more control points.
    dimension : str
        '2d', '3d', or 'auto': asymmetric lifts on the 3D skeleton are predicted by the spatial
        model.
    windows : Windows
        Distance from a recorded lift; spatial model.
    basin_hops : int
        Runs from the best solution, displaced, in search of a better one; spatial model.
    """

    SPATIAL_TIME_LIMIT: Final = 30.0
    MORE_CONTROL: Final = 3
    """Control points more with rest in acceleration, which merges one more at each end and needs
    one more piece: one value more remains free."""

    n_control: int = 7
    n_nodes: int = 25
    posture_tolerance: float = POSTURE_TOLERANCE
    coefficient_set: str = COEFFICIENT_SET
    time_limit: float = 10.0
    refinements: int = 6
    static_ends: str = 'acceleration'
    dimension: str = 'auto'
    windows: Windows = field(default_factory=Windows)
    basin_hops: int = 3

    @property
    def spline_control(self) -> int:
        """Control points per joint with those that the rest at the ends takes."""
        return self.n_control + (self.MORE_CONTROL if self.static_ends == 'acceleration' else 0)


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
    """
    if options.dimension in MODELS:
        return MODELS[options.dimension]
    return SPATIAL if spatial_data and asymmetry() else SAGITTAL
