# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Path of a muscle through a torus, compiled.

As in OpenSim's ``WrapTorus`` the torus is replaced, for each segment, by a long cylinder along the
tangent of its centre line at one point of it, and the segment passes this cylinder on the side of
the torus' hole.  The point is the one nearest to a point of the segment's line, which OpenSim
seeks from both ends as the one closest to a circle of *twice* the radius of the centre line (its
residual has a factor of two that the derivative of the distance has not); the same is done here,
so that results agree.  OpenSim's least-squares search can end at a turning point of the residual
that is not a zero of it, and so not nearest to anything; such points are not taken here.
"""

import math

from human_model.compiled_cache import njit
from muscle_analyzer.core.muscles.cylinder_wrapping import (
    NOWHERE,
    POSSIBLE,
    Vector,
    component,
    wrap_cylinder,
)

#: What a torus does to a segment that does not touch it. OpenSim reports it as wrapped without
#: points, so that it never makes two surfaces change places (see `path_wrapping.wrap_path`).
PASSED = -2
#: Factor of OpenSim's residual, and length of its cylinder [m].
SEARCH_FACTOR, CYLINDER_LENGTH = 2.0, 1e4
_STEPS, _TOLERANCE = 100, 1e-15


@njit(error_model='numpy')
def _slope(u: float, base: float, reach: float, c3: float, c4: float, c5: float) -> float:
    """Return half the derivative of the squared distance of a line's point from a circle."""
    from_axis = math.sqrt(max(0.0, u * u * c4 + 2.0 * c3 * u + c5))
    return u + base - reach * (c4 * u + c3) / from_axis if from_axis > 0.0 else u + base


@njit(error_model='numpy')
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


@njit(error_model='numpy')
def nearest_of_ring(
    first: Vector, second: Vector, radius: float, axis: int, sign: int
) -> tuple[bool, float, float]:
    """Find the point of a circle about the z axis that a segment's line passes.

    Parameters
    ----------
    first, second
        Ends of the segment [m].
    radius
        Of the circle [m].
    axis, sign
        Half on which the point of the line must lie, as of `wrap_cylinder`.

    Returns
    -------
    found : bool
        Whether there is a point on the active half.
    x, y : float
        The point of the circle [m].
    """
    x1, y1, z1 = first
    dx, dy, dz = second[0] - x1, second[1] - y1, second[2] - z1
    size = math.sqrt(dx * dx + dy * dy + dz * dz)
    if size == 0.0:
        return False, 0.0, 0.0
    dx, dy, dz = dx / size, dy / size, dz / size
    base = x1 * dx + y1 * dy + z1 * dz
    reach = SEARCH_FACTOR * radius
    c3, c4, c5 = x1 * dx + y1 * dy, dx * dx + dy * dy, x1 * x1 + y1 * y1
    root_1 = root_2 = -base
    if c4 > 0.0:
        outer = reach * math.sqrt(c4)
        centre, least = -c3 / c4, max(0.0, c5 - c3 * c3 / c4)
        turn_square = (reach * c4 * least) ** (2.0 / 3.0) - least
        if turn_square <= 0.0:
            root_1 = _root(-base - outer, -base + outer, base, reach, c3, c4, c5)
            root_2 = root_1
        else:
            # Between two turning points the slope falls: one nearest point on either side.
            left = centre - math.sqrt(turn_square / c4)
            right = centre + math.sqrt(turn_square / c4)
            on_left = _slope(left, base, reach, c3, c4, c5) >= 0.0
            on_right = _slope(right, base, reach, c3, c4, c5) <= 0.0
            if on_left:
                root_1 = _root(min(left, -base - outer), left, base, reach, c3, c4, c5)
                root_2 = root_1
            if on_right:
                root_2 = _root(right, max(right, -base + outer), base, reach, c3, c4, c5)
                if not on_left:
                    root_1 = root_2
    found, best, nearest_x, nearest_y = False, math.inf, 0.0, 0.0
    for root in (root_1, root_2):
        x, y, z = x1 + root * dx, y1 + root * dy, z1 + root * dz
        from_axis = math.hypot(x, y)
        distance = math.hypot(from_axis - radius, z)
        active = sign == 0 or component((x, y, z), axis) * sign > 0.0
        if from_axis > 0.0 and active and distance < best:
            found, best = True, distance
            nearest_x, nearest_y = radius * x / from_axis, radius * y / from_axis
    return found, nearest_x, nearest_y


@njit(error_model='numpy')
def wrap_torus(
    first: Vector, second: Vector, dimensions: Vector, axis: int, sign: int, geodesic: bool
) -> tuple[int, float, Vector, Vector]:
    """Wrap one segment over a torus about the z axis; arguments and results as `wrap_cylinder`.

    `dimensions` are the radius of the tube and that of its centre line [m].  A segment that is not
    wrapped is `PASSED`, any other `POSSIBLE`.
    """
    found, x, y = nearest_of_ring(first, second, dimensions[1], axis, sign)
    if not found:
        return PASSED, 0.0, NOWHERE, NOWHERE
    # Axes of the cylinder: x to the centre of the hole, y down the torus' axis, z along the ring.
    x0, x1 = -x / dimensions[1], -y / dimensions[1]
    dx, dy = first[0] - x, first[1] - y
    end_1 = x0 * dx + x1 * dy, -first[2], x0 * dy - x1 * dx
    dx, dy = second[0] - x, second[1] - y
    end_2 = x0 * dx + x1 * dy, -second[2], x0 * dy - x1 * dx
    tube = dimensions[0], CYLINDER_LENGTH, 0.0
    contact, arc, one, two = wrap_cylinder(end_1, end_2, tube, 0, 1, geodesic)
    if contact < POSSIBLE:
        return PASSED, 0.0, NOWHERE, NOWHERE
    tangent_first = x + x0 * one[0] - x1 * one[2], y + x1 * one[0] + x0 * one[2], -one[1]
    tangent_second = x + x0 * two[0] - x1 * two[2], y + x1 * two[0] + x0 * two[2], -two[1]
    return POSSIBLE, arc, tangent_first, tangent_second
