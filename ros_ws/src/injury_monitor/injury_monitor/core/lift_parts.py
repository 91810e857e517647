# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Collection of the parts of a lift, which arrive one by one, until it can be assessed."""

from __future__ import annotations

from dataclasses import dataclass, field

from human_model.typing import Array, BoolArray
from injury_monitor.core.loads import ActivationSeries, LiftLoads, TorqueSeries
from injury_monitor.core.rnle_assessment import LiftEnds
from injury_monitor.core.validation import positive

MEASURED = 'measured'
PREDICTED = 'predicted'


@dataclass(frozen=True)
class SpineSeries:
    """L5-S1 load over a lift: time (n,) [s], compression and anterior shear (n,) [N]."""

    time: Array
    compression: Array
    anterior_shear: Array
    solved: BoolArray


@dataclass
class LiftParts:
    """Parts of one lift that have arrived.

    Attributes
    ----------
    lift_id : str
    since : float
        When its first part arrived, on the clock of the caller [s].
    start : float or None
        Start of the lift [s]; known once the measured lift has arrived.
    ends : LiftEnds or None
    spine, torques, activations : dict
        By source, ``measured`` or ``predicted``.
    no_prediction : str
        Why there is no predicted lift; '' if there may be one.
    """

    lift_id: str
    since: float
    start: float | None = None
    ends: LiftEnds | None = None
    spine: dict[str, SpineSeries] = field(default_factory=dict)
    torques: dict[str, TorqueSeries] = field(default_factory=dict)
    activations: dict[str, ActivationSeries] = field(default_factory=dict)
    no_prediction: str = ''

    def complete(self) -> bool:
        """Return whether nothing more is to be waited for."""
        if self.start is None:
            return False
        sources = (MEASURED,) if self.no_prediction else (MEASURED, PREDICTED)
        return all(
            source in part
            for source in sources
            for part in (self.spine, self.torques, self.activations)
        )

    def loads(self, source: str) -> LiftLoads | None:
        """Return the loads of one source, or None if there is no spine load."""
        if source not in self.spine:
            return None
        spine = self.spine[source]
        start = self.start if self.start is not None else float(spine.time[0])
        return LiftLoads(
            self.lift_id,
            start,
            spine.time,
            spine.compression,
            spine.anterior_shear,
            spine.solved,
            self.torques.get(source),
            self.activations.get(source),
        )


class LiftCollector:
    """Parts of all lifts that wait for their assessment.

    Parameters
    ----------
    wait : float
        How long after its first part a lift is assessed at the latest, with what is there [s].
    """

    def __init__(self, wait: float) -> None:
        self.wait = positive('wait', wait)
        self._waiting: dict[str, LiftParts] = {}
        self._done: set[str] = set()

    def parts(self, lift_id: str, now: float) -> LiftParts | None:
        """Return the parts of a lift to be filled; None if it has been assessed already."""
        if lift_id in self._done:
            return None
        return self._waiting.setdefault(lift_id, LiftParts(lift_id, now))

    def any_ready(self, now: float) -> bool:
        """Return whether a lift is complete or has waited long enough."""
        return any(self._is_ready(parts, now) for parts in self._waiting.values())

    def take(self, now: float) -> LiftParts:
        """Take out the first lift that is ready.

        A lift whose waiting time is over without a measured spine load cannot be assessed; it is
        taken out too, so that the caller can report it.

        Raises
        ------
        StopIteration
            If no lift is ready.
        """
        parts = next(parts for parts in self._waiting.values() if self._is_ready(parts, now))
        del self._waiting[parts.lift_id]
        self._done.add(parts.lift_id)
        return parts

    def _is_ready(self, parts: LiftParts, now: float) -> bool:
        return parts.complete() or now - parts.since >= self.wait
