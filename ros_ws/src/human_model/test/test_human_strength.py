# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Dynamic joint strength: the form of the equations, the published magnitudes, the signs."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from human_model.constants import GRAVITY
from human_model.exceptions import StrengthError
from human_model.skeletons import Skeleton3D
from human_model.strength import (
    LARGE,
    JointStrength,
    coefficient_sets,
    peak,
    surface,
)
from human_model.subject import Subject

YOUNG_MAN = Subject('m', 'male', 75.0, 1.75, 22.0)
YOUNG_WOMAN = Subject('f', 'female', 62.0, 1.63, 22.0)
COEFFICIENTS = (0.1, 0.2, 0.9, 0.5, -0.05, -1.2, 2.3, 0.8)


def isometric_peak(strength, coordinate, side):
    q = np.linspace(-2.0, 2.6, 2001)
    torque = np.abs(strength.bound(coordinate, side)(q, 0 * q))
    return torque.max(), q[torque.argmax()]


@given(st.floats(-5, 5), st.floats(-10, 10))
def test_surface_is_equation_2_14_as_printed(q, v):
    c1, c2, c3, c4, c5, c6, c7, c8 = COEFFICIENTS
    angle = 4 * np.exp(-(q - c3) / c4) / (1 + np.exp(-(q - c3) / c4)) ** 2
    speed = 4 * np.exp(-(v - c6) / c7) / (1 + np.exp(-(v - c6) / c7)) ** 2
    expected = c1 + c2 * angle + c5 * speed + c8 * angle * speed
    assert surface(COEFFICIENTS, q, v) == pytest.approx(expected, rel=1e-12)


def test_bell():
    assert peak(0.7, 0.7, 0.2) == 1.0
    assert peak(0.7 + 0.3, 0.7, 0.2) == pytest.approx(peak(0.7 - 0.3, 0.7, 0.2))
    assert peak(np.array([50.0]), 0.0, 0.1) == pytest.approx(0.0, abs=1e-100)


@pytest.mark.parametrize('symbol', [ca.SX, ca.MX])
def test_casadi_gives_the_same_numbers_and_derivatives(symbol):
    strength = JointStrength('3d_40dof', YOUNG_MAN)
    q, v = symbol.sym('q'), symbol.sym('v')
    lower, upper = strength.limits('knee_angle_r', q, v)
    function = ca.Function('limits', [q, v], [lower, upper, ca.jacobian(upper, q)])
    for angle, speed in ((0.3, -1.0), (1.4, 2.0)):
        values = [float(value) for value in function(angle, speed)]
        assert values[:2] == pytest.approx(strength.limits('knee_angle_r', angle, speed))
        bound, h = strength.bound('knee_angle_r', 'upper'), 1e-5
        slope = (bound(angle + h, speed) - bound(angle - h, speed)) / (2 * h)
        assert values[2] == pytest.approx(slope, rel=1e-7)


@pytest.mark.parametrize(
    ('coordinate', 'side', 'published', 'at_degrees'),
    [
        # Anderson et al. 2007: C1 of men of 18-25 years (m g h), C3: median of the six groups,
        # of hip flexion: of men of 18-25 years
        ('hip_flexion_r', 'lower', 0.161, 69.2),
        ('knee_angle_r', 'lower', 0.163, 65.3),
        ('knee_angle_r', 'upper', 0.087, 27.7),
        ('ankle_angle_r', 'lower', 0.095, 26.4),
        ('ankle_angle_r', 'upper', 0.033, -15.4),
        ('hip_flexion_r', 'upper', 0.113, -12.3),
    ],
)
def test_legs_have_the_published_peaks(coordinate, side, published, at_degrees):
    """Isometric peak within the fits' error: 10 % in size, 16 degrees in place."""
    torque, angle = isometric_peak(JointStrength('3d_40dof', YOUNG_MAN), coordinate, side)
    scale = YOUNG_MAN.mass * GRAVITY * YOUNG_MAN.stature
    assert torque == pytest.approx(published * scale, rel=0.10)
    assert np.degrees(angle) == pytest.approx(at_degrees, abs=16)


@pytest.mark.parametrize(
    ('subject', 'coordinate', 'side', 'published'),
    [
        (YOUNG_MAN, 'lumbar_extension', 'lower', 182),
        (YOUNG_MAN, 'elbow_flex_l', 'upper', 77),
        (YOUNG_WOMAN, 'elbow_flex_l', 'upper', 41),
        (YOUNG_MAN, 'arm_flex_r', 'upper', 78),
        (YOUNG_MAN, 'arm_flex_r', 'lower', 101),
        (YOUNG_MAN, 'lumbar_rotation', 'lower', 71.6),
        (YOUNG_MAN, 'lumbar_bending', 'upper', 159),
        (YOUNG_WOMAN, 'arm_add_r', 'lower', 37),
        (YOUNG_MAN, 'wrist_flex_r', 'upper', 12.2),
    ],
)
def test_trunk_and_arms_have_the_published_peaks(subject, coordinate, side, published):
    """The fitted shapes reach 0.91 to 1.03 of the published isometric peak."""
    torque, _ = isometric_peak(JointStrength('3d_40dof', subject), coordinate, side)
    assert torque == pytest.approx(published, rel=0.10)


@pytest.mark.parametrize(('subject', 'published'), [(YOUNG_MAN, 328.5), (YOUNG_WOMAN, 197.5)])
def test_trunk_extensors_have_the_published_peak_at_the_largest_tested_flexion(subject, published):
    bound = JointStrength('2d_10dof', subject).bound('lumbar_extension', 'upper')
    assert bound(-np.radians(60.0), 0.0) == pytest.approx(published, rel=1e-3)


def test_muscles_are_weaker_when_they_shorten():
    strength = JointStrength('3d_40dof', YOUNG_MAN)
    for coordinate, angle in (
        ('knee_angle_r', 1.0),
        ('hip_flexion_l', 0.9),
        ('elbow_flex_r', 1.0),
        ('lumbar_extension', -0.5),
        ('ankle_angle_r', 0.1),
    ):
        for side, direction in (('upper', 1.0), ('lower', -1.0)):
            bound = strength.bound(coordinate, side)
            shortening, still = bound(angle, 2.0 * direction), bound(angle, 0.0)
            assert abs(shortening) < abs(still), (coordinate, side)


def test_trunk_extensors_are_stronger_bent_forward():
    """Extension torque rises with flexion (Keller and Roy 2002)."""
    strength = JointStrength('2d_10dof', YOUNG_MAN)
    bound = strength.bound('lumbar_extension', 'upper')
    assert bound(-np.radians(50), 0.0) > bound(0.0, 0.0) > bound(np.radians(20), 0.0)


def test_the_two_spine_joints_bend_with_the_whole():
    """Both spine joints at their share of a flexion have the strength of the whole spine."""
    flat, full = JointStrength('2d_10dof', YOUNG_MAN), JointStrength('3d_40dof', YOUNG_MAN)
    for total in (-0.2, -0.9):
        whole = flat.limits('lumbar_extension', total, 0.5)
        assert full.limits('lumbar_extension', 0.63 * total, 0.63 * 0.5) == pytest.approx(
            whole, rel=1e-4
        )
        assert full.limits('thorax_extension', 0.37 * total, 0.37 * 0.5) == pytest.approx(
            whole, rel=1e-4
        )


def test_non_negative_set_always_has_strength():
    q, v = np.meshgrid(np.linspace(-2, 3, 61), np.linspace(-12, 12, 61))
    for skeleton in ('2d_10dof', '3d_40dof'):
        for subject in (YOUNG_MAN, YOUNG_WOMAN):
            strength = JointStrength(skeleton, subject)
            for coordinate in strength.coordinates:
                lower, upper = strength.limits(coordinate, q, v)
                assert np.all(lower < 0) and np.all(upper > 0), coordinate


def test_paired_joints_are_doubled_in_the_sagittal_skeleton():
    flat, full = JointStrength('2d_10dof', YOUNG_MAN), JointStrength('3d_40dof', YOUNG_MAN)
    for name in ('arm_flex', 'elbow_flex', 'hip_flexion', 'knee_angle', 'ankle_angle'):
        both = np.array(flat.limits(name, 0.4, 0.3))
        assert both == pytest.approx(2 * np.array(full.limits(f'{name}_r', 0.4, 0.3)))
    assert flat.limits('mtp_angle', 0.0, 0.0) == (-2 * LARGE, 2 * LARGE)


def test_z_score_scales_by_the_coefficient_of_variation():
    strong = Subject('s', 'male', 75.0, 1.75, 22.0, strength_z=1.05)
    ratio = (
        JointStrength('3d_40dof', strong).limits('lumbar_extension', -0.3, 0.0)[1]
        / JointStrength('3d_40dof', YOUNG_MAN).limits('lumbar_extension', -0.3, 0.0)[1]
    )
    assert ratio == pytest.approx(1 + 1.05 * 0.16)


@pytest.mark.parametrize('sex', ['male', 'female'])
@pytest.mark.parametrize('skeleton', ['2d_10dof', '3d_40dof'])
def test_strength_never_grows_from_30_to_70_years(skeleton, sex):
    q, v = np.meshgrid(np.radians(np.linspace(-60, 140, 41)), np.linspace(-4, 6, 21))
    ages = np.arange(30.0, 71.0, 5.0)
    people = [JointStrength(skeleton, Subject('a', sex, 75.0, 1.75, age)) for age in ages]
    for coordinate in people[0].coordinates:
        for side in ('lower', 'upper'):
            limit = np.abs([person.bound(coordinate, side)(q, v) for person in people])
            assert np.all(np.diff(limit, axis=0) <= 1e-9), (coordinate, side)


def test_age_and_sex_choose_the_row():
    scale = 75.0 * GRAVITY * 1.75
    for age, published in ((20.0, 0.163), (60.0, 0.156), (66.5, 0.1465), (75.0, 0.137)):
        subject = Subject('a', 'male', 75.0, 1.75, age)
        bound = JointStrength('3d_40dof', subject).bound('knee_angle_r', 'lower')
        assert -bound.magnitude == pytest.approx(published * scale)
    young = Subject('f', 'female', 62.0, 1.63, 20.0)
    woman = JointStrength('3d_40dof', young).bound('knee_angle_r', 'lower')
    assert -woman.magnitude == pytest.approx(0.159 * 62.0 * GRAVITY * 1.63)


@pytest.mark.parametrize('name', coefficient_sets())
def test_every_set_covers_every_joint(name):
    for skeleton in ('2d_10dof', '3d_40dof'):
        strength = JointStrength(skeleton, YOUNG_WOMAN, name)
        assert all('pelvis' not in coordinate for coordinate in strength.coordinates)
        assert len(strength.coordinates) == (7 if skeleton == '2d_10dof' else 34)


def test_arrays_of_all_coordinates():
    skeleton = Skeleton3D.of(YOUNG_MAN)
    strength = JointStrength('3d_40dof', YOUNG_MAN)
    q = np.zeros((5, 40))
    lower, upper = strength.limit_arrays(skeleton.coordinates, q, q)
    assert lower.shape == upper.shape == (5, 40)
    assert np.all(np.isinf(upper[:, :6])) and np.all(np.isfinite(upper[:, 6:]))
    column = skeleton.index('knee_angle_l')
    assert (lower[2, column], upper[2, column]) == pytest.approx(
        strength.limits('knee_angle_l', 0.0, 0.0)
    )


def test_bad_input_is_named():
    with pytest.raises(StrengthError, match="no coefficient set named 'mine'"):
        JointStrength('3d_40dof', YOUNG_MAN, 'mine')
    with pytest.raises(StrengthError, match="no skeleton named 'stick'"):
        JointStrength('stick', YOUNG_MAN)
    with pytest.raises(StrengthError, match="no upper strength of 'pelvis_tx'"):
        JointStrength('3d_40dof', YOUNG_MAN).bound('pelvis_tx', 'upper')
