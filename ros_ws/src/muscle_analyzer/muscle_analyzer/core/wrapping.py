# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Path of a muscle over a cylinder, compiled.

The conditions under which a path wraps, and on which side, are those of OpenSim's
``WrapCylinder`` (Delp et al. 1990, IEEE Trans Biomed Eng 37:757): without a quadrant the
shorter side, and only if the straight segment meets the cylinder; with a quadrant around the
given half, also when the segment misses the cylinder on its other half.

Seen along the axis the path is given by its tangents.  For the heights of the tangent points
there are two constructions:

* the *geodesic*, straight in the unrolled surface: the shortest path, which changes smoothly
  when the wrap begins, and whose moment arms are the derivatives of its length;
* OpenSim's, which puts them in the plane through both ends and the *apex*, a point of the surface
  over the axis where the segment passes it.  It differs from the geodesic when the segment is
  oblique to the axis (by up to 4 mm of moment arm in the lifting full-body model).
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: What a surface does to one segment of a path: an end point lies inside; it is not met; it may
#: be wrapped if no other segment is shorter; the segment pierces it and must wrap.
INSIDE, MISSED, POSSIBLE, PIERCED = -1, 0, 1, 2


@njit(cache=True, error_model='numpy')
def _apex_heights(
    first: Array,
    second: Array,
    radius: float,
    far: bool,
    tangents: tuple[float, float, float, float],
) -> tuple[float, float]:
    """
    Give the heights of the tangent points in the plane of both ends and the apex.

    `tangents` are x and y of the first and of the second tangent point; `far` puts the apex on
    the side of the axis away from the segment.  A height outside those of the ends is replaced by
    that of its end.
    """
    share = math.sqrt(first[0] ** 2 + first[1] ** 2)
    share /= share + math.sqrt(second[0] ** 2 + second[1] ** 2)
    height = first[2] + share * (second[2] - first[2])
    # Direction normal to the axis in the plane of both ends and the point of the axis there.
    ax = first[0] * (second[2] - height) - (first[2] - height) * second[0]
    ay = first[1] * (second[2] - height) - (first[2] - height) * second[1]
    size = math.sqrt(ax * ax + ay * ay)
    if size == 0.0:
        return first[2], second[2]
    mid_x = first[0] + share * (second[0] - first[0])
    mid_y = first[1] + share * (second[1] - first[1])
    size = radius / size
    if (ax * mid_x + ay * mid_y > 0.0) == far:
        size = -size
    ax, ay = size * ax, size * ay
    ux, uy, uz = first[0] - ax, first[1] - ay, first[2] - height
    wx, wy, wz = second[0] - ax, second[1] - ay, second[2] - height
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    if nz == 0.0:
        return first[2], second[2]
    low = first[2] - (nx * (tangents[0] - first[0]) + ny * (tangents[1] - first[1])) / nz
    high = first[2] - (nx * (tangents[2] - first[0]) + ny * (tangents[3] - first[1])) / nz
    gap = abs(second[2] - first[2])
    low = low if abs(low - second[2]) < gap else first[2]
    high = high if abs(high - first[2]) < gap else second[2]
    return low, high


@njit(cache=True, error_model='numpy')
def _tangents(x: float, y: float, radius: float) -> tuple[float, float, float, float]:
    """
    Give the tangent points of a circle about the origin seen from a point outside it.

    The first two numbers are x and y of the point counter-clockwise of it (left of it, seen from
    the centre), then come those of the other.
    """
    square = x * x + y * y
    along = radius * radius / square
    across = radius * math.sqrt(max(0.0, square - radius * radius)) / square
    px, py, qx, qy = along * x, along * y, across * y, across * x
    return px - qx, py + qy, px + qx, py - qy


@njit(cache=True, error_model='numpy')
def _cylinder_sense(
    one: tuple[float, float, float, float],
    two: tuple[float, float, float, float],
    axis: int,
    sign: int,
    heights: tuple[float, float],
) -> int:
    """
    Choose the way round that uses the active half of a cylinder.

    `one` and `two` are the `_tangents` of both ends.  The path runs counter-clockwise from the
    left one of the first end to the right one of the second, or clockwise from right to left.  Of
    a half along the axis only the `heights` of the ends tell whether tangent points are on it.
    """
    k = 1 if axis == 1 else 0
    first_left, first_right = one[k] * sign > 0.0, one[k + 2] * sign > 0.0
    second_left, second_right = two[k] * sign > 0.0, two[k + 2] * sign > 0.0
    if axis == 2:
        first_left = first_right = heights[0] * sign > 0.0
        second_left = second_right = heights[1] * sign > 0.0
    if first_left != first_right:
        return 1 if first_left else -1
    if first_left:
        return -1 if second_left else 1
    if second_left:
        return -1
    if second_right:
        return 1
    # No tangent point is on the active half: the longer way round passes over it.
    left = one[0] * two[2] + one[1] * two[3]
    right = one[2] * two[0] + one[3] * two[1]
    return 1 if left < right else -1


@njit(cache=True, error_model='numpy')
def wrap_cylinder(
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
    Wrap one segment over a cylinder about the z axis.

    Parameters
    ----------
    first, second
        Ends of the segment in the cylinder's frame (3,) [m].
    dimensions
        Radius and length [m].
    axis, sign
        Active half: coordinate 0 (x), 1 (y) or 2 (z) and its sign; sign 0 for the whole surface.
    geodesic
        Whether to take the geodesic or OpenSim's construction.
    tangent_first, tangent_second
        Filled with the tangent points (3,) [m].

    Returns
    -------
    contact : int
        One of `INSIDE`, `MISSED`, `POSSIBLE`, `PIERCED`; the last two with tangent points.
    arc : float
        Length of the path on the surface [m].
    """
    radius = dimensions[0]
    x1, y1, x2, y2 = first[0], first[1], second[0], second[1]
    square_1, square_2 = x1 * x1 + y1 * y1, x2 * x2 + y2 * y2
    if square_1 < radius * radius or square_2 < radius * radius:
        return INSIDE, 0.0
    dx, dy = x2 - x1, y2 - y1
    square = dx * dx + dy * dy
    if square == 0.0:
        return MISSED, 0.0

    # Point of the segment's line closest to the axis.
    share = -(x1 * dx + y1 * dy) / square
    nearest_x, nearest_y = x1 + share * dx, y1 + share * dy
    pierced = 0.0 < share < 1.0 and nearest_x**2 + nearest_y**2 < radius * radius
    if sign == 0 and not pierced:
        return MISSED, 0.0
    contact = PIERCED if pierced else POSSIBLE
    if sign != 0:
        active_1 = first[axis] * sign > 0.0
        active_2 = second[axis] * sign > 0.0
        nearest = first[axis] + share * (second[axis] - first[axis])
        if active_1 or active_2:
            if not pierced and (active_1 == active_2 or nearest * sign > 0.0):
                return MISSED, 0.0
        else:
            contact = POSSIBLE

    one, two = _tangents(x1, y1, radius), _tangents(x2, y2, radius)
    if sign == 0:
        sense = 1 if x1 * y2 - y1 * x2 > 0.0 else -1
    else:
        sense = _cylinder_sense(one, two, axis, sign, (first[2], second[2]))
    left = one[0] * two[2] + one[1] * two[3]
    right = one[2] * two[0] + one[3] * two[1]
    # Whether the way round taken is not the one with the smaller angle.
    far = (sense == 1) == (left < right)
    if sense == 1:
        tangent_first[0], tangent_first[1] = one[0], one[1]
        tangent_second[0], tangent_second[1] = two[2], two[3]
    else:
        tangent_first[0], tangent_first[1] = one[2], one[3]
        tangent_second[0], tangent_second[1] = two[0], two[1]
    across = tangent_first[0] * tangent_second[1] - tangent_first[1] * tangent_second[0]
    turned = math.atan2(sense * across, left if sense == 1 else right)
    around = radius * (turned if turned >= 0.0 else turned + 2.0 * math.pi)
    if geodesic:
        # Straight in the unrolled surface: height grows evenly with the way seen along the axis.
        free_1 = math.sqrt(square_1 - radius * radius)
        free_2 = math.sqrt(square_2 - radius * radius)
        slope = (second[2] - first[2]) / (free_1 + around + free_2)
        tangent_first[2] = first[2] + slope * free_1
        tangent_second[2] = second[2] - slope * free_2
    else:
        xy = (tangent_first[0], tangent_first[1], tangent_second[0], tangent_second[1])
        heights = _apex_heights(first, second, radius, far, xy)
        tangent_first[2], tangent_second[2] = heights
    half = 0.5 * dimensions[1]
    if abs(tangent_first[2]) > half and abs(tangent_second[2]) > half:
        return MISSED, 0.0
    return contact, math.sqrt(around**2 + (tangent_second[2] - tangent_first[2]) ** 2)
