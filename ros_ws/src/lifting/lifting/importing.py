# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Import of files of a motion laboratory into a bag."""

from __future__ import annotations

from dataclasses import replace

from lifting_recordings.exceptions import SubjectFileError
from lifting_recordings.importer import ImportOptions, ImportReport, read_recording, write_bag
from lifting_recordings.subject_file import QUIET_STANDING


def import_recording(options: ImportOptions) -> ImportReport:
    """Convert a recording into a bag; nothing is written if anything is wrong.

    Raises
    ------
    BagError
        One of its kinds, naming file, field and value.
    """
    read = read_recording(options)
    entry, recording, calibration = read.entry, read.recording, None
    # These steps need models that take a second or two to load.
    if entry.recording.marker_set or read.static_trial is not None:
        from lifting.recorded_markers import marker_set_of, renamed, with_places
        from lifting.static_trial import calibrate_markers

        marker_set = marker_set_of(entry)
        if marker_set is None:
            raise SubjectFileError(
                f'{entry.path}: recording.marker_set: is missing, but a static trial is given'
            )
        recording = renamed(recording, marker_set)
        if read.static_trial is not None:
            trial = renamed(read.static_trial, marker_set)
            calibration, statements = calibrate_markers(trial, entry, marker_set)
            recording = replace(recording, statements=(*recording.statements, *statements))
        recording, calibration = with_places(recording, marker_set, entry.subject, calibration)
    if entry.recording.plate_registration == QUIET_STANDING:
        from lifting.plate_registration import register_plates

        recording = register_plates(recording, entry, calibration)
    return write_bag(options, replace(read, recording=recording, calibration=calibration))
