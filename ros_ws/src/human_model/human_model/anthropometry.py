# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Segment lengths, masses, centres of mass and inertia tensors from a few body measures.

Lengths come from regressions on stature and mass (ANSUR II) and, inside the trunk and the foot,
from the lifting full-body model; measured lengths replace them. Masses, centres of mass and
inertia tensors are the fractions of Dumas et al. 2007, which stand in for GEBOD: they reproduce
the thesis' masses of table 2.2 to about one percent. The fractions of a sex add up to 1.002 or
0.999; they are divided by their sum, so that the segments weigh exactly what the subject weighs.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from human_model.exceptions import AnthropometryError
from human_model.frames import ROS_FROM_OPENSIM
from human_model.inertia import combine, positive_inertia, rotate
from human_model.subject import Subject
from human_model.tables import Row, length_sum, read_table
from human_model.typing import Array

#: Share of the foot's mass that is in the toes, and the toes' centre of mass and inertia, from
#: the body ``toes_r`` of Rajagopal et al. 2016 (0.2166 kg of 1.5666 kg talus, calcaneus, toes).
TOES_MASS_FRACTION = 0.2166 / 1.5666

TRUNK = ('pelvis', 'lumbar', 'thorax', 'head')
LIMBS = ('upper_arm', 'forearm', 'hand', 'thigh', 'shank', 'foot', 'toes')

#: Lengths that may be negative (offsets to the back).
_OFFSETS = ('l5s1_forward', 'sacrum_forward', 't12l1_forward', 'shoulder_forward', 'c7_forward')
#: Lengths that may be zero (the thesis' skeletons have no such offset).
_MAY_BE_ZERO = ('l5s1_height', 'ankle_height', 'heel_length', 'mtp_drop', 'hand_grip')
#: Columns of the centre of mass and of the signed radii of gyration.
_COM = ('com_x', 'com_y', 'com_z')
_RADII = ('r_xx', 'r_yy', 'r_zz', 'r_xy', 'r_xz', 'r_yz')


@dataclass(frozen=True, eq=False)
class SegmentParameters:
    """Geometry and inertia of all segments of one skeleton.

    Attributes
    ----------
    lengths : mapping
        Segment lengths [m] by name (``data/segment_lengths.csv`` says what they mean).
    segments : tuple of str, n
    mass : ndarray (n,)
        kg.
    com : ndarray (n, 3)
        Centre of mass in the segment's anatomical frame [m]: REP-103 axes in the neutral
        posture, origin in the proximal joint.
    inertia : ndarray (n, 3, 3)
        Inertia tensor about the centre of mass in the same axes [kg m^2].
    sources : mapping
        Where each length, and ``mass``, ``com``, ``inertia``, comes from.
    """

    lengths: Mapping[str, float]
    segments: tuple[str, ...]
    mass: Array
    com: Array
    inertia: Array
    sources: Mapping[str, str]

    def __post_init__(self) -> None:
        """Check shapes and that every inertia tensor can belong to a body."""
        n = len(self.segments)
        if self.mass.shape != (n,) or self.com.shape != (n, 3) or self.inertia.shape != (n, 3, 3):
            raise AnthropometryError(
                f'{n} segments, but shapes {self.mass.shape}, '
                f'{self.com.shape}, {self.inertia.shape}'
            )
        for i, name in enumerate(self.segments):
            if not (np.isfinite(self.mass[i]) and self.mass[i] >= 0):
                raise AnthropometryError(f'{name}: mass {self.mass[i]} kg')
            if self.mass[i] > 0 and not positive_inertia(self.inertia[i]):
                raise AnthropometryError(
                    f'{name}: inertia {self.inertia[i].tolist()} kg m^2 cannot belong to a body'
                )
        for array in (self.mass, self.com, self.inertia):
            array.setflags(write=False)

    @property
    def total_mass(self) -> float:
        """Sum of the segment masses [kg]."""
        return float(self.mass.sum())

    def index(self, segment: str) -> int:
        """Index of a segment by name."""
        if segment not in self.segments:
            raise AnthropometryError(
                f'no segment named {segment!r}; there are {", ".join(self.segments)}'
            )
        return self.segments.index(segment)


#: Dumas' forearm and hand are supinated; the palm of the neutral posture faces the thigh. Turn
#: of the right arm by 90 degrees about the upward axis.
_PALM_IN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def body_dimensions(sex: str, stature: float, mass: float) -> dict[str, float]:
    """ANSUR II body dimensions [m] by regression on stature [m] and mass [kg]."""
    dimensions = {'stature': stature}
    columns = 'sex dimension constant per_stature per_mass'
    for row in read_table('human_model', 'ansur2_regressions.csv', columns):
        if row['sex'] == sex:
            constant, per_stature, per_mass = row.numbers('constant', 'per_stature', 'per_mass')
            dimensions[row['dimension']] = constant + per_stature * stature + per_mass * mass
    return dimensions


def segment_lengths(subject: Subject) -> tuple[dict[str, float], dict[str, str]]:
    """Segment lengths [m] of a subject and their sources; measured lengths take precedence.

    ``subject.lengths`` go before those of ``subject.calibration``, both before the regressions.

    Raises
    ------
    AnthropometryError
        If a measured length has an unknown name or a length comes out not positive.
    """
    measured = {**(subject.calibration.lengths if subject.calibration else {}), **subject.lengths}
    columns = 'length sex reference reference_stature reference_mass scale_by terms'
    rows = read_table('human_model', 'segment_lengths.csv', columns)
    table = [row for row in rows if row['sex'] in ('both', subject.sex)]
    unknown = sorted(set(measured) - {row['length'] for row in table})
    if unknown:
        raise AnthropometryError(
            f'subject.lengths: unknown length {unknown[0]!r}; known are '
            + ', '.join(row['length'] for row in table)
        )
    own = body_dimensions(subject.sex, subject.stature, subject.mass)
    predicted: dict[str, float] = {}
    for row in table:
        if row['reference']:
            # The generic full-body models are men; other references are of the subject's sex.
            reference = body_dimensions(
                'male' if row['sex'] == 'both' else subject.sex,
                row.number('reference_stature'),
                row.number('reference_mass'),
            )
            value = row.number('reference') * own[row['scale_by']] / reference[row['scale_by']]
        else:
            value = length_sum(row['terms'], {**own, **predicted})
        predicted[row['length']] = value
    lengths = {name: float(measured.get(name, value)) for name, value in predicted.items()}
    sources = {
        row['length']: 'measured' if row['length'] in measured else row['source'] for row in table
    }
    for name, value in lengths.items():
        low = 0.0 if name in _MAY_BE_ZERO and value == 0.0 else 0.005
        if name not in _OFFSETS and value < low:
            raise AnthropometryError(
                f'length {name}: {value:.4f} m of subject {subject.pseudonym!r} is not positive'
            )
    return lengths, sources


def segment_parameters(subject: Subject) -> SegmentParameters:
    """Lengths, masses, centres of mass and inertia tensors of the 3D skeleton's segments.

    Raises
    ------
    AnthropometryError
        If a length is unknown or a result is not physical.
    """
    lengths, sources = segment_lengths(subject)
    bodies = _dumas_bodies(subject.sex, lengths)
    total = sum(body[0] for body in bodies.values())
    names = tuple(bodies)
    sources = {
        **sources,
        'mass': 'Dumas et al. 2007 fractions, divided by their sum '
        f'({_fraction_sum(subject.sex):.3f}) to give the mass of the subject',
        'com': 'Dumas et al. 2007, 2015',
        'inertia': 'Dumas et al. 2007, 2015',
    }
    scale = subject.mass / total
    return SegmentParameters(
        lengths,
        names,
        np.array([bodies[name][0] for name in names]) * scale,
        np.array([bodies[name][1] for name in names]),
        np.array([bodies[name][2] for name in names]) * scale,
        sources,
    )


def _fraction_sum(sex: str) -> float:
    return sum(
        row.number('mass_fraction') * (1 if row['segment'] in TRUNK else 2)
        for row in _dumas_rows(sex)
    )


def _dumas_rows(sex: str) -> list[Row]:
    columns = ' '.join(('sex segment mass_fraction', *_COM, *_RADII))
    rows = read_table('human_model', 'dumas_inertia.csv', columns)
    return [row for row in rows if row['sex'] == sex]


def _long_axes(lengths: Mapping[str, float]) -> dict[str, Array]:
    """Vector [m] along each segment's long axis, upward or to the toes, REP-103, neutral."""
    return {
        'pelvis': np.array([lengths['l5s1_forward'], 0.0, lengths['l5s1_height']]),
        'lumbar': np.array([lengths['t12l1_forward'], 0.0, lengths['t12l1_height']]),
        'thorax': np.array([lengths['c7_forward'], 0.0, lengths['c7_height']]),
        'head': np.array([0.0, 0.0, lengths['head_neck']]),
        'upper_arm': np.array([0.0, 0.0, lengths['upper_arm']]),
        'forearm': np.array([0.0, 0.0, lengths['forearm']]),
        'hand': np.array([0.0, 0.0, lengths['hand']]),
        'thigh': np.array([0.0, 0.0, lengths['thigh']]),
        'shank': np.array([0.0, 0.0, lengths['shank']]),
    }


def _dumas_bodies(sex: str, lengths: Mapping[str, float]) -> dict[str, tuple[float, Array, Array]]:
    """Mass fraction, centre of mass and unit-mass-fraction inertia, segment by segment."""
    axes = _long_axes(lengths)
    #: Dumas' origins that are not the proximal joint of this skeleton.
    origin = {name: axes[name] for name in ('pelvis', 'lumbar', 'thorax')}
    #: Lengths Dumas' fractions belong to where the segment has no such length itself.
    sizes = {
        'pelvis': lengths['pelvis_length'],
        'foot': float(np.hypot(lengths['ankle_mtp'], lengths['mtp_drop'])),
    }
    right: dict[str, tuple[float, Array, Array]] = {}
    for row in _dumas_rows(sex):
        name = row['segment']
        turn = _upright_to(axes[name]) if name in axes else np.eye(3)
        length = sizes.get(name, float(np.linalg.norm(axes.get(name, 0.0))))
        mass = row.number('mass_fraction')
        com = np.array(row.numbers(*_COM)) * length
        inertia = _dumas_tensor(row) * mass * length**2
        if name in ('forearm', 'hand'):
            turn = _PALM_IN
        axes_change = turn @ ROS_FROM_OPENSIM
        com = axes_change @ com + origin.get(name, np.zeros(3))
        right[name] = (mass, com, rotate(inertia, axes_change))
    right['foot'], right['toes'] = _split_foot(right['foot'], lengths)
    bodies = {name: _symmetric(right[name]) for name in TRUNK}
    for name in LIMBS:
        bodies[f'{name}_r'] = right[name]
        bodies[f'{name}_l'] = _mirrored(right[name])
    return bodies


def _dumas_tensor(row: Row) -> Array:
    """Tensor per m L^2 in ISB axes: diagonal r^2, off-diagonal sign(r) r^2."""
    xx, yy, zz, xy, xz, yz = (radius * abs(radius) for radius in row.numbers(*_RADII))
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _upright_to(direction: Array) -> Array:
    """Rotation in the sagittal plane that takes the upward axis to a direction without y."""
    norm = np.linalg.norm(direction)
    if norm == 0.0:
        return np.eye(3)
    x, _, z = direction / norm
    return np.array([[z, 0.0, x], [0.0, 1.0, 0.0], [-x, 0.0, z]])


def _mirrored(body: tuple[float, Array, Array]) -> tuple[float, Array, Array]:
    mirror = np.diag([1.0, -1.0, 1.0])
    return body[0], mirror @ body[1], mirror @ body[2] @ mirror


def _symmetric(body: tuple[float, Array, Array]) -> tuple[float, Array, Array]:
    """Sagittally symmetric version: a person of no measured asymmetry stands straight."""
    mass, com, inertia = body
    _, com_mirrored, inertia_mirrored = _mirrored(body)
    return mass, (com + com_mirrored) / 2, (inertia + inertia_mirrored) / 2


def _split_foot(
    foot: tuple[float, Array, Array], lengths: Mapping[str, float]
) -> tuple[tuple[float, Array, Array], tuple[float, Array, Array]]:
    """Divide Dumas' foot into hindfoot (origin ankle) and toes (origin MTP joint)."""
    columns = 'length mass com_x com_z i_xx i_yy i_zz'
    row = read_table('human_model', 'toes_inertia.csv', columns)[0]
    scale = lengths['toes'] / row.number('length')
    mass = foot[0] * TOES_MASS_FRACTION
    forward, up = row.numbers('com_x', 'com_z')
    com = np.array([forward, 0.0, up]) * scale
    inertia = np.diag(row.numbers('i_xx', 'i_yy', 'i_zz')) * scale**2 * (mass / row.number('mass'))
    to_ankle = np.array([lengths['ankle_mtp'], 0.0, -lengths['mtp_drop']])
    hindfoot = combine([foot, (-mass, com + to_ankle, -inertia)])
    return hindfoot, (mass, com, inertia)


def sagittal_parameters(parameters: SegmentParameters) -> SegmentParameters:
    """Segments of the sagittal skeleton from those of the 3D one: paired limbs are one link.

    Trunk = lumbar, thorax and head in the neutral posture; forearm = both forearms and hands.
    """
    lengths = parameters.lengths
    t12l1 = np.array([lengths['t12l1_forward'], 0.0, lengths['t12l1_height']])
    c7 = t12l1 + np.array([lengths['c7_forward'], 0.0, lengths['c7_height']])
    wrist = np.array([0.0, 0.0, -lengths['forearm']])
    none = np.zeros(3)
    groups: dict[str, list[tuple[str, Array]]] = {
        'pelvis': [('pelvis', none)],
        'trunk': [('lumbar', none), ('thorax', t12l1), ('head', c7)],
        'forearm': [
            (f'{part}_{side}', at)
            for part, at in (('forearm', none), ('hand', wrist))
            for side in 'rl'
        ],
    }
    for name in ('upper_arm', 'thigh', 'shank', 'foot', 'toes'):
        groups[name] = [(f'{name}_{side}', none) for side in 'rl']
    order = ('pelvis', 'trunk', 'upper_arm', 'forearm', 'thigh', 'shank', 'foot', 'toes')
    bodies = []
    for name in order:
        parts = [(parameters.index(part), at) for part, at in groups[name]]
        bodies.append(
            combine(
                [
                    (float(parameters.mass[i]), parameters.com[i] + at, parameters.inertia[i])
                    for i, at in parts
                ]
            )
        )
    return SegmentParameters(
        lengths,
        order,
        np.array([body[0] for body in bodies]),
        np.array([body[1] for body in bodies]),
        np.array([body[2] for body in bodies]),
        parameters.sources,
    )
