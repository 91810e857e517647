# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Named subjects: the persons of the thesis, with its own link tables where it prints them.

Table 2.2 (sagittal skeleton) and table 3.2 (3D skeleton) give link lengths and masses; centres of
mass and, in 3D, inertia tensors are not printed and are taken from the fractions of Dumas et al.
2007. The Izz of table 2.2 fit a rod about its proximal end (radius of gyration 0.53 to 0.61 of
the length), so they are read as inertia about the proximal joint. The Izz of table 3.2 name no
axis and no point (0.74 of the length for the thigh), so they are kept in the data file only.
"""

from dataclasses import replace

import numpy as np

from human_model.anthropometry import (
    SegmentParameters,
    sagittal_parameters,
    segment_lengths,
    segment_parameters,
)
from human_model.errors import SubjectError
from human_model.inertia import combine
from human_model.subject import Subject
from human_model.tables import length_sum, read_table


def subject_names() -> tuple[str, ...]:
    """Names of the subjects that come with the package."""
    return tuple(row['name'] for row in read_table('subjects'))


def named_subject(name: str) -> Subject:
    """Subject of ``data/subjects.csv``, with the thesis' link lengths if it prints them.

    Raises
    ------
    SubjectError
        If there is no subject of that name.
    """
    rows = {row['name']: row for row in read_table('subjects')}
    if name not in rows:
        raise SubjectError(f'no subject named {name!r}; there are {", ".join(rows)}')
    row = rows[name]
    return Subject(pseudonym=name, sex=row['sex'], mass=float(row['mass']),
                   stature=float(row['stature']), age=float(row['age']),
                   strength_z=float(row['strength_z']), lengths=_lengths(name))


def named_parameters(name: str) -> SegmentParameters:
    """Segment parameters of a named subject: ``thesis_2d`` of the sagittal skeleton, else 3D.

    The masses of ``thesis_2d`` and ``thesis_3d`` are those the thesis prints.
    """
    subject = named_subject(name)
    if name == 'thesis_2d':
        return _thesis_2d(subject)
    parameters = segment_parameters(subject)
    return _thesis_3d(parameters) if name == 'thesis_3d' else parameters


def _lengths(name: str) -> dict[str, float]:
    rows = [row for row in read_table('thesis_lengths') if row['subject'] == name]
    if not rows:
        return {}
    links = {row['link']: float(row['length']) for row in read_table(f'{name}_links')}
    return {row['length']: float(row['factor']) * links[row['link']]
            + length_sum(row['plus'], links) for row in rows}


def _thesis_2d(subject: Subject) -> SegmentParameters:
    """Masses and Izz of table 2.2; centres of mass at Dumas' fraction of each link.

    The pelvis has no mass of its own: link 1 reaches from the sacrum, where the hips are too.
    """
    generic = replace(subject, lengths={})
    sagittal = sagittal_parameters(segment_parameters(generic))
    upper_body = sagittal_parameters(_pelvis_in_trunk(segment_parameters(generic)))
    printed = {row['segment']: row for row in read_table('thesis_2d_links')}
    own, long = segment_lengths(subject)[0], sagittal.lengths
    reach = {'trunk': ('t12l1_height', 'shoulder_height'), 'upper_arm': ('upper_arm',),
             'forearm': ('forearm',), 'thigh': ('thigh',), 'shank': ('shank',),
             'foot': ('ankle_mtp',), 'toes': ('toes',)}
    n = len(sagittal.segments)
    mass, com, inertia = np.zeros(n), np.zeros((n, 3)), np.zeros((n, 3, 3))
    for i, segment in enumerate(sagittal.segments):
        if segment == 'pelvis':
            continue
        source = upper_body if segment == 'trunk' else sagittal
        scale = sum(own[key] for key in reach[segment]) / sum(long[key] for key in reach[segment])
        mass[i] = float(printed[segment]['mass'])
        along = 0 if segment in ('foot', 'toes') else 2
        com[i, along] = source.com[i, along] * scale
        about_joint = float(printed[segment]['inertia_zz'])
        tensor = source.inertia[i]
        inertia[i] = tensor * ((about_joint - mass[i] * com[i] @ com[i]) / tensor[1, 1])
    return SegmentParameters(
        own, sagittal.segments, mass, com, inertia,
        {**{key: 'thesis tables 2.2 and 3.2' for key in own}, 'mass': 'thesis table 2.2',
         'com': 'Dumas et al. 2007 fraction of the link', 'inertia': 'thesis table 2.2'})


def _pelvis_in_trunk(parameters: SegmentParameters) -> SegmentParameters:
    """Parameters whose lumbar segment carries the pelvis, rigidly, in the neutral posture."""
    pelvis, lumbar = parameters.index('pelvis'), parameters.index('lumbar')
    lengths = parameters.lengths
    down = -np.array([lengths['l5s1_forward'], 0.0, lengths['l5s1_height']])
    parts = [(float(parameters.mass[i]), parameters.com[i] + at, parameters.inertia[i])
             for i, at in ((pelvis, down), (lumbar, np.zeros(3)))]
    mass, com, inertia = (np.array(array) for array in
                          (parameters.mass, parameters.com, parameters.inertia))
    mass[lumbar], com[lumbar], inertia[lumbar] = combine(parts)
    mass[pelvis], com[pelvis], inertia[pelvis] = 0.0, np.zeros(3), np.zeros((3, 3))
    return replace(parameters, mass=mass, com=com, inertia=inertia)


def _thesis_3d(parameters: SegmentParameters) -> SegmentParameters:
    """Masses of table 3.2; the torso (links 2 and 4) divided as Dumas divides it."""
    link = {row['link']: float(row['mass']) for row in read_table('thesis_3d_links')}
    torso = link['L2'] + link['L4']
    share = parameters.mass / parameters.mass[parameters.index('lumbar')]
    thorax = share[parameters.index('thorax')]
    masses = {'pelvis': link['L1'] + 2 * link['L9'], 'lumbar': torso / (1 + thorax),
              'thorax': torso * thorax / (1 + thorax), 'head': link['L8']}
    for name, key in (('upper_arm', 'L5'), ('forearm', 'L6'), ('hand', 'L7'), ('thigh', 'L10'),
                      ('shank', 'L11'), ('foot', 'L12'), ('toes', 'L13')):
        masses[f'{name}_r'] = masses[f'{name}_l'] = link[key]
    mass = np.array([masses[name] for name in parameters.segments])
    inertia = parameters.inertia * (mass / parameters.mass)[:, None, None]
    return replace(parameters, mass=mass, inertia=inertia,
                   sources={**parameters.sources, 'mass': 'thesis table 3.2'})
