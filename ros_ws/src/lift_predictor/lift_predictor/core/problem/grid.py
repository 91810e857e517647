# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Control points and time nodes of a lift: what fixes the structure of its NLP."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from human_model.typing import Array
from lift_predictor.core.bspline import RestToRestSpline, require_nodes


@dataclass(frozen=True)
class TimeGrid(ABC):
    """Sizes that fix the structure of the NLP of one model.

    Attributes
    ----------
    n_control : int
        Control points per coordinate.
    n_nodes : int
        Uniform time nodes of the constraints, and of Simpson's rule for the effort: an even number
        of intervals in each spline piece (`bspline.require_nodes`). With fewer the solver finds
        motions that violate the constraints between the nodes.
    rest : str
        Derivative that is zero at both ends: 'velocity' (equation 4.7), or 'acceleration' as well.

    Raises
    ------
    SplineError
        Numbers that do not fit.
    """

    N_COORDINATES: ClassVar[int]
    N_SCALARS: ClassVar[int]
    """Variables that hold for the whole lift: the box's mass [kg], and maybe the duration [s]."""

    n_control: int
    n_nodes: int
    rest: str = 'velocity'

    def __post_init__(self) -> None:
        """Refuse numbers that do not fit."""
        require_nodes(self.spline, self.n_nodes)

    @cached_property
    def spline(self) -> RestToRestSpline:
        """Spline of each coordinate."""
        return RestToRestSpline(self.n_control, self.rest)

    @property
    def n_splined(self) -> int:
        """Free control values, all coordinates of one point together."""
        return self.spline.n_free * self.N_COORDINATES

    @property
    def n_variables(self) -> int:
        """Optimisation variables: control values, then the scalars."""
        return self.n_splined + self.N_SCALARS

    @property
    def times(self) -> Array:
        """Normalised node times, shape (n_nodes,)."""
        return np.linspace(0.0, 1.0, self.n_nodes)

    @property
    @abstractmethod
    def constraint_names(self) -> tuple[str, ...]:
        """Name of every constraint, for messages."""

    @abstractmethod
    def variable_name(self, index: int) -> str:
        """Name of a variable, for messages."""

    def control(self, x: Array) -> Array:
        """Free control values (n_free, n_coordinates) of a vector of variables."""
        return x[: self.n_splined].reshape(self.spline.n_free, -1)
