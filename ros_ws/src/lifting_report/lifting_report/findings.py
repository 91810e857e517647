# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of a lift in the report: assessment, alarms, quality, solve reports."""

from __future__ import annotations

from dataclasses import dataclass, field

from injury_monitor.core.assessment import Criterion
from muscle_analyzer.core.emg.comparison import EmgMatch


@dataclass(frozen=True)
class Lifting:
    """Revised NIOSH lifting equation at the governing end of the lift.

    Attributes
    ----------
    multipliers : tuple of six floats
        HM, VM, DM, AM, FM, CM.
    recommended_weight_limit, lifting_index : float
        [kg], 1.
    limiting_multiplier : str
    band : str
        Exposure band; '' to have it looked up from the index.
    variables : dict
        Task variables by symbol with their unit, for example ``{'H [cm]': 42.0}``; may be empty.
    """

    multipliers: tuple[float, ...]
    recommended_weight_limit: float
    lifting_index: float
    limiting_multiplier: str
    band: str
    variables: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Risk:
    """Assessment of one lift.

    Attributes
    ----------
    criteria : tuple of Criterion
    avoidable_compression, avoidable_shear : float
        Measured minus predicted peak [N]; NaN without a prediction.
    zone : str
        ``nominal``, ``action``, ``hazardous`` or ``unknown`` (NIOSH 1981).
    summary : str
    samples_left_out : int
    """

    criteria: tuple[Criterion, ...]
    avoidable_compression: float
    avoidable_shear: float
    zone: str
    summary: str
    samples_left_out: int

    def find(self, name: str, source: str) -> Criterion | None:
        """Return the first criterion whose name begins with ``name``, or None."""
        for row in self.criteria:
            if row.criterion.startswith(name) and row.source == source:
                return row
        return None


@dataclass(frozen=True)
class AlarmRow:
    """One alarm transition; stamp [s] since the start of the recording."""

    stamp: float
    alarm: str
    previous_state: str
    state: str
    value: float
    limit: float
    margin: float
    unit: str
    limit_source: str
    lift_id: str
    historical: bool = False


@dataclass(frozen=True)
class SolveRow:
    """One solve report in words and numbers."""

    stage: str
    status: int
    status_name: str
    message: str
    iterations: int
    primal_residual: float
    dual_residual: float
    solve_time: float


@dataclass(frozen=True)
class QualityRow:
    """One quality measure: name, measured and predicted value in a unit, and what it means.

    A value that is not there is NaN and its reason stands in ``meaning``.
    """

    name: str
    measured: float
    predicted: float
    unit: str
    meaning: str


@dataclass(frozen=True)
class EmgFindings:
    """EMG of a lift beside its computed activations.

    Attributes
    ----------
    matches : tuple of EmgMatch
        One for each channel that could be compared.
    left_out : tuple of str
        Why other channels could not.
    """

    matches: tuple[EmgMatch, ...]
    left_out: tuple[str, ...] = ()
