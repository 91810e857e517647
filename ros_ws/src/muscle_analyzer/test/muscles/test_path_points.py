# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Conditional and moving path points: lengths by hand, moment arms as derivatives of lengths."""

import math
from itertools import pairwise

import numpy as np
import pytest

from muscle_analyzer.core.exceptions import OsimFormatError
from muscle_analyzer.core.multibody.kinematics import body_jacobians, forward_kinematics
from muscle_analyzer.core.multibody.model import compile_model
from muscle_analyzer.core.muscles.path_table import path_table
from muscle_analyzer.core.muscles.paths import crossed_paths, muscle_paths, posture_paths
from muscle_analyzer.core.osim.reader import read_osim
from muscle_analyzer.core.subject.model import default_path_lengths

LAST = '<PathPoint name="p2">'
CONDITIONAL = """<ConditionalPathPoint name="via"><socket_parent_frame>/bodyset/upper
</socket_parent_frame><location>0.05 -0.1 0</location><range>{range}</range>
<socket_coordinate>/jointset/{coordinate}</socket_coordinate></ConditionalPathPoint>"""
MOVING = """<MovingPathPoint name="slider"><socket_parent_frame>/bodyset/{body}
</socket_parent_frame>{location}</MovingPathPoint>"""
ALONG = """<{axis}_location>{function}</{axis}_location>
<socket_{axis}_coordinate>/jointset/joint/{coordinate}</socket_{axis}_coordinate>"""
CURVE = '<PolynomialFunction><coefficients>{0}</coefficients></PolynomialFunction>'
COUPLER = """<CoordinateCouplerConstraint name="follow"><coupled_coordinates_function>
<PolynomialFunction><coefficients>0.4 -0.3 0.1</coefficients></PolynomialFunction>
</coupled_coordinates_function><independent_coordinate_names>q1</independent_coordinate_names>
<dependent_coordinate_name>q2</dependent_coordinate_name></CoordinateCouplerConstraint>"""
WRAP = """</objects></PathPointSet><PathWrapSet><objects><PathWrap name="w">
<wrap_object>drum</wrap_object><range>{range}</range></PathWrap></objects></PathWrapSet>"""


def moving(x, y, z, body='upper'):
    """Write a moving point; each axis is a polynomial and its coordinate."""
    location = ''.join(
        ALONG.format(axis=axis, function=CURVE.format(f), coordinate=c)
        for axis, (f, c) in zip('xyz', (x, y, z), strict=True)
    )
    return MOVING.format(body=body, location=location)


@pytest.fixture
def compiled(write_model):
    """Return a function that compiles the pendulum with a point before the muscle's last."""

    def compile_with(point, *replaced, **options):
        path = write_model((LAST, point + LAST), *replaced, **options)
        model = compile_model(read_osim(path))
        return model, path_table(model, geodesic=True)

    return compile_with


def paths_at(model, table, q):
    q = np.asarray(q, dtype=float)
    zero = np.zeros_like(q)
    state = forward_kinematics(model.tree, q, zero, zero)
    return posture_paths(table, state, body_jacobians(model.tree, state))


def check_moment_arms(model, table, q):
    """Compare moment arms with minus the differences of the lengths."""
    q = np.asarray(q, dtype=float)
    arms = paths_at(model, table, q).moment_arm
    for j in range(q.size):
        shift = 1e-6 * (np.arange(q.size) == j)
        longer, shorter = (paths_at(model, table, q + s).length for s in (shift, -shift))
        np.testing.assert_allclose(arms[:, j], -(longer - shorter) / 2e-6, atol=1e-9)
    state = forward_kinematics(model.tree, q, np.zeros_like(q), np.zeros_like(q))
    crossed = table.crossed_index[: table.crossed_start[1]]
    np.testing.assert_allclose(crossed_paths(table, state).arm, arms[0, crossed], rtol=1e-15)


def turned(point, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * point[0] - s * point[1], s * point[0] + c * point[1]])


def length_of(*points):
    return sum(math.dist(a, b) for a, b in pairwise(points))


@pytest.mark.parametrize(
    ('angle', 'there'),
    [(-0.5, True), (0.5, True), (0.500009, True), (0.50002, False), (1.0, False)],
)
def test_conditional_point_is_there_within_its_range_and_a_margin(compiled, angle, there):
    model, table = compiled(CONDITIONAL.format(range='-0.5 0.5', coordinate='shoulder/q1'))
    ends = np.array([0.1, 0.0]), turned((0.02, -0.2), angle)
    via = [turned((0.05, -0.1), angle)] if there else []
    found = paths_at(model, table, [angle, 0.0])
    assert found.length[0] == pytest.approx(length_of(ends[0], *via, ends[1]), abs=1e-14)
    check_moment_arms(model, table, [angle - 1e-3, 0.0])


def test_condition_may_be_on_a_coupled_coordinate(compiled):
    """q2 = 0.4 q1^2 - 0.3 q1 + 0.1 is above 0.1 for negative q1 only."""
    point = CONDITIONAL.format(range='0.1 9', coordinate='elbow/q2')
    model, table = compiled(point, constraints=COUPLER)
    for angle, there in ((-0.4, True), (0.4, False)):
        via = [turned((0.05, -0.1), angle)] if there else []
        expected = length_of([0.1, 0.0], *via, turned((0.02, -0.2), angle))
        assert paths_at(model, table, [angle]).length[0] == pytest.approx(expected, abs=1e-14)


def test_unknown_coordinate_of_a_condition_is_named(compiled):
    with pytest.raises(OsimFormatError, match="path point via: no coordinate 'q7'"):
        compiled(CONDITIONAL.format(range='0 1', coordinate='elbow/q7'))


def test_moving_point_moves_with_its_coordinate_and_pulls_it(compiled):
    """The elbow slides a point of the upper link; the muscle crosses only the shoulder."""
    point = moving(('0.2 0.05', 'q2'), ('0.1 -0.03 -0.1', 'q2'), ('0', 'q2'))
    model, table = compiled(point)
    a, b = 0.3, -0.4
    via = turned((0.2 * b + 0.05, 0.1 * b**2 - 0.03 * b - 0.1), a)
    expected = length_of([0.1, 0.0], via, turned((0.02, -0.2), a))
    found = paths_at(model, table, [a, b])
    assert found.length[0] == pytest.approx(expected, abs=1e-14)
    assert abs(found.moment_arm[0, 1]) > 1e-3
    check_moment_arms(model, table, [a, b])


def test_moving_point_counts_coupled_and_mixed_coordinates(compiled):
    point = moving(('0.2 0.05', 'q2'), ('0.1 -0.1', 'q1'), ('0.3 0.01', 'q2'), 'lower')
    model, table = compiled(point, constraints=COUPLER)
    check_moment_arms(model, table, [0.7])
    assert paths_at(model, table, [0.7]).length[0] > 0.0


def test_moving_point_next_to_a_wrap_object(compiled):
    """The drum lies between the sliding point and the muscle's end."""
    point = moving(('0.2 -0.1', 'q2'), ('0.1 -0.04', 'q2'), ('0', 'q2'))
    end = '</objects></PathPointSet>'
    # Around the drum at (0, -0.1): points 2 and 3 are on either side of it.
    model, table = compiled(
        point, (end, WRAP.format(range='2 3')), ('<location>0.02 -0.2 0', '<location>0.1 -0.17 0')
    )
    q = [0.2, 0.1]
    straight = length_of(turned((-0.08, -0.03), 0.2), turned((0.1, -0.17), 0.2))
    first = length_of([0.1, 0.0], turned((-0.08, -0.03), 0.2))
    assert paths_at(model, table, q).length[0] > first + straight + 1e-4
    check_moment_arms(model, table, q)


def test_locked_coordinate_holds_its_point(compiled):
    plain = '<Coordinate name="q2"><default_value>0'
    locked = '<Coordinate name="q2"><locked>true</locked><default_value>0.5'
    point = moving(('0.2 0.05', 'q2'), ('-0.1', 'q2'), ('0', 'q2'))
    model, table = compiled(point, (plain, locked))
    expected = length_of([0.1, 0.0], turned((0.15, -0.1), 0.3), turned((0.02, -0.2), 0.3))
    assert paths_at(model, table, [0.3]).length[0] == pytest.approx(expected, abs=1e-14)
    check_moment_arms(model, table, [0.3])


def test_posture_must_be_known(compiled):
    model, table = compiled(CONDITIONAL.format(range='0 1', coordinate='shoulder/q1'))
    zero = np.zeros(2)
    state = forward_kinematics(model.tree, zero, zero, zero)
    with pytest.raises(ValueError, match='posture_paths'):
        muscle_paths(table, state.position, state.rotation, body_jacobians(model.tree, state))


def test_range_counts_points_that_are_not_there(compiled):
    """A wrap between points 2 and 3 has no segment once the conditional second is gone."""
    point = CONDITIONAL.format(range='0 9', coordinate='elbow/q2')
    point = point.replace('0.05 -0.1 0', '-0.08 -0.05 0')
    end = '</objects></PathPointSet>'
    model, table = compiled(
        point, (end, WRAP.format(range='2 3')), ('<location>0.02 -0.2 0', '<location>0.1 -0.17 0')
    )
    ends = np.array([0.1, 0.0]), np.array([0.1, -0.17])
    assert paths_at(model, table, [0.0, -0.1]).length[0] == pytest.approx(length_of(*ends))
    via = np.array([-0.08, -0.05])
    straight = length_of(ends[0], via, ends[1])
    assert paths_at(model, table, [0.0, 0.1]).length[0] > straight + 1e-4


def test_default_path_lengths_know_the_posture(compiled):
    """Scaling takes fibre lengths from them: a model with such points can be scaled."""
    model, table = compiled(CONDITIONAL.format(range='-0.5 0.5', coordinate='shoulder/q1'))
    expected = paths_at(model, table, model.default).length
    assert default_path_lengths(model.source) == pytest.approx(expected, abs=1e-14)
