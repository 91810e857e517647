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
      marker_set: plug_in_gait_58    # name of the marker set the tracker is to use
      rename: {OLD: NEW}       # marker names of the file to names of the set
      roles: {HEEL_R: heel right}    # for marker names the importer does not know
      box_markers: {BOX1: [x, y, z]} # three or more, m from the box centre, box axes
      emg: [EMG1, EMG2]        # analog channels of a C3D file to keep; else all but the plates
      plate_registration: as_recorded  # or quiet_standing: plates are moved, see there
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from lifting_recordings.exceptions import SubjectFileError

# Adults: outside these a number is taken for a unit error, not for a person.
_RANGES = {'mass': (30.0, 250.0), 'stature': (1.2, 2.3), 'age': (16.0, 100.0)}
_SEXES = {'male': 1, 'female': 2}
_COUPLINGS = {'good': 1, 'fair': 2, 'poor': 3}
_NAN3 = (math.nan, math.nan, math.nan)


#: Where the plates are: as the file says, or as quiet standing says (see `plate_registration`).
AS_RECORDED, QUIET_STANDING = 'as_recorded', 'quiet_standing'


@dataclass(frozen=True)
class SubjectEntry:
    """Fields of lifting_interfaces/Subject that a person enters; units as in the message."""

    pseudonym: str
    sex: int
    mass: float
    stature: float
    age: float
    strength_z: float = 0.0
    segment_lengths: Mapping[str, float] = field(default_factory=dict)
    source: str = ''


@dataclass(frozen=True)
class TaskEntry:
    """Fields of lifting_interfaces/Task that a person enters; units as in the message."""

    task_id: str
    description: str
    box_mass: float
    box_size: tuple[float, float, float]
    coupling: int
    lifts_per_minute: float
    lifts_per_day: float
    duration_hours: float
    control_at_destination: bool = False
    box_start: tuple[float, float, float] = _NAN3
    box_end: tuple[float, float, float] = _NAN3
    simulated: bool = False


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
    """The whole file."""

    path: Path
    subject: SubjectEntry
    task: TaskEntry
    recording: RecordingEntry


class _Section:
    """One mapping of the file; every access checks and names the field."""

    def __init__(self, path: Path, name: str, data: object) -> None:
        if not isinstance(data, dict):
            raise SubjectFileError(f'{path}: section {name!r} is missing or not a mapping')
        self._path, self._name = path, name
        self._data: dict[str, Any] = dict(data)

    def error(self, key: str, problem: str) -> SubjectFileError:
        return SubjectFileError(f'{self._path}: {self._name}.{key}: {problem}')

    def take(self, key: str, *default: object) -> Any:
        if key in self._data:
            return self._data.pop(key)
        if default:
            return default[0]
        raise self.error(key, 'is missing')

    def number(self, key: str, *default: float) -> float:
        value = self.take(key, *default)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.error(key, f'expected a number, found {value!r}')
        if not math.isfinite(value):
            raise self.error(key, f'is {value}')
        if key in _RANGES and not _RANGES[key][0] <= value <= _RANGES[key][1]:
            raise self.error(key, f'{value:g} is outside {_RANGES[key]}')
        return float(value)

    def at_least_zero(self, key: str, *default: float) -> float:
        value = self.number(key, *default)
        if value < 0.0:
            raise self.error(key, f'{value:g} is negative')
        return value

    def text(self, key: str, *default: str) -> str:
        value = self.take(key, *default)
        if not isinstance(value, str):
            raise self.error(key, f'expected a text, found {value!r}')
        return value.strip()

    def flag(self, key: str, default: bool) -> bool:
        value = self.take(key, default)
        if not isinstance(value, bool):
            raise self.error(key, f'expected true or false, found {value!r}')
        return value

    def choice(self, key: str, choices: Mapping[str, int]) -> int:
        value = self.take(key)
        if value not in choices:
            raise self.error(key, f'{value!r} is not one of {", ".join(choices)}')
        return choices[value]

    def triple(self, key: str, *default: tuple[float, float, float]) -> tuple[float, float, float]:
        return self.as_triple(key, self.take(key, *default))

    def as_triple(self, key: str, value: object) -> tuple[float, float, float]:
        if not isinstance(value, list | tuple) or len(value) != 3:
            raise self.error(key, f'expected three numbers, found {value!r}')
        if any(isinstance(v, bool) or not isinstance(v, int | float) for v in value):
            raise self.error(key, f'expected three numbers, found {value!r}')
        return (float(value[0]), float(value[1]), float(value[2]))

    def mapping(self, key: str) -> dict[str, Any]:
        value = self.take(key, {})
        if not isinstance(value, dict):
            raise self.error(key, f'expected a mapping, found {value!r}')
        return {str(k): v for k, v in value.items()}

    def texts(self, key: str) -> dict[str, str]:
        return {k: str(v) for k, v in self.mapping(key).items()}

    def finish(self) -> None:
        if self._data:
            raise self.error(next(iter(self._data)), 'is not a known field')


def read_subject_file(path: str | Path) -> SubjectFile:
    """Read and validate a subject file (schema in the module's docstring).

    Raises
    ------
    SubjectFileError
        Naming file, field and value.
    """
    path = Path(path)
    whole = _whole(path)
    subject = _subject(_Section(path, 'subject', whole.take('subject', None)))
    task = _task(_Section(path, 'task', whole.take('task', None)))
    recording = _recording(_Section(path, 'recording', whole.take('recording', {})))
    whole.finish()
    return SubjectFile(path, subject, task, recording)


def read_person(path: str | Path) -> SubjectEntry:
    """Read only who it is: section `subject` of a subject file or of a task file.

    Raises
    ------
    SubjectFileError
        Naming file, field and value.
    """
    path = Path(path)
    return _subject(_Section(path, 'subject', _whole(path).take('subject', None)))


def _whole(path: Path) -> _Section:
    try:
        data = yaml.safe_load(path.read_text(encoding='utf-8'))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise SubjectFileError(f'{path}: cannot be read: {error}') from error
    return _Section(path, 'file', data)


def _subject(section: _Section) -> SubjectEntry:
    pseudonym = section.text('pseudonym')
    if not pseudonym:
        raise section.error('pseudonym', 'is empty')
    lengths = section.mapping('segment_lengths')
    for name, value in lengths.items():
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < 2.0:
            raise section.error(f'segment_lengths.{name}', f'{value!r} is not a length in metres')
    entry = SubjectEntry(
        pseudonym=pseudonym,
        sex=section.choice('sex', _SEXES),
        mass=section.number('mass'),
        stature=section.number('stature'),
        age=section.number('age'),
        strength_z=section.number('strength_z', 0.0),
        segment_lengths={k: float(v) for k, v in lengths.items()},
        source=section.text('source', ''),
    )
    section.finish()
    return entry


def _task(section: _Section) -> TaskEntry:
    box_mass = section.at_least_zero('box_mass')
    size = section.triple('box_size', *(() if box_mass > 0.0 else ((0.0, 0.0, 0.0),)))
    if box_mass > 0.0 and min(size) <= 0.0:
        raise section.error('box_size', f'{size} is not positive, but box_mass is {box_mass:g} kg')
    entry = TaskEntry(
        task_id=section.text('task_id'),
        description=section.text('description', ''),
        box_mass=box_mass,
        box_size=size,
        coupling=section.choice('coupling', _COUPLINGS),
        lifts_per_minute=section.at_least_zero('lifts_per_minute'),
        lifts_per_day=section.at_least_zero('lifts_per_day'),
        duration_hours=section.at_least_zero('duration_hours'),
        control_at_destination=section.flag('control_at_destination', False),
        box_start=section.triple('box_start', _NAN3),
        box_end=section.triple('box_end', _NAN3),
        simulated=section.flag('simulated', False),
    )
    section.finish()
    return entry


def _recording(section: _Section) -> RecordingEntry:
    emg = section.take('emg', None)
    if emg is not None and not isinstance(emg, list):
        raise section.error('emg', f'expected a list of channel names, found {emg!r}')
    box = section.mapping('box_markers')
    if box and len(box) < 3:
        raise section.error('box_markers', f'{len(box)} markers do not fix a box; 3 are needed')
    registration = section.text('plate_registration', AS_RECORDED)
    if registration not in (AS_RECORDED, QUIET_STANDING):
        raise section.error(
            'plate_registration', f'{registration!r} is neither {AS_RECORDED} nor {QUIET_STANDING}'
        )
    entry = RecordingEntry(
        marker_set=section.text('marker_set', ''),
        rename=section.texts('rename'),
        roles=section.texts('roles'),
        box_markers={k: section.as_triple(f'box_markers.{k}', v) for k, v in box.items()},
        emg=None if emg is None else tuple(str(name) for name in emg),
        plate_registration=registration,
    )
    section.finish()
    return entry
