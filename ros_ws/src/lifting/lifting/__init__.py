# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifts in a few lines of Python, without ROS.

Examples
--------
>>> import lifting
>>> lift = lifting.track(lifting.load_recording('bags/symmetric_12kg')).lifts[0]
>>> best = lifting.predict(lift)
>>> load = lifting.analyze(lift)
>>> print(lifting.assess(load, lifting.analyze(best)).summary)
>>> load.plot()
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from human_model import __version__

if TYPE_CHECKING:
    from human_model.motion import BodyMotion
    from human_model.skeletons import Skeleton3D
    from human_model.subject import Subject
    from human_model.task import Box, Coupling, Work
    from injury_monitor.core.lifting_equation import LiftingTask, lifting_equation
    from lift_predictor.core.planning.plan_task import PlanTask
    from lifting.assessment import assess
    from lifting.exceptions import IncompleteLiftError, IncompleteRecordingError, NoSolutionError
    from lifting.importing import import_recording
    from lifting.lift import Lift
    from lifting.loads import Loads, analyze
    from lifting.prediction import Prediction, maximum_weight, predict
    from lifting.recording import Recording, load_recording
    from lifting.tracking import Tracking, track
    from lifting_recordings.alignment import ConventionOptions
    from lifting_recordings.importer import ImportOptions

__all__ = [
    'BodyMotion',
    'Box',
    'ConventionOptions',
    'Coupling',
    'ImportOptions',
    'IncompleteLiftError',
    'IncompleteRecordingError',
    'Lift',
    'LiftingTask',
    'Loads',
    'NoSolutionError',
    'PlanTask',
    'Prediction',
    'Recording',
    'Skeleton3D',
    'Subject',
    'Tracking',
    'Work',
    '__version__',
    'analyze',
    'assess',
    'import_recording',
    'lifting_equation',
    'load_recording',
    'maximum_weight',
    'predict',
    'track',
]

# Modules are imported when a name is first used: `import lifting` itself takes no time.
_MODULES = {
    'BodyMotion': 'human_model.motion',
    'Box': 'human_model.task',
    'ConventionOptions': 'lifting_recordings.alignment',
    'Coupling': 'human_model.task',
    'ImportOptions': 'lifting_recordings.importer',
    'IncompleteLiftError': 'lifting.exceptions',
    'IncompleteRecordingError': 'lifting.exceptions',
    'Lift': 'lifting.lift',
    'LiftingTask': 'injury_monitor.core.lifting_equation',
    'Loads': 'lifting.loads',
    'NoSolutionError': 'lifting.exceptions',
    'PlanTask': 'lift_predictor.core.planning.plan_task',
    'Prediction': 'lifting.prediction',
    'Recording': 'lifting.recording',
    'Skeleton3D': 'human_model.skeletons',
    'Subject': 'human_model.subject',
    'Tracking': 'lifting.tracking',
    'Work': 'human_model.task',
    'analyze': 'lifting.loads',
    'assess': 'lifting.assessment',
    'import_recording': 'lifting.importing',
    'lifting_equation': 'injury_monitor.core.lifting_equation',
    'load_recording': 'lifting.recording',
    'maximum_weight': 'lifting.prediction',
    'predict': 'lifting.prediction',
    'track': 'lifting.tracking',
}


def __getattr__(name: str) -> object:
    """Import an exported name when it is first used."""
    if name not in _MODULES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    value = getattr(import_module(_MODULES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the exported names."""
    return __all__
