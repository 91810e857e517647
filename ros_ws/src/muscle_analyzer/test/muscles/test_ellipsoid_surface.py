# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Closest points of an ellipsoid by their conditions, and the mean direction to it by samples."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from muscle_analyzer.core.muscles.ellipsoid_surface import closest_on_ellipsoid, mean_direction

CHEST = np.array([0.07, 0.16, 0.12])
coordinate = st.floats(-0.3, 0.3)
points = st.tuples(coordinate, coordinate, coordinate)


@settings(deadline=None)
@given(points, st.sampled_from([-1, 0, 1, 2]))
def test_closest_point_lies_on_the_surface_and_the_way_there_is_normal_to_it(point, held):
    point = np.array(point)
    free = [i for i in range(3) if i != held]
    assume(np.all(np.abs(point) > 1e-4))
    found = np.array(closest_on_ellipsoid(tuple(CHEST), tuple(point), held))
    assert np.sum((found[free] / CHEST[free]) ** 2) == pytest.approx(1.0, abs=1e-9)
    normal = (found / CHEST**2)[free]
    way = (found - point)[free]
    cross = np.outer(normal, way) - np.outer(way, normal)
    assert np.abs(cross).max() <= 1e-7 * np.linalg.norm(normal)
    if held >= 0:
        assert found[held] == point[held]
    # The closest of many points of the surface.
    angles = np.random.default_rng(0).uniform(0, 2 * np.pi, (200, 2))
    unit = np.zeros((200, 3))
    unit[:, free[0]], unit[:, free[1]] = np.cos(angles[:, 0]), np.sin(angles[:, 0])
    others = unit * CHEST
    assert np.linalg.norm(way) <= np.linalg.norm((others - point)[:, free], axis=1).min() + 1e-9


@pytest.mark.parametrize('axes', [(0.07, 0.16, 0.12), (0.16, 0.07, 0.12), (0.12, 0.16, 0.07)])
def test_point_between_two_closest_points_gets_one_of_them(axes):
    """In the plane normal to the smallest half axis, inside the focal ellipse."""
    smallest = int(np.argmin(axes))
    point = np.full(3, 0.01)
    point[smallest] = 0.0
    found = np.array(closest_on_ellipsoid(axes, tuple(point), -1))
    assert np.sum((found / np.array(axes)) ** 2) == pytest.approx(1.0, abs=1e-12)
    normal = found / np.array(axes) ** 2
    way = found - point
    assert np.abs(np.cross(normal, way)).max() < 1e-12 * np.linalg.norm(normal)
    assert found[smallest] > 0.0
    # Beside the plane the closest point is on the same side and as far.
    beside = point.copy()
    beside[smallest] = -1e-9
    other = np.array(closest_on_ellipsoid(axes, tuple(beside), -1))
    mirrored = np.where(np.arange(3) == smallest, -1.0, 1.0) * found
    np.testing.assert_allclose(other, mirrored, atol=1e-7)


@pytest.mark.parametrize('axes', [(0.1, 0.1, 0.1), (0.05, 0.1, 0.1), (0.1, 0.05, 0.05)])
def test_centre_is_closest_to_the_end_of_a_smallest_half_axis(axes):
    found = np.array(closest_on_ellipsoid(axes, (0.0, 0.0, 0.0), -1))
    assert np.linalg.norm(found) == pytest.approx(min(axes))


def surface_point(rng):
    unit = rng.normal(size=3)
    return CHEST * unit / np.linalg.norm(unit)


def test_mean_direction_is_that_of_the_samples_of_opensim():
    """The sums of OpenSim, sample by sample; half of the chords cross the plane of the jump."""
    rng = np.random.default_rng(7)
    error = []
    for _ in range(100):
        enter, leave = surface_point(rng), surface_point(rng)
        total = np.zeros(3)
        for i in range(1, 299):
            sample = enter + i / 300.0 * (leave - enter)
            way = np.array(closest_on_ellipsoid(tuple(CHEST), tuple(sample), -1)) - sample
            total += way / np.linalg.norm(way)
        mean = np.array(mean_direction(tuple(CHEST), tuple(enter), tuple(leave)))
        error.append(np.linalg.norm(mean - total / np.linalg.norm(total)))
    # The rest is in chords close to the plane's edge, where the direction changes fast.
    assert np.median(error) < 1e-6
    assert np.percentile(error, 90) < 1e-3
    assert max(error) < 1e-2
