# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Revised NIOSH lifting equation against published vectors."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from human_model.task import Coupling
from injury_monitor.core import lifting_equation as rnle
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.lifting_equation import LiftingTask, lifting_equation
from injury_monitor.core.lifting_geometry import LiftEnd, forward_direction, lifting_task

INCH = 2.54
POUND = 0.45359237


def task(**changes):
    values = {
        'horizontal': 25.0,
        'vertical': 75.0,
        'distance': 25.0,
        'asymmetry': 0.0,
        'lifts_per_minute': 0.2,
        'duration_hours': 1.0,
        'coupling': Coupling.GOOD,
    }
    return LiftingTask(**(values | changes))


def test_ideal_lift_is_the_load_constant():
    result = lifting_equation(task(), 23.0)
    assert result.multipliers == (1.0,) * 6
    assert result.recommended_weight_limit == 23.0
    assert result.lifting_index == 1.0
    assert result.limiting_multiplier == ''


@pytest.mark.parametrize(
    ('vertical', 'horizontal', 'coupling', 'multipliers', 'pounds'),
    [
        (15.0, 23.0, Coupling.FAIR, (0.44, 0.89, 0.86, 1.0, 1.0, 0.95), 15.7),
        (63.0, 23.0, Coupling.FAIR, (0.44, 0.75, 0.86, 1.0, 1.0, 1.00), 13.9),
    ],
)
def test_punch_press_example_of_the_manual(vertical, horizontal, coupling, multipliers, pounds):
    """NIOSH 94-110 example 1, multipliers to the manual's two decimals, limit unrounded.

    The example is in inches, where HM = 10 in / H; the metric formula has 25 cm, not 25.4 cm.
    """
    result = lifting_equation(
        task(
            horizontal=horizontal * INCH,
            vertical=vertical * INCH,
            distance=48.0 * INCH,
            coupling=coupling,
        ),
        44.0 * POUND,
    )
    in_inches = np.array(result.multipliers) * [10.0 * INCH / 25.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    np.testing.assert_allclose(in_inches, multipliers, atol=0.01)
    assert result.recommended_weight_limit / POUND == pytest.approx(pounds, abs=0.1)
    assert result.limiting_multiplier == 'HM'


@pytest.mark.parametrize(
    ('rate', 'hours', 'vertical', 'value'),
    [
        (0.0, 1.0, 0.0, 1.00),
        (0.2, 8.0, 0.0, 0.85),
        (4.0, 8.0, 0.0, 0.45),
        (9.0, 8.0, 74.9, 0.0),
        (9.0, 8.0, 75.0, 0.15),
        (12.0, 2.0, 80.0, 0.21),
        (12.0, 8.0, 80.0, 0.0),
        (15.0, 1.0, 80.0, 0.28),
        (15.0, 1.0, 10.0, 0.0),
        (15.1, 1.0, 80.0, 0.0),
        (7.5, 1.0, 0.0, 0.65),
    ],
)
def test_frequency_table(rate, hours, vertical, value):
    assert rnle.frequency_multiplier(rate, hours, vertical) == pytest.approx(value)


@pytest.mark.parametrize(
    ('function', 'argument', 'value'),
    [
        (rnle.horizontal_multiplier, 10.0, 1.0),
        (rnle.horizontal_multiplier, 50.0, 0.5),
        (rnle.horizontal_multiplier, 63.0, 25.0 / 63.0),
        (rnle.horizontal_multiplier, 63.1, 0.0),
        (rnle.vertical_multiplier, 0.0, 0.775),
        (rnle.vertical_multiplier, 175.0, 0.7),
        (rnle.vertical_multiplier, 175.1, 0.0),
        (rnle.distance_multiplier, 0.0, 1.0),
        (rnle.distance_multiplier, 100.0, 0.865),
        (rnle.distance_multiplier, 175.1, 0.0),
        (rnle.asymmetry_multiplier, 135.0, 0.568),
        (rnle.asymmetry_multiplier, 135.1, 0.0),
    ],
)
def test_multipliers_and_their_ends(function, argument, value):
    assert function(argument) == pytest.approx(value)


def test_out_of_reach_has_no_limit_but_an_infinite_index():
    result = lifting_equation(task(horizontal=70.0), 5.0)
    assert result.recommended_weight_limit == 0.0
    assert math.isinf(result.lifting_index)
    assert result.limiting_multiplier == 'HM'
    assert rnle.lifting_index_band(result.lifting_index) == 'very high'


@given(
    st.floats(0, 100),
    st.floats(0, 200),
    st.floats(0, 200),
    st.floats(0, 180),
    st.floats(0, 20),
    st.floats(0.1, 8),
    st.sampled_from(list(Coupling)),
)
def test_limit_never_exceeds_the_load_constant(h, v, d, a, f, hours, coupling):
    result = lifting_equation(LiftingTask(h, v, d, a, f, hours, coupling), 10.0)
    assert all(0.0 <= m <= 1.0 + 1e-12 for m in result.multipliers)
    assert 0.0 <= result.recommended_weight_limit <= rnle.LOAD_CONSTANT * (1.0 + 1e-12)


@pytest.mark.parametrize(
    ('index', 'band'),
    [
        (0.0, 'very low'),
        (1.0, 'very low'),
        (1.01, 'low'),
        (2.0, 'moderate'),
        (3.0, 'high'),
        (3.01, 'very high'),
    ],
)
def test_bands(index, band):
    assert rnle.lifting_index_band(index) == band


@pytest.mark.parametrize(
    ('field', 'value'),
    [
        ('horizontal', -1.0),
        ('vertical', math.nan),
        ('distance', math.inf),
        ('asymmetry', 181.0),
        ('lifts_per_minute', -0.1),
        ('duration_hours', 0.0),
        ('duration_hours', 8.1),
        ('coupling', 4),
    ],
)
def test_bad_task_is_refused_by_field(field, value):
    with pytest.raises(InvalidInputError, match=field):
        task(**{field: value})


def test_geometry_of_a_lift_to_the_left():
    """Feet side by side facing x; grip 0.4 m away, turned 45 deg to the left."""
    ankles = np.array([[1.0, 1.9, 0.08], [1.0, 2.1, 0.08]])
    np.testing.assert_allclose(forward_direction(ankles), [1.0, 0.0])
    part = 0.4 * math.sqrt(0.5)
    end = LiftEnd(np.array([1.0 + part, 2.0 + part, 0.6]), ankles)
    result = lifting_task(end, -0.35, forward_direction(ankles), 1.0, 1.0, Coupling.FAIR)
    assert result.horizontal == pytest.approx(40.0)
    assert result.vertical == pytest.approx(60.0)
    assert result.distance == pytest.approx(35.0)
    assert result.asymmetry == pytest.approx(45.0)


@given(st.floats(-math.pi, math.pi), st.floats(-math.pi, math.pi))
def test_geometry_does_not_depend_on_the_laboratory(turn, direction):
    def rotate(points):
        c, s = math.cos(turn), math.sin(turn)
        return np.asarray(points) @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])

    ankles = np.array([[0.0, -0.1, 0.1], [0.0, 0.1, 0.1]])
    grip = np.array([0.5 * math.cos(direction), 0.5 * math.sin(direction), 0.7])
    results = [
        lifting_task(LiftEnd(g, a), 0.2, forward_direction(a), 1.0, 1.0, Coupling.GOOD)
        for g, a in ((grip, ankles), (rotate(grip), rotate(ankles)))
    ]
    assert results[1].horizontal == pytest.approx(results[0].horizontal)
    assert results[1].asymmetry == pytest.approx(results[0].asymmetry, abs=1e-5)
    assert results[0].asymmetry == pytest.approx(abs(math.degrees(direction)), abs=1e-5)


def test_bad_places_are_refused():
    ankles = np.zeros((2, 3))
    with pytest.raises(InvalidInputError, match='ankles'):
        forward_direction(ankles)
    with pytest.raises(InvalidInputError, match='grip'):
        LiftEnd(np.array([np.nan, 0.0, 0.0]), ankles)
    with pytest.raises(InvalidInputError, match='ankles'):
        LiftEnd(np.zeros(3), np.zeros((3, 2)))
