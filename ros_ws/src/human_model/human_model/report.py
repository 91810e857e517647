# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The account every solver gives of its result: whether it is good data and how it got there."""

from dataclasses import asdict, dataclass
from enum import IntEnum
from typing import Any


class SolveStatus(IntEnum):
    """Outcome of a solver; only ``OK`` marks good data.

    The hundreds identify the package: 1xx motion tracker, 2xx lift predictor, 3xx muscle analyzer.
    """

    OK = 0
    TRACKER_NOT_CONVERGED = 101
    TRACKER_MARKERS_MISSING = 102
    TRACKER_BAD_INPUT = 103
    TRACKER_NO_LIFT = 104
    TRACKER_MARKERS_SWAPPED = 105
    TRACKER_NO_GROUND_FORCE = 106
    TRACKER_MASS_MISMATCH = 107
    TRACKER_FILTER_SETTLING = 108
    PREDICTOR_NOT_CONVERGED = 201
    PREDICTOR_INFEASIBLE = 202
    PREDICTOR_UNREACHABLE = 203
    PREDICTOR_BAD_INPUT = 204
    PREDICTOR_VERIFICATION_FAILED = 205
    PREDICTOR_TIME_LIMIT = 206
    MUSCLE_NOT_CONVERGED = 301
    MUSCLE_TOO_WEAK = 302
    MUSCLE_TRANSFER_FAILED = 303
    MUSCLE_BAD_INPUT = 304
    MUSCLE_NO_GROUND_FORCE = 305


@dataclass(frozen=True)
class SolveReport:
    """Report of one solve.

    Attributes
    ----------
    status : SolveStatus
        0 is good data, everything else is not.
    message : str
        In words, with names and values of what failed.
    iterations : int
        Iterations of the solver.
    objective : float
        Objective at the result, in the solver's own unit.
    primal_residual, dual_residual : float
        Largest violation of the constraints and of stationarity, in the solver's own units.
    build_time, solve_time : float
        Wall-clock seconds to build and to solve the problem.
    """

    status: SolveStatus = SolveStatus.OK
    message: str = ''
    iterations: int = 0
    objective: float = 0.0
    primal_residual: float = 0.0
    dual_residual: float = 0.0
    build_time: float = 0.0
    solve_time: float = 0.0

    def __post_init__(self) -> None:
        """Make the status an enum member, so that an unknown number is refused."""
        object.__setattr__(self, 'status', SolveStatus(self.status))

    @property
    def ok(self) -> bool:
        """Whether the result is good data."""
        return self.status is SolveStatus.OK

    def to_dict(self) -> dict[str, Any]:
        """Plain dictionary of the fields, status as an integer."""
        return {**asdict(self), 'status': int(self.status)}

    @classmethod
    def from_dict(cls, fields: dict[str, Any]) -> 'SolveReport':
        """Inverse of `to_dict`."""
        return cls(**fields)
