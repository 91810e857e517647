# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Place of the box in each frame: its pose where it is seen and plausible, else by the hands.

Hands that carry a box move with it. A pose that leaves the hands is therefore wrong, whether it
is a stray, exchanged or frozen, and so is one that is faster than a box is lifted. Then the box
is where it was relative to the hands (carried), or where it was seen last (at rest).
"""

import math
from dataclasses import dataclass

import numpy as np

from human_model.typing import Array
from motion_tracker.core.forces.hand_force import HandForceEstimator

#: Largest change of the box relative to the hands that carry it [m], beyond what `_FOLLOW`
#: explains: twice what the simulated recordings have (noise of 0.5 mm; at most 2.2 mm).
RESIDUAL = 0.005

#: Time constant with which the place of the box in the hands may change [s]: a slip of 0.05 m/s is
#: followed. An engineering choice.
_FOLLOW = 0.1

#: Largest speed of a box [m/s]. An engineering choice: boxes in the simulated recordings reach
#: 1.3 m/s, a box that falls 0.5 m reaches 3.1 m/s.
SPEED = 3.0

#: Rise of the hands at a box whose pose keeps each digit, from which on it counts as frozen [m]:
#: the rise after which the hands alone carry a box (`HandForceSettings.free_rise`).
RISE = 0.02

#: A place that contradicts the one before is believed after it has been consistent for this long
#: [s]. An engineering choice: longer than the gaps that are bridged.
CONFIRM = 0.2

#: Share of the poses of the last `WINDOW` seconds beyond which all count as not seen.
NOISY = 0.1
WINDOW = 0.5


@dataclass(frozen=True, eq=False)
class BoxPlace:
    """Place of the box in one frame.

    Attributes
    ----------
    position : ndarray (3,)
        Of its centre, world [m].
    offset : ndarray (3,) or None
        From the middle of the hands, where these determine the place [m].
    jumped : bool
        Whether the place has no connection with the one before.
    doubt : str
        Reason why the pose was not used; empty if it was.
    """

    position: Array
    offset: Array | None = None
    jumped: bool = False
    doubt: str = ''


class BoxWatch:
    """Watch over the pose of the box in one recording."""

    def __init__(self) -> None:
        self._stamp = -np.inf
        self._place: Array | None = None
        self._raw: Array | None = None
        self._offset = np.zeros(3)
        self._correction = np.zeros(3)
        self._candidate: tuple[float, Array] | None = None
        self._poor = 0.0
        self._lowest = np.inf

    def check(
        self, stamp: float, seen: Array | None, hands: Array, carried: bool, held: bool
    ) -> BoxPlace | None:
        """Return the place of the box in a frame; None before it was seen.

        Parameters
        ----------
        stamp
            Of the frame [s].
        seen
            Centre of the box (3,) [m] by its pose; None if there is none.
        hands
            Middle of the grip centres (3,) [m].
        carried
            Whether the hands carry the box.
        held
            Whether the hands are at the box, so that they can carry it.
        """
        step, self._stamp = stamp - self._stamp, stamp
        if self._place is None:
            if seen is None:
                return None
            place = self._accept(seen, hands, jumped=True)
            return BoxPlace(seen, self._offset, jumped=True) if held else place
        doubt = self._doubt(seen, hands, carried, held, step)
        weight = min(1.0, step / WINDOW)
        self._poor += weight * (float(bool(doubt) and seen is not None) - self._poor)
        if not doubt and carried and self._poor > NOISY:
            doubt = 'the pose of the box is noisy'
        if not doubt and seen is not None:
            self._raw = seen
            return self._accept(seen - self._correction, hands, carried, step)
        expected = hands + self._offset if carried else self._place
        self._raw = seen if seen is not None else self._raw
        if seen is not None and self._confirmed(stamp, seen, hands, carried):
            self._poor = 0.0
            if carried:
                # The box goes on where the hands have it: its load has no step.
                self._correction = seen - expected
                return self._accept(expected, hands, carried, step)
            self._correction = np.zeros(3)
            if held:
                self._offset = seen - hands
                self._place = seen
                return BoxPlace(seen, self._offset, jumped=True)
            return self._accept(seen, hands, jumped=True)
        self._place = expected
        return BoxPlace(expected, self._offset if carried else None, doubt=doubt)

    def _doubt(
        self, seen: Array | None, hands: Array, carried: bool, held: bool, step: float
    ) -> str:
        """Return why a pose is not used; empty if it is."""
        assert self._place is not None
        if seen is None:
            return 'the box is not seen'
        place = seen - self._correction
        if carried:
            apart = math.dist(place - hands, self._offset)
            if apart > RESIDUAL:
                return f'the box moves {1000 * apart:.0f} mm relative to the hands that carry it'
            if self._raw is not None and _same(seen, self._raw):
                return 'the pose of the box does not change while it is carried'
            return ''
        if self._raw is None or not _same(seen, self._raw):
            self._lowest = np.inf
        self._lowest = min(self._lowest, float(hands[2]))
        if held and hands[2] - self._lowest > RISE:
            return 'the pose of the box does not change while the hands at it rise'
        speed = max(0.0, math.dist(place, self._place) - 2 * RESIDUAL) / step
        return f'the box moves at {speed:.1f} m/s' if speed > SPEED else ''

    def _confirmed(self, stamp: float, seen: Array, hands: Array, carried: bool) -> bool:
        """Whether poses in doubt have been consistent with each other for long enough."""
        place = seen - hands if carried else seen
        if self._candidate is None or (
            np.linalg.norm(place - self._candidate[1])
            > (2 * RESIDUAL if carried else 10 * RESIDUAL)
        ):
            self._candidate = stamp, place
            return False
        if not carried:
            self._candidate = self._candidate[0], place
        if stamp - self._candidate[0] < CONFIRM:
            return False
        self._candidate = None
        return True

    def _accept(
        self,
        place: Array,
        hands: Array,
        carried: bool = False,
        step: float = np.inf,
        jumped: bool = False,
    ) -> BoxPlace:
        self._candidate = None
        weight = min(1.0, step / _FOLLOW) if carried else 1.0
        self._offset = self._offset + weight * (place - hands - self._offset)
        self._place = place
        return BoxPlace(place, jumped=jumped)


def _same(a: Array, b: Array) -> bool:
    return bool(a[2] == b[2] and a[0] == b[0] and a[1] == b[1])


class BoxFollower:
    """Place of the box in one recording, and whether the hands carry it.

    Parameters
    ----------
    hand_force
        Of the recording: reach of the hands, and height of the box at rest.

    Attributes
    ----------
    carried : bool
        Whether the hands carried the box in the last frame.
    """

    def __init__(self, hand_force: HandForceEstimator) -> None:
        self.carried = False
        self._hand_force = hand_force
        self._watch = BoxWatch()
        self._last: Array | None = None
        self._support: float | None = None

    def place(self, stamp: float, seen: Array | None, grips: Array) -> BoxPlace | None:
        """Return the place of the box in a frame; None before it was seen.

        Parameters
        ----------
        stamp
            Of the frame [s].
        seen
            Centre of the box (3,) [m] by its pose; None if there is none.
        grips
            Grip centres (2, 3) [m].
        """
        held = self.carried = False
        last = seen if self._last is None else self._last
        if last is not None:
            held = self._hand_force.gate(grips, last) > 0.0
            if self._support is None:
                self._support = self._hand_force.support
            rise = 0.0 if self._support is None else float(last[2]) - self._support
            self.carried = held and rise > self._hand_force.settings.free_rise
        if not self.carried:
            self._support = None
        place = self._watch.check(stamp, seen, 0.5 * (grips[0] + grips[1]), self.carried, held)
        if place is not None:
            self._last = place.position
        return place
