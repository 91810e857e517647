# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The markers of a recording against those of its marker set: names, absences, places.

A coordinate that only absent markers show would spoil every sample, because the tracker takes it
for lost. So the bag lists the markers that the recording has, with their places on the segments:
what nobody marked stays neutral. A marker set of one's own travels in the bag the same way.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from human_model.exceptions import HumanModelError, LiftingError
from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from lifting_recordings.exceptions import SubjectFileError
from lifting_recordings.marker_names import names_of_set
from lifting_recordings.messages import MarkerCalibration
from lifting_recordings.recording import Recording
from lifting_recordings.subject_file import SubjectFile
from motion_tracker.core.exceptions import MotionTrackerError
from motion_tracker.core.inverse_kinematics.inverse_kinematics import InverseKinematics
from motion_tracker.core.markers.marker_model import MarkerModel, from_anthropometry
from motion_tracker.core.markers.marker_set import MarkerSet, load_marker_set


def marker_set_of(entry: SubjectFile) -> MarkerSet | None:
    """Return the marker set of a subject file; None if it names none.

    A name that ends in ``.csv`` is a file beside the subject file.

    Raises
    ------
    SubjectFileError
        There is no such set, or its file is damaged.
    """
    name = entry.recording.marker_set
    if not name:
        return None
    try:
        marker_set = load_marker_set(entry.path.parent / name if name.endswith('.csv') else name)
    except (MotionTrackerError, HumanModelError) as error:
        raise SubjectFileError(f'{entry.path}: recording.marker_set: {error}') from error
    segments = Skeleton3D.of(entry.subject).segments
    for marker in marker_set.markers:
        if marker.segment not in segments:
            raise SubjectFileError(
                f'{entry.path}: recording.marker_set: {name}: marker {marker.name}: segment '
                f'{marker.segment!r} is not one of {", ".join(segments)}'
            )
    return marker_set


def renamed(recording: Recording, marker_set: MarkerSet) -> Recording:
    """Return the recording with the names of the set for markers that have other ones."""
    new = names_of_set(recording.names, marker_set.names)
    if not new:
        return recording
    said = ', '.join(f'{old} as {name}' for old, name in new.items())
    return replace(
        recording,
        names=tuple(new.get(name, name) for name in recording.names),
        statements=(
            *recording.statements,
            f'{recording.path.name}: markers under the names of {marker_set.name}: {said}.',
        ),
    )


def with_places(
    recording: Recording,
    marker_set: MarkerSet,
    subject: Subject,
    calibration: MarkerCalibration | None,
) -> tuple[Recording, MarkerCalibration | None]:
    """Return the recording with statements, and the places of the markers that it has.

    Parameters
    ----------
    recording : Recording
        With the names of the set.
    marker_set : MarkerSet
        Its markers.
    subject : Subject
        The person.
    calibration : MarkerCalibration or None
        From a static trial.

    Returns
    -------
    Recording, and MarkerCalibration or None
        None if the recording has all markers of a set of the package and there is no static
        trial: then the tracker scales the set.

    Raises
    ------
    SubjectFileError
        The markers of the recording do not determine the pelvis, or none of the set is there.
    """
    there = {
        name
        for i, name in enumerate(recording.names)
        if np.isfinite(recording.markers[:, i].sum(axis=1)).any()
    }
    own = marker_set.path is not None
    try:
        if calibration is None:
            whole = from_anthropometry(marker_set, subject)
        else:
            whole = MarkerModel(
                calibration.marker_names,
                calibration.segments,
                np.asarray(calibration.offsets),
                np.ones(len(calibration.marker_names)),
            )
        model = whole.only([name for name in whole.names if name in there])
        absent = [name for name in whole.names if name not in there]
        if not absent and not own:
            return recording, calibration
        skeleton = Skeleton3D.of(subject)
        neutral = InverseKinematics(skeleton, model).unobservable
    except LiftingError as error:
        raise SubjectFileError(
            f'{recording.path}: the markers of {marker_set.name} that it has cannot be tracked: '
            f'{error}: name others with recording.rename, or choose another recording.marker_set'
        ) from error
    statements = list(recording.statements)
    if absent:
        statements.append(
            f'Markers of {marker_set.name} not in the recording: {", ".join(absent)}.'
        )
    if neutral:
        statements.append(
            'Coordinates that these markers do not determine in standing are drawn to neutral: '
            f'{", ".join(neutral)}.'
        )
    if own and len({marker.weight for marker in marker_set.markers}) > 1:
        statements.append(
            f'Weights of the marker set {marker_set.name} are not kept in the bag: its markers '
            'count alike.'
        )
    keep = [whole.names.index(name) for name in model.names]
    places = MarkerCalibration(
        marker_set='' if own else marker_set.name,
        marker_names=model.names,
        segments=model.segments,
        offsets=whole.offsets[keep],
        rms=float('nan') if calibration is None else calibration.rms,
        segment_lengths={} if calibration is None else calibration.segment_lengths,
    )
    return replace(recording, statements=tuple(statements)), places
