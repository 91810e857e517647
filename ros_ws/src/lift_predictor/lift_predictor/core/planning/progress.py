# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Progress of a plan."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class PlanProgress:
    """Progress of a plan.

    Attributes
    ----------
    stage : str
        'feet' while their place is searched, then 'lift'.
    done, total : int
        Places, or runs of the solver.
    best : float
        Objective of the best run so far; NaN: none yet.
    """

    stage: str
    done: int
    total: int
    best: float


PlanListener = Callable[[PlanProgress], None]
"""Called after each run of the solver. An error that it raises ends the work."""
