# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From the programme's 26 splines to the 40 coordinates of the skeleton, with two derivatives."""

from __future__ import annotations

from functools import cache
from typing import Any, Final

import casadi as ca
import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.spatial.parameters import (
    DEPENDENT,
    N_PARAMETERS,
    N_SPLINED,
    ROOT,
    SPLINED,
    SpatialParameters,
)
from lift_predictor.core.models.spatial.rotations import Turning
from lift_predictor.core.models.spatial.stance import stance

_PELVIS: Final = (
    'pelvis_tx',
    'pelvis_ty',
    'pelvis_tz',
    'pelvis_tilt',
    'pelvis_list',
    'pelvis_rotation',
)
_SAME: Final = tuple(name for name in SPLINED if name not in ROOT) + ROOT[4:]
NAMES: Final = (*_PELVIS, *DEPENDENT, *_SAME)
"""Coordinates of the skeleton in the order of `skeleton_function`; the toes' angle is 0."""


def skeleton_function() -> Any:
    """CasADi function (q, dq, ddq, p, heading, origin) -> position, velocity, acceleration.

    Inputs are the splined coordinates and derivatives by time (26), the direction of the stance
    frame's x axis in the laboratory [rad] and its origin there (3) [m]. Outputs are 38
    coordinates `NAMES` with derivatives by time.
    """
    q, dq, ddq = (ca.SX.sym(name, N_SPLINED) for name in ('q', 'dq', 'ddq'))
    p, heading = ca.SX.sym('p', N_PARAMETERS), ca.SX.sym('heading')
    origin = ca.SX.sym('origin', 3)
    placed = stance(q, p)
    lab = Turning.fixed(heading)
    centre = origin + lab.place([placed.centre[i] for i in range(3)])
    still = ca.SX(0.0)
    pelvis = lab.joint(2, 1.0, placed.turn, still, still)
    pelvis = pelvis.joint(0, 1.0, placed.list_, still, still)
    x, y, z = pelvis.joint(1, -1.0, placed.tilt, still, still).axes
    # Rotation by tilt about -y, list about x, rotation about z.
    angles = ca.vertcat(
        ca.atan2(-z[0], z[2]),
        ca.atan2(-z[1], ca.sqrt(x[1] ** 2 + y[1] ** 2)),
        ca.atan2(x[1], y[1]),
    )
    value = ca.vertcat(
        centre[0], centre[2], -centre[1], angles,
        *(placed.leg[name] for name in DEPENDENT), *(q[SPLINED.index(name)] for name in _SAME),
    )  # fmt: skip
    rate = ca.jtimes(value, q, dq)
    change = ca.jtimes(rate, ca.vertcat(q, dq), ca.vertcat(dq, ddq))
    return ca.Function('skeleton', [q, dq, ddq, p, heading, origin], [value, rate, change])


@cache
def _function() -> Any:
    return skeleton_function()


def skeleton_motion(
    q: Array,
    dq: Array,
    ddq: Array,
    parameters: SpatialParameters,
    coordinates: tuple[str, ...],
    heading: float = 0.0,
    origin: Array | None = None,
) -> tuple[Array, Array, Array]:
    """Skeleton coordinates and two derivatives of n instants.

    Parameters
    ----------
    q, dq, ddq : array, shape (n, 26)
        Splined coordinates, derivatives by time.
    parameters : SpatialParameters
        Person and task.
    coordinates : tuple of str
        Names and order wanted (`Skeleton3D.coordinates`).
    heading : float
        Direction of the stance frame in the laboratory [rad].
    origin : array, shape (3,)
        Its origin there [m]; zero if omitted.

    Returns
    -------
    tuple of array, shape (n, len(coordinates))
    """
    n = len(q)
    place = np.zeros(3) if origin is None else origin
    outputs = _function().map(n)(q.T, dq.T, ddq.T, parameters.pack(), heading, place)
    column = {name: i for i, name in enumerate(NAMES)}
    result = []
    for output in outputs:
        values = np.asarray(output).reshape(len(NAMES), n)
        full = np.zeros((n, len(coordinates)))
        for i, name in enumerate(coordinates):
            if name in column:
                full[:, i] = values[column[name]]
        result.append(full)
    # Angles of the free pelvis are continuous over time.
    for name in _PELVIS[3:]:
        i = coordinates.index(name)
        result[0][:, i] = np.unwrap(result[0][:, i])
    return result[0], result[1], result[2]
