# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Path of a muscle over a cylinder, compiled.

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

from human_model.compiled_cache import njit

#: A point or a direction. Tuples, not arrays: compiled code keeps them in registers, and counts no
#: references to them.
Vector = tuple[float, float, float]

#: What a surface does to one segment of a path: an end point lies inside; it is not met; it may
#: be wrapped if no other segment is shorter; the segment pierces it and must wrap.
INSIDE, MISSED, POSSIBLE, PIERCED = -1, 0, 1, 2
#: What stands for the tangent points where there are none.
NOWHERE = (0.0, 0.0, 0.0)


@njit(error_model='numpy')
def component(vector: Vector, axis: int) -> float:
    """Return one of the three components of a vector."""
    return vector[0] if axis == 0 else (vector[1] if axis == 1 else vector[2])


@njit(error_model='numpy')
def _apex_heights(
    first: Vector,
    second: Vector,
    radius: float,
    far: bool,
    tangents: tuple[float, float, float, float],
) -> tuple[float, float]:
    """Return the heights of the tangent points in the plane of both ends and the apex.

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


@njit(error_model='numpy')
def _tangents(x: float, y: float, radius: float) -> tuple[float, float, float, float]:
    """Return the tangent points of a circle about the origin seen from a point outside it.

    The first two numbers are x and y of the point counter-clockwise of it (left of it, seen from
    the centre), then come those of the other.
    """
    square = x * x + y * y
    along = radius * radius / square
    across = radius * math.sqrt(max(0.0, square - radius * radius)) / square
    px, py, qx, qy = along * x, along * y, across * y, across * x
    return px - qx, py + qy, px + qx, py - qy


@njit(error_model='numpy')
def _cylinder_sense(
    one: tuple[float, float, float, float],
    two: tuple[float, float, float, float],
    axis: int,
    sign: int,
    heights: tuple[float, float],
) -> int:
    """Choose the way round that uses the active half of a cylinder.

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


@njit(error_model='numpy')
def wrap_cylinder(
    first: Vector, second: Vector, dimensions: Vector, axis: int, sign: int, geodesic: bool
) -> tuple[int, float, Vector, Vector]:
    """Wrap one segment over a cylinder about the z axis.

    Parameters
    ----------
    first, second
        Ends of the segment in the cylinder's frame [m].
    dimensions
        Radius and length [m].
    axis, sign
        Active half: coordinate 0 (x), 1 (y) or 2 (z) and its sign; sign 0 for the whole surface.
    geodesic
        Whether to take the geodesic or OpenSim's construction.

    Returns
    -------
    contact : int
        One of `INSIDE`, `MISSED`, `POSSIBLE`, `PIERCED`; the last two with tangent points.
    arc : float
        Length of the path on the surface [m].
    tangent_first, tangent_second : Vector
        Where the path meets the surface and where it leaves it [m].
    """
    radius = dimensions[0]
    x1, y1, z1 = first
    x2, y2, z2 = second
    square_1, square_2 = x1 * x1 + y1 * y1, x2 * x2 + y2 * y2
    if square_1 < radius * radius or square_2 < radius * radius:
        return INSIDE, 0.0, NOWHERE, NOWHERE
    dx, dy = x2 - x1, y2 - y1
    square = dx * dx + dy * dy
    if square == 0.0:
        return MISSED, 0.0, NOWHERE, NOWHERE

    # Point of the segment's line closest to the axis.
    share = -(x1 * dx + y1 * dy) / square
    nearest_x, nearest_y = x1 + share * dx, y1 + share * dy
    pierced = 0.0 < share < 1.0 and nearest_x**2 + nearest_y**2 < radius * radius
    if sign == 0 and not pierced:
        return MISSED, 0.0, NOWHERE, NOWHERE
    contact = PIERCED if pierced else POSSIBLE
    if sign != 0:
        from_1, from_2 = component(first, axis), component(second, axis)
        active_1, active_2 = from_1 * sign > 0.0, from_2 * sign > 0.0
        nearest = from_1 + share * (from_2 - from_1)
        if active_1 or active_2:
            if not pierced and (active_1 == active_2 or nearest * sign > 0.0):
                return MISSED, 0.0, NOWHERE, NOWHERE
        else:
            contact = POSSIBLE

    one, two = _tangents(x1, y1, radius), _tangents(x2, y2, radius)
    if sign == 0:
        sense = 1 if x1 * y2 - y1 * x2 > 0.0 else -1
    else:
        sense = _cylinder_sense(one, two, axis, sign, (z1, z2))
    left = one[0] * two[2] + one[1] * two[3]
    right = one[2] * two[0] + one[3] * two[1]
    # Whether the way round taken is not the one with the smaller angle.
    far = (sense == 1) == (left < right)
    if sense == 1:
        tx1, ty1, tx2, ty2 = one[0], one[1], two[2], two[3]
    else:
        tx1, ty1, tx2, ty2 = one[2], one[3], two[0], two[1]
    turned = math.atan2(sense * (tx1 * ty2 - ty1 * tx2), left if sense == 1 else right)
    around = radius * (turned if turned >= 0.0 else turned + 2.0 * math.pi)
    if geodesic:
        # Straight in the unrolled surface: height grows evenly with the way seen along the axis.
        free_1 = math.sqrt(square_1 - radius * radius)
        free_2 = math.sqrt(square_2 - radius * radius)
        slope = (z2 - z1) / (free_1 + around + free_2)
        tz1, tz2 = z1 + slope * free_1, z2 - slope * free_2
    else:
        tz1, tz2 = _apex_heights(first, second, radius, far, (tx1, ty1, tx2, ty2))
    half = 0.5 * dimensions[1]
    if abs(tz1) > half and abs(tz2) > half:
        return MISSED, 0.0, NOWHERE, NOWHERE
    arc = math.sqrt(around**2 + (tz2 - tz1) ** 2)
    return contact, arc, (tx1, ty1, tz1), (tx2, ty2, tz2)
