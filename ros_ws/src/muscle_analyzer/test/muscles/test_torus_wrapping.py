# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Torus wrapping against plane geometry and turns of the whole figure."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from muscle_analyzer.core.muscles.cylinder_wrapping import POSSIBLE
from muscle_analyzer.core.muscles.torus_wrapping import PASSED, nearest_of_ring, wrap_torus

TUBE, RING = 0.02, 0.05
SIZE = (TUBE, RING, 0.0)
X = 0


def wrap(first, second, axis=X, sign=0, geodesic=True):
    first, second = np.array(first, float), np.array(second, float)
    contact, arc, *tangents = wrap_torus(tuple(first), tuple(second), SIZE, axis, sign, geodesic)
    near, far = np.array(tangents)
    whole = np.linalg.norm(near - first) + arc + np.linalg.norm(second - far)
    return contact, near, far, arc, whole


def test_segment_through_the_tube_passes_on_the_side_of_the_hole():
    """Along the torus' axis at the centre line: half a turn less two tangents."""
    ends = (RING, 0.0, -2.0 * TUBE), (RING, 0.0, 2.0 * TUBE)
    contact, near, far, arc, whole = wrap(*ends)
    turn = math.pi - 2.0 * math.acos(0.5)
    assert contact == POSSIBLE
    assert arc == pytest.approx(TUBE * turn)
    assert whole == pytest.approx(TUBE * (turn + 2.0 * math.sqrt(3.0)))
    for point, sense in ((near, -1.0), (far, 1.0)):
        np.testing.assert_allclose(
            point, [RING - TUBE * math.sin(math.pi / 3), 0.0, sense * 0.5 * TUBE], atol=1e-12
        )


def test_segment_through_the_hole_is_left_alone():
    assert wrap((0.01, 0.0, -0.1), (0.01, 0.0, 0.1))[0] == PASSED


def test_segment_outside_is_pulled_through_the_hole():
    """The cylinder that stands for the torus has its active half towards the hole."""
    contact, near, far, _, whole = wrap((0.09, 0.0, -0.1), (0.09, 0.0, 0.1))
    assert contact == POSSIBLE
    assert near[0] < RING and far[0] < RING
    assert whole > 0.2


def test_half_of_the_ring_that_is_not_active_does_nothing():
    ends = (RING, 0.0, -2.0 * TUBE), (RING, 0.0, 2.0 * TUBE)
    assert wrap(*ends, X, 1)[0] == POSSIBLE
    assert wrap(*ends, X, -1)[0] == PASSED


@settings(deadline=None)
@given(st.integers(0, 10**9), st.floats(-3.0, 3.0))
def test_turn_about_the_axis_of_the_torus_changes_nothing(seed, angle):
    rng = np.random.default_rng(seed)
    ends = rng.normal(scale=0.08, size=(2, 3))
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    contact, near, far, arc, _ = wrap(*ends)
    again, turned_near, turned_far, same, _ = wrap(*(ends @ turn.T))
    assert again == contact
    assert same == pytest.approx(arc, abs=1e-9)
    np.testing.assert_allclose([turned_near, turned_far], [turn @ near, turn @ far], atol=1e-9)


@settings(deadline=None)
@given(st.integers(0, 10**9))
def test_nearest_point_is_a_minimum_of_the_search_function(seed):
    """The line's distance from a circle of twice the radius, as the module's header says."""
    rng = np.random.default_rng(seed)
    first, second = rng.normal(scale=0.1, size=(2, 3))
    there, *found = nearest_of_ring(tuple(first), tuple(second), RING, X, 0)
    assert there
    assert np.hypot(found[0], found[1]) == pytest.approx(RING)
    direction = (second - first) / np.linalg.norm(second - first)

    def square(u):
        point = first + u * direction
        return (np.hypot(point[0], point[1]) - 2.0 * RING) ** 2 + point[2] ** 2

    # The minima of a fine scan, refined.
    grid = np.linspace(-1.0, 1.0, 4001)
    values = np.array([square(u) for u in grid])
    low = np.flatnonzero((values[1:-1] < values[:-2]) & (values[1:-1] < values[2:])) + 1
    off = []
    for k in low:
        u = minimize_scalar(square, bracket=(grid[k - 1], grid[k], grid[k + 1]), tol=1e-14).x
        point = first + u * direction
        off.append(np.linalg.norm(RING * point[:2] / np.hypot(*point[:2]) - found))
    assert min(off) < 1e-6
