# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Curves of the muscle of Millard, Uchida, Seth and Delp 2013 (J Biomech Eng 135:021005).

Each curve is a row of quintic Bezier sections that bend round the corner between two tangents, as
OpenSim 4's ``Millard2012EquilibriumMuscle`` has them, with straight lines before and behind.  A
section gives x and y as functions of a parameter; here each curve is sampled once on an even grid
of x and joined by cubics with its own slopes, which is within 1e-7 of it.

Default values are those of OpenSim 4.6.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array, IntArray
from muscle_analyzer.core.exceptions import OsimFormatError
from muscle_analyzer.core.osim.model import Muscle

KIND = 'Millard2012EquilibriumMuscle'
#: Points of the grid, and halvings that find a curve's parameter for each of them.
_NODES, _HALVINGS = 1025, 52
_BINOMIAL = np.array([1.0, 5.0, 10.0, 10.0, 5.0, 1.0])

ACTIVE = {
    'min_norm_active_fiber_length': 0.4441,
    'transition_norm_fiber_length': 0.73,
    'max_norm_active_fiber_length': 1.8123,
    'shallow_ascending_slope': 0.8616,
    'minimum_value': 0.1,
}
VELOCITY = {
    'concentric_slope_at_vmax': 0.0,
    'concentric_slope_near_vmax': 0.25,
    'isometric_slope': 5.0,
    'eccentric_slope_at_vmax': 0.0,
    'eccentric_slope_near_vmax': 0.15,
    'max_eccentric_velocity_force_multiplier': 1.4,
    'concentric_curviness': 0.6,
    'eccentric_curviness': 0.9,
}
PASSIVE = {'strain_at_zero_force': 0.0, 'strain_at_one_norm_force': 0.7}
#: Stiffness at low force, its product with the strain range at one normalised force, and
#: curviness where a file gives none of the three.
LOW_STIFFNESS, STIFFNESS_STRAIN, CURVINESS = 0.2, 2.0, 0.75
_SHAPE = ('stiffness_at_low_force', 'stiffness_at_one_norm_force', 'curviness')


@dataclass(frozen=True, eq=False)
class SampledCurve:
    """A curve on an even grid, straight outside.

    Attributes
    ----------
    lower, step : float
        First point of the grid and distance of its points.
    value, slope : (n,)
        Of the curve at the points.
    """

    lower: float
    step: float
    value: Array
    slope: Array


class CurveTable(NamedTuple):
    """Different curves, for the compiled functions.

    Attributes
    ----------
    lower, step : (n_k,)
        First point of each curve's grid and distance of its points.
    value, slope : (n_k, n)
        Of each curve at the points of its grid.
    """

    lower: Array
    step: Array
    value: Array
    slope: Array


def curve_table(curves: Sequence[SampledCurve]) -> CurveTable:
    """Put curves into one table, in their order."""
    return CurveTable(
        np.array([curve.lower for curve in curves]),
        np.array([curve.step for curve in curves]),
        np.array([curve.value for curve in curves]).reshape(-1, _NODES),
        np.array([curve.slope for curve in curves]).reshape(-1, _NODES),
    )


@njit(error_model='numpy')
def curve_value(
    lower: Array, step: Array, value: Array, slope: Array, curve: int, x: float
) -> float:
    """Return the value of a curve at x.

    Parameters
    ----------
    lower, step, value, slope
        Of a `CurveTable`.
    curve
        Number of the curve in it.
    x
        Where.
    """
    place = (x - lower[curve]) / step[curve]
    inside = min(max(place, 0.0), _NODES - 1.0)
    k = min(int(inside), _NODES - 2)
    t = inside - k
    rest = 1.0 - t
    y0, y1 = value[curve, k], value[curve, k + 1]
    m0, m1 = slope[curve, k] * step[curve], slope[curve, k + 1] * step[curve]
    between = rest**2 * ((1.0 + 2.0 * t) * y0 + t * m0)
    between += t**2 * ((3.0 - 2.0 * t) * y1 - rest * m1)
    return float(between + (place - inside) * (m0 if place < 0.0 else m1))


def corner(
    x0: float, y0: float, slope0: float, x1: float, y1: float, slope1: float, curviness: float
) -> Array:
    """Return the control points (2, 6) of a section between two points with given slopes.

    The inner ones lie on the tangents, the nearer to where these cross the greater the curviness
    (0 to 1, of which OpenSim takes 0.1 to 0.9).
    """
    if abs(slope0 - slope1) > np.sqrt(np.finfo(float).eps):
        x = (y1 - y0 - x1 * slope1 + x0 * slope0) / (slope0 - slope1)
    else:
        x = 0.5 * (x0 + x1)
    y = (x - x1) * slope1 + y1
    share = 0.1 + 0.8 * curviness
    ax, ay = x0 + share * (x - x0), y0 + share * (y - y0)
    bx, by = x1 + share * (x - x1), y1 + share * (y - y1)
    return np.array([[x0, ax, ax, bx, bx, x1], [y0, ay, ay, by, by, y1]])


def _bernstein(u: Array, degree: int) -> Array:
    binomial = _BINOMIAL if degree == 5 else np.array([1.0, 4.0, 6.0, 4.0, 1.0])
    powers = np.arange(degree + 1)
    return np.asarray(binomial * u[:, None] ** powers * (1.0 - u[:, None]) ** (degree - powers))


def sampled(sections: Sequence[Array]) -> SampledCurve:
    """Sample a row of sections.

    Raises
    ------
    OsimFormatError
        If x does not grow along the sections: the properties contradict each other.
    """
    points = np.array(sections)
    if np.any(np.diff(points[:, 0, :]) < 0.0) or np.any(points[:, 0, 0] >= points[:, 0, 5]):
        raise OsimFormatError(f'sections of a curve run backwards: x = {points[:, 0, [0, 5]]}')
    lower, upper = points[0, 0, 0], points[-1, 0, 5]
    x = np.linspace(lower, upper, _NODES)
    section = np.clip(np.searchsorted(points[:, 0, 0], x, side='right') - 1, 0, len(points) - 1)
    control = points[section]
    low, high = np.zeros(_NODES), np.ones(_NODES)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        short = np.sum(_bernstein(middle, 5) * control[:, 0], axis=1) < x
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    u = 0.5 * (low + high)
    rate = np.einsum('nk,ndk->nd', _bernstein(u, 4), np.diff(control, axis=2))
    value = np.sum(_bernstein(u, 5) * control[:, 1], axis=1)
    return SampledCurve(
        float(lower), float(upper - lower) / (_NODES - 1), value, rate[:, 1] / rate[:, 0]
    )


def active_curve(properties: Mapping[str, float]) -> SampledCurve:
    """Return the active force over fibre length, by the properties of `ACTIVE`."""
    x0, x1, x3, slope, low = (properties[name] for name in ACTIVE)
    wide = 0.05
    y1 = 1.0 - slope * (1.0 - wide - x1)
    rise, fall = 1.25 * y1 / (x1 - x0), -1.0 / (x3 - 1.0 - 2.0 * wide)
    x01, y01 = 0.5 * (x0 + x1), 0.5 * y1
    x1s, y1s = 0.5 * (x1 + 1.0 - wide), 0.5 * (1.0 + y1)
    x23, y23 = 0.5 * (1.0 + wide + x3), 0.5
    return sampled(
        [
            corner(x0, low, 0.0, x01, y01, rise, 1.0),
            corner(x01, y01, rise, x1s, y1s, slope, 1.0),
            corner(x1s, y1s, slope, 1.0, 1.0, 0.0, 1.0),
            corner(1.0, 1.0, 0.0, x23, y23, fall, 1.0),
            corner(x23, y23, fall, x3, low, 0.0, 1.0),
        ]
    )


def velocity_curve(properties: Mapping[str, float]) -> SampledCurve:
    """Return the force over fibre velocity, lengthening positive, by those of `VELOCITY`."""
    far, near, isometric, out, near_out, most, bend, bend_out = (
        properties[name] for name in VELOCITY
    )
    y, y_out = 0.05 * (near + far), most - 0.05 * (near_out + out)
    return sampled(
        [
            corner(-1.0, 0.0, far, -0.9, y, near, bend),
            corner(-0.9, y, near, 0.0, 1.0, isometric, bend),
            corner(0.0, 1.0, isometric, 0.9, y_out, near_out, bend_out),
            corner(0.9, y_out, near_out, 1.0, most, out, bend_out),
        ]
    )


def passive_curve(properties: Mapping[str, float]) -> SampledCurve:
    """Return the passive force over fibre length, by those of `PASSIVE` and its shape."""
    zero, one = (1.0 + properties[name] for name in PASSIVE)
    shape = (LOW_STIFFNESS, STIFFNESS_STRAIN / (one - zero), CURVINESS)
    if all(name in properties for name in _SHAPE):
        shape = (properties[_SHAPE[0]], properties[_SHAPE[1]], properties[_SHAPE[2]])
    low, stiffness, bend = shape
    x = zero + min(0.1 / stiffness, 0.1 * (one - zero))
    y = low * 0.5 * (x - zero)
    return sampled(
        [corner(zero, 0.0, 0.0, x, y, low, bend), corner(x, y, low, one, 1.0, stiffness, bend)]
    )


class MillardCurves(NamedTuple):
    """Curves of a model's Millard muscles.

    Attributes
    ----------
    table : CurveTable
        The different curves.
    number : (n_m, 3) int
        Those of each muscle of the model: active and passive force over length, force over
        velocity; -1 for muscles of other kinds.
    """

    table: CurveTable
    number: IntArray


def millard_curves(muscles: Sequence[Muscle]) -> MillardCurves:
    """Build the curves of a model's muscles, each that several muscles have once.

    Raises
    ------
    OsimFormatError
        If the properties of a curve contradict each other; names the muscle.
    """
    known: dict[tuple[str, tuple[tuple[str, float], ...]], int] = {}
    curves: list[SampledCurve] = []
    number = np.full((len(muscles), 3), -1, np.int64)
    for i, muscle in enumerate(muscles):
        if muscle.kind != KIND:
            continue
        for place, (tag, defaults, build) in enumerate(_CURVES):
            own = {
                name.removeprefix(f'{tag}/'): value
                for name, value in muscle.properties.items()
                if name.startswith(f'{tag}/')
            }
            properties = {**defaults, **own}
            key = (tag, tuple(sorted(properties.items())))
            if key not in known:
                try:
                    curves.append(build(properties))
                except OsimFormatError as error:
                    raise OsimFormatError(f'muscle {muscle.name} <{tag}>: {error}') from error
                known[key] = len(curves) - 1
            number[i, place] = known[key]
    return MillardCurves(curve_table(curves), number)


_CURVES: tuple[tuple[str, Mapping[str, float], Callable[[Mapping[str, float]], SampledCurve]], ...]
_CURVES = (
    ('ActiveForceLengthCurve', ACTIVE, active_curve),
    ('FiberForceLengthCurve', PASSIVE, passive_curve),
    ('ForceVelocityCurve', VELOCITY, velocity_curve),
)
