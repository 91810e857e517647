# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Optimal lifts of a person: of a recorded task, or of a task alone.

Names are imported when they are first used, so that `import lift_predictor` stays fast.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lift_predictor.core.options import PredictorOptions, Windows
    from lift_predictor.core.planning.plan_task import PlanTask
    from lift_predictor.core.planning.planned_lift import PlannedLift
    from lift_predictor.core.planning.planner import LiftPlanner
    from lift_predictor.core.predictor import LiftPredictor
    from lift_predictor.core.problem.comparison import LiftComparison
    from lift_predictor.core.problem.maximum_weight import MaximumWeight, Weighting
    from lift_predictor.core.problem.prediction import NearestLift, Prediction

_MODULES = {
    'LiftComparison': 'problem.comparison',
    'LiftPlanner': 'planning.planner',
    'LiftPredictor': 'predictor',
    'MaximumWeight': 'problem.maximum_weight',
    'NearestLift': 'problem.prediction',
    'PlanTask': 'planning.plan_task',
    'PlannedLift': 'planning.planned_lift',
    'Prediction': 'problem.prediction',
    'PredictorOptions': 'options',
    'Weighting': 'problem.maximum_weight',
    'Windows': 'options',
}

__all__ = [
    'LiftComparison',
    'LiftPlanner',
    'LiftPredictor',
    'MaximumWeight',
    'NearestLift',
    'PlanTask',
    'PlannedLift',
    'Prediction',
    'PredictorOptions',
    'Weighting',
    'Windows',
]


def __getattr__(name: str) -> object:
    """Import an exported name."""
    if name not in _MODULES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    return getattr(import_module(f'lift_predictor.core.{_MODULES[name]}'), name)
