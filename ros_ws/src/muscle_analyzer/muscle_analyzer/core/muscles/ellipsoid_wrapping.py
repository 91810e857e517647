# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Path of a muscle over an ellipsoid, compiled.

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

from human_model.compiled_cache import njit
from muscle_analyzer.core.muscles.cylinder_wrapping import (
    INSIDE,
    MISSED,
    NOWHERE,
    PIERCED,
    Vector,
    component,
)
from muscle_analyzer.core.muscles.ellipsoid_surface import closest_on_ellipsoid, mean_direction

#: Cosine between segment and axis below which only the mean direction counts, and above which only
#: the crossing of the coordinate plane does; share of the pierced length near either end in which
#: the crossing loses its weight (constants of OpenSim's hybrid method).
PARALLEL_NONE, PARALLEL_FULL, END_SHARE = 0.7073, 0.9, 0.3
#: Methods of choosing the guide.
HYBRID, MIDPOINT = 0, 1
#: Nodes and weights of the arc length on one half of it, from the outside inwards: share of the
#: whole and weight (Gauss-Legendre of 12 nodes, the other half mirrored).
_RAW_NODES, _RAW_WEIGHTS = np.polynomial.legendre.leggauss(12)
_NODES, _WEIGHTS = -_RAW_NODES[:6], 0.5 * _RAW_WEIGHTS[:6]


@njit(error_model='numpy')
def _guide(
    axes: Vector, enter: Vector, leave: Vector, axis: int, sign: int, method: int
) -> Vector:
    """Return the surface point that fixes the plane of the path."""
    dx, dy, dz = leave[0] - enter[0], leave[1] - enter[1], leave[2] - enter[2]
    best, longest, begin = 0, dx, enter[0]
    if abs(dy) > abs(longest):
        best, longest, begin = 1, dy, enter[1]
    if abs(dz) > abs(longest):
        best, longest, begin = 2, dz, enter[2]
    parallel = abs(longest) / math.sqrt(dx * dx + dy * dy + dz * dz)
    crossing = -begin / longest
    if method == HYBRID and parallel > PARALLEL_NONE:
        weight = min(1.0, max(0.0, min(crossing, 1.0 - crossing) / END_SHARE))
        parallel = PARALLEL_NONE + weight * (parallel - PARALLEL_NONE)
    fan = (PARALLEL_FULL - parallel) / (PARALLEL_FULL - PARALLEL_NONE)
    fan = min(1.0, max(0.0, fan))

    middle = 0.5 * (enter[0] + leave[0]), 0.5 * (enter[1] + leave[1]), 0.5 * (enter[2] + leave[2])
    guide = middle
    if method == MIDPOINT:
        guide = closest_on_ellipsoid(axes, middle, -1)
    elif fan < 1.0:
        point = enter[0] + crossing * dx, enter[1] + crossing * dy, enter[2] + crossing * dz
        guide = closest_on_ellipsoid(axes, point, best)
    if method == HYBRID and fan > 0.0:
        mean = mean_direction(axes, enter, leave)
        # A point one mean half axis away, as OpenSim scales lengths.
        reach = (axes[0] + axes[1] + axes[2]) / 3.0
        point = (
            middle[0] + reach * mean[0],
            middle[1] + reach * mean[1],
            middle[2] + reach * mean[2],
        )
        by_fan = closest_on_ellipsoid(axes, point, -1)
        if fan < 1.0:
            rest = 1.0 - fan
            by_fan = (
                rest * guide[0] + fan * by_fan[0],
                rest * guide[1] + fan * by_fan[1],
                rest * guide[2] + fan * by_fan[2],
            )
            by_fan = closest_on_ellipsoid(axes, by_fan, -1)
        guide = by_fan
    if sign != 0 and component(guide, axis) * sign < 0.0:
        # Mirrored, and drawn towards the plane of the mirror by as much as the fan counts.
        back = fan - 1.0
        point = (
            guide[0] * (back if axis == 0 else 1.0),
            guide[1] * (back if axis == 1 else 1.0),
            guide[2] * (back if axis == 2 else 1.0),
        )
        guide = closest_on_ellipsoid(axes, point, axis if fan == 1.0 else -1)
    return guide


@njit(error_model='numpy')
def _arc(
    axes: Vector,
    p: Vector,
    q: Vector,
    first: tuple[float, float],
    second: tuple[float, float],
    turned: float,
) -> float:
    """Measure the image of an arc of the unit circle on the axes p and q.

    `first` and `second` are cosine and sine of the angles of its ends; `turned` is the angle
    between them.  At an angle the speed is the root of a mean plus parts with twice the angle.
    """
    px, py, pz = axes[0] * p[0], axes[1] * p[1], axes[2] * p[2]
    qx, qy, qz = axes[0] * q[0], axes[1] * q[1], axes[2] * q[2]
    pp, qq = px * px + py * py + pz * pz, qx * qx + qy * qy + qz * qz
    pq = px * qx + py * qy + pz * qz
    mean, by_cosine = 0.5 * (qq + pp), 0.5 * (qq - pp)
    # Of twice the angle in the middle, which is the sum of those of the ends.
    c = first[0] * second[0] - first[1] * second[1]
    s = first[1] * second[0] + first[0] * second[1]
    even, odd = by_cosine * c - pq * s, by_cosine * s + pq * c
    arc = 0.0
    for k in range(_NODES.size):
        angle = turned * _NODES[k]
        level, change = mean + even * math.cos(angle), odd * math.sin(angle)
        # Rounding can make the speed at the end of a long axis negative.
        arc += _WEIGHTS[k] * (
            math.sqrt(max(0.0, level - change)) + math.sqrt(max(0.0, level + change))
        )
    return turned * arc


@njit(error_model='numpy')
def wrap_ellipsoid(
    first: Vector, second: Vector, axes: Vector, axis: int, sign: int, method: int
) -> tuple[int, float, Vector, Vector]:
    """Wrap one segment over an ellipsoid; arguments and results as `wrap_cylinder`.

    `axes` are the half axes along x, y and z [m], `method` is `HYBRID` or `MIDPOINT`.
    """
    # In units of the half axes the ellipsoid is the unit sphere.
    ax, ay, az = first[0] / axes[0], first[1] / axes[1], first[2] / axes[2]
    bx, by, bz = second[0] / axes[0], second[1] / axes[1], second[2] / axes[2]
    square_a, square_b = ax * ax + ay * ay + az * az, bx * bx + by * by + bz * bz
    if square_a < 1.0 or square_b < 1.0:
        return INSIDE, 0.0, NOWHERE, NOWHERE
    dx, dy, dz = bx - ax, by - ay, bz - az
    square_d, middle = dx * dx + dy * dy + dz * dz, ax * dx + ay * dy + az * dz
    under_root = middle * middle - square_d * (square_a - 1.0)
    if square_d == 0.0 or under_root <= 0.0:
        return MISSED, 0.0, NOWHERE, NOWHERE
    root = math.sqrt(under_root)
    enter, leave = (-middle - root) / square_d, (-middle + root) / square_d
    if not (0.0 < enter < 1.0 and 0.0 < leave < 1.0):
        return MISSED, 0.0, NOWHERE, NOWHERE

    guide = _guide(
        axes,
        (axes[0] * (ax + enter * dx), axes[1] * (ay + enter * dy), axes[2] * (az + enter * dz)),
        (axes[0] * (ax + leave * dx), axes[1] * (ay + leave * dy), axes[2] * (az + leave * dz)),
        axis,
        sign,
        method,
    )
    gx, gy, gz = guide[0] / axes[0] - ax, guide[1] / axes[1] - ay, guide[2] / axes[2] - az
    nx, ny, nz = dy * gz - dz * gy, dz * gx - dx * gz, dx * gy - dy * gx
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    if size < 1e-12:
        # The segment runs through the guide itself: no side to wrap to.
        return MISSED, 0.0, NOWHERE, NOWHERE
    nx, ny, nz = nx / size, ny / size, nz / size
    height = nx * ax + ny * ay + nz * az
    radius = math.sqrt(max(0.0, 1.0 - height * height))
    # Axes of the section's plane, the first towards the first end.
    from_centre_1 = math.sqrt(square_a - height * height)
    px = (ax - height * nx) / from_centre_1
    py = (ay - height * ny) / from_centre_1
    pz = (az - height * nz) / from_centre_1
    qx, qy, qz = ny * pz - nz * py, nz * px - nx * pz, nx * py - ny * px
    x2, y2 = bx * px + by * py + bz * pz, bx * qx + by * qy + bz * qz
    from_centre_2 = math.sqrt(x2 * x2 + y2 * y2)

    # The normal is chosen so that the guide is left of the segment: clockwise round the centre.
    c1, c2 = min(1.0, radius / from_centre_1), min(1.0, radius / from_centre_2)
    s1, s2 = -math.sqrt(1.0 - c1 * c1), math.sqrt(1.0 - c2 * c2)
    x2, y2 = x2 / from_centre_2, y2 / from_centre_2
    c2, s2 = x2 * c2 - y2 * s2, y2 * c2 + x2 * s2
    turned = math.atan2(s1 * c2 - c1 * s2, c1 * c2 + s1 * s2)
    if turned < 0.0:
        turned += 2.0 * math.pi
    arc = radius * _arc(axes, (px, py, pz), (qx, qy, qz), (c1, s1), (c2, s2), turned)
    nx, ny, nz = height * nx, height * ny, height * nz
    c1, s1, c2, s2 = radius * c1, radius * s1, radius * c2, radius * s2
    tangent_first = (
        axes[0] * (nx + c1 * px + s1 * qx),
        axes[1] * (ny + c1 * py + s1 * qy),
        axes[2] * (nz + c1 * pz + s1 * qz),
    )
    tangent_second = (
        axes[0] * (nx + c2 * px + s2 * qx),
        axes[1] * (ny + c2 * py + s2 * qy),
        axes[2] * (nz + c2 * pz + s2 * qz),
    )
    return PIERCED, arc, tangent_first, tangent_second
