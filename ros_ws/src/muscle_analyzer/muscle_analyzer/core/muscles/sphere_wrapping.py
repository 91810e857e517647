# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Path of a muscle over a sphere, compiled.

The path lies in the plane of both ends and the centre and is an arc of a great circle between the
points where lines from the ends touch the sphere.  As in OpenSim's ``WrapSphere`` a segment wraps
only when it pierces the sphere, whatever the active half; with a half, and neither end on it, the
path goes round the far side unless its tangents then lead away from the active half.

OpenSim gives a path that goes more than half round a negative arc length; here it is positive.
A segment that passes through the centre, where OpenSim repeats the wrap it computed last, does
not wrap.
"""

import math

from human_model.compiled_cache import njit
from muscle_analyzer.core.muscles.cylinder_wrapping import (
    INSIDE,
    MISSED,
    NOWHERE,
    PIERCED,
    POSSIBLE,
    Vector,
    component,
)

#: Sine of the angle between the segment and the way to the centre below which the plane of the
#: path is not defined (constant of OpenSim's method).
CENTRAL = 1e-5


@njit(error_model='numpy')
def wrap_sphere(
    first: Vector, second: Vector, dimensions: Vector, axis: int, sign: int
) -> tuple[int, float, Vector, Vector]:
    """Wrap one segment over a sphere; arguments and results as `wrap_cylinder`.

    `dimensions` begins with the radius [m].
    """
    radius = dimensions[0]
    x1, y1, z1 = first
    x2, y2, z2 = second
    square_1, square_2 = x1 * x1 + y1 * y1 + z1 * z1, x2 * x2 + y2 * y2 + z2 * z2
    if min(square_1, square_2) < radius * radius:
        return INSIDE, 0.0, NOWHERE, NOWHERE
    dx, dy, dz = x2 - x1, y2 - y1, z2 - z1
    square = dx * dx + dy * dy + dz * dz
    along = x1 * dx + y1 * dy + z1 * dz
    under_root = along * along - square * (square_1 - radius * radius)
    if square == 0.0 or under_root < 0.0:
        return MISSED, 0.0, NOWHERE, NOWHERE
    root = math.sqrt(under_root)
    if -along - root <= 0.0 or -along + root >= square:
        return MISSED, 0.0, NOWHERE, NOWHERE

    from_centre_1, from_centre_2 = math.sqrt(square_1), math.sqrt(square_2)
    nx, ny, nz = y1 * z2 - z1 * y2, z1 * x2 - x1 * z2, x1 * y2 - y1 * x2
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    if size < CENTRAL * math.sqrt(square) * from_centre_2:
        return MISSED, 0.0, NOWHERE, NOWHERE
    nx, ny, nz = nx / size, ny / size, nz / size
    # Unit vectors to the ends, and a quarter turn on in the sense from the first to the second.
    px, py, pz = x1 / from_centre_1, y1 / from_centre_1, z1 / from_centre_1
    ux, uy, uz = x2 / from_centre_2, y2 / from_centre_2, z2 / from_centre_2
    qx, qy, qz = ny * pz - nz * py, nz * px - nx * pz, nx * py - ny * px
    vx, vy, vz = ny * uz - nz * uy, nz * ux - nx * uz, nx * uy - ny * ux
    between = math.acos(max(-1.0, min(1.0, px * ux + py * uy + pz * uz)))
    # Cosines and sines, times the radius, of the angles between ends and tangents.
    cosine_1, cosine_2 = min(1.0, radius / from_centre_1), min(1.0, radius / from_centre_2)
    c1, s1 = radius * cosine_1, radius * math.sqrt(1.0 - cosine_1 * cosine_1)
    c2, s2 = radius * cosine_2, radius * math.sqrt(1.0 - cosine_2 * cosine_2)

    contact = POSSIBLE
    if sign != 0:
        from_1, from_2 = component(first, axis), component(second, axis)
        active_1, active_2 = from_1 * sign > 0.0, from_2 * sign > 0.0
        if active_1 or active_2:
            contact = PIERCED
        if not (active_1 and active_2):
            # The free parts of the path round the far side, both taken from end to tangent.
            lead = c1 * component((px, py, pz), axis) - s1 * component((qx, qy, qz), axis)
            lead += c2 * component((ux, uy, uz), axis) + s2 * component((vx, vy, vz), axis)
            if (lead - from_1 - from_2) * sign >= 0.0:
                s1, s2 = -s1, -s2
                between = 2.0 * math.pi - between
    arc = radius * max(0.0, between - math.acos(cosine_1) - math.acos(cosine_2))
    tangent_first = c1 * px + s1 * qx, c1 * py + s1 * qy, c1 * pz + s1 * qz
    tangent_second = c2 * ux - s2 * vx, c2 * uy - s2 * vy, c2 * uz - s2 * vz
    return contact, arc, tangent_first, tangent_second
