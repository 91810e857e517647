# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Path of a muscle over an ellipsoid, compiled.

As in OpenSim's ``WrapEllipsoid`` a segment wraps when it pierces the ellipsoid, and its path lies
in a plane through its ends and one point of the surface, the *guide*.  OpenSim's 'hybrid' method
takes the guide from where the segment crosses the coordinate plane most normal to it, or, if no
axis is nearly parallel to the segment, from the mean direction to the surface along the segment,
and blends between the two; 'midpoint' takes it from the middle of the pierced part.  A guide on
the passive half is mirrored.

Here the tangent points are found in closed form: divided by its half axes the ellipsoid is a unit
sphere, its section a circle, and lines tangent to the one stay tangent to the other.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core.wrapping import INSIDE, MISSED, PIERCED

Array = NDArray[np.float64]
#: A whole number, as Python or as compiled code has it.
Index = int | np.int64

#: Cosine between segment and axis below which only the mean direction counts, and above which only
#: the crossing of the coordinate plane does; share of the pierced length near either end in which
#: the crossing loses its weight (constants of OpenSim's hybrid method).
PARALLEL_NONE, PARALLEL_FULL, END_SHARE = 0.7073, 0.9, 0.3
#: Methods of choosing the guide.
HYBRID, MIDPOINT = 0, 1
#: Nodes and weights of the mean direction, for each part of the chord between coordinate planes
#: (where the closest point may jump).  OpenSim takes 298 evenly spaced samples instead.
_RAW_NODES, _RAW_WEIGHTS = np.polynomial.legendre.leggauss(6)
_FAN_NODES, _FAN_WEIGHTS = 0.5 * (_RAW_NODES + 1.0), 0.5 * _RAW_WEIGHTS
#: Nodes and weights of the arc length (Gauss-Legendre on [0, 1]).
_RAW_NODES, _RAW_WEIGHTS = np.polynomial.legendre.leggauss(12)
_NODES, _WEIGHTS = 0.5 * (_RAW_NODES + 1.0), 0.5 * _RAW_WEIGHTS


@njit(cache=True, error_model='numpy')
def _dot(a: Array, b: Array) -> float:
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@njit(cache=True, error_model='numpy')
def _cross(a: Array, b: Array) -> Array:
    out = np.empty(3)
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
    return out


@njit(cache=True, error_model='numpy')
def closest_on_ellipsoid(
    axes: Array, point: Array, held: Index, closest: Array, guess: float = -np.inf
) -> float:
    """
    Find the point of an ellipsoid closest to a point off its centre.

    With x_i = a_i^2 u_i / (t + a_i^2) the largest root t of sum (x_i / a_i)^2 = 1 is sought by
    Newton's method, from the left, where the function is convex and falling, or from a guess, a
    step from whose right leads to the left (Eberly, Distance from a point to an ellipse, an
    ellipsoid, or a hyperellipsoid).  Returns t.

    Parameters
    ----------
    axes, point
        Half axes and point (3,).
    held
        Coordinate kept as it is (the problem is then that of an ellipse in the plane of the
        other two), or -1.
    closest
        Filled with the result (3,).
    guess
        Of t, from a point nearby.
    """
    start = -np.inf
    for i in range(3):
        if i != held:
            start = max(start, axes[i] * abs(point[i]) - axes[i] * axes[i])
    t = max(start, guess)
    for _ in range(64):
        value, slope = -1.0, 0.0
        for i in range(3):
            if i != held:
                over = t + axes[i] * axes[i]
                if over <= 0.0:
                    continue
                ratio = axes[i] * point[i] / over
                value += ratio * ratio
                slope -= 2.0 * ratio * ratio / over
        if abs(value) < 1e-14 or slope == 0.0:
            break
        t = max(start, t - value / slope)
    for i in range(3):
        closest[i] = point[i]
        if i != held:
            over = t + axes[i] * axes[i]
            closest[i] = 0.0 if over <= 0.0 else axes[i] * axes[i] * point[i] / over
    return t


@njit(cache=True, error_model='numpy')
def _mean_direction(axes: Array, enter: Array, leave: Array, held: Index, mean: Array) -> None:
    """Fill `mean` with the mean of the unit vectors from a chord to the closest surface."""
    sample, surface = np.empty(3), np.empty(3)
    cuts = np.zeros(5)
    n = 1
    for i in range(3):
        if enter[i] * leave[i] < 0.0:
            cut = enter[i] / (enter[i] - leave[i])
            k = n
            while cuts[k - 1] > cut:
                cuts[k] = cuts[k - 1]
                k -= 1
            cuts[k] = cut
            n += 1
    cuts[n] = 1.0
    for i in range(3):
        mean[i] = 0.0
    t = -np.inf
    for part in range(n):
        width = cuts[part + 1] - cuts[part]
        for k in range(_FAN_NODES.size):
            share = cuts[part] + width * _FAN_NODES[k]
            for i in range(3):
                sample[i] = enter[i] + share * (leave[i] - enter[i])
            t = closest_on_ellipsoid(axes, sample, held, surface, t)
            square = 0.0
            for i in range(3):
                square += (surface[i] - sample[i]) ** 2
            if square > 0.0:
                weight = width * _FAN_WEIGHTS[k] / math.sqrt(square)
                for i in range(3):
                    mean[i] += weight * (surface[i] - sample[i])
    length = math.sqrt(_dot(mean, mean))
    if length > 0.0:
        for i in range(3):
            mean[i] /= length


@njit(cache=True, error_model='numpy')
def _guide(
    axes: Array, enter: Array, leave: Array, axis: int, sign: int, method: int, guide: Array
) -> None:
    """Fill `guide` with the surface point that fixes the plane of the path."""
    # Typed integers: a literal would make the compiler specialise the functions they are given to.
    best: Index = np.int64(0)
    none: Index = np.int64(-1)
    square = 0.0
    for i in range(3):
        square += (leave[i] - enter[i]) ** 2
        if abs(leave[i] - enter[i]) > abs(leave[best] - enter[best]):
            best = i
    parallel = abs(leave[best] - enter[best]) / math.sqrt(square)
    crossing = enter[best] / (enter[best] - leave[best])
    if method == HYBRID and parallel > PARALLEL_NONE:
        weight = min(1.0, max(0.0, min(crossing, 1.0 - crossing) / END_SHARE))
        parallel = PARALLEL_NONE + weight * (parallel - PARALLEL_NONE)
    fan = (PARALLEL_FULL - parallel) / (PARALLEL_FULL - PARALLEL_NONE)
    fan = min(1.0, max(0.0, fan))

    point = np.empty(3)
    if method == MIDPOINT:
        for i in range(3):
            point[i] = 0.5 * (enter[i] + leave[i])
        closest_on_ellipsoid(axes, point, none, guide)
    elif fan < 1.0:
        for i in range(3):
            point[i] = enter[i] + crossing * (leave[i] - enter[i])
        closest_on_ellipsoid(axes, point, best, guide)
    if method == HYBRID and fan > 0.0:
        by_fan = np.empty(3)
        _mean_direction(axes, enter, leave, none, by_fan)
        # A point one mean half axis away, as OpenSim scales lengths.
        reach = (axes[0] + axes[1] + axes[2]) / 3.0
        for i in range(3):
            point[i] = 0.5 * (enter[i] + leave[i]) + reach * by_fan[i]
        closest_on_ellipsoid(axes, point, none, by_fan)
        for i in range(3):
            point[i] = by_fan[i] if fan == 1.0 else (1.0 - fan) * guide[i] + fan * by_fan[i]
        closest_on_ellipsoid(axes, point, none, guide)
    if sign != 0 and guide[axis] * sign < 0.0:
        for i in range(3):
            point[i] = guide[i]
        point[axis] *= fan - 1.0
        closest_on_ellipsoid(axes, point, axis if fan == 1.0 else none, guide)


@njit(cache=True, error_model='numpy')
def wrap_ellipsoid(
    first: Array,
    second: Array,
    axes: Array,
    axis: int,
    sign: int,
    method: int,
    tangent_first: Array,
    tangent_second: Array,
) -> tuple[int, float]:
    """
    Wrap one segment over an ellipsoid; arguments and results as `wrap_cylinder`.

    `axes` are the half axes along x, y and z [m], `method` is `HYBRID` or `MIDPOINT`.
    """
    # In units of the half axes the ellipsoid is the unit sphere.
    a, b, along = np.empty(3), np.empty(3), np.empty(3)
    for i in range(3):
        a[i], b[i] = first[i] / axes[i], second[i] / axes[i]
        along[i] = b[i] - a[i]
    square_a, square_d, middle = _dot(a, a), _dot(along, along), _dot(a, along)
    if square_a < 1.0 or _dot(b, b) < 1.0:
        return INSIDE, 0.0
    if square_d == 0.0:
        return MISSED, 0.0
    under_root = middle * middle - square_d * (square_a - 1.0)
    if under_root <= 0.0:
        return MISSED, 0.0
    root = math.sqrt(under_root)
    enter, leave = (-middle - root) / square_d, (-middle + root) / square_d
    if not (0.0 < enter < 1.0 and 0.0 < leave < 1.0):
        return MISSED, 0.0

    guide, p, q = np.empty(3), np.empty(3), np.empty(3)
    for i in range(3):
        p[i] = axes[i] * (a[i] + enter * along[i])
        q[i] = axes[i] * (a[i] + leave * along[i])
    _guide(axes, p, q, axis, sign, method, guide)
    for i in range(3):
        guide[i] = guide[i] / axes[i] - a[i]
    normal = _cross(along, guide)
    size = math.sqrt(_dot(normal, normal))
    if size < 1e-12:
        # The segment runs through the guide itself: no side to wrap to.
        return MISSED, 0.0
    for i in range(3):
        normal[i] /= size
    height = _dot(normal, a)
    radius = math.sqrt(max(0.0, 1.0 - height * height))
    # Axes of the section's plane, the first towards the first end.
    from_centre_1 = math.sqrt(_dot(a, a) - height * height)
    for i in range(3):
        p[i] = (a[i] - height * normal[i]) / from_centre_1
    q = _cross(normal, p)
    x2, y2 = _dot(b, p), _dot(b, q)
    from_centre_2 = math.hypot(x2, y2)

    # The normal is chosen so that the guide is left of the segment: clockwise round the centre.
    angle_1 = -math.acos(min(1.0, radius / from_centre_1))
    angle_2 = math.atan2(y2, x2) + math.acos(min(1.0, radius / from_centre_2))
    turned = (angle_1 - angle_2) % (2.0 * math.pi)
    arc = 0.0
    for k in range(_NODES.size):
        angle = angle_1 - turned * _NODES[k]
        c, s = math.cos(angle), math.sin(angle)
        speed = 0.0
        for i in range(3):
            speed += (axes[i] * (c * q[i] - s * p[i])) ** 2
        arc += _WEIGHTS[k] * math.sqrt(speed)
    c1, s1 = math.cos(angle_1), math.sin(angle_1)
    c2, s2 = math.cos(angle_2), math.sin(angle_2)
    for i in range(3):
        tangent_first[i] = axes[i] * (height * normal[i] + radius * (c1 * p[i] + s1 * q[i]))
        tangent_second[i] = axes[i] * (height * normal[i] + radius * (c2 * p[i] + s2 * q[i]))
    return PIERCED, radius * turned * arc
