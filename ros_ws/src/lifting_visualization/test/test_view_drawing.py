# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Shapes stand where the quantities are, and have the colours of the limits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from human_model.motion import POINTS
from lifting_visualization.core import drawing
from lifting_visualization.core.drawing import SpineScale
from lifting_visualization.core.exceptions import PictureError
from lifting_visualization.core.shapes import Kind
from lifting_visualization.core.tables import bones, colours

SCALE = SpineScale(3400.0, 6400.0, 1e-4)
GREY = (0.6, 0.6, 0.6, 0.5)


def test_every_point_but_none_twice_is_the_end_of_a_bone():
    assert {name for pair in bones() for name in pair} == set(POINTS)
    assert len({frozenset(pair) for pair in bones()}) == len(bones())


def test_stick_figure_joins_the_points(skeleton):
    points = skeleton.point_array(skeleton.standing())[0]
    lines, joints, head = drawing.body('person', POINTS, points, GREY)
    assert lines.kind is Kind.LINES
    place = dict(zip(POINTS, points, strict=True))
    for k, (one, other) in enumerate(bones()):
        np.testing.assert_array_equal(lines.points[2 * k], place[one])
        np.testing.assert_array_equal(lines.points[2 * k + 1], place[other])
    np.testing.assert_array_equal(joints.points, points)
    # The ball of the head ends at the vertex.
    assert head.points[0, 2] + 0.5 * head.size[2] == pytest.approx(place['head'][2])


def test_a_missing_point_is_named(skeleton):
    points = skeleton.point_array(skeleton.standing())[0]
    with pytest.raises(PictureError, match='c7 is missing'):
        drawing.body('person', tuple(n if n != 'c7' else 'neck' for n in POINTS), points, GREY)


@pytest.mark.parametrize(
    ('value', 'role'),
    [
        (0.0, 'below_limit'),
        (3399.9, 'below_limit'),
        (3400.0, 'above_action'),
        (6399.9, 'above_action'),
        (6400.0, 'above_maximum'),
        (9000.0, 'above_maximum'),
    ],
)
def test_colour_changes_at_the_limits(value, role):
    arrow, text = drawing.compression('l5_s1', np.zeros(3), np.array([0, 0, 1.0]), value, SCALE)
    assert arrow.colour == text.colour == colours()[role]


@given(
    st.floats(1.0, 1e4),
    st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1),
)
def test_arrow_of_compression_ends_in_the_disc(value, direction):
    place = np.array([0.1, 0.2, 1.0])
    arrow, text = drawing.compression('l5_s1', place, np.array(direction), value, SCALE)
    tail, tip = arrow.points
    np.testing.assert_array_equal(tip, place)
    assert np.linalg.norm(tail - tip) == pytest.approx(1e-4 * value)
    assert (tail - tip) @ direction > 0.0
    assert text.text == f'{value:.0f} N'


def test_tension_points_the_other_way():
    place, up = np.zeros(3), np.array([0.0, 0.0, 1.0])
    arrow, _ = drawing.compression('l5_s1', place, up, -1000.0, SCALE)
    np.testing.assert_allclose(arrow.points, [place, 0.1 * up])


def test_no_number_no_arrow():
    shapes = drawing.compression('l5_s1', np.zeros(3), np.array([0, 0, 1.0]), np.nan, SCALE)
    assert [shape.kind for shape in shapes] == [Kind.NOTHING, Kind.NOTHING]


def test_ground_forces_stand_on_their_places():
    force = np.array([[10.0, 0.0, 600.0], [0.0, 5.0, 3.0]])
    cop = np.array([[0.1, -0.1, 0.0], [np.nan, np.nan, np.nan]])
    right, left = drawing.ground_forces('ground_force', force, cop, 1e-3)
    np.testing.assert_allclose(right.points, [cop[0], cop[0] + 1e-3 * force[0]])
    assert left.kind is Kind.NOTHING


def test_box_is_drawn_where_it_is_known():
    turn = np.array([0.0, 0.0, 1.0, 0.0])
    known = drawing.box('box', np.ones(3), np.array([0.3, 0.4, 0.2]), turn)
    assert (known.kind, known.size) == (Kind.BOX, (0.3, 0.4, 0.2))
    np.testing.assert_array_equal(known.orientation, turn)
    for place, size in ((np.full(3, np.nan), np.ones(3)), (np.ones(3), np.zeros(3))):
        assert drawing.box('box', place, size, turn).kind is Kind.NOTHING


def test_path_joins_neighbours_and_leaves_out_the_unknown():
    places = np.array([[0.0, 0, 0], [1.0, 0, 0], [np.nan, 0, 0], [2.0, 0, 0]])
    line = drawing.path('hand_paths', 0, places, GREY)
    np.testing.assert_array_equal(line.points[:, 0], [0.0, 1.0, 1.0, 2.0])
    assert drawing.path('hand_paths', 0, places[:1], GREY).kind is Kind.NOTHING
