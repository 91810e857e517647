# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Subjects, skeletons, dynamics and joint strength of a lifting person.

Names are imported when they are first used, so that a node starts fast.

Examples
--------
>>> subject = Subject('S1', 'male', mass=63.5, stature=1.69, age=31)
>>> skeleton = Skeleton3D.of(subject)
>>> q = skeleton.standing()
>>> skeleton.inverse_dynamics(q, 0 * q, 0 * q)  # [N m], the first three [N]
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from human_model.anthropometry import SegmentParameters, segment_parameters
    from human_model.exceptions import HumanModelError, LiftingError
    from human_model.motion import BodyMotion, Lift
    from human_model.named_subjects import named_subject
    from human_model.opensim_storage import Storage, read_storage
    from human_model.report import SolveReport, SolveStatus
    from human_model.skeleton import ExternalForce
    from human_model.skeletons import Skeleton2D, Skeleton3D
    from human_model.strength import JointStrength
    from human_model.subject import Calibration, Subject
    from human_model.task import Box, Coupling, Task, Work

#: Of all packages; the manifests package.xml repeat it.
__version__ = '0.1.0'

__all__ = [
    'BodyMotion',
    'Box',
    'Calibration',
    'Coupling',
    'ExternalForce',
    'HumanModelError',
    'JointStrength',
    'Lift',
    'LiftingError',
    'SegmentParameters',
    'Skeleton2D',
    'Skeleton3D',
    'SolveReport',
    'SolveStatus',
    'Storage',
    'Subject',
    'Task',
    'Work',
    '__version__',
    'named_subject',
    'read_storage',
    'segment_parameters',
]

_MODULES = {
    'BodyMotion': 'motion',
    'Box': 'task',
    'Calibration': 'subject',
    'Coupling': 'task',
    'ExternalForce': 'skeleton',
    'HumanModelError': 'exceptions',
    'JointStrength': 'strength',
    'Lift': 'motion',
    'LiftingError': 'exceptions',
    'SegmentParameters': 'anthropometry',
    'Skeleton2D': 'skeletons',
    'Skeleton3D': 'skeletons',
    'SolveReport': 'report',
    'SolveStatus': 'report',
    'Storage': 'opensim_storage',
    'Subject': 'subject',
    'Task': 'task',
    'Work': 'task',
    'named_subject': 'named_subjects',
    'read_storage': 'opensim_storage',
    'segment_parameters': 'anthropometry',
}


def __getattr__(name: str) -> object:
    """Import a name of `__all__` when it is first used."""
    if name not in _MODULES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    return getattr(import_module(f'{__name__}.{_MODULES[name]}'), name)
