# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lifts of one recording: under way, over, being built, with the frames they are made of."""

from collections import deque
from collections.abc import Iterator, Sequence

from motion_tracker.core.hand_force import HandForceEstimator
from motion_tracker.core.ik_types import IKSolution
from motion_tracker.core.lift_events import LiftEvent, LiftPhase
from motion_tracker.core.live_status import LiveStatus
from motion_tracker.core.measured_lift import LiftBuilder
from motion_tracker.core.tracked import FROM_BOX, DetectedEvent, FrameRecord, MeasuredLift, Output

#: Frames older than this are forgotten unless a lift needs them [s].
_HISTORY = 15.0


class LiftRecords:
    """Memory of one recording: its latest frames and the lifts in them.

    Parameters
    ----------
    builder
        Of the measured lifts.
    margin
        Time before and after a lift that takes part in its filters [s].
    first_lift
        Number of the first lift, which goes into its name.

    Attributes
    ----------
    number : int
        Of the last lift that began; ``first_lift`` - 1 before.
    end_known : float or None
        Stamp at which the end of the last lift was known [s]; None while one is under way or none
        was.
    """

    def __init__(self, builder: LiftBuilder, margin: float, first_lift: int) -> None:
        self.number = first_lift - 1
        self.end_known: float | None = None
        self._builder = builder
        self._margin = margin
        self._frames: deque[FrameRecord] = deque()
        self._current: tuple[str, LiftEvent, float | None] | None = None
        self._due: deque[tuple[str, LiftEvent, LiftEvent, float | None]] = deque()
        self._builds: deque[tuple[float, Iterator[MeasuredLift | None]]] = deque()

    @property
    def lifting(self) -> bool:
        """Whether a lift is under way."""
        return self._current is not None

    def record(self, stamp: float, solution: IKSolution) -> None:
        """Keep a frame for the lift it may belong to."""
        self._frames.append(FrameRecord(stamp, solution))

    def take(self, events: Sequence[LiftEvent], source: str) -> list[Output]:
        """Name the lifts of events that were detected from ``source``."""
        outputs: list[Output] = []
        for event in events:
            if event.phase is LiftPhase.START:
                self.number += 1
                support = event.height if source == FROM_BOX else None
                self._current = (f'lift_{self.number:03d}', event, support)
                self.end_known = None
                outputs.append(DetectedEvent(event, self._current[0], source))
            elif self._current is not None:
                lift_id, start, support = self._current
                self._due.append((lift_id, start, event, support))
                self._current = None
                self.end_known = event.time + event.detection_delay
                outputs.append(DetectedEvent(event, lift_id, source))
        return outputs

    def begin_builds(
        self, now: float, rate: float, estimator: HandForceEstimator, status: LiveStatus
    ) -> None:
        """Begin to build the lifts whose frames have come in.

        Parameters
        ----------
        now
            Stamp of the latest frame [s].
        rate
            Of the marker frames [Hz].
        estimator, status
            What was learnt until now.
        """
        while self._due and now >= self._due[0][2].time + self._margin:
            lift_id, start, end, support = self._due.popleft()
            frames = [
                frame
                for frame in self._frames
                if start.time - self._margin <= frame.stamp <= end.time + self._margin
            ]
            self._builds.append(
                (
                    start.time,
                    self._builder.build(
                        lift_id,
                        start.time,
                        end.time,
                        frames,
                        rate,
                        estimator,
                        support,
                        status.doubt_since(start.time),
                    ),
                )
            )

    def build(self, steps: int | None = None) -> list[Output]:
        """Take some steps, or all, of building measured lifts; return those that are done."""
        done: list[Output] = []
        while self._builds and steps != 0:
            lift = next(self._builds[0][1])
            if lift is not None:
                done.append(lift)
                self._builds.popleft()
            if steps is not None:
                steps -= 1
        return done

    def forget(self, now: float) -> float | None:
        """Drop old frames every now and then; return the stamp [s] before which none is needed.

        None while there is nothing to drop.
        """
        keep = now - _HISTORY
        for start in [start for start, _ in self._builds] + [due[1].time for due in self._due]:
            keep = min(keep, start - 2 * self._margin)
        if self._current is not None:
            keep = min(keep, self._current[1].time - 2 * self._margin)
        if not self._frames or self._frames[0].stamp >= keep - _HISTORY:
            return None
        while self._frames[0].stamp < keep:
            self._frames.popleft()
        return keep
