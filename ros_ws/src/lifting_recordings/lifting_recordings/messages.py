# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Subject and Task messages from the entries of a subject file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from human_model.subject import Subject
from human_model.task import Task
from human_model.typing import Array
from lifting_recordings.bag_writer import BagWriter

_SEX = {'male': 1, 'female': 2}


@dataclass(frozen=True)
class MarkerCalibration:
    """Where the markers sit on this person's segments.

    Attributes
    ----------
    marker_set : str
        Name of the marker set.
    marker_names, segments : tuple of str
        One per marker.
    offsets : ndarray, shape (n_markers, 3)
        [m] in the segment's anatomical frame.
    rms : float
        Root mean square distance of the markers in the static trial [m].
    segment_lengths : dict
        Segment lengths the static trial suggests [m]; may be empty.
    """

    marker_set: str
    marker_names: tuple[str, ...]
    segments: tuple[str, ...]
    offsets: Array
    rms: float
    segment_lengths: Mapping[str, float] = field(default_factory=dict)


def subject_message(
    writer: BagWriter,
    stamp_ns: int,
    subject: Subject,
    source: str,
    marker_set: str,
    calibration: MarkerCalibration | None,
) -> Any:
    """Return a lifting_interfaces/Subject.

    Parameters
    ----------
    writer : BagWriter
        Makes the messages.
    stamp_ns : int
        [ns].
    subject : Subject
        The person.
    source : str
        What was measured of the person and what was assumed.
    marker_set : str
        Name of the marker set of the recording; '' if none is named.
    calibration : MarkerCalibration or None
        From a static trial.
    """
    found = calibration.segment_lengths if calibration else {}
    # What a person measured takes precedence over what the static trial suggests.
    merged = {**found, **subject.lengths}
    return writer.make(
        'lifting_interfaces/msg/Subject',
        header=writer.header(stamp_ns, ''),
        pseudonym=subject.pseudonym,
        sex=_SEX[subject.sex],
        mass=subject.mass,
        stature=subject.stature,
        age=subject.age,
        strength_z=subject.strength_z,
        segment_length_names=list(merged),
        segment_lengths=np.array(list(merged.values()), dtype=np.float64),
        marker_set=calibration.marker_set if calibration else marker_set,
        marker_names=list(calibration.marker_names) if calibration else [],
        marker_segments=list(calibration.segments) if calibration else [],
        marker_offsets=(
            np.asarray(calibration.offsets, dtype=np.float64).ravel()
            if calibration
            else np.zeros(0)
        ),
        calibration_rms=calibration.rms if calibration else float('nan'),
        source=source,
    )


def task_message(writer: BagWriter, stamp_ns: int, task: Task, source: str) -> Any:
    """Return a lifting_interfaces/Task; `source` says where from and what was detected."""
    box, work = task.box, task.work
    start, end = (np.array(place or [np.nan] * 3) for place in (box.start, box.end))
    return writer.make(
        'lifting_interfaces/msg/Task',
        header=writer.header(stamp_ns),
        task_id=task.task_id,
        description=task.description,
        box_mass=box.mass,
        box_size=np.array(box.size, dtype=np.float64),
        box_start=writer.point(start),
        box_end=writer.point(end),
        coupling=int(work.coupling),
        lifts_per_minute=work.lifts_per_minute,
        lifts_per_day=work.lifts_per_day,
        duration_hours=work.duration_hours,
        control_at_destination=work.control_at_destination,
        simulated=task.simulated,
        source=source,
    )
