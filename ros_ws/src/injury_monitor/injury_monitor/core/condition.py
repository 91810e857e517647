# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Turns samples of one value into edges: limit exceeded, returned to normal.

Delays and deadband as in ISA-18.2 / IEC 62682. Only the data's own stamps count, never a wall
clock, so the same samples give the same edges online and offline, at any speed.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.limits import Limit
from injury_monitor.core.validation import non_negative, positive


class EdgeKind(Enum):
    """Direction of an edge."""

    RAISE = 'raise'
    CLEAR = 'clear'


@dataclass(frozen=True)
class Edge:
    """A confirmed change of one condition.

    Attributes
    ----------
    kind : EdgeKind
    stamp : float
        Sample with which the delay was over [s].
    onset : float
        First sample on the new side of the limit [s].
    value : float
        Value at ``stamp``.
    """

    kind: EdgeKind
    stamp: float
    onset: float
    value: float


class LimitCondition:
    """One value against one limit.

    The condition becomes active when the value has been at or above the limit for ``on_delay``
    seconds of seen time, and inactive when it has been below limit minus deadband for
    ``off_delay`` seconds. Seen time is counted between neighbouring good samples only: a sample
    that did not solve, or a gap longer than ``max_gap``, stops the clock without resetting it.

    Parameters
    ----------
    limit : Limit
    on_delay, off_delay : float
        [s].
    deadband : float
        Fraction of the limit, 0 to 1.
    max_gap : float
        [s].
    """

    def __init__(
        self, limit: Limit, on_delay: float, off_delay: float, deadband: float, max_gap: float
    ) -> None:
        self.limit = limit
        self.on_delay = non_negative('on_delay', on_delay)
        self.off_delay = non_negative('off_delay', off_delay)
        if not 0.0 <= deadband < 1.0:
            raise InvalidInputError('deadband', deadband, 'must lie in 0 to 1')
        self.clear_below = limit.value * (1.0 - deadband)
        self.max_gap = positive('max_gap', max_gap)
        self.active = False
        self._last: float | None = None
        self._onset: float | None = None
        self._held = 0.0
        self._broken = False

    def interrupt(self) -> None:
        """Note that a sample did not solve: the time up to the next good one is not seen time."""
        self._broken = True

    def restart(self) -> None:
        """Forget pending delays, as after a jump of the stamps; an active condition stays."""
        self._last = None
        self._onset = None
        self._held = 0.0
        self._broken = False

    def sample(self, stamp: float, value: float) -> Edge | None:
        """Take one good sample.

        Parameters
        ----------
        stamp : float
            [s], later than the sample before.
        value : float
            In the unit of the limit.

        Returns
        -------
        Edge or None
            The edge this sample confirmed.
        """
        seen = 0.0
        if self._last is not None and not self._broken and stamp - self._last <= self.max_gap:
            seen = stamp - self._last
        self._last = stamp
        self._broken = False
        turned = value < self.clear_below if self.active else value >= self.limit.value
        if not turned:
            self._onset = None
            self._held = 0.0
            return None
        if self._onset is None:
            self._onset = stamp
        else:
            self._held += seen
        delay = self.off_delay if self.active else self.on_delay
        # A nanosecond of tolerance: stamps of a 100 Hz clock are not exact in binary.
        if self._held < delay - 1e-9:
            return None
        kind = EdgeKind.CLEAR if self.active else EdgeKind.RAISE
        edge = Edge(kind, stamp, self._onset, value)
        self.active = not self.active
        self._onset = None
        self._held = 0.0
        return edge
