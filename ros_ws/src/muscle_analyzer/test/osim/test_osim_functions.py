# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Functions of `.osim` files against scipy and against what defines them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import make_interp_spline

from muscle_analyzer.core.exceptions import OsimFormatError
from muscle_analyzer.core.osim.functions import (
    constant,
    evaluate,
    function_table,
    linear,
    piecewise_linear,
    polynomial,
    simm_spline,
    smooth_step,
)

X = np.array([0.0, 0.17, 0.35, 0.6, 0.7, 1.1, 1.3])
Y = np.array([0.0, 0.013, 0.023, 0.03, 0.033, 0.02, -0.01])


def third_derivative(x, y):
    return 6.0 * np.polyfit(x, y, 3)[0]


def test_spline_equals_scipys_with_the_same_end_conditions():
    ends = [(3, third_derivative(X[:4], Y[:4]))], [(3, third_derivative(X[-4:], Y[-4:]))]
    expected = make_interp_spline(X, Y, k=3, bc_type=ends)
    spline = simm_spline(X, Y)
    for x in np.linspace(0.0, 1.3, 57)[:-1]:
        values = [float(expected(x, nu)) for nu in range(3)]
        assert spline.derivatives(x) == pytest.approx(values, abs=1e-9)


@given(st.lists(st.floats(-2.0, 2.0), min_size=4, max_size=4), st.floats(0.0, 1.29))
def test_spline_of_a_cubic_is_the_cubic(coefficients, x):
    cubic = np.polynomial.Polynomial(coefficients)
    values = simm_spline(X, cubic(X)).derivatives(x)
    assert values == pytest.approx(
        [cubic.deriv(k)(x) if k else cubic(x) for k in range(3)], abs=1e-8
    )


def test_spline_goes_on_as_a_straight_line():
    spline = simm_spline(X, Y)
    for end, outside in ((X[0], -0.4), (X[-1], 2.0)):
        value, slope, _ = spline.derivatives(end)
        assert spline.derivatives(outside) == pytest.approx(
            (value + slope * (outside - end), slope, 0.0)
        )


def test_spline_of_three_points_is_the_parabola():
    spline = simm_spline([0.0, 1.0, 3.0], [1.0, 2.0, 10.0])
    assert spline.derivatives(2.0)[0] == pytest.approx(1.0 + 2.0**2)


def test_compiled_evaluation_equals_the_plain_one():
    functions = [
        constant(0.3),
        linear(2.0, -1.0),
        polynomial([0.1, -0.3, 0.4, 0.05, 0.01]),
        piecewise_linear([0.0, 1.0, 2.0], [0.0, 2.0, 1.0]),
        simm_spline(X, Y).scaled(1.3),
    ]
    table = function_table(functions)
    for number, function in enumerate(functions):
        for x in np.linspace(-1.0, 3.0, 41):
            assert evaluate(table, number, x) == pytest.approx(function.derivatives(x), abs=1e-12)


@pytest.mark.parametrize(
    ('x', 'y', 'named'),
    [([0.0], [1.0], 'two'), ([0.0, 1.0], [1.0], '2 x, 1 y'), ([0.0, 0.0], [1.0, 2.0], 'increase')],
)
def test_bad_points_are_refused(x, y, named):
    with pytest.raises(OsimFormatError, match=named):
        simm_spline(x, y)


def test_smooth_step_is_level_at_both_ends():
    step = smooth_step(1.0, 3.0, 5.0, -1.0)
    assert step.derivatives(0.0) == (5.0, 0.0, 0.0)
    assert step.derivatives(4.0) == (-1.0, 0.0, 0.0)
    assert step.derivatives(1.0) == pytest.approx((5.0, 0.0, 0.0))
    assert step.derivatives(3.0 - 1e-12) == pytest.approx((-1.0, 0.0, 0.0), abs=1e-9)
    # Halfway: the mean, and 15/8 of the mean slope.
    assert step.derivatives(2.0) == pytest.approx((2.0, -3.0 * 15.0 / 8.0, 0.0))


def test_step_without_width_is_refused():
    with pytest.raises(OsimFormatError, match=r'ends at 1\.0, not after its start at 1\.0'):
        smooth_step(1.0, 1.0, 0.0, 1.0)


def test_shifted_function_has_the_same_slopes():
    spline = simm_spline(X, Y)
    value, slope, bend = spline.derivatives(0.4)
    assert spline.shifted(0.7).derivatives(0.4) == pytest.approx((value + 0.7, slope, bend))
