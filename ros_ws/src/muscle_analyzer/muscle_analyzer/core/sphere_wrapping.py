# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""
Path of a muscle over a sphere, compiled.

The path lies in the plane of both ends and the centre and is an arc of a great circle between the
points where lines from the ends touch the sphere.  As in OpenSim's ``WrapSphere`` a segment wraps
only when it pierces the sphere, whatever the active half; with a half, and neither end on it, the
path goes round the far side unless its tangents then lead away from the active half.

OpenSim gives a path that goes more than half round a negative arc length; here it is positive.
A segment that passes through the centre, where OpenSim repeats the wrap it computed last, does
not wrap.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from muscle_analyzer.core.wrapping import INSIDE, MISSED, PIERCED, POSSIBLE

Array = NDArray[np.float64]

#: Sine of the angle between the segment and the way to the centre below which the plane of the
#: path is not defined (constant of OpenSim's method).
CENTRAL = 1e-5


@njit(cache=True, error_model='numpy')
def wrap_sphere(
    first: Array,
    second: Array,
    dimensions: Array,
    axis: int,
    sign: int,
    tangent_first: Array,
    tangent_second: Array,
) -> tuple[int, float]:
    """
    Wrap one segment over a sphere; arguments and results as `wrap_cylinder`.

    `dimensions` begins with the radius [m].
    """
    radius = dimensions[0]
    square_1 = first[0] ** 2 + first[1] ** 2 + first[2] ** 2
    square_2 = second[0] ** 2 + second[1] ** 2 + second[2] ** 2
    if min(square_1, square_2) < radius * radius:
        return INSIDE, 0.0
    square, along = 0.0, 0.0
    for i in range(3):
        step = second[i] - first[i]
        square += step * step
        along += first[i] * step
    under_root = along * along - square * (square_1 - radius * radius)
    if square == 0.0 or under_root < 0.0:
        return MISSED, 0.0
    root = math.sqrt(under_root)
    if -along - root <= 0.0 or -along + root >= square:
        return MISSED, 0.0

    from_centre_1, from_centre_2 = math.sqrt(square_1), math.sqrt(square_2)
    nx = first[1] * second[2] - first[2] * second[1]
    ny = first[2] * second[0] - first[0] * second[2]
    nz = first[0] * second[1] - first[1] * second[0]
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    if size < CENTRAL * math.sqrt(square) * from_centre_2:
        return MISSED, 0.0
    nx, ny, nz = nx / size, ny / size, nz / size
    # Unit vectors to the ends, and a quarter turn on in the sense from the first to the second.
    p, q, u, v = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for i in range(3):
        p[i], u[i] = first[i] / from_centre_1, second[i] / from_centre_2
    q[0], q[1], q[2] = ny * p[2] - nz * p[1], nz * p[0] - nx * p[2], nx * p[1] - ny * p[0]
    v[0], v[1], v[2] = ny * u[2] - nz * u[1], nz * u[0] - nx * u[2], nx * u[1] - ny * u[0]
    between = math.acos(max(-1.0, min(1.0, p[0] * u[0] + p[1] * u[1] + p[2] * u[2])))
    to_tangent_1 = math.acos(min(1.0, radius / from_centre_1))
    to_tangent_2 = math.acos(min(1.0, radius / from_centre_2))

    contact, sense = POSSIBLE, 1.0
    if sign != 0:
        active_1, active_2 = first[axis] * sign > 0.0, second[axis] * sign > 0.0
        if active_1 or active_2:
            contact = PIERCED
        if not (active_1 and active_2):
            # The free parts of the path round the far side, both taken from end to tangent.
            lead = radius * (math.cos(to_tangent_1) * p[axis] - math.sin(to_tangent_1) * q[axis])
            lead += radius * (math.cos(to_tangent_2) * u[axis] + math.sin(to_tangent_2) * v[axis])
            if (lead - first[axis] - second[axis]) * sign >= 0.0:
                sense = -1.0
    for i in range(3):
        tangent_first[i] = radius * (
            math.cos(to_tangent_1) * p[i] + sense * math.sin(to_tangent_1) * q[i]
        )
        tangent_second[i] = radius * (
            math.cos(to_tangent_2) * u[i] - sense * math.sin(to_tangent_2) * v[i]
        )
    if sense < 0.0:
        between = 2.0 * math.pi - between
    return contact, radius * max(0.0, between - to_tangent_1 - to_tangent_2)
