# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Path of a muscle through a torus, compiled.

As in OpenSim's ``WrapTorus`` the torus is replaced, for each segment, by a long cylinder along the
tangent of its centre line at one point of it, and the segment passes this cylinder on the side of
the torus' hole.  The point is the one nearest to a point of the segment's line, which OpenSim
seeks from both ends as the one closest to a circle of *twice* the radius of the centre line (its
residual has a factor of two that the derivative of the distance has not); the same is done here,
so that results agree.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core.wrapping import POSSIBLE, wrap_cylinder

Array = NDArray[np.float64]

#: What a torus does to a segment that does not touch it. OpenSim reports it as wrapped without
#: points, so that it never makes two surfaces change places (see `path_wrapping.wrap_path`).
PASSED = -2
#: Factor of OpenSim's residual, and length of its cylinder [m].
SEARCH_FACTOR, CYLINDER_LENGTH = 2.0, 1e4
_STEPS, _TOLERANCE = 100, 1e-15


@njit(cache=True, error_model='numpy')
def _slope(u: float, base: float, reach: float, c3: float, c4: float, c5: float) -> float:
    """Give half the derivative of the squared distance of a line's point from a circle."""
    from_axis = math.sqrt(max(0.0, u * u * c4 + 2.0 * c3 * u + c5))
    return u + base - reach * (c4 * u + c3) / from_axis if from_axis > 0.0 else u + base


@njit(cache=True, error_model='numpy')
def _root(
    low: float, high: float, base: float, reach: float, c3: float, c4: float, c5: float
) -> float:
    """Find the zero of the slope, which grows from `low` to `high`, by bisection."""
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        if _slope(middle, base, reach, c3, c4, c5) < 0.0:
            low = middle
        else:
            high = middle
        if high - low < _TOLERANCE:
            break
    return 0.5 * (low + high)


@njit(cache=True, error_model='numpy')
def nearest_of_ring(
    first: Array, second: Array, radius: float, axis: int, sign: int, nearest: Array
) -> bool:
    """
    Find the point of a circle about the z axis that a segment's line passes.

    Parameters
    ----------
    first, second
        Ends of the segment (3,) [m].
    radius
        Of the circle [m].
    axis, sign
        Half on which the point of the line must lie, as of `wrap_cylinder`.
    nearest
        Filled with the point of the circle (3,) [m].

    Returns
    -------
    bool
        Whether there is a point on the active half.
    """
    direction = np.empty(3)
    size = 0.0
    for i in range(3):
        direction[i] = second[i] - first[i]
        size += direction[i] ** 2
    size = math.sqrt(size)
    if size == 0.0:
        return False
    base = 0.0
    for i in range(3):
        direction[i] /= size
        base += first[i] * direction[i]
    reach = SEARCH_FACTOR * radius
    c3 = first[0] * direction[0] + first[1] * direction[1]
    c4 = direction[0] ** 2 + direction[1] ** 2
    c5 = first[0] ** 2 + first[1] ** 2
    roots = np.full(2, -base)
    if c4 > 0.0:
        outer = reach * math.sqrt(c4)
        centre, least = -c3 / c4, max(0.0, c5 - c3 * c3 / c4)
        turn_square = (reach * c4 * least) ** (2.0 / 3.0) - least
        if turn_square <= 0.0:
            roots[:] = _root(-base - outer, -base + outer, base, reach, c3, c4, c5)
        else:
            # Between two turning points the slope falls: one nearest point on either side.
            left = centre - math.sqrt(turn_square / c4)
            right = centre + math.sqrt(turn_square / c4)
            on_left = _slope(left, base, reach, c3, c4, c5) >= 0.0
            on_right = _slope(right, base, reach, c3, c4, c5) <= 0.0
            if on_left:
                roots[:] = _root(min(left, -base - outer), left, base, reach, c3, c4, c5)
            if on_right:
                at = _root(right, max(right, -base + outer), base, reach, c3, c4, c5)
                roots[1] = at
                if not on_left:
                    roots[0] = at
    best = np.inf
    for root in roots:
        x, y, z = (
            first[0] + root * direction[0],
            first[1] + root * direction[1],
            first[2] + root * direction[2],
        )
        from_axis = math.hypot(x, y)
        place = x if axis == 0 else (y if axis == 1 else z)
        distance = math.hypot(from_axis - radius, z)
        if from_axis > 0.0 and (sign == 0 or place * sign > 0.0) and distance < best:
            best = distance
            nearest[0], nearest[1] = radius * x / from_axis, radius * y / from_axis
            nearest[2] = 0.0
    return best < np.inf


@njit(cache=True, error_model='numpy')
def wrap_torus(
    first: Array,
    second: Array,
    dimensions: Array,
    axis: int,
    sign: int,
    geodesic: bool,
    tangent_first: Array,
    tangent_second: Array,
) -> tuple[int, float]:
    """
    Wrap one segment over a torus about the z axis; arguments and results as `wrap_cylinder`.

    `dimensions` are the radius of the tube and that of its centre line [m].  A segment that is not
    wrapped is `PASSED`, any other `POSSIBLE`.
    """
    centre = np.empty(3)
    if not nearest_of_ring(first, second, dimensions[1], axis, sign, centre):
        return PASSED, 0.0
    # Axes of the cylinder: x to the centre of the hole, y down the torus' axis, z along the ring.
    x0, x1 = -centre[0] / dimensions[1], -centre[1] / dimensions[1]
    ends = np.empty((4, 3))
    for k in range(2):
        end = first if k == 0 else second
        dx, dy = end[0] - centre[0], end[1] - centre[1]
        ends[k, 0] = x0 * dx + x1 * dy
        ends[k, 1] = -end[2]
        ends[k, 2] = -x1 * dx + x0 * dy
    tube = np.array([dimensions[0], CYLINDER_LENGTH, 0.0])
    contact, arc = wrap_cylinder(ends[0], ends[1], tube, 0, 1, geodesic, ends[2], ends[3])
    if contact < POSSIBLE:
        return PASSED, 0.0
    for k in range(2):
        tangent = tangent_first if k == 0 else tangent_second
        tangent[0] = centre[0] + x0 * ends[2 + k, 0] - x1 * ends[2 + k, 2]
        tangent[1] = centre[1] + x1 * ends[2 + k, 0] + x0 * ends[2 + k, 2]
        tangent[2] = -ends[2 + k, 1]
    return POSSIBLE, arc
