# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The person: identity under a pseudonym, body measures, strength, and marker calibration."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from human_model.exceptions import SubjectError
from human_model.fields import Fields

SEXES = ('male', 'female')

#: Accepted values: outside of these the ANSUR II regressions (adults, US Army 2012) and the
#: strength data are extrapolated too far, or the unit is wrong (grams, centimetres, pounds).
RANGES = {
    'mass': (30.0, 250.0, 'kg'),
    'stature': (1.2, 2.2, 'm'),
    'age': (14.0, 100.0, 'years'),
    'strength_z': (-2.0, 3.0, 'standard deviations'),
}

#: Accepted segment lengths [m]; negative for the two that are offsets to the back.
LENGTH_RANGE = (-0.2, 1.2)


def _real(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise SubjectError(f'subject.{name}', value, f'a number is needed, got {value!r}')
    number = float(value)
    if not np.isfinite(number):
        raise SubjectError(f'subject.{name}', number, f'a finite number is needed, got {number}')
    return number


@dataclass(frozen=True, eq=False)
class Calibration:
    """Marker model of one subject, measured in a static trial.

    Attributes
    ----------
    marker_names : tuple of str, n
        Markers as named in the recording.
    segments : tuple of str, n
        Segment each marker is fixed to.
    local_offsets : ndarray (n, 3)
        Marker position in the segment's anatomical frame [m].
    lengths : mapping
        Segment lengths measured in the static trial [m], by name of `anthropometry`.
    residual_rms : float
        Root mean square distance of model and measured markers in the static trial [m].
    """

    marker_names: tuple[str, ...]
    segments: tuple[str, ...]
    local_offsets: npt.NDArray[np.float64]
    lengths: Mapping[str, float] = field(default_factory=dict)
    residual_rms: float = 0.0

    def __post_init__(self) -> None:
        """Check that names, segments and offsets belong together."""
        offsets = np.array(self.local_offsets, dtype=np.float64)
        offsets.setflags(write=False)
        object.__setattr__(self, 'local_offsets', offsets)
        object.__setattr__(self, 'marker_names', tuple(self.marker_names))
        object.__setattr__(self, 'segments', tuple(self.segments))
        object.__setattr__(self, 'lengths', dict(self.lengths))
        n = len(self.marker_names)
        if len(self.segments) != n or offsets.shape != (n, 3):
            raise SubjectError(
                'calibration',
                (n, len(self.segments), offsets.shape),
                f'{n} marker names, {len(self.segments)} segments and local_offsets of shape '
                f'{offsets.shape} do not belong together',
            )
        if len(set(self.marker_names)) != n:
            raise SubjectError(
                'calibration.marker_names', self.marker_names, 'a name occurs twice'
            )
        if not np.all(np.isfinite(offsets)):
            raise SubjectError('calibration.local_offsets', offsets, 'not finite')
        if not _real('calibration.residual_rms', self.residual_rms) >= 0.0:
            raise SubjectError(
                'calibration.residual_rms', self.residual_rms, f'negative, got {self.residual_rms}'
            )

    def to_dict(self) -> dict[str, Any]:
        """Plain dictionary (lists, numbers, strings) of the calibration."""
        return {
            'marker_names': list(self.marker_names),
            'segments': list(self.segments),
            'local_offsets': self.local_offsets.tolist(),
            'lengths': dict(self.lengths),
            'residual_rms': float(self.residual_rms),
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> 'Calibration':
        """Inverse of `to_dict`; a missing field is named."""
        for name in ('marker_names', 'segments', 'local_offsets'):
            if name not in fields:
                raise SubjectError(f'calibration.{name}', None, 'missing')
        return cls(
            tuple(fields['marker_names']),
            tuple(fields['segments']),
            np.asarray(fields['local_offsets'], dtype=np.float64).reshape(-1, 3),
            dict(fields.get('lengths', {})),
            float(fields.get('residual_rms', 0.0)),
        )


@dataclass(frozen=True, eq=False)
class Subject:
    """One person, entered once; every result carries the pseudonym and the mass.

    Attributes
    ----------
    pseudonym : str
        Name in reports and messages; never the person's own.
    sex : {'male', 'female'}
        Chooses the anthropometric regressions and the strength tables.
    mass : float
        Body mass [kg].
    stature : float
        Standing height [m].
    age : float
        Years.
    strength_z : float
        Strength percentile as a z-score (thesis equations 2.15 and 2.18).
    lengths : mapping
        Measured segment lengths [m]; they replace the regressions. Names: `anthropometry`.
    calibration : Calibration or None
        Marker model, once a static trial was seen.
    """

    pseudonym: str
    sex: str
    mass: float
    stature: float
    age: float
    strength_z: float = 0.0
    lengths: Mapping[str, float] = field(default_factory=dict)
    calibration: Calibration | None = None

    def __post_init__(self) -> None:
        """Check every field against its range."""
        if not isinstance(self.pseudonym, str) or not self.pseudonym.strip():
            raise SubjectError(
                'subject.pseudonym', self.pseudonym, f'a name is needed, got {self.pseudonym!r}'
            )
        if self.sex not in SEXES:
            raise SubjectError(
                'subject.sex', self.sex, f'{" or ".join(SEXES)} is needed, got {self.sex!r}'
            )
        for name, (low, high, unit) in RANGES.items():
            value = _real(name, getattr(self, name))
            if not low <= value <= high:
                raise SubjectError(
                    f'subject.{name}',
                    value,
                    f'{value:g} {unit} is outside of {low:g} to {high:g} {unit}, the range this '
                    'model accepts',
                )
            object.__setattr__(self, name, value)
        if not isinstance(self.lengths, Mapping):
            raise SubjectError(
                'subject.lengths',
                self.lengths,
                f'lengths by name are needed, got {self.lengths!r}',
            )
        lengths = {}
        for name, length in self.lengths.items():
            value = _real(f'lengths[{name}]', length)
            if not LENGTH_RANGE[0] <= value <= LENGTH_RANGE[1]:
                raise SubjectError(
                    f'subject.lengths[{name}]',
                    value,
                    f'{value:g} m is outside of {LENGTH_RANGE[0]:g} to {LENGTH_RANGE[1]:g} m',
                )
            lengths[str(name)] = value
        object.__setattr__(self, 'lengths', lengths)
        if self.calibration is not None and not isinstance(self.calibration, Calibration):
            raise SubjectError(
                'subject.calibration',
                self.calibration,
                f'no calibration, got {self.calibration!r}',
            )

    def to_dict(self) -> dict[str, Any]:
        """Plain dictionary (for YAML or JSON) of the subject."""
        return {
            'pseudonym': self.pseudonym,
            'sex': self.sex,
            'mass': self.mass,
            'stature': self.stature,
            'age': self.age,
            'strength_z': self.strength_z,
            'lengths': dict(self.lengths),
            'calibration': None if self.calibration is None else self.calibration.to_dict(),
        }

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> 'Subject':
        """Inverse of `to_dict`; unknown or missing fields are named.

        Raises
        ------
        SubjectError
            If a field is missing, unknown or out of range.
        """
        known = {
            'pseudonym',
            'sex',
            'mass',
            'stature',
            'age',
            'strength_z',
            'lengths',
            'calibration',
        }
        unknown = sorted(set(fields) - known)
        if unknown:
            raise SubjectError('subject', unknown[0], f'unknown field {unknown[0]!r}')
        missing = sorted({'pseudonym', 'sex', 'mass', 'stature', 'age'} - set(fields))
        if missing:
            raise SubjectError(f'subject.{missing[0]}', None, 'missing')
        values = dict(fields)
        calibration = values.get('calibration')
        if isinstance(calibration, Mapping):
            values['calibration'] = Calibration.from_dict(calibration)
        values['lengths'] = values.get('lengths') or {}
        return cls(**values)


def read_subject(fields: Fields) -> Subject:
    """Take the fields of a person; another field is an error."""
    pseudonym = fields.text('pseudonym')
    if not pseudonym:
        raise fields.error('pseudonym', 'is empty')
    lengths = fields.section('segment_lengths', {})
    subject = Subject(
        pseudonym=pseudonym,
        sex=fields.choice('sex', {sex: sex for sex in SEXES}),
        mass=fields.within('mass', RANGES['mass']),
        stature=fields.within('stature', RANGES['stature']),
        age=fields.within('age', RANGES['age']),
        strength_z=fields.within('strength_z', RANGES['strength_z'], 0.0),
        lengths={name: lengths.within(name, (*LENGTH_RANGE, 'm')) for name in lengths.names()},
    )
    fields.finish()
    return subject
