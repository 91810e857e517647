# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of lifts as bags: read, write, import and recover; no ROS needed.

Names are imported when they are first used, so that the lift command starts fast.

Examples
--------
>>> with BagReader('bags/symmetric_12kg') as reader:
...     topics = list(reader.topics)
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lifting_recordings.alignment import ConventionOptions
    from lifting_recordings.bag_writer import BagWriter
    from lifting_recordings.exceptions import BagError
    from lifting_recordings.importer import (
        ImportOptions,
        ReadRecording,
        read_recording,
        write_bag,
    )
    from lifting_recordings.reader import BagReader
    from lifting_recordings.recording import Plate, Recording
    from lifting_recordings.subject_file import SubjectFile, read_subject_file

__all__ = [
    'BagError',
    'BagReader',
    'BagWriter',
    'ConventionOptions',
    'ImportOptions',
    'Plate',
    'ReadRecording',
    'Recording',
    'SubjectFile',
    'read_recording',
    'read_subject_file',
    'write_bag',
]

_MODULES = {
    'BagError': 'exceptions',
    'BagReader': 'reader',
    'BagWriter': 'bag_writer',
    'ConventionOptions': 'alignment',
    'ImportOptions': 'importer',
    'Plate': 'recording',
    'ReadRecording': 'importer',
    'Recording': 'recording',
    'SubjectFile': 'subject_file',
    'read_recording': 'importer',
    'read_subject_file': 'subject_file',
    'write_bag': 'importer',
}


def __getattr__(name: str) -> object:
    """Import a name of `__all__` when it is first used."""
    if name not in _MODULES:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    return getattr(import_module(f'{__name__}.{_MODULES[name]}'), name)
