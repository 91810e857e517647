# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled estimate of the hand forces, the same for a live sample and for a whole lift."""

import numpy as np

from human_model.compiled_cache import njit
from human_model.constants import GRAVITY
from human_model.typing import Array

#: Hands closer together than this share the box equally, squared [m^2].
_NO_SPAN = 1e-4


@njit
def smooth_step(x: float) -> float:
    """0 below 0, 1 above 1, cubic with level ends in between."""
    s = min(max(x, 0.0), 1.0)
    return s * s * (3.0 - 2.0 * s)


@njit
def split(hands: Array, box: Array) -> float:
    """Share of the right hand: 1 where the box is at the right hand, 0 at the left, half unknown.

    Parameters
    ----------
    hands
        Grip centres (2, 3) right, left [m].
    box
        Centre of the box (3,) [m].
    """
    x, y = hands[0, 0] - hands[1, 0], hands[0, 1] - hands[1, 1]
    length = x * x + y * y
    if length < _NO_SPAN:
        return 0.5
    along = (box[0] - hands[1, 0]) * x + (box[1] - hands[1, 1]) * y
    return float(min(max(along / length, 0.0), 1.0))


@njit
def gate(hands: Array, box: Array, reach: float, fade: float) -> float:
    """1 while both hands (2, 3) [m] are at the box, 0 while one is well away from it."""
    distance = 0.0
    for side in range(2):
        x, y, z = hands[side, 0] - box[0], hands[side, 1] - box[1], hands[side, 2] - box[2]
        distance = max(distance, np.sqrt(x * x + y * y + z * z))
    return 1.0 - smooth_step((distance - reach) / fade)


@njit
def hand_forces(
    mass: float,
    missing: Array,
    hands: Array,
    box: Array,
    acceleration: Array,
    support: float,
    since_end: float,
    reach: float,
    fade: float,
    free_rise: float,
    largest_share: float,
    release_time: float,
) -> Array:
    """Force of the box on the [right, left] hand (n, 2, 3) [N].

    Parameters
    ----------
    mass
        Of the box [kg].
    missing
        Ground force beyond the body's need (n,), without its bias [N]; NaN without plates.
    hands, box, acceleration
        Grip centres (n, 2, 3) [m], box centre (n, 3) [m] and its acceleration [m/s^2].
    support
        Height the box was lifted from [m]; NaN: nothing is carried.
    since_end
        Time since the end of the last lift was known [s]; NaN while one is under way.
    reach, fade, free_rise, largest_share, release_time
        As in `hand_force.HandForceSettings`; half the box's diagonal is part of the reach.
    """
    n = hands.shape[0]
    force = np.zeros((n, 2, 3))
    kept = 1.0 if np.isnan(since_end) else 1.0 - smooth_step(since_end / release_time)
    most = largest_share * mass * GRAVITY
    for k in range(n):
        if not np.all(np.isfinite(box[k])):
            continue
        carried = 0.0
        if not np.isnan(support):
            carried = kept * smooth_step((box[k, 2] - support) / free_rise)
        taken = 0.0
        if not np.isnan(missing[k]):
            taken = gate(hands[k], box[k], reach, fade) * min(max(missing[k], 0.0), most)
        right = split(hands[k], box[k])
        for r in range(3):
            gravity = GRAVITY if r == 2 else 0.0
            total = carried * (-mass * (acceleration[k, r] + gravity))
            if r == 2:
                total -= (1.0 - carried) * taken
            force[k, 0, r] = right * total
            force[k, 1, r] = (1.0 - right) * total
    return force
