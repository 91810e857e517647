# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Functions and rotations as OpenSim's files write them: the way back of `osim.functions`."""

from __future__ import annotations

import math
from xml.etree.ElementTree import Element

import numpy as np

from human_model.typing import Array
from muscle_analyzer.core.exceptions import ModelWriteError
from muscle_analyzer.core.opensim_bridge.xml_tree import add_numbers
from muscle_analyzer.core.osim.functions import (
    PiecewisePolynomial,
    piecewise_linear,
    simm_spline,
    smooth_step,
)

#: Coefficients of a piece.
_LINE, _QUINTIC = 2, 6
#: Relative difference of coefficients up to which a spline through the same points is the same.
_SAME = 1e-9


def function_element(function: PiecewisePolynomial, name: str = '') -> Element:
    """Return a function as an element: constant, line, polynomial, broken line, step, spline.

    Raises
    ------
    ModelWriteError
        If the function is none of these.
    """
    element = Element('Constant')
    if function.is_constant():
        add_numbers(element, 'value', function.coefficients[0, 0])
    elif function.anchors.size == 1:
        rising = np.polynomial.Polynomial(function.coefficients[0])
        # About zero instead of about the anchor.
        rising = rising(np.polynomial.Polynomial([-function.anchors[0], 1.0]))
        element.tag = 'LinearFunction' if rising.coef.size == _LINE else 'PolynomialFunction'
        add_numbers(element, 'coefficients', rising.coef[::-1])
    elif function.coefficients.shape[1] == _LINE:
        element.tag = 'PiecewiseLinearFunction'
        last = function.anchors[-1] + 1.0
        knots = np.append(function.anchors, last)
        _add_points(element, function, piecewise_linear(knots, _values(function, knots)), knots)
    elif function.coefficients.shape[1] == _QUINTIC:
        element.tag = 'StepFunction'
        start, end = (float(place) for place in function.switches)
        low, high = (function.derivatives(place)[0] for place in (start, end))
        _check_same(function, smooth_step(start, end, low, high))
        for name_of, place, value in (('start', start, low), ('end', end, high)):
            add_numbers(element, f'transition_{name_of}_time', place)
            add_numbers(element, f'{name_of}_value', value)
    else:
        element.tag = 'SimmSpline'
        knots = function.switches
        _add_points(element, function, simm_spline(knots, _values(function, knots)), knots)
    if name:
        element.set('name', name)
    return element


def _values(function: PiecewisePolynomial, knots: Array) -> Array:
    return np.array([function.derivatives(float(x))[0] for x in knots])


def _add_points(
    element: Element, function: PiecewisePolynomial, again: PiecewisePolynomial, knots: Array
) -> None:
    """Append the points, if a function made of them is the same function."""
    _check_same(function, again)
    add_numbers(element, 'x', knots)
    add_numbers(element, 'y', _values(function, knots))


def _check_same(function: PiecewisePolynomial, again: PiecewisePolynomial) -> None:
    """Raise ModelWriteError if a function cannot be written as another one."""
    scale = max(float(np.abs(function.coefficients).max()), 1e-300)
    if (
        again.coefficients.shape != function.coefficients.shape
        or not np.array_equal(again.anchors, function.anchors)
        or np.abs(again.coefficients - function.coefficients).max() > _SAME * scale
    ):
        raise ModelWriteError(
            f'a function of {function.anchors.size} pieces is no broken line, step or SimmSpline'
        )


def xyz_angles(rotation: Array) -> Array:
    """Return the successive turns (3,) about x, the new y and the new z, of a matrix, rad.

    The way back of `osim.xml.body_fixed_xyz`.
    """
    r = rotation
    about_y = math.atan2(r[0, 2], math.hypot(r[0, 0], r[0, 1]))
    if math.hypot(r[0, 0], r[0, 1]) < np.sqrt(np.finfo(float).eps):
        # The first and the last axis are one: the first takes the whole turn.
        return np.array([math.atan2(r[2, 1], r[1, 1]), about_y, 0.0])
    return np.array([math.atan2(-r[1, 2], r[2, 2]), about_y, math.atan2(-r[0, 1], r[0, 0])])
