# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Cylinder wrapping against plane geometry, and the properties of a shortest path."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from muscle_analyzer.core.muscles.cylinder_wrapping import (
    INSIDE,
    MISSED,
    PIERCED,
    POSSIBLE,
    wrap_cylinder,
)

RADIUS = 0.03
SIZE = np.array([RADIUS, 1.0, 0.0])
X, Y = 0, 1


def wrap(first, second, axis=X, sign=0, size=SIZE, geodesic=True):
    first, second = np.array(first, float), np.array(second, float)
    ends = tuple(first), tuple(second)
    contact, arc, *tangents = wrap_cylinder(*ends, tuple(size), axis, sign, geodesic)
    near, far = np.array(tangents)
    whole = np.linalg.norm(near - first) + arc + np.linalg.norm(second - far)
    return contact, near, far, arc, whole


@pytest.mark.parametrize('geodesic', [True, False])
def test_symmetric_segment_normal_to_the_axis(geodesic):
    """Both ends 2 r from the axis: tangents of sqrt(3) r, an arc of 60 degrees."""
    half = math.sqrt(3.75) * RADIUS
    ends = (-half, 0.5 * RADIUS, 0.0), (half, 0.5 * RADIUS, 0.0)
    contact, near, far, arc, whole = wrap(*ends, geodesic=geodesic)
    turn = math.pi - 2.0 * math.asin(0.25) - 2.0 * math.acos(0.5)
    assert contact == PIERCED
    assert arc == pytest.approx(RADIUS * turn)
    assert whole == pytest.approx(RADIUS * (turn + 2.0 * math.sqrt(3.0)))
    assert near[1] > 0.0 and far[1] > 0.0
    for point, end in zip((near, far), ends, strict=True):
        assert np.hypot(*point[:2]) == pytest.approx(RADIUS)
        assert point[:2] @ (point - end)[:2] == pytest.approx(0.0, abs=1e-15)


def test_far_side_is_taken_when_the_quadrant_asks_for_it():
    ends = (-0.06, 0.01, 0.0), (0.06, 0.01, 0.0)
    _, near, _, short, _ = wrap(*ends)
    contact, around, _, long, _ = wrap(*ends, Y, -1)
    # With both ends on the passive half OpenSim leaves the choice among segments open.
    assert contact == POSSIBLE
    assert near[1] > 0.0 > around[1]
    assert long > short


def test_end_inside_and_segments_that_miss():
    assert wrap((0.01, 0.0, 0.0), (0.1, 0.0, 0.0))[0] == INSIDE
    assert wrap((-0.06, 0.04, 0.0), (0.06, 0.04, 0.0))[0] == MISSED
    # Beyond the end of the cylinder.
    assert wrap((-0.06, 0.0, 0.6), (0.06, 0.0, 0.6))[0] == MISSED
    # The segment ends before it reaches the cylinder.
    assert wrap((-0.06, 0.0, 0.0), (-0.04, 0.0, 0.0))[0] == MISSED


def test_segment_on_the_passive_side_is_pulled_round_the_active_half():
    """The straight line passes the axis on the passive side without touching."""
    ends = (-0.06, -0.1, 0.0), (0.1, 0.01, 0.0)
    assert wrap(*ends, Y, 0)[0] == MISSED
    contact, near, far, _, whole = wrap(*ends, Y, 1)
    assert contact == POSSIBLE
    assert near[1] > 0.0 and far[1] > 0.0
    assert whole > np.linalg.norm(np.subtract(*ends))
    # The same segment on the active side is left alone.
    assert wrap((-0.06, 0.06, 0.0), (0.08, 0.05, 0.0), Y, 1)[0] == MISSED


@st.composite
def piercing(draw):
    """Draw a segment that passes the axis at less than the radius and ends outside."""
    angle, turn, tilt = (draw(st.floats(-3.0, 3.0)) for _ in range(3))
    offset = RADIUS * draw(st.floats(0.0, 0.95))
    direction = np.array([math.cos(turn), math.sin(turn), math.tan(0.4 * tilt)])
    middle = np.array([math.cos(angle) * offset, math.sin(angle) * offset, 0.0])
    before, after = draw(st.floats(0.07, 0.2)), draw(st.floats(0.07, 0.2))
    return (*(middle - before * direction), *(middle + after * direction))


ends = piercing()


@settings(deadline=None)
@given(ends)
def test_geodesic_is_straight_in_the_unrolled_surface(values):
    first, second = values[:3], values[3:]
    contact, near, far, arc, whole = wrap(first, second)
    assert contact == PIERCED
    assume(arc > 1e-9)
    rises = [near[2] - first[2], far[2] - near[2], second[2] - far[2]]
    ways = [np.linalg.norm(near - first), arc, np.linalg.norm(second - far)]
    assert np.array(rises) * whole == pytest.approx(
        np.array(ways) * (second[2] - first[2]), abs=1e-12
    )
    assert whole >= np.linalg.norm(np.subtract(first, second)) - 1e-15


@settings(deadline=None)
@given(ends)
def test_opensim_construction_is_never_shorter_and_on_the_surface(values):
    first, second = values[:3], values[3:]
    contact, *_, whole = wrap(first, second)
    other, near, far, _, longer = wrap(first, second, geodesic=False)
    assert contact == other == PIERCED
    assert longer >= whole - 1e-12
    assert np.hypot(near[0], near[1]) == pytest.approx(RADIUS)
    assert np.hypot(far[0], far[1]) == pytest.approx(RADIUS)


@settings(deadline=None)
@given(ends)
def test_length_is_continuous_where_the_wrap_begins(values):
    """Shift the segment to touch the cylinder: no arc, the straight length, no kink."""
    first, second = np.array(values[:3]), np.array(values[3:])
    along = (second - first)[:2]
    assume(np.linalg.norm(along) > 0.01)
    normal = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    shift = normal @ first[:2] - RADIUS * (1.0 - 1e-9)
    for end in (first, second):
        end[:2] -= shift * normal
    share = -(first[:2] @ along) / (along @ along)
    assume(0.1 < share < 0.9)
    contact, near, _, arc, whole = wrap(first, second, size=np.array([RADIUS, 9.0, 0.0]))
    assert contact == PIERCED
    assert arc < 1e-4
    assert whole == pytest.approx(np.linalg.norm(second - first), abs=1e-8)
    assert (near - first) / np.linalg.norm(near - first) == pytest.approx(
        (second - first) / np.linalg.norm(second - first), abs=1e-3
    )
