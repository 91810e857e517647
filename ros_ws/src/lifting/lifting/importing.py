# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Import of files of a motion laboratory into a bag."""

from __future__ import annotations

from dataclasses import replace

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
    # Both steps need models that take a second or two to load.
    if read.static_trial is not None:
        from lifting.static_trial import calibrate_markers

        calibration, statements = calibrate_markers(read.static_trial, entry)
        recording = replace(recording, statements=(*recording.statements, *statements))
    if entry.recording.plate_registration == QUIET_STANDING:
        from lifting.plate_registration import register_plates

        recording = register_plates(recording, entry, calibration)
    return write_bag(options, replace(read, recording=recording, calibration=calibration))
