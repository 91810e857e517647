# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Ellipsoid wrapping against great circles and cylinders."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from muscle_analyzer.core.muscles.cylinder_wrapping import INSIDE, MISSED, PIERCED
from muscle_analyzer.core.muscles.ellipsoid_surface import closest_on_ellipsoid
from muscle_analyzer.core.muscles.ellipsoid_wrapping import HYBRID, MIDPOINT, wrap_ellipsoid

CHEST = np.array([0.07, 0.16, 0.12])


@st.composite
def piercing(draw, axes):
    """Draw ends of a segment that passes through an ellipsoid."""
    rng = np.random.default_rng(draw(st.integers(0, 10**9)))
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    inside = rng.normal(size=3)
    inside *= draw(st.floats(0.05, 0.9)) / np.linalg.norm(inside)
    middle = inside * axes
    before, after = rng.uniform(2.2, 4.0, 2) * max(axes)
    return middle - before * direction, middle + after * direction


def wrap(first, second, axes, axis=0, sign=0, method=HYBRID):
    first, second = np.array(first, float), np.array(second, float)
    ends, axes = (tuple(first), tuple(second)), tuple(map(float, axes))
    contact, arc, *tangents = wrap_ellipsoid(*ends, axes, axis, sign, method)
    near, far = np.array(tangents)
    whole = np.linalg.norm(near - first) + arc + np.linalg.norm(second - far)
    return contact, near, far, arc, whole


@settings(deadline=None)
@given(piercing((0.05, 0.05, 0.05)))
def test_sphere_gives_the_great_circle(ends):
    """All guides of a sphere lie in the plane of both ends and the centre: a geodesic."""
    r = 0.05
    first, second = ends
    contact, _, _, arc, whole = wrap(first, second, (r, r, r))
    assert contact == PIERCED
    from_1, from_2 = np.linalg.norm(first), np.linalg.norm(second)
    between = math.acos(np.clip(first @ second / (from_1 * from_2), -1.0, 1.0))
    turn = between - math.acos(min(1.0, r / from_1)) - math.acos(min(1.0, r / from_2))
    assert arc == pytest.approx(r * turn, abs=2e-6)
    expected = r * turn + math.sqrt(from_1**2 - r * r) + math.sqrt(from_2**2 - r * r)
    assert whole == pytest.approx(expected, abs=2e-6)


@settings(deadline=None)
@given(piercing(tuple(CHEST)))
def test_path_is_tangent_and_in_one_plane(ends):
    first, second = ends
    contact, near, far, arc, whole = wrap(first, second, CHEST)
    assert contact == PIERCED
    for tangent, end in ((near, first), (far, second)):
        assert np.sum((tangent / CHEST) ** 2) == pytest.approx(1.0)
        normal = tangent / CHEST**2
        assert normal @ (end - tangent) == pytest.approx(0.0, abs=1e-9 * np.linalg.norm(normal))
    volume = np.linalg.det([second - first, near - first, far - first])
    assert volume == pytest.approx(0.0, abs=1e-14)
    assert arc >= np.linalg.norm(far - near) - 1e-12
    assert whole >= np.linalg.norm(second - first)


def test_long_ellipsoid_equals_a_cylinder():
    """Half axes (r, r, large) and ends in a plane normal to the long axis."""
    ends = (-0.06, 0.01, 0.0), (0.06, 0.02, 0.0)
    contact, near, far, arc, _ = wrap(*ends, (0.03, 0.03, 50.0))
    assert contact == PIERCED
    turn = np.arctan2(near[1], near[0]) - np.arctan2(far[1], far[0])
    assert arc == pytest.approx(0.03 * turn)
    assert near[:2] @ (near - ends[0])[:2] == pytest.approx(0.0, abs=1e-12)


def test_guide_on_the_passive_half_is_mirrored():
    ends = (0.02, -0.05, -0.2), (0.02, 0.05, 0.2)
    _, near, *_ = wrap(*ends, CHEST, 0, 0)
    _, mirrored, *_ = wrap(*ends, CHEST, 0, -1)
    assert near[0] > 0.0 > mirrored[0]


def test_inside_and_missed():
    assert wrap((0.0, 0.0, 0.01), (0.0, 0.0, 0.5), CHEST)[0] == INSIDE
    assert wrap((0.08, 0.0, -0.2), (0.08, 0.0, 0.2), CHEST)[0] == MISSED
    assert wrap((0.0, 0.0, 0.2), (0.0, 0.0, 0.5), CHEST)[0] == MISSED


def plane_of(first, near, far, second):
    normal = np.cross(near - first, far - first)
    assert np.dot(normal, second - first) == pytest.approx(0.0, abs=1e-12)
    return normal / np.linalg.norm(normal)


def test_midpoint_guide_lies_in_the_plane_of_the_path():
    """The guide is the surface point closest to the middle of the pierced part."""
    first, second = np.array([-0.2, 0.05, 0.03]), np.array([0.25, 0.02, -0.04])
    contact, near, far, *_ = wrap(first, second, CHEST, method=MIDPOINT)
    assert contact == PIERCED
    normal = plane_of(first, near, far, second)
    way = second - first
    a, d = first / CHEST, way / CHEST
    middle = first - (a @ d) / (d @ d) * way
    guide = np.array(closest_on_ellipsoid(tuple(CHEST), tuple(middle), -1))
    assert normal @ (guide - first) == pytest.approx(0.0, abs=1e-10)


def test_both_methods_agree_on_a_sphere():
    ends = (-0.2, 0.05, 0.03), (0.25, 0.02, -0.04)
    lengths = [wrap(*ends, [0.1] * 3, method=method)[-1] for method in (HYBRID, MIDPOINT)]
    assert lengths[1] == pytest.approx(lengths[0], abs=1e-9)
