# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Muscle forces by static optimisation, and the loads of L5-S1 and other joints.

The names are imported when they are first used, so that a node starts fast.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from muscle_analyzer.core.exceptions import MuscleAnalyzerError
    from muscle_analyzer.core.loads.analysis import MuscleAnalysis
    from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
    from muscle_analyzer.core.loads.muscle_model import MuscleModel
    from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
    from muscle_analyzer.core.loads.torque_limits import JointTorques
    from muscle_analyzer.core.recruitment.static_optimization import StaticOptimizationOptions

__all__ = [
    'JointTorques',
    'MuscleAnalysis',
    'MuscleAnalyzer',
    'MuscleAnalyzerError',
    'MuscleAnalyzerOptions',
    'MuscleModel',
    'StaticOptimizationOptions',
]

_MODULES = {
    'JointTorques': 'loads.torque_limits',
    'MuscleAnalysis': 'loads.analysis',
    'MuscleAnalyzer': 'loads.analyzer',
    'MuscleAnalyzerError': 'exceptions',
    'MuscleAnalyzerOptions': 'loads.options',
    'MuscleModel': 'loads.muscle_model',
    'StaticOptimizationOptions': 'recruitment.static_optimization',
}


def __getattr__(name: str) -> object:
    """Import a name of `__all__` when it is first used."""
    if name not in _MODULES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    return getattr(import_module(f'{__name__}.core.{_MODULES[name]}'), name)
