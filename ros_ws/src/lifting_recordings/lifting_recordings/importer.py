# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""C3D, or TRC with MOT or STO, and a subject file become one bag.

`lifting.import_recording` is the whole import: between reading and writing it calibrates the
markers and registers the plates, for which it needs the packages of the computation.

Topics: `markers`, `force_plates/{right,left}/wrench` (force of the ground on the person, moment
about the laboratory origin, frame `world`), `box/pose` when box markers are named, `emg` where
the file has it, `subject` and `task` (transient local).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from human_model.constants import SIDES
from human_model.typing import Array
from lifting_recordings.alignment import ConventionOptions, align
from lifting_recordings.bag_writer import START_TIME_NS, BagWriter, in_order
from lifting_recordings.box_pose import box_poses
from lifting_recordings.c3d_files import read_c3d
from lifting_recordings.exceptions import (
    BagError,
    ConventionError,
    FileFormatError,
    SubjectFileError,
)
from lifting_recordings.messages import MarkerCalibration, subject_message, task_message
from lifting_recordings.opensim_forces import read_trc_and_forces
from lifting_recordings.plate_assignment import Carried
from lifting_recordings.raw_markers import without_zeros
from lifting_recordings.recording import Analog, Plate, RawRecording, Recording
from lifting_recordings.subject_file import SubjectFile, read_subject_file

_EMG_BLOCK_SECONDS = 0.01


@dataclass(frozen=True)
class ImportOptions:
    """Files and settings of an import.

    Attributes
    ----------
    markers : Path
        C3D or TRC file.
    subject : Path
        Subject file (YAML, see `subject_file`).
    output : Path
        Bag folder to create.
    forces : Path or None
        MOT or STO file that belongs to a TRC file.
    static : Path or None
        Static trial (C3D or TRC) for the calibration of the marker set.
    conventions : ConventionOptions
        For conventions that the data leave open.
    start_time_ns : int
        Stamp of time zero of the file [ns].
    compress : bool
        zstd inside the MCAP file.
    label_prefix : str or None
        Prefix of the labels of the subject, where the file holds several subjects or objects.
    """

    markers: Path
    subject: Path
    output: Path
    forces: Path | None = None
    static: Path | None = None
    conventions: ConventionOptions = field(default_factory=ConventionOptions)
    start_time_ns: int = START_TIME_NS
    compress: bool = True
    label_prefix: str | None = None


@dataclass(frozen=True, eq=False)
class ReadRecording:
    """A recording as it was read, in the conventions of the graph.

    Attributes
    ----------
    entry : SubjectFile
        Person, task and marker set.
    recording : Recording
        The lifts.
    static_trial : Recording or None
        Quiet standing for the calibration of the markers; without force plates.
    calibration : MarkerCalibration or None
        Result of the static trial.
    """

    entry: SubjectFile
    recording: Recording
    static_trial: Recording | None = None
    calibration: MarkerCalibration | None = None


@dataclass(frozen=True)
class ImportReport:
    """Result of an import.

    Attributes
    ----------
    bag : Path
        The bag.
    statements : tuple of str
        One sentence per detected convention; the same stand in `task.source`.
    messages : dict
        Messages per topic.
    duration : float
        [s].
    """

    bag: Path
    statements: tuple[str, ...]
    messages: dict[str, int]
    duration: float


def read_raw(
    markers: Path,
    forces: Path | None,
    emg: tuple[str, ...] | None = None,
    prefix: str | None = None,
) -> RawRecording:
    """Read a C3D file, or a TRC file with its forces; a marker at 0, 0, 0 is not seen.

    Raises
    ------
    FileFormatError
        Missing, foreign or damaged file.
    """
    for path in (markers, forces):
        if path is not None and not path.is_file():
            raise FileFormatError(path, 'does not exist')
    kind = markers.suffix.lower()
    if kind == '.c3d':
        if forces is not None:
            raise FileFormatError(forces, 'a C3D file brings its own forces; leave this one out')
        raw = read_c3d(markers, emg, prefix)
    elif kind == '.trc':
        raw = read_trc_and_forces(markers, forces, prefix)
    else:
        raise FileFormatError(markers, f'marker files are .c3d or .trc, not {kind!r}')
    if not raw.time.size:
        raise FileFormatError(markers, 'holds no frame')
    positions, notes = without_zeros(markers, raw.names, raw.positions)
    return replace(raw, positions=positions, notes=(*raw.notes, *notes))


def rename_markers(raw: RawRecording, entry: SubjectFile) -> RawRecording:
    """Return the recording with the marker names of the marker set (`recording.rename`)."""
    rename = entry.recording.rename
    unknown = [name for name in rename if name not in raw.names]
    if unknown:
        raise SubjectFileError(
            f'{entry.path}: recording.rename.{unknown[0]}: {raw.path} has no such marker'
        )
    names = tuple(rename.get(name, name) for name in raw.names)
    if len(set(names)) < len(names):
        raise SubjectFileError(f'{entry.path}: recording.rename gives two markers one name')
    return replace(raw, names=names)


def read_recording(options: ImportOptions) -> ReadRecording:
    """Read the files, bring them into the conventions of the graph and check them.

    Raises
    ------
    BagError
        One of its kinds, naming file, field and value.
    """
    entry = read_subject_file(options.subject)
    if options.output.exists():
        raise BagError(f'{options.output} exists already; it is not overwritten')
    person = entry.subject
    carried = Carried(person.mass, entry.task.box.mass, tuple(entry.recording.box_markers))

    def aligned(raw: RawRecording, conventions: ConventionOptions) -> Recording:
        return align(
            rename_markers(raw, entry),
            person.stature,
            carried,
            conventions,
            entry.recording.roles,
        )

    raw = read_raw(options.markers, options.forces, entry.recording.emg, options.label_prefix)
    if raw.time.size < 2:
        raise FileFormatError(options.markers, 'holds one frame; a recording needs two or more')
    recording = aligned(raw, options.conventions)
    if options.static is None:
        return ReadRecording(entry, recording)
    still = read_raw(options.static, None, (), options.label_prefix)
    # The conventions of the static trial are detected anew: it may be another file kind.
    trial = aligned(replace(still, plates=()), replace(options.conventions, plates={}))
    return ReadRecording(entry, recording, trial)


def write_bag(options: ImportOptions, read: ReadRecording) -> ImportReport:
    """Write a recording to `options.output`."""
    entry, recording = read.entry, read.recording
    counts: dict[str, int] = {}
    origin_ns = options.start_time_ns - round(recording.time[0] * 1e9)
    statements = recording.statements
    position, quaternion = None, None
    if entry.recording.box_markers:
        try:
            position, quaternion, misfits = box_poses(
                recording.names, recording.markers, entry.recording.box_markers
            )
        except ConventionError as error:
            raise ConventionError(f'{entry.path}: {error}') from error
        if misfits:
            statements += (f'Box: no pose in {misfits} frames, whose markers do not fit the box.',)
    source = ' '.join((f'Imported from {recording.path.name}.', *statements))
    with BagWriter(options.output, compress=options.compress) as writer:
        streams = [_latched(writer, options.start_time_ns, entry, source, read.calibration)]
        streams.append(marker_stream(writer, origin_ns, recording))
        streams += [
            plate_stream(writer, origin_ns, side, recording.plates[side])
            for side in SIDES
            if side in recording.plates
        ]
        if position is not None and quaternion is not None:
            streams.append(pose_stream(writer, origin_ns, recording.time, position, quaternion))
        if recording.analog is not None:
            streams.append(_emg_stream(writer, origin_ns, recording.analog))
        for stamp, topic, message in in_order(*streams):
            writer.write(topic, stamp, message)
            counts[topic] = counts.get(topic, 0) + 1
    return ImportReport(
        bag=options.output,
        statements=statements,
        messages=counts,
        duration=float(recording.time[-1] - recording.time[0]),
    )


Stream = Iterator[tuple[int, str, Any]]


def _latched(
    writer: BagWriter,
    stamp_ns: int,
    entry: SubjectFile,
    source: str,
    calibration: MarkerCalibration | None,
) -> Stream:
    writer.topic('subject', 'lifting_interfaces/msg/Subject', transient_local=True)
    writer.topic('task', 'lifting_interfaces/msg/Task', transient_local=True)
    subject = subject_message(
        writer, stamp_ns, entry.subject, entry.source, entry.recording.marker_set, calibration
    )
    return iter(
        (
            (stamp_ns, 'subject', subject),
            (stamp_ns, 'task', task_message(writer, stamp_ns, entry.task, source)),
        )
    )


def marker_stream(writer: BagWriter, origin_ns: int, recording: Recording) -> Stream:
    """Yield the `markers` messages; announces the topic at once."""
    writer.topic('markers', 'lifting_interfaces/msg/Markers')

    def stream() -> Stream:
        for frame, (time, places) in enumerate(
            zip(recording.time, recording.markers, strict=True)
        ):
            stamp = origin_ns + round(time * 1e9)
            yield stamp, 'markers', writer.markers(stamp, frame, recording.names, places)

    return stream()


def plate_stream(writer: BagWriter, origin_ns: int, side: str, plate: Plate) -> Stream:
    """Yield the wrenches under one foot; announces the topic at once."""
    topic = f'force_plates/{side}/wrench'
    writer.topic(topic, 'geometry_msgs/msg/WrenchStamped')

    def stream() -> Stream:
        for time, force, moment in zip(plate.time, plate.force, plate.moment, strict=True):
            stamp = origin_ns + round(time * 1e9)
            yield stamp, topic, writer.wrench(stamp, force, moment)

    return stream()


def pose_stream(
    writer: BagWriter, origin_ns: int, time: Array, position: Array, quaternion: Array
) -> Stream:
    """Yield the poses of the box where it was seen; announces the topic at once."""
    writer.topic('box/pose', 'geometry_msgs/msg/PoseStamped')

    def stream() -> Stream:
        for i in np.flatnonzero(np.isfinite(position[:, 0])):
            stamp = origin_ns + round(time[i] * 1e9)
            yield stamp, 'box/pose', writer.pose(stamp, position[i], quaternion[i])

    return stream()


def _emg_stream(writer: BagWriter, origin_ns: int, analog: Analog) -> Stream:
    """Yield blocks of samples: rows samples, columns channels; names and units in the layout."""
    writer.topic('emg', 'std_msgs/msg/Float64MultiArray')
    period = float(np.median(np.diff(analog.time)))
    block = max(1, round(_EMG_BLOCK_SECONDS / period))
    channels = ','.join(f'{n} [{u}]' for n, u in zip(analog.names, analog.units, strict=True))

    def stream() -> Stream:
        for start in range(0, analog.time.size, block):
            part = analog.values[start : start + block]
            rows, columns = part.shape
            dims = [
                writer.make(
                    'std_msgs/msg/MultiArrayDimension', label=label, size=size, stride=stride
                )
                for label, size, stride in (
                    (f'samples, {1.0 / period:g} Hz', rows, rows * columns),
                    (channels, columns, columns),
                )
            ]
            layout = writer.make('std_msgs/msg/MultiArrayLayout', dim=dims, data_offset=0)
            message = writer.make(
                'std_msgs/msg/Float64MultiArray',
                layout=layout,
                data=np.ascontiguousarray(part).ravel(),
            )
            yield origin_ns + round(analog.time[start] * 1e9), 'emg', message

    return stream()
