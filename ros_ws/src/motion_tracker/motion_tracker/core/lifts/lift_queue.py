# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Queue of the lifts of one recording: named at their events, built in steps in the background.

A whole lift takes a dozen steps of about a millisecond. Each marker frame allows one step. The
step is taken with a later sample that completes no frame, so that a live frame does not wait for
it.
"""

from collections import deque
from collections.abc import Iterator, Sequence

import numpy as np

from motion_tracker.core.forces.box_watch import BoxPlace
from motion_tracker.core.forces.hand_force import HandForceEstimator
from motion_tracker.core.inverse_kinematics.solution import IKSolution
from motion_tracker.core.lifts.lift_events import LiftEvent, LiftPhase
from motion_tracker.core.lifts.measured_lift import LiftBuilder
from motion_tracker.core.live_status import LiveStatus
from motion_tracker.core.tracked import (
    FROM_BOX,
    DetectedEvent,
    FrameRecord,
    MeasuredLift,
    Notice,
    Output,
)

#: Frames older than this are removed unless a lift needs them [s].
_HISTORY = 15.0


class LiftQueue:
    """Recent frames of a recording, and the lifts that are built from them.

    Parameters
    ----------
    builder
        Of the measured lifts.
    margin
        Time before and after a lift that takes part in its filters [s].
    first_lift
        Number of the first lift, which is part of its name.
    hand_force, status
        Of the recording; a lift uses their state at the begin of its building.
    session
        End of the lifts' names, by which lifts of two processes differ; '' for none.

    Attributes
    ----------
    number : int
        Of the last lift that began; ``first_lift`` - 1 before the first.
    end_known : float or None
        Stamp at which the end of the last lift was known [s]; None during a lift and before the
        first end.
    """

    def __init__(
        self,
        builder: LiftBuilder,
        margin: float,
        first_lift: int,
        hand_force: HandForceEstimator,
        status: LiveStatus,
        session: str = '',
    ) -> None:
        self.number = first_lift - 1
        self.end_known: float | None = None
        self._builder = builder
        self._margin = margin
        self._hand_force = hand_force
        self._status = status
        self._suffix = f'_{session}' if session else ''
        self._frames: deque[FrameRecord] = deque()
        self._latest = -np.inf
        self._allowed_steps = 0
        self._current: tuple[str, LiftEvent, float | None] | None = None
        self._due: deque[tuple[str, LiftEvent, LiftEvent, float | None]] = deque()
        self._builds: deque[tuple[float, Iterator[MeasuredLift | None]]] = deque()

    @property
    def lifting(self) -> bool:
        """Whether a lift is under way."""
        return self._current is not None

    def record(self, stamp: float, solution: IKSolution, box: BoxPlace | None = None) -> None:
        """Store a frame for the lift that it may belong to, and allow one step of the builds."""
        self._frames.append(FrameRecord(stamp, solution, box))
        self._latest = stamp
        self._allowed_steps += 1

    def take(self, events: Sequence[LiftEvent], source: str) -> list[Output]:
        """Name the lifts of events that were detected from ``source``."""
        outputs: list[Output] = []
        for event in events:
            if event.phase is LiftPhase.START:
                self.number += 1
                support = event.height if source == FROM_BOX else None
                self._current = (f'lift_{self.number:03d}{self._suffix}', event, support)
                self.end_known = None
                outputs.append(DetectedEvent(event, self._current[0], source))
            elif self._current is not None:
                lift_id, start, support = self._current
                self._due.append((lift_id, start, event, support))
                self._current = None
                self.end_known = event.time + event.detection_delay
                outputs.append(DetectedEvent(event, lift_id, source))
        return outputs

    def gap(self, stamp: float) -> float:
        """Return the time since the last frame [s]."""
        return stamp - self._latest

    def give_up(self, stamp: float) -> list[Output]:
        """Drop the lift under way, whose end will not be found after the stamp [s]."""
        if self._current is None:
            return []
        lift_id, start, _ = self._current
        self._current = None
        return [
            Notice(
                f'{lift_id} began at {start.time:.3f} s and has no end in the frames until '
                f'{min(stamp, self._latest):.3f} s: it is not assessed'
            )
        ]

    def begin(self, now: float, rate: float) -> None:
        """Begin to build the lifts whose frames have all arrived.

        Parameters
        ----------
        now
            Stamp of the latest frame [s].
        rate
            Of the marker frames [Hz].
        """
        while self._due and now >= self._due[0][2].time + self._margin:
            lift_id, start, end, support = self._due.popleft()
            frames = [
                frame
                for frame in self._frames
                if start.time - self._margin <= frame.stamp <= end.time + self._margin
            ]
            build = self._builder.build(
                lift_id,
                start.time,
                end.time,
                frames,
                rate,
                self._hand_force,
                support,
                self._status.doubt_since(start.time),
            )
            self._builds.append((start.time, build))

    def work(self, frame_completed: bool) -> list[Output]:
        """Take one allowed step and remove what is not needed any more; return a finished lift.

        Parameters
        ----------
        frame_completed
            Whether the sample that was just processed completed a frame: the step that this frame
            allows then waits for the next sample.
        """
        if self._allowed_steps <= int(frame_completed):
            return []
        self._allowed_steps -= 1
        done = self._step()
        self._forget()
        return done

    def finish(self) -> list[Output]:
        """Build all lifts to the end."""
        done: list[Output] = []
        while self._builds:
            done += self._step()
        return done

    def _step(self) -> list[Output]:
        if not self._builds:
            return []
        lift = next(self._builds[0][1])
        if lift is None:
            return []
        self._builds.popleft()
        return [lift]

    def _forget(self) -> None:
        """Remove old frames and samples from time to time."""
        keep = self._latest - _HISTORY
        for start in [start for start, _ in self._builds] + [due[1].time for due in self._due]:
            keep = min(keep, start - 2 * self._margin)
        if self._current is not None:
            keep = min(keep, self._current[1].time - 2 * self._margin)
        if not self._frames or self._frames[0].stamp >= keep - _HISTORY:
            return
        while self._frames[0].stamp < keep:
            self._frames.popleft()
        self._builder.forget(keep)
