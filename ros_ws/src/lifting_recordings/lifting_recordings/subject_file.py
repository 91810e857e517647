# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The YAML file that says who lifts what: schema, reading, validation.

::

    subject:
      pseudonym: S04           # never a name or a personnel number
      sex: female              # or male
      mass: 62.6               # kg, without the load
      stature: 1.68            # m
      age: 31                  # years
      strength_z: 0.0          # optional, standard deviations from the population mean
      segment_lengths: {}      # optional, name: m
      joint_widths: {}         # optional, knee, ankle, elbow: m; for static trials without medial
                               # markers
      source: in words         # optional, what was measured and what assumed
    task:
      task_id: squats
      description: five squats
      box_mass: 0.0            # kg; 0: nothing is lifted
      box_size: [0.0, 0.0, 0.0]  # depth, width between the hands, height [m]; needed with a box
      box_start: [x, y, z]     # optional, m, laboratory frame; else taken from the recording
      box_end: [x, y, z]       # optional
      coupling: fair           # good, fair or poor
      lifts_per_minute: 0.2
      lifts_per_day: 100
      duration_hours: 1.0
      control_at_destination: false  # optional
      simulated: false         # optional
    recording:                 # optional
      marker_set: plug_in_gait_58    # name of a marker set, or a CSV file beside this file
      rename: {OLD: NEW}       # marker names of the file to names of the set
      roles: {HEEL_R: heel right}    # for marker names the importer does not know
      box_markers: {BOX1: [x, y, z]} # three or more, m from the box centre, box axes
      emg: [EMG1, EMG2]        # analog channels of a C3D file to keep; else all but the plates
      plate_registration: as_recorded  # or quiet_standing: plates are moved, see there
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from human_model.fields import Fields
from human_model.subject import Subject, read_subject
from human_model.task import Box, Task, read_work
from lifting_recordings.exceptions import SubjectFileError

#: Joints whose width replaces a medial marker, and limits of a width.
_WIDE_JOINTS = ('knee', 'ankle', 'elbow')
_JOINT_WIDTH = (0.03, 0.2, 'm')
#: Sides of a box that two hands lift, and the distance of a marker from its surface (engineering
#: choices: they find centimetres and millimetres written for metres) [m].
_BOX_SIDE = (0.01, 2.0)
_BOX_MARKER_REACH = 0.15

#: Where the plates are: as the file says, or as quiet standing says (see `plate_registration`).
AS_RECORDED, QUIET_STANDING = 'as_recorded', 'quiet_standing'


@dataclass(frozen=True)
class RecordingEntry:
    """What the file's names mean."""

    marker_set: str = ''
    rename: Mapping[str, str] = field(default_factory=dict)
    roles: Mapping[str, str] = field(default_factory=dict)
    box_markers: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    emg: tuple[str, ...] | None = None
    plate_registration: str = AS_RECORDED


@dataclass(frozen=True)
class SubjectFile:
    """The whole file; `source` states what was measured of the person and what was assumed."""

    path: Path
    subject: Subject
    source: str
    task: Task
    recording: RecordingEntry
    joint_widths: Mapping[str, float] = field(default_factory=dict)


class _Section(Fields):
    """One mapping of the file."""

    ERROR = SubjectFileError

    def triple(self, key: str, *default: tuple[float, float, float]) -> tuple[float, float, float]:
        """Take three numbers."""
        x, y, z = self.numbers(key, 3, *default)
        return x, y, z


def read_subject_file(path: str | Path) -> SubjectFile:
    """Read and validate a subject file (schema in the module's docstring).

    Raises
    ------
    SubjectFileError
        Naming file, field and value.
    """
    path = Path(path)
    whole = _Section.read(path)
    person = whole.section('subject')
    widths = person.section('joint_widths', {})
    joint_widths = {
        name: widths.within(name, _JOINT_WIDTH) for name in _WIDE_JOINTS if name in widths
    }
    widths.finish()
    subject, source = _subject(person)
    task = _task(whole.section('task'))
    recording = _recording(whole.section('recording', {}))
    whole.finish()
    for name, place in recording.box_markers.items():
        far = [
            abs(x) > side / 2 + _BOX_MARKER_REACH
            for x, side in zip(place, task.box.size, strict=True)
        ]
        if task.box.mass > 0.0 and any(far):
            raise SubjectFileError(
                f'{path}: recording.box_markers.{name}: {list(place)} m is more than '
                f'{_BOX_MARKER_REACH:g} m outside of the box of task.box_size '
                f'{list(task.box.size)} m: write metres, measured from the centre of the box'
            )
    return SubjectFile(path, subject, source, task, recording, joint_widths)


def read_person(path: str | Path) -> Subject:
    """Read the person only: section `subject` of a subject file or of a task file.

    Raises
    ------
    SubjectFileError
        Naming file, field and value.
    """
    section = _Section.read(Path(path)).section('subject')
    section.take('joint_widths', {})
    return _subject(section)[0]


def _subject(section: _Section) -> tuple[Subject, str]:
    source = section.text('source', '')
    return read_subject(section), source


def _task(section: _Section) -> Task:
    mass = section.at_least_zero('box_mass')
    size = section.triple('box_size', *(() if mass > 0.0 else ((0.0, 0.0, 0.0),)))
    if mass > 0.0 and min(size) <= 0.0:
        raise section.error('box_size', f'{size} is not positive, but box_mass is {mass:g} kg')
    if mass > 0.0 and not all(_BOX_SIDE[0] <= side <= _BOX_SIDE[1] for side in size):
        raise section.error(
            'box_size', f'{size} m: each side is between {_BOX_SIDE[0]:g} and {_BOX_SIDE[1]:g} m'
        )
    start, end = (
        section.triple(key) if key in section else None for key in ('box_start', 'box_end')
    )
    task = Task(
        section.text('task_id'),
        Box(mass, size, start, end),
        read_work(section),
        section.text('description', ''),
        section.flag('simulated', False),
    )
    section.finish()
    return task


def _recording(section: _Section) -> RecordingEntry:
    emg = section.take('emg', None)
    if emg is not None and not isinstance(emg, list):
        raise section.error('emg', f'expected a list of channel names, found {emg!r}')
    box = section.section('box_markers', {})
    names = box.names()
    if 0 < len(names) < 3:
        raise section.error('box_markers', f'{len(names)} markers do not fix a box; 3 are needed')
    registration = section.text('plate_registration', AS_RECORDED)
    if registration not in (AS_RECORDED, QUIET_STANDING):
        raise section.error(
            'plate_registration', f'{registration!r} is neither {AS_RECORDED} nor {QUIET_STANDING}'
        )
    entry = RecordingEntry(
        marker_set=section.text('marker_set', ''),
        rename=_texts(section, 'rename'),
        roles=_texts(section, 'roles'),
        box_markers={name: box.triple(name) for name in names},
        emg=None if emg is None else tuple(str(name) for name in emg),
        plate_registration=registration,
    )
    section.finish()
    return entry


def _texts(section: _Section, key: str) -> dict[str, str]:
    return {name: str(value) for name, value in section.mapping(key).items()}
