# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Zero of a falling slope by false position, compiled: one trial at a time.

Illinois rule: when one end stays twice, the slope kept for it is halved.
"""

from typing import NamedTuple

from human_model.compiled_cache import kernel


class Bracket(NamedTuple):
    """Two places with the zero between them.

    Attributes
    ----------
    near, near_slope : float
        Place where the slope is positive, and the slope there.
    past, past_slope : float
        The same where it is negative.
    last : int
        Which was moved last: 1 the first, -1 the second, 0 neither.
    """

    near: float
    near_slope: float
    past: float
    past_slope: float
    last: int


@kernel
def whole_step(first: float, whole: float, last: int) -> Bracket:
    """Bracket a step from 0, with the slope `first`, to 1, with the slope `whole`."""
    return Bracket(0.0, first, 1.0, whole, last)


@kernel
def narrowed(bracket: Bracket, place: float, slope: float) -> Bracket:
    """Return the bracket in which a place replaces the end whose slope has the same sign."""
    near, near_slope, past, past_slope, last = bracket
    if slope > 0.0:
        if last == 1:
            past_slope *= 0.5
        return Bracket(place, slope, past, past_slope, 1)
    if last == -1:
        near_slope *= 0.5
    return Bracket(near, near_slope, place, slope, -1)


@kernel
def crossing(bracket: Bracket) -> float:
    """Return the place where a line through both ends is zero."""
    near, near_slope, past, past_slope, _ = bracket
    return near + (past - near) * near_slope / (near_slope - past_slope)
