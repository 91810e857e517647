# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Segment parameters of the persons of the thesis, from its printed link tables.

Table 2.2 (sagittal skeleton) and table 3.2 (3D skeleton) give link lengths and masses, but no
centres of mass. The Izz of table 2.2 have radii of gyration of 0.53 to 0.61 of the length, about
those of a uniform rod about its end (0.577); they are read as inertia about the proximal joint of
a link with its centre of mass in the middle. (With a centre of mass from Dumas' fractions the
trunk's printed Izz would leave a negative inertia.) The Izz of table 3.2 name no axis and no
point (0.74 of the length for the thigh) and are kept in the data file only; there centres of mass
and inertia tensors come from the fractions of Dumas et al. 2007.
"""

from dataclasses import replace

import numpy as np

from human_model.anthropometry import (
    SegmentParameters,
    sagittal_parameters,
    segment_lengths,
    segment_parameters,
)
from human_model.named_subjects import named_subject
from human_model.subject import Subject
from human_model.tables import Row, read_table


def named_parameters(name: str) -> SegmentParameters:
    """Segment parameters of a named subject: ``thesis_2d`` of the sagittal skeleton, else 3D.

    The masses of ``thesis_2d`` and ``thesis_3d`` are those the thesis prints.
    """
    subject = named_subject(name)
    if name == 'thesis_2d':
        return _thesis_2d(subject)
    return _thesis_3d(subject) if name == 'thesis_3d' else segment_parameters(subject)


def _thesis_2d(subject: Subject) -> SegmentParameters:
    """Masses and Izz of table 2.2, centres of mass in the middle of each link.

    The pelvis has no mass of its own: link 1 reaches from the sacrum, where the hips are too.
    Only the moment of inertia about the lateral axis acts in the plane; the others keep Dumas'
    proportion to it.
    """
    generic = sagittal_parameters(segment_parameters(replace(subject, lengths={})))
    lengths = segment_lengths(subject)[0]
    printed = printed_links('thesis_2d', 'segment', 'length mass inertia_zz')
    n = len(generic.segments)
    mass, com, inertia = np.zeros(n), np.zeros((n, 3)), np.zeros((n, 3, 3))
    for i, segment in enumerate(generic.segments):
        if segment == 'pelvis':
            continue
        mass[i] = printed[segment].number('mass')
        half = printed[segment].number('length') / 2
        if segment in ('foot', 'toes'):
            com[i, 0] = half
        else:
            com[i, 2] = half if segment == 'trunk' else -half
        central = printed[segment].number('inertia_zz') - mass[i] * half**2
        inertia[i] = generic.inertia[i] * (central / generic.inertia[i, 1, 1])
    return SegmentParameters(
        lengths,
        generic.segments,
        mass,
        com,
        inertia,
        {
            **dict.fromkeys(lengths, 'thesis tables 2.2 and 3.2, ANSUR II where they are silent'),
            'mass': 'thesis table 2.2',
            'com': 'middle of the link',
            'inertia': 'thesis table 2.2, about the proximal joint',
        },
    )


def _thesis_3d(subject: Subject) -> SegmentParameters:
    """Masses of table 3.2; the torso (links 2 and 4) divided as Dumas divides it.

    The printed foot (0.1 m to the metatarsal joint, 0.165 m from there to the toe) is no shape
    Dumas' foot can be divided into, so foot and toes keep the generic foot's centres of mass and,
    scaled by mass, its inertia.
    """
    body = {
        name: value for name, value in subject.lengths.items() if name not in ('ankle_mtp', 'toes')
    }
    parameters = segment_parameters(replace(subject, lengths=body))
    link = {
        name: row.number('mass')
        for name, row in printed_links('thesis_3d', 'link', 'mass').items()
    }
    torso = link['L2'] + link['L4']
    share = parameters.mass / parameters.mass[parameters.index('lumbar')]
    thorax = share[parameters.index('thorax')]
    masses = {
        'pelvis': link['L1'] + 2 * link['L9'],
        'lumbar': torso / (1 + thorax),
        'thorax': torso * thorax / (1 + thorax),
        'head': link['L8'],
    }
    for name, key in (
        ('upper_arm', 'L5'),
        ('forearm', 'L6'),
        ('hand', 'L7'),
        ('thigh', 'L10'),
        ('shank', 'L11'),
        ('foot', 'L12'),
        ('toes', 'L13'),
    ):
        masses[f'{name}_r'] = masses[f'{name}_l'] = link[key]
    mass = np.array([masses[name] for name in parameters.segments])
    inertia = parameters.inertia * (mass / parameters.mass)[:, None, None]
    lengths, sources = segment_lengths(subject)
    return replace(
        parameters,
        lengths=lengths,
        mass=mass,
        inertia=inertia,
        sources={**parameters.sources, **sources, 'mass': 'thesis table 3.2'},
    )


def printed_links(name: str, key: str, columns: str) -> dict[str, Row]:
    """Return the printed links of a named subject by the name in a column."""
    rows = read_table('human_model', f'{name}_links.csv', f'{key} {columns}')
    return {row[key]: row for row in rows}
