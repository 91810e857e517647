# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Published limits of spine loads, joint torques and muscle activations; alarms and assessments.

Names are imported when they are first used, so that a node starts fast.

Examples
--------
>>> monitor = InjuryMonitor(assignment=assignment)
>>> events = monitor.update_spine_load(0.00, compression=3600.0, anterior_shear=400.0, solved=True)
>>> limits_for(loads_per_day=50).compression_action.value
3400.0
>>> task = LiftingTask(
...     horizontal=40, vertical=30, distance=60, asymmetry=0, lifts_per_minute=1,
...     duration_hours=2, coupling=Coupling.FAIR,
... )
>>> lifting_equation(task, load=12.0).lifting_index
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from human_model.task import Coupling, Work
    from injury_monitor.core.alarm import AlarmState, Trigger
    from injury_monitor.core.alarm_event import AlarmEvent
    from injury_monitor.core.alarm_settings import AlarmSettings
    from injury_monitor.core.assessment import Criterion, RiskAssessment, assess_lift
    from injury_monitor.core.assignment import Assignment
    from injury_monitor.core.exceptions import InjuryMonitorError
    from injury_monitor.core.lifting_equation import (
        LiftingEquation,
        LiftingTask,
        lifting_equation,
    )
    from injury_monitor.core.lifting_geometry import LiftEnd
    from injury_monitor.core.limits import Limit, LimitSet, Zone, limits_for
    from injury_monitor.core.loads import ActivationSeries, LiftLoads, TorqueSeries
    from injury_monitor.core.monitor import InjuryMonitor
    from injury_monitor.core.rnle_assessment import LiftEnds

__all__ = [
    'ActivationSeries',
    'AlarmEvent',
    'AlarmSettings',
    'AlarmState',
    'Assignment',
    'Coupling',
    'Criterion',
    'InjuryMonitor',
    'InjuryMonitorError',
    'LiftEnd',
    'LiftEnds',
    'LiftLoads',
    'LiftingEquation',
    'LiftingTask',
    'Limit',
    'LimitSet',
    'RiskAssessment',
    'TorqueSeries',
    'Trigger',
    'Work',
    'Zone',
    'assess_lift',
    'lifting_equation',
    'limits_for',
]

_MODULES = {
    'ActivationSeries': 'loads',
    'AlarmEvent': 'alarm_event',
    'AlarmSettings': 'alarm_settings',
    'AlarmState': 'alarm',
    'Assignment': 'assignment',
    'Coupling': 'lifting_equation',
    'Criterion': 'assessment',
    'InjuryMonitor': 'monitor',
    'InjuryMonitorError': 'exceptions',
    'LiftEnd': 'lifting_geometry',
    'LiftEnds': 'rnle_assessment',
    'LiftLoads': 'loads',
    'LiftingEquation': 'lifting_equation',
    'LiftingTask': 'lifting_equation',
    'Limit': 'limits',
    'LimitSet': 'limits',
    'RiskAssessment': 'assessment',
    'TorqueSeries': 'loads',
    'Trigger': 'alarm',
    'Work': 'assignment',
    'Zone': 'limits',
    'assess_lift': 'assessment',
    'lifting_equation': 'lifting_equation',
    'limits_for': 'limits',
}


def __getattr__(name: str) -> object:
    """Import a name of `__all__` when it is first used."""
    if name not in _MODULES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    return getattr(import_module(f'{__name__}.core.{_MODULES[name]}'), name)
