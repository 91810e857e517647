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
    share = math.hypot(first[0], first[1])
    share /= share + math.hypot(second[0], second[1])
    height = first[2] + share * (second[2] - first[2])
    # Direction normal to the axis in the plane of both ends and the point of the axis there.
    ax = first[0] * (second[2] - height) - (first[2] - height) * second[0]
    ay = first[1] * (second[2] - height) - (first[2] - height) * second[1]
    size = math.hypot(ax, ay)
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
def _cylinder_sense(
    angles: tuple[float, float, float, float],
    radius: float,
    axis: int,
    sign: int,
    heights: tuple[float, float],
) -> int:
    """
    Choose the way round that uses the active half of a cylinder.

    `angles` are those of the tangent points: of the first end counter-clockwise and clockwise of
    it, then of the second end.  The path runs counter-clockwise from the first to the fourth, or
    clockwise from the second to the third.  Of a half along the axis only the `heights` of the
    ends tell whether tangent points are on it.
    """
    turn = 0.5 * math.pi if axis == 1 else 0.0
    first_left = radius * math.cos(angles[0] - turn) * sign > 0.0
    first_right = radius * math.cos(angles[1] - turn) * sign > 0.0
    second_left = radius * math.cos(angles[2] - turn) * sign > 0.0
    second_right = radius * math.cos(angles[3] - turn) * sign > 0.0
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
    left = math.cos(angles[3] - angles[0])
    right = math.cos(angles[2] - angles[1])
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
    from_axis_1, from_axis_2 = math.hypot(x1, y1), math.hypot(x2, y2)
    if from_axis_1 < radius or from_axis_2 < radius:
        return INSIDE, 0.0
    dx, dy = x2 - x1, y2 - y1
    square = dx * dx + dy * dy
    if square == 0.0:
        return MISSED, 0.0

    # Point of the segment's line closest to the axis.
    share = -(x1 * dx + y1 * dy) / square
    pierced = 0.0 < share < 1.0 and math.hypot(x1 + share * dx, y1 + share * dy) < radius
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

    angle_1, angle_2 = math.atan2(y1, x1), math.atan2(y2, x2)
    to_tangent_1 = math.acos(min(1.0, radius / from_axis_1))
    to_tangent_2 = math.acos(min(1.0, radius / from_axis_2))
    if sign == 0:
        sense = 1 if x1 * y2 - y1 * x2 > 0.0 else -1
    else:
        sense = _cylinder_sense(
            (
                angle_1 + to_tangent_1,
                angle_1 - to_tangent_1,
                angle_2 + to_tangent_2,
                angle_2 - to_tangent_2,
            ),
            radius,
            axis,
            sign,
            (first[2], second[2]),
        )
    difference = angle_2 - angle_1
    between = to_tangent_1 + to_tangent_2
    # Whether the way round taken is not the one with the smaller angle.
    far = (sense == 1) == (math.cos(difference - between) < math.cos(difference + between))
    angle_1 += sense * to_tangent_1
    angle_2 -= sense * to_tangent_2
    turned = (sense * (angle_2 - angle_1)) % (2.0 * math.pi)

    around = radius * turned
    tangent_first[0], tangent_first[1] = radius * math.cos(angle_1), radius * math.sin(angle_1)
    tangent_second[0], tangent_second[1] = radius * math.cos(angle_2), radius * math.sin(angle_2)
    if geodesic:
        # Straight in the unrolled surface: height grows evenly with the way seen along the axis.
        free_1 = math.sqrt(from_axis_1 * from_axis_1 - radius * radius)
        free_2 = math.sqrt(from_axis_2 * from_axis_2 - radius * radius)
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
    return contact, math.hypot(around, tangent_second[2] - tangent_first[2])
