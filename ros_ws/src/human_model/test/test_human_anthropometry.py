# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lengths, masses, centres of mass and inertia tensors."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from human_model.anthropometry import (
    SegmentParameters,
    body_dimensions,
    sagittal_parameters,
    segment_lengths,
    segment_parameters,
)
from human_model.exceptions import AnthropometryError, HumanModelError
from human_model.inertia import combine, positive_inertia, rotate, shift
from human_model.skeletons import Skeleton3D
from human_model.subject import Calibration, Subject
from human_model.tables import length_sum, read_table


@settings(max_examples=40)
@given(st.sampled_from(['male', 'female']), st.floats(45, 130), st.floats(1.45, 2.05))
def test_segments_weigh_what_the_subject_weighs(sex, mass, stature):
    parameters = segment_parameters(Subject('p', sex, mass, stature, 30))
    assert parameters.total_mass == pytest.approx(mass, rel=1e-12)
    assert sagittal_parameters(parameters).total_mass == pytest.approx(mass, rel=1e-12)
    lengths = parameters.lengths
    height = sum(
        lengths[name]
        for name in (
            'ankle_height',
            'shank',
            'thigh',
            'l5s1_height',
            't12l1_height',
            'c7_height',
            'head_neck',
        )
    )
    assert height == pytest.approx(stature, abs=1e-9)


def test_mean_soldier_has_the_survey_s_mean_dimensions():
    """ANSUR II means: regressions pass through the mean of stature and mass."""
    dimensions = body_dimensions('male', 1.7562, 85.52)
    assert dimensions['trochanterionheight'] == pytest.approx(0.9009, abs=2e-4)
    assert dimensions['cervicaleheight'] == pytest.approx(1.5173, abs=2e-4)
    women = body_dimensions('female', 1.6285, 67.76)
    assert women['acromionradialelength'] == pytest.approx(0.3112, abs=2e-4)


def test_lengths_are_near_those_of_another_study():
    """De Leva 1996, joint centre to joint centre, 100 men of 1.741 m and 73.0 kg."""
    lengths, _ = segment_lengths(Subject('mean', 'male', 73.0, 1.741, 24))
    for name, published in (
        ('thigh', 0.4222),
        ('shank', 0.4403),
        ('forearm', 0.2689),
        ('upper_arm', 0.2817),
        ('hand', 0.1879),
    ):
        assert lengths[name] == pytest.approx(published, abs=0.03), name
    hip_to_c7 = sum(lengths[name] for name in ('l5s1_height', 't12l1_height', 'c7_height'))
    assert hip_to_c7 == pytest.approx(0.6033, abs=0.01)
    foot = sum(lengths[name] for name in ('heel_length', 'ankle_mtp', 'toes'))
    assert foot == pytest.approx(0.2581, abs=0.015)


def test_centre_of_mass_of_the_upper_body_is_where_another_study_puts_it():
    """Head, thorax, abdomen and arms over L5-S1 against de Leva 1996: 0.274 m of 1.741 m.

    Computed from de Leva's table with L5-S1 0.116 m above the hips, the pelvis left out; their
    middle trunk reaches lower than our lumbar segment.
    """
    parameters = segment_parameters(Subject('mean', 'male', 73.0, 1.741, 24))
    body = Skeleton3D(parameters)
    frames = body.forward(body.standing())
    upper = [
        i
        for i, name in enumerate(parameters.segments)
        if name.startswith(('lumbar', 'thorax', 'head', 'upper_arm', 'forearm', 'hand'))
    ]
    heights = np.array([frames[i, 2, 3] + parameters.com[i, 2] for i in upper])
    mass = parameters.mass[upper]
    assert mass.sum() / 73.0 == pytest.approx(0.491, abs=0.01)
    centre = mass @ heights / mass.sum() - body.points(body.standing())['l5_s1'][2]
    assert centre == pytest.approx(0.274, abs=0.02)


def test_mass_fractions_are_those_of_table_2_2(man):
    """Dumas stands in for GEBOD: head, trunk and pelvis 0.5428, thighs 0.2431 and so on."""
    parameters = sagittal_parameters(segment_parameters(man))
    fraction = dict(zip(parameters.segments, parameters.mass / man.mass, strict=True))
    assert fraction['pelvis'] + fraction['trunk'] == pytest.approx(0.5428, abs=0.003)
    assert fraction['upper_arm'] == pytest.approx(0.0486, abs=0.001)
    assert fraction['forearm'] == pytest.approx(0.0463, abs=0.001)
    assert fraction['thigh'] == pytest.approx(0.2431, abs=0.003)
    assert fraction['shank'] == pytest.approx(0.0954, abs=0.001)
    assert fraction['foot'] + fraction['toes'] == pytest.approx(0.0238, abs=0.001)


@pytest.mark.parametrize(
    ('segment', 'length', 'published'),
    [
        ('upper_arm_r', 'upper_arm', 0.436),
        ('forearm_r', 'forearm', 0.430),
        ('thigh_r', 'thigh', 0.433),
        ('shank_r', 'shank', 0.433),
        ('hand_r', 'hand', 0.3624),
    ],
)
def test_centres_of_mass_lie_where_other_studies_put_them(man, segment, length, published):
    """Distance from the proximal joint by length: Winter's table, for the hand de Leva 1996.

    The hand's row shows that Dumas' fractions belong to the length up to the finger tip.
    """
    parameters = segment_parameters(man)
    along = -parameters.com[parameters.index(segment), 2] / parameters.lengths[length]
    assert along == pytest.approx(published, abs=0.03)


def test_torso_is_that_of_the_undivided_study(man):
    """Thorax and abdomen together: 0.42 of the length from C7 to L5-S1 (Dumas et al. 2007)."""
    parameters = segment_parameters(man)
    lengths = parameters.lengths
    whole = sum(lengths[name] for name in ('t12l1_height', 'c7_height'))
    thorax, lumbar = parameters.index('thorax'), parameters.index('lumbar')
    mass, com, _ = combine(
        [
            (parameters.mass[lumbar], parameters.com[lumbar], parameters.inertia[lumbar]),
            (
                parameters.mass[thorax],
                parameters.com[thorax] + [0, 0, lengths['t12l1_height']],
                parameters.inertia[thorax],
            ),
        ]
    )
    assert mass / man.mass == pytest.approx(0.333, abs=0.001)
    assert (whole - com[2]) / whole == pytest.approx(0.42, abs=0.02)


def test_left_mirrors_right(woman):
    parameters = segment_parameters(woman)
    mirror = np.diag([1.0, -1.0, 1.0])
    for i, name in enumerate(parameters.segments):
        if name.endswith('_r'):
            j = parameters.index(name[:-1] + 'l')
            assert parameters.com[j] == pytest.approx(mirror @ parameters.com[i])
            assert parameters.inertia[j] == pytest.approx(mirror @ parameters.inertia[i] @ mirror)
        elif not name.endswith('_l'):
            assert parameters.com[i, 1] == 0.0


def test_foot_and_toes_make_dumas_foot(man):
    parameters = segment_parameters(man)
    lengths = parameters.lengths
    parts = []
    for name, at in (
        ('foot_r', np.zeros(3)),
        ('toes_r', np.array([lengths['ankle_mtp'], 0, -lengths['mtp_drop']])),
    ):
        i = parameters.index(name)
        parts.append((parameters.mass[i], parameters.com[i] + at, parameters.inertia[i]))
    mass, com, inertia = combine(parts)
    size = np.hypot(lengths['ankle_mtp'], lengths['mtp_drop'])
    rows = read_table('human_model', 'dumas_inertia.csv', 'sex segment com_x com_y com_z r_zz')
    row = next(r for r in rows if (r['sex'], r['segment']) == ('male', 'foot'))
    x, y, z = row.numbers('com_x', 'com_y', 'com_z')
    assert com == pytest.approx(size * np.array([x, -z, y]))
    assert inertia[1, 1] == pytest.approx(mass * (size * row.number('r_zz')) ** 2)


def test_measured_lengths_replace_regressions(man):
    calibration = Calibration(
        ('m',), ('thigh_r',), np.zeros((1, 3)), {'thigh': 0.42, 'shank': 0.40}
    )
    subject = Subject(
        'p', 'male', man.mass, man.stature, 31, lengths={'shank': 0.43}, calibration=calibration
    )
    lengths, sources = segment_lengths(subject)
    assert (lengths['thigh'], lengths['shank']) == (0.42, 0.43)
    assert sources['thigh'] == 'measured'
    assert sources['forearm'] == 'ANSUR II regressions'
    assert lengths['forearm'] == segment_lengths(man)[0]['forearm']


def test_unknown_or_impossible_lengths_are_named(man):
    with pytest.raises(AnthropometryError, match="unknown length 'femur'"):
        segment_lengths(Subject('p', 'male', 70, 1.7, 30, lengths={'femur': 0.4}))
    with pytest.raises(AnthropometryError, match=r'length thigh: 0\.0000 m'):
        segment_lengths(Subject('p', 'male', 70, 1.7, 30, lengths={'thigh': 0.0}))


def test_every_number_has_a_source(man):
    parameters = segment_parameters(man)
    assert set(parameters.sources) == {*parameters.lengths, 'mass', 'com', 'inertia'}


def test_inertia_that_no_body_can_have_is_refused():
    one = np.ones(1)
    for tensor in (
        np.diag([1.0, 1.0, 3.0]),
        np.diag([1.0, -1.0, 1.0]),
        np.array([[1.0, 0.1, 0], [0, 1.0, 0], [0, 0, 1.0]]),
    ):
        with pytest.raises(AnthropometryError, match='stone: inertia'):
            SegmentParameters({}, ('stone',), one, np.zeros((1, 3)), tensor[None], {})
    with pytest.raises(AnthropometryError, match='stone: mass'):
        SegmentParameters({}, ('stone',), -one, np.zeros((1, 3)), np.eye(3)[None], {})


def test_rod_from_two_halves():
    """A rod of mass m, length L: m L^2 / 12 about the middle, from its two halves."""
    half = np.diag([0.25, 0.25, 1e-9]) / 24
    _, com, inertia = combine([(0.5, np.array([0, 0, z]), half) for z in (0.0, 0.5)])
    assert com == pytest.approx([0, 0, 0.25])
    assert inertia[0, 0] == pytest.approx(1 / 12)
    assert positive_inertia(inertia)
    assert shift(2.0, np.array([0, 0, 3.0])) == pytest.approx(np.diag([18.0, 18.0, 0]))
    quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    assert rotate(np.diag([1.0, 2.0, 2.5]), quarter) == pytest.approx(np.diag([2.0, 1.0, 2.5]))


def test_length_sums():
    lengths = {'a': 1.0, 'b_2': 2.5}
    assert length_sum('-a + b_2 - 0.5', lengths) == pytest.approx(1.0)
    assert length_sum('', lengths) == 0.0
    with pytest.raises(HumanModelError, match="unknown length 'c'"):
        length_sum('a + c', lengths)
    with pytest.raises(HumanModelError, match='not a sum'):
        length_sum('a * b_2', lengths)
