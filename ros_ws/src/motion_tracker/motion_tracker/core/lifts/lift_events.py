# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Start and end of a lift from the height of the box, or of the hands.

Thesis, section 4.3: the lift starts in the first frame in which the velocity of the box increases
from rest in the upward direction, and ends in the frame in which its height reaches the first
local maximum after that. Measured heights carry noise, so that taken literally every frame
at rest is a local maximum. The detector therefore (1) finds the rise with a threshold on the
smoothed velocity, (2) waits until the rise and its end are certain, and (3) goes back and
estimates the instant itself from the raw samples: where there was rest before (or is rest after)
by the change point from a constant to a polynomial, where the motion turned without rest by the
zero of the smoothed velocity. Smoothing looks a fixed time ahead, so the events are the same live
and offline; live events are reported later, with their delay.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from human_model.typing import Array
from motion_tracker.core.exceptions import LiftEventError
from motion_tracker.core.lifts.onset_kernel import onset

#: Steps of the search for a change point [s]; well below the 10 ms of a frame.
_STEP = 0.002

#: A start with a step of acceleration is believed when its squared misfit is below this share of
#: that of a smooth start: a box pulled by arms does not start with a step.
STEP_EVIDENCE = 0.7


class LiftPhase(IntEnum):
    """Which event; numbers as in the message."""

    START = 1
    END = 2


@dataclass(frozen=True)
class LiftEventSettings:
    """Thresholds of the detection.

    Attributes
    ----------
    minimum_rise : float
        A smaller rise is no lift [m].
    minimum_body_rise : float
        When detected from the hands: the shoulders must rise by this too while the hands do, so
        that raising the arms is no lift [m].
    rest_speed : float
        Vertical speed below which the box counts as at rest [m/s].
    rest_time : float
        Shortest time at rest; a shorter one is a turning point [s].
    settle_time : float
        Time without further rise after which a maximum is certain [s].
    drop : float
        Descent from a maximum that makes it certain at once [m].
    half_window : float
        Half of the window of the local parabola that smooths [s].
    onset_rise : float
        Height over (or under) the rest position up to which samples take part in the change
        point [m].
    """

    minimum_rise: float = 0.05
    minimum_body_rise: float = 0.03
    rest_speed: float = 0.03
    rest_time: float = 0.1
    settle_time: float = 0.15
    drop: float = 0.01
    half_window: float = 0.05
    onset_rise: float = 0.045

    def __post_init__(self) -> None:
        """Check that every threshold is positive."""
        for name, value in vars(self).items():
            if not (np.isfinite(value) and value > 0):
                raise LiftEventError(f'lift_events.{name}: must be positive, got {value}')


@dataclass(frozen=True)
class LiftEvent:
    """Start or end of a lift.

    Attributes
    ----------
    phase : LiftPhase
    number : int
        Lifts are counted from 1.
    time : float
        Of the event itself [s].
    height : float
        At the event [m].
    detection_delay : float
        Stamp of the sample that made it certain minus ``time`` [s].
    """

    phase: LiftPhase
    number: int
    time: float
    height: float
    detection_delay: float


class LiftEventDetector:
    """Streaming detector of lifts; heights are pushed in the order of time.

    Parameters
    ----------
    settings
        Thresholds.
    history
        Samples older than this are dropped [s]; the longest lift that is found.
    """

    def __init__(self, settings: LiftEventSettings | None = None, history: float = 30.0) -> None:
        self.settings = settings or LiftEventSettings()
        self._history = history
        self._time: list[float] = []
        self._raw: list[float] = []
        self._body: list[float] = []
        self._smooth: list[float] = []
        self._speed: list[float] = []
        self._number = 0
        self._base = -1
        self._top = -1
        self._rising = False

    @property
    def lifting(self) -> bool:
        """Whether a start was reported and its end not yet."""
        return self._rising

    def push(self, time: float, height: float, body: float = np.nan) -> list[LiftEvent]:
        """Take one sample; return the events that became certain.

        Parameters
        ----------
        time
            Stamp [s], later than the one before.
        height
            Of the box or of the hands [m]. A sample that is not finite is left out.
        body
            Height of the shoulders [m] when detecting from the hands; NaN otherwise.

        Raises
        ------
        LiftEventError
            If time does not increase.
        """
        if self._time and not time > self._time[-1]:
            raise LiftEventError(f'time: {time:.6f} s does not follow {self._time[-1]:.6f} s')
        if not (np.isfinite(height) and np.isfinite(time)):
            return []
        self._time.append(time)
        self._raw.append(height)
        self._body.append(body)
        events: list[LiftEvent] = []
        while len(self._smooth) < len(self._time):
            at = len(self._smooth)
            if self._time[at] + self.settings.half_window > time - 1e-9:
                break
            events += self._advance(at)
        self._forget()
        return events

    def finish(self) -> list[LiftEvent]:
        """End of the recording: use the samples that still waited for their window."""
        events: list[LiftEvent] = []
        while len(self._smooth) < len(self._time):
            events += self._advance(len(self._smooth))
        if self._rising and self._speed[-1] <= self.settings.rest_speed:
            events.append(self._end())
        return events

    def _advance(self, at: int) -> list[LiftEvent]:
        height, speed = self._parabola(at)
        self._smooth.append(height)
        self._speed.append(speed)
        if self._rising:
            return self._look_for_end(at)
        if speed <= self.settings.rest_speed:
            self._base = at
            return []
        if self._base < 0 or height - self._smooth[self._base] < self.settings.minimum_rise:
            return []
        if self._body[at] - self._body[self._base] < self.settings.minimum_body_rise:
            return []
        self._rising = True
        self._number += 1
        self._top = at
        when, value = self._start_instant()
        return [self._event(LiftPhase.START, when, value)]

    def _look_for_end(self, at: int) -> list[LiftEvent]:
        recent = max(self._speed[at], self._speed[at - 1], self._speed[self._top])
        if self._smooth[at] > self._smooth[self._top] and recent > self.settings.rest_speed:
            self._top = at
        settled = self._time[at] - self._time[self._top] >= self.settings.settle_time
        dropped = self._smooth[self._top] - self._smooth[at] >= self.settings.drop
        return [self._end()] if settled or dropped else []

    def _end(self) -> LiftEvent:
        when, value = self._end_instant()
        self._rising = False
        self._base = -1
        return self._event(LiftPhase.END, when, value)

    def _event(self, phase: LiftPhase, when: float, value: float) -> LiftEvent:
        return LiftEvent(
            phase, self._number, float(when), float(value), float(self._time[-1] - when)
        )

    def _parabola(self, at: int) -> tuple[float, float]:
        """Height [m] and speed [m/s] at one sample by a least-squares parabola round it."""
        centre, half = self._time[at], self.settings.half_window + 1e-9
        first = at
        while first > 0 and centre - self._time[first - 1] <= half:
            first -= 1
        last = at + 1
        while last < len(self._time) and self._time[last] - centre <= half:
            last += 1
        times = [(time - centre) / half for time in self._time[first:last]]
        heights = self._raw[first:last]
        if len(times) > 3:
            height, slope = _parabola_at_zero(times, heights)
            return height, slope / half
        powers = np.array(times)[:, None] ** np.arange(len(times))
        coefficients = np.linalg.solve(powers, np.array(heights))
        return (float(coefficients[0]), float(coefficients[1]) / half if len(times) > 1 else 0.0)

    def _at_rest(self, first: int, last: int) -> bool:
        """Whether the smoothed speed stays below rest speed over the samples first..last."""
        limit = self.settings.rest_speed
        return all(abs(speed) <= limit for speed in self._speed[first : last + 1])

    def _start_instant(self) -> tuple[float, float]:
        base = self._base
        before = base
        while before > 0 and self._time[base] - self._time[before] < self.settings.rest_time:
            before -= 1
        rested = self._time[base] - self._time[before] >= self.settings.rest_time - 1e-9
        if rested and self._at_rest(before, base):
            first = before
            while (
                first > 0
                and self._time[base] - self._time[first] < 3 * self.settings.rest_time
                and abs(self._speed[first - 1]) <= self.settings.rest_speed
            ):
                first -= 1
            level = float(np.median(self._raw[first : before + 1]))
            last = base
            while (
                last < len(self._smooth) - 1
                and self._smooth[last] - level < self.settings.onset_rise
            ):
                last += 1
            t, z = np.array(self._time[first : last + 1]), np.array(self._raw[first : last + 1])
            return _change_point(t, z)
        return self._turning_point(base)

    def _end_instant(self) -> tuple[float, float]:
        top = self._top
        after = top
        while (
            after < len(self._speed) - 1
            and self._time[after] - self._time[top] < self.settings.rest_time
        ):
            after += 1
        if self._time[after] - self._time[top] >= self.settings.rest_time - 1e-9 and self._at_rest(
            top + 1, after
        ):
            level = float(np.median(self._raw[top : after + 1]))
            first = top
            while first > self._base and level - self._smooth[first] < self.settings.onset_rise:
                first -= 1
            t = np.array(self._time[first : after + 1])[::-1]
            z = np.array(self._raw[first : after + 1])[::-1]
            when, height = _change_point(-t, -z)
            return -when, -height
        return self._turning_point(top)

    def _turning_point(self, near: int) -> tuple[float, float]:
        """Where the smoothed speed changes its sign, between the samples next to ``near``."""
        best: tuple[float, float] | None = None
        for i in range(max(0, near - 10), min(len(self._speed) - 1, near + 10)):
            a, b = self._speed[i], self._speed[i + 1]
            if (a <= 0.0) != (b <= 0.0):
                when = self._time[i] + (self._time[i + 1] - self._time[i]) * a / (a - b)
                if best is None or abs(when - self._time[near]) < abs(best[0] - self._time[near]):
                    best = (when, self._smooth[i])
        return best if best is not None else (self._time[near], self._smooth[near])

    def _forget(self) -> None:
        if self._rising or self._time[-1] - self._time[0] < 2 * self._history:
            return
        drop = int(np.searchsorted(self._time, self._time[-1] - self._history))
        if self._base >= 0:
            drop = min(drop, max(0, self._base - 100))
        for samples in (self._time, self._raw, self._body, self._smooth, self._speed):
            del samples[:drop]
        self._base = self._base - drop if self._base >= 0 else -1


def _parabola_at_zero(t: list[float], z: list[float]) -> tuple[float, float]:
    """Value and slope at 0 of the least-squares parabola through more than three points.

    By the normal equations in plain numbers: the points are few, and ``t`` is of order one.
    """
    n, s1, s2, s3, s4 = float(len(t)), 0.0, 0.0, 0.0, 0.0
    r0 = r1 = r2 = 0.0
    for x, y in zip(t, z, strict=True):
        square = x * x
        s1 += x
        s2 += square
        s3 += square * x
        s4 += square * square
        r0 += y
        r1 += x * y
        r2 += square * y
    # Cofactors of the first two columns of [[n, s1, s2], [s1, s2, s3], [s2, s3, s4]].
    a, b, c = s2 * s4 - s3 * s3, s2 * s3 - s1 * s4, s1 * s3 - s2 * s2
    d, e = n * s4 - s2 * s2, s1 * s2 - n * s3
    determinant = n * a + s1 * b + s2 * c
    return (a * r0 + b * r1 + c * r2) / determinant, (b * r0 + d * r1 + e * r2) / determinant


def _change_point(time: Array, height: Array) -> tuple[float, float]:
    """Instant [s] and level [m] at which a constant turns into a rise.

    With x the time since the instant and X its value at the last sample, the rise goes with
    ``x^3 - x^4 / (4 X)``: acceleration starts from zero and its growth eases off, as in the
    first twentieth of a minimum-jerk motion. A start with a step of acceleration, ``x^2``, is
    taken only when it fits clearly better.
    """
    instants = np.arange(time[0], time[-2], _STEP)
    time, height = np.ascontiguousarray(time), np.ascontiguousarray(height)
    smooth = onset(time, height, instants, True)
    step = onset(time, height, instants, False)
    _, instant, level = step if step[0] < STEP_EVIDENCE * smooth[0] else smooth
    return instant, level


def detect_lifts(
    time: npt.ArrayLike,
    height: npt.ArrayLike,
    body: npt.ArrayLike | None = None,
    settings: LiftEventSettings | None = None,
) -> list[LiftEvent]:
    """All events of a recording, by the same detector that runs live.

    Parameters
    ----------
    time, height
        Stamps [s] and heights [m], shape (n,).
    body
        Height of the shoulders [m], shape (n,), when detecting from the hands.
    """
    stamps = np.asarray(time, dtype=np.float64)
    heights = np.asarray(height, dtype=np.float64)
    shoulders = (
        np.full_like(heights, np.nan) if body is None else np.asarray(body, dtype=np.float64)
    )
    if not stamps.shape == heights.shape == shoulders.shape or stamps.ndim != 1:
        raise LiftEventError(
            f'time {stamps.shape}, height {heights.shape} and body '
            f'{shoulders.shape} must have one shape (n,)'
        )
    detector = LiftEventDetector(settings, history=np.inf)
    events = [
        event
        for row in zip(stamps, heights, shoulders, strict=True)
        for event in detector.push(*map(float, row))
    ]
    return events + detector.finish()
