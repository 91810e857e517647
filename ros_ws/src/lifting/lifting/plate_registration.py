# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Position of the force plates relative to the cameras, from a person who stands still.

While a person stands still, the net moments at L5-S1 from above and from below differ by the
moment of the error in the positions of the plates. An error of 10 mm changes joint torques by some
14 % (McCaw and DeVita 1995, J Biomech 28:985). If a subject file requests it, both plates are
moved by one horizontal shift, constant over the recording, so that the difference is zero in quiet
standing.

Residual reduction (Delp et al. 2007) moves the trunk's centre of mass instead. In standing both
have the same effect. In a squat the offset of a plate stays constant in the laboratory; the offset
of the trunk turns with the trunk. docs/validation.md shows a recording whose plates are displaced.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from human_model.constants import SIDES
from human_model.exceptions import HumanModelError
from human_model.skeletons import Skeleton3D
from human_model.subject import Calibration, Subject
from human_model.typing import Array
from lifting.recorded_markers import marker_set_of
from lifting_recordings.exceptions import ConventionError
from lifting_recordings.messages import MarkerCalibration
from lifting_recordings.recording import Plate, Recording, centre_of_pressure
from lifting_recordings.subject_file import QUIET_STANDING, SubjectFile
from motion_tracker.core.exceptions import MotionTrackerError
from motion_tracker.core.filters import zero_phase
from motion_tracker.core.quiet_standing import (
    QuietStanding,
    coordinates_of,
    find_quiet_standing,
    missing_moment,
)
from muscle_analyzer.core.exceptions import MuscleAnalyzerError
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer

#: Offset beyond which plates are not moved [m]: the largest errors of centres of pressure
#: reported for force plates, Schmiedmayer and Kastner 2000 (J Biomech Eng 122:523).
LARGEST = 0.03
#: Cut-off of the plates [Hz], as in the thesis (section 3.4).
_CUTOFF = 25.0


@dataclass(frozen=True, eq=False)
class PlateOffset:
    """Correction of the positions of both plates.

    Attributes
    ----------
    offset : ndarray, shape (2,)
        To add to the positions of both plates, world x and y [m].
    spread : ndarray, shape (2,)
        Standard deviation over the frames [m].
    """

    offset: Array
    spread: Array


def offset_of(missing: npt.ArrayLike, force: npt.ArrayLike) -> PlateOffset:
    """Return the shift of the plates that balances a missing moment.

    Parameters
    ----------
    missing : array-like, shape (n, 3)
        Moment from above less that from below, per sample [N m].
    force : array-like, shape (n, 3)
        Of the ground on the person [N].
    """
    moments, forces = (np.asarray(a, dtype=np.float64) for a in (missing, force))
    # (x, y, 0) x force = missing; its horizontal part is due to the vertical force alone.
    rows = np.stack((-moments[:, 1], moments[:, 0]), axis=1) / forces[:, 2:]
    return PlateOffset(rows.mean(axis=0), rows.std(axis=0))


def moved(plate: Plate, offset: npt.ArrayLike) -> Plate:
    """Return a plate moved by `offset`, shape (2,), on the floor [m]."""
    shift = np.array([*np.asarray(offset, dtype=np.float64), 0.0])
    return replace(plate, moment=plate.moment + np.cross(shift, plate.force))


def register_plates(
    recording: Recording, entry: SubjectFile, calibration: MarkerCalibration | None
) -> Recording:
    """Return the recording with its plates moved to balance quiet standing.

    Raises
    ------
    ConventionError
        A plate or the marker set is missing, quiet standing is too short, or the offset is larger
        than `LARGEST`.
    """
    where = f'{entry.path}: recording.plate_registration: {QUIET_STANDING}'
    if missing := [side for side in SIDES if side not in recording.plates]:
        raise ConventionError(f'{where}: no plate is under the {missing[0]} foot')
    if not entry.recording.marker_set:
        raise ConventionError(f'{where}: recording.marker_set is needed')
    try:
        by_model, by_segments, seconds = _offsets(recording, entry, calibration)
    except (MotionTrackerError, HumanModelError, MuscleAnalyzerError) as error:
        raise ConventionError(f'{where}: {error}') from error
    size = float(np.linalg.norm(by_model.offset))
    if not size <= LARGEST:
        raise ConventionError(
            f'{where}: the plates would have to be moved by {1e3 * size:.0f} mm, more than '
            f'{1e3 * LARGEST:.0f} mm: look for the error in plates, mass or markers'
        )
    statement = (
        f'Both plates were moved by {_text(by_model.offset)}, so that the net moment at L5-S1 is '
        f'the same from above and below in {seconds:.1f} s of quiet standing (standard deviation '
        f'{1e3 * by_model.spread.max():.0f} mm); the segment masses of the skeleton alone would '
        f'move them by {_text(by_segments.offset)}.'
    )
    return replace(
        recording,
        plates={side: moved(plate, by_model.offset) for side, plate in recording.plates.items()},
        statements=(*recording.statements, statement),
    )


def _text(offset: Array) -> str:
    x, y = (round(1e3 * float(shift)) for shift in offset)
    return f'{x:+d} mm forward and {y:+d} mm to the left'


def _offsets(
    recording: Recording, entry: SubjectFile, calibration: MarkerCalibration | None
) -> tuple[PlateOffset, PlateOffset, float]:
    """Return the offsets by the musculoskeletal model and by the skeleton, and the time used."""
    subject = entry.subject
    if calibration is not None:
        subject = replace(
            subject,
            calibration=Calibration(
                calibration.marker_names,
                calibration.segments,
                calibration.offsets,
                dict(calibration.segment_lengths),
                0.0 if np.isnan(calibration.rms) else calibration.rms,
            ),
        )
    rate = 1.0 / float(np.median(np.diff(recording.time)))
    marker_set = marker_set_of(entry)
    skeleton, q = coordinates_of(subject, marker_set, recording.names, recording.markers)
    wrenches = [_wrench(recording.plates[side], recording.time) for side in SIDES]
    force = np.stack([w[:, :3] for w in wrenches], axis=1)
    moment = np.stack([w[:, 3:] for w in wrenches], axis=1)
    standing = find_quiet_standing(skeleton, rate, q, force.sum(axis=1))
    force, moment = force[standing.frames], moment[standing.frames]
    by_segments = missing_moment(skeleton, standing, force.sum(axis=1), moment.sum(axis=1))
    by_model = _missing_by_model(subject, skeleton, standing, recording.time, force, moment)
    return (
        offset_of(by_model, force.sum(axis=1)),
        offset_of(by_segments, force.sum(axis=1)),
        len(standing.frames) / rate,
    )


def _missing_by_model(
    subject: Subject,
    skeleton: Skeleton3D,
    standing: QuietStanding,
    time: Array,
    force: Array,
    moment: Array,
) -> Array:
    """Return the net L5-S1 moment (n, 3) from above less that from below [N m]."""
    places = np.stack([centre_of_pressure(force[:, k], moment[:, k]) for k in (0, 1)], axis=1)
    motion = skeleton.body_motion(
        time[standing.frames],
        standing.q,
        standing.qd,
        standing.qdd,
        ground_force=force,
        centre_of_pressure=places,
        free_moment=moment - np.cross(places, force),
    )
    analyzer = MuscleAnalyzer(subject)
    analysis = analyzer.analyze(motion, source='measured')
    missing: Array = analysis.net_moment_top_down - analysis.net_moment_bottom_up
    if not np.isfinite(missing).all():
        bad = next(report for report in analysis.reports if report.status != 0)
        raise MuscleAnalyzerError(f'quiet standing: {bad.message}')
    return missing


def _wrench(plate: Plate, time: Array) -> Array:
    """Return force and moment (n, 6) of a plate at other times, filtered without delay."""
    rate = 1.0 / float(np.median(np.diff(plate.time)))
    values = zero_phase(np.concatenate((plate.force, plate.moment), axis=1), rate, _CUTOFF)
    return np.stack([np.interp(time, plate.time, column) for column in values.T], axis=1)
