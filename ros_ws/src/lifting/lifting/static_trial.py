# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Marker calibration from a static trial, by the calibration of the tracker."""

from __future__ import annotations

from human_model.exceptions import HumanModelError
from lifting_recordings.exceptions import StaticTrialError
from lifting_recordings.messages import MarkerCalibration
from lifting_recordings.recording import Recording
from lifting_recordings.subject_file import SubjectFile
from motion_tracker.core.calibration import calibrate
from motion_tracker.core.exceptions import MotionTrackerError
from motion_tracker.core.markers.marker_set import MarkerSet


def calibrate_markers(
    trial: Recording, entry: SubjectFile, marker_set: MarkerSet
) -> tuple[MarkerCalibration, tuple[str, ...]]:
    """Return the calibration and the statements for the report.

    Parameters
    ----------
    trial : Recording
        Quiet standing, in the graph's conventions.
    entry : SubjectFile
        The person.
    marker_set : MarkerSet
        Set the markers belong to.

    Raises
    ------
    StaticTrialError
        The trial cannot be used; the message contains the reason.
    """
    try:
        known = [i for i, marker in enumerate(trial.names) if marker in marker_set.names]
        found = calibrate(
            marker_set,
            [trial.names[i] for i in known],
            trial.markers[:, known],
            entry.subject,
            entry.joint_widths,
        )
    except (MotionTrackerError, HumanModelError) as error:
        raise StaticTrialError(f'{trial.path}: {error}') from error
    left_out = sorted(set(trial.names) - {trial.names[i] for i in known})
    statements = [f'Static trial {trial.path.name}: {text}' for text in found.statements]
    if left_out:
        statements.append(
            f'Static trial {trial.path.name}: not in {marker_set.name}: {", ".join(left_out)}.'
        )
    result = found.calibration
    return (
        MarkerCalibration(
            marker_set='' if marker_set.path is not None else marker_set.name,
            marker_names=result.marker_names,
            segments=result.segments,
            offsets=result.local_offsets,
            rms=result.residual_rms,
            segment_lengths=result.lengths,
        ),
        tuple(statements),
    )
