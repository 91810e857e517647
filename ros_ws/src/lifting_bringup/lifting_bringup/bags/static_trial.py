# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker calibration from a static trial, by the tracker's own calibration."""

from __future__ import annotations

from lifting_bringup.bags.exceptions import SubjectFileError
from lifting_bringup.bags.messages import MarkerCalibration
from lifting_bringup.bags.recording import Recording
from lifting_bringup.bags.subject_file import SubjectFile


def calibrate(trial: Recording, entry: SubjectFile) -> tuple[MarkerCalibration, tuple[str, ...]]:
    """Return the calibration, segment lengths [m] and statements for the report.

    Raises
    ------
    SubjectFileError
        No marker set is named.
    """
    if not entry.recording.marker_set:
        raise SubjectFileError(
            f'{entry.path}: recording.marker_set: is missing, but a static trial is given'
        )
    raise NotImplementedError
