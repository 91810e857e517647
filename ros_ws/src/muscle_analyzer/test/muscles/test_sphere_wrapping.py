# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Sphere wrapping against plane geometry and the properties of a shortest path."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from muscle_analyzer.core.muscles.cylinder_wrapping import INSIDE, MISSED, PIERCED, POSSIBLE
from muscle_analyzer.core.muscles.sphere_wrapping import wrap_sphere

RADIUS = 0.04
SIZE = (RADIUS, 0.0, 0.0)
X, Y = 0, 1


def wrap(first, second, axis=X, sign=0):
    first, second = np.array(first, float), np.array(second, float)
    contact, arc, *tangents = wrap_sphere(tuple(first), tuple(second), SIZE, axis, sign)
    near, far = np.array(tangents)
    whole = np.linalg.norm(near - first) + arc + np.linalg.norm(second - far)
    return contact, near, far, arc, whole


def test_symmetric_segment():
    """Both ends 2 r from the centre, 1/2 r off it: tangents of sqrt(3) r and their arc."""
    half = math.sqrt(3.75) * RADIUS
    ends = (-half, 0.5 * RADIUS, 0.0), (half, 0.5 * RADIUS, 0.0)
    contact, near, far, arc, whole = wrap(*ends)
    turn = math.pi - 2.0 * math.asin(0.25) - 2.0 * math.acos(0.5)
    assert contact == POSSIBLE
    assert arc == pytest.approx(RADIUS * turn)
    assert whole == pytest.approx(RADIUS * (turn + 2.0 * math.sqrt(3.0)))
    assert near[1] > 0.0 and far[1] > 0.0
    for point, end in zip((near, far), ends, strict=True):
        assert np.linalg.norm(point) == pytest.approx(RADIUS)
        assert point @ (point - end) == pytest.approx(0.0, abs=1e-15)


def test_end_inside_and_segments_that_miss():
    assert wrap((0.01, 0.02, 0.0), (0.1, 0.0, 0.0))[0] == INSIDE
    assert wrap((-0.1, 0.05, 0.0), (0.1, 0.05, 0.0))[0] == MISSED
    # The line pierces the sphere beyond the segment's end.
    assert wrap((-0.1, 0.01, 0.0), (-0.05, 0.01, 0.0))[0] == MISSED
    # Through the centre there is no plane to wrap in.
    assert wrap((-0.1, 0.0, 0.0), (0.1, 0.0, 0.0))[0] == MISSED
    # A segment that misses is not pulled to the active half, as it would be by a cylinder.
    assert wrap((-0.1, -0.05, 0.0), (0.1, -0.05, 0.0), Y, 1)[0] == MISSED


def test_active_half_decides_the_way_round_when_no_end_is_on_it():
    ends = (-0.1, -0.01, 0.0), (0.1, -0.01, 0.0)
    contact, near, far, short, _ = wrap(*ends)
    assert near[1] < 0.0 and far[1] < 0.0
    contact, near, far, long, _ = wrap(*ends, Y, 1)
    assert contact == POSSIBLE
    assert near[1] > 0.0 and far[1] > 0.0
    # The two arcs and the angles between the tangents at each end make up the whole circle.
    between = 2.0 * math.acos(RADIUS / math.hypot(0.1, 0.01))
    assert short + long + 2.0 * RADIUS * between == pytest.approx(2.0 * math.pi * RADIUS)


def test_end_on_the_active_half_makes_the_wrap_certain():
    ends = (-0.1, 0.01, 0.0), (0.1, 0.02, 0.0)
    contact, near, far, arc, _ = wrap(*ends, Y, 1)
    free, tangent, other, length, _ = wrap(*ends)
    assert (contact, free) == (PIERCED, POSSIBLE)
    np.testing.assert_array_equal([near, far], [tangent, other])
    assert arc == length


@settings(deadline=None)
@given(st.integers(0, 10**9), st.floats(0.01, 0.99))
def test_path_is_a_plane_shortest_path(seed, share):
    """Tangents and arc lie in one plane; bending the path out of it makes it longer."""
    rng = np.random.default_rng(seed)
    along, across = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
    middle = share * RADIUS * across
    first, second = (middle + t * along for t in (-rng.uniform(0.05, 0.2), rng.uniform(0.05, 0.2)))
    assume(min(np.linalg.norm(first), np.linalg.norm(second)) > RADIUS)
    contact, near, far, arc, whole = wrap(first, second)
    assert contact == POSSIBLE
    normal = np.cross(first, second)
    for point in (near, far):
        assert point @ normal == pytest.approx(0.0, abs=1e-12)
    assert near @ far == pytest.approx(RADIUS**2 * math.cos(arc / RADIUS), abs=1e-12)
    assert whole >= np.linalg.norm(second - first) - 1e-15
    # A string over points of the sphere beside the path is longer than the path.
    turned = near + 0.01 * rng.normal(size=3)
    turned *= RADIUS / np.linalg.norm(turned)
    angle = math.acos(np.clip(turned @ far / RADIUS**2, -1.0, 1.0))
    inside = np.linalg.norm(turned - first) < np.sqrt(first @ first - RADIUS**2) + 1e-12
    if inside:
        beside = np.linalg.norm(turned - first) + RADIUS * angle + np.linalg.norm(second - far)
        assert beside >= whole - 1e-6
