# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Closest points of an ellipsoid, and the mean direction from a chord to its surface, compiled.

A point x is closest to a point p where x_i = a_i^2 p_i / (t + a_i^2) with the largest root t of
S(t) = sum (x_i / a_i)^2 = 1 (Eberly, Distance from a point to an ellipse, an ellipsoid, or a
hyperellipsoid).  The unknown here is z = t + min a_i^2, which keeps its digits near the pole of
the smallest half axis.  The root is that of 1 / sqrt(S) - 1, nearly straight in z, and is found by
Chebyshev's method of third order, its curvature term bounded.
"""

import math

import numpy as np

from human_model.compiled_cache import njit
from muscle_analyzer.core.muscles.cylinder_wrapping import Vector

#: Largest error of sqrt(S) from which one more step, of third order, gives all digits.
LAST_STEP = 1e-5
#: Bounds of the factor by which curvature changes a step, most steps, and smallest z (where a pole
#: is, if the coordinate of the point is zero).
LEAST_FACTOR, MOST_FACTOR, MOST_STEPS, LEAST_Z = 0.5, 3.0, 64, 1e-200
#: OpenSim averages directions at samples i / 300 of the chord, i from 1 to 298.
SAMPLE_SPACING, SAMPLES = 1.0 / 300.0, 298
#: Nodes and weights of the mean direction (Gauss-Legendre on [0, 1]) on both sides of a jump, one
#: after the other, and steps to the closest points of all of them at once.
_RAW_NODES, _RAW_WEIGHTS = np.polynomial.legendre.leggauss(8)
_NODES = np.tile(0.5 * (_RAW_NODES + 1.0), 2)
_WEIGHTS = np.tile(0.5 * _RAW_WEIGHTS, 2)
_STEPS = 5
#: What the compiler may do to sums, so that it computes all nodes at once.
_REORDERED = {'reassoc', 'contract', 'arcp', 'nsz'}


@njit(error_model='numpy')
def closest_on_ellipsoid(axes: Vector, point: Vector, held: int) -> Vector:
    """Find the point of an ellipsoid closest to a point.

    Parameters
    ----------
    axes, point
        Half axes and point [m].
    held
        Coordinate kept as it is (the problem is then that of an ellipse in the plane of the
        other two), or -1.

    Returns
    -------
    Vector
        The closest point [m]; one of two, if the point is equally far from both.
    """
    x, y, z = point
    sx, sy, sz = axes[0] * axes[0], axes[1] * axes[1], axes[2] * axes[2]
    # A held coordinate takes no part: an infinite half axis.
    ax = math.inf if held == 0 else sx
    ay = math.inf if held == 1 else sy
    az = math.inf if held == 2 else sz
    ux = 0.0 if held == 0 else axes[0] * x
    uy = 0.0 if held == 1 else axes[1] * y
    uz = 0.0 if held == 2 else axes[2] * z
    least = min(ax, ay, az)
    ex, ey, ez = ax - least, ay - least, az - least
    start = max(LEAST_Z, abs(ux) - ex, abs(uy) - ey, abs(uz) - ez)
    # First guess: S as a straight line in t at the surface.
    rx, ry, rz = ux / ax, uy / ay, uz / az
    rx, ry, rz = rx * rx, ry * ry, rz * rz
    root = start
    inverse = rx / ax + ry / ay + rz / az
    if inverse > 0.0:
        root = max(start, least - 0.5 * (1.0 - rx - ry - rz) / inverse)
    total = 0.0
    for _ in range(MOST_STEPS):
        ox, oy, oz = 1.0 / (root + ex), 1.0 / (root + ey), 1.0 / (root + ez)
        rx, ry, rz = ux * ox, uy * oy, uz * oz
        rx, ry, rz = rx * rx, ry * ry, rz * rz
        total = rx + ry + rz
        rx, ry, rz = rx * ox, ry * oy, rz * oz
        slope = rx + ry + rz
        off = math.sqrt(total) - 1.0
        if slope == 0.0 or (root == start and off < 0.0):
            break
        step = total / slope
        curved = 1.0 + 1.5 * off * ((rx * ox + ry * oy + rz * oz) * step / slope - 1.0)
        root = max(start, root + off * step * min(MOST_FACTOR, max(LEAST_FACTOR, curved)))
        if abs(off) < LAST_STEP:
            break
    px, py, pz = ax * x / (root + ex), ay * y / (root + ey), az * z / (root + ez)
    if root == LEAST_Z:
        # In the plane between the two closest points, which the sum leaves open: to the positive.
        rest = 1.0 - total
        if ex == 0.0:
            px = axes[0] * math.sqrt(rest)
        elif ey == 0.0:
            py = axes[1] * math.sqrt(rest)
        else:
            pz = axes[2] * math.sqrt(rest)
    return (x if held == 0 else px), (y if held == 1 else py), (z if held == 2 else pz)


@njit(error_model='numpy', fastmath=_REORDERED)
def _sum_of_normals(
    axes: Vector, enter: Vector, step: Vector, begin: float, middle: float, end: float
) -> tuple[float, float, float, float]:
    """Sum the normals at the points closest to the nodes on a chord, all at once.

    The nodes lie in the parts of the chord from `begin` to `middle` and from there to `end`
    (shares of it).  Each point is found as in `closest_on_ellipsoid`, in so many steps that they
    nearly always suffice.  Returns the sum, weighted with the lengths of the parts, and the sum of
    the squared errors of sqrt(S) before the last step.
    """
    sx, sy, sz = axes[0] * axes[0], axes[1] * axes[1], axes[2] * axes[2]
    least = min(sx, sy, sz)
    ex, ey, ez = sx - least, sy - least, sz - least
    wx, wy, wz = 1.0 / sx, 1.0 / sy, 1.0 / sz
    sum_x, sum_y, sum_z, error = 0.0, 0.0, 0.0, 0.0
    for k in range(_NODES.size):
        first = 2 * k < _NODES.size
        width = middle - begin if first else end - middle
        share = (begin if first else middle) + width * _NODES[k]
        x, y = enter[0] + share * step[0], enter[1] + share * step[1]
        z = enter[2] + share * step[2]
        ux, uy, uz = axes[0] * x, axes[1] * y, axes[2] * z
        start = max(LEAST_Z, abs(ux) - ex, abs(uy) - ey, abs(uz) - ez)
        rx, ry, rz = x * x * wx, y * y * wy, z * z * wz
        root = least - 0.5 * (1.0 - rx - ry - rz) / (rx * wx + ry * wy + rz * wz)
        root = max(start, root)
        off = 0.0
        for _ in range(_STEPS):
            # As in `closest_on_ellipsoid`, times powers of the product of the poles' distances:
            # one division.
            ox, oy, oz = root + ex, root + ey, root + ez
            qx, qy, qz = oy * oz, oz * ox, ox * oy
            product = ox * qx
            rx, ry, rz = ux * qx, uy * qy, uz * qz
            rx, ry, rz = rx * rx, ry * ry, rz * rz
            total = rx + ry + rz
            rx, ry, rz = rx * qx, ry * qy, rz * qz
            slope = rx + ry + rz
            inverse = 1.0 / (product * slope)
            off = math.sqrt(total) * slope * inverse - 1.0
            inverse *= product
            way = total * inverse
            curved = 1.0 + 1.5 * off * ((rx * qx + ry * qy + rz * qz) * way * inverse - 1.0)
            way *= off * product * min(MOST_FACTOR, max(LEAST_FACTOR, curved))
            root = max(start, root + way)
        ox, oy, oz = root + ex, root + ey, root + ez
        rx, ry, rz = x * oy * oz, y * oz * ox, z * ox * oy
        weight = width * _WEIGHTS[k] / math.sqrt(rx * rx + ry * ry + rz * rz)
        sum_x += weight * rx
        sum_y += weight * ry
        sum_z += weight * rz
        error += off * off
    return sum_x, sum_y, sum_z, error


@njit(error_model='numpy')
def _exact_sum_of_normals(
    axes: Vector, enter: Vector, step: Vector, begin: float, middle: float, end: float
) -> Vector:
    """Sum as `_sum_of_normals`, each point found to the last digit."""
    sum_x, sum_y, sum_z = 0.0, 0.0, 0.0
    for k in range(_NODES.size):
        first = 2 * k < _NODES.size
        width = middle - begin if first else end - middle
        share = (begin if first else middle) + width * _NODES[k]
        sample = enter[0] + share * step[0], enter[1] + share * step[1], enter[2] + share * step[2]
        surface = closest_on_ellipsoid(axes, sample, -1)
        nx, ny = surface[0] / axes[0] ** 2, surface[1] / axes[1] ** 2
        nz = surface[2] / axes[2] ** 2
        weight = width * _WEIGHTS[k] / math.sqrt(nx * nx + ny * ny + nz * nz)
        sum_x, sum_y, sum_z = sum_x + weight * nx, sum_y + weight * ny, sum_z + weight * nz
    return sum_x, sum_y, sum_z


@njit(error_model='numpy')
def mean_direction(axes: Vector, enter: Vector, leave: Vector) -> Vector:
    """Average the unit vectors from a chord to the closest surface, and make a unit vector of it.

    Where the chord crosses the plane normal to the smallest half axis the closest point may jump.
    The parts before and after have the weight and the extent of OpenSim's samples on them; a
    sample stands for the chord half the way to its neighbours.

    Parameters
    ----------
    axes
        Half axes [m].
    enter, leave
        Ends of the chord on the surface [m].
    """
    step = leave[0] - enter[0], leave[1] - enter[1], leave[2] - enter[2]
    a, b = enter[0], leave[0]
    if axes[1] < axes[0] and axes[1] <= axes[2]:
        a, b = enter[1], leave[1]
    elif axes[2] < axes[0] and axes[2] < axes[1]:
        a, b = enter[2], leave[2]
    before = SAMPLES // 2
    if a * b < 0.0:
        before = min(SAMPLES, int(a / ((a - b) * SAMPLE_SPACING)))
    begin, middle = 0.5 * SAMPLE_SPACING, (before + 0.5) * SAMPLE_SPACING
    end = (SAMPLES + 0.5) * SAMPLE_SPACING
    x, y, z, error = _sum_of_normals(axes, enter, step, begin, middle, end)
    if not error < LAST_STEP * LAST_STEP:
        x, y, z = _exact_sum_of_normals(axes, enter, step, begin, middle, end)
    size = math.sqrt(x * x + y * y + z * z)
    if size > 0.0:
        return x / size, y / size, z / size
    return x, y, z
