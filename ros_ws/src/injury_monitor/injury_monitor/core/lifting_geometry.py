# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""H, V, D and A of the revised NIOSH lifting equation from recorded places.

Definitions of NIOSH 94-110, section 1.1.2: H is the horizontal distance between the mid-points of
the inner ankle bones and of the hands; V the height of the hands; D the vertical travel between
origin and destination; A the angle between the sagittal plane of the neutral body position and
the line from the ankles to the hands. The ankle joint centres stand for the inner ankle bones:
their mid-point is the same for symmetric feet.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from human_model.task import Coupling
from human_model.typing import Array
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.lifting_equation import LiftingTask
from injury_monitor.core.validation import array


@dataclass(frozen=True)
class LiftEnd:
    """Where hands and ankles are at one end of a lift, REP-103, z from the floor up.

    Attributes
    ----------
    grip : array (3,)
        Mid-point of the hands, or the centre of the box where no hands are tracked [m].
    ankles : array (2, 3)
        Right and left ankle joint centre [m].
    """

    grip: Array
    ankles: Array

    def __post_init__(self) -> None:
        """Refuse wrong shapes and NaN."""
        for field, shape in (('grip', (3,)), ('ankles', (2, 3))):
            values = array(field, getattr(self, field), shape)
            if not np.all(np.isfinite(values)):
                raise InvalidInputError(field, values.tolist(), 'must be finite')
            object.__setattr__(self, field, values)


def forward_direction(ankles: npt.ArrayLike) -> Array:
    """Return the horizontal unit vector at right angles to the line between the ankles.

    This is the sagittal direction of the neutral body position while the feet stand side by side.

    Parameters
    ----------
    ankles : array (2, 3)
        Right and left ankle [m].

    Returns
    -------
    array (2,)
        x, y of the unit vector.

    Raises
    ------
    InvalidInputError
        If both ankles are at the same place.
    """
    right, left = np.asarray(ankles, dtype=np.float64)
    across = (left - right)[:2]
    length = float(np.hypot(*across))
    if length < 1e-6:
        raise InvalidInputError(
            'ankles', np.asarray(ankles).tolist(), 'right and left are at the same place'
        )
    return np.array([across[1], -across[0]]) / length


def lifting_task(
    end: LiftEnd,
    travel: float,
    forward: Array,
    lifts_per_minute: float,
    duration_hours: float,
    coupling: Coupling,
) -> LiftingTask:
    """Return the task variables at one end of a lift.

    Parameters
    ----------
    end : LiftEnd
        Origin or destination.
    travel : float
        Height of the grip at the destination minus that at the origin [m], any sign.
    forward : array (2,)
        Sagittal direction of the neutral body position (horizontal unit vector).
    lifts_per_minute, duration_hours, coupling
        As in :class:`LiftingTask`.

    Returns
    -------
    LiftingTask
        Lengths in cm, angle in degrees, as the equation wants them.
    """
    reach = end.grip[:2] - end.ankles.mean(axis=0)[:2]
    distance = float(np.hypot(*reach))
    if distance < 1e-9:
        asymmetry = 0.0
    else:
        cosine = float(np.dot(reach, forward)) / distance
        asymmetry = math.degrees(math.acos(min(1.0, max(-1.0, cosine))))
    return LiftingTask(
        100.0 * distance,
        100.0 * float(end.grip[2]),
        100.0 * abs(travel),
        asymmetry,
        lifts_per_minute,
        duration_hours,
        coupling,
    )
