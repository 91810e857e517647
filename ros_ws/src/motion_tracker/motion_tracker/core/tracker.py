# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The motion tracker: marker frames, wrenches and box poses in; body motion and lifts out.

Streams may arrive in any interleaving: a marker frame waits until both plates and the box (if
there are any) have delivered samples up to its stamp, so the results depend on the stamps
alone and are the same live, replayed and offline. Whole lifts are built in the background
(`lift_queue`).
"""

from collections import Counter, deque
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from human_model.constants import SIDES
from human_model.motion import POINTS
from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from human_model.typing import Array
from motion_tracker.core.exceptions import MotionTrackerError, TrackerError
from motion_tracker.core.filters import settling_time
from motion_tracker.core.forces.box_watch import BoxFollower, BoxPlace
from motion_tracker.core.forces.force_plates import PlateGeometry
from motion_tracker.core.forces.hand_force import HandForceEstimator
from motion_tracker.core.forces.mass_watch import MassWatch
from motion_tracker.core.initial_rest import initial_speed
from motion_tracker.core.inverse_kinematics.inverse_kinematics import InverseKinematics
from motion_tracker.core.inverse_kinematics.solution import IKSolution
from motion_tracker.core.lifts.lift_events import LiftEventDetector
from motion_tracker.core.lifts.lift_queue import LiftQueue
from motion_tracker.core.lifts.measured_lift import LiftBuilder
from motion_tracker.core.live_motion import HANDS, LiveMotion
from motion_tracker.core.live_status import LiveStatus
from motion_tracker.core.markers.marker_frames import MarkerFrames
from motion_tracker.core.markers.marker_model import model_for
from motion_tracker.core.markers.marker_set import MarkerSet
from motion_tracker.core.sample_clock import (
    JITTER_SAMPLES,
    SampleClock,
    jitters,
    mean_deviation,
    mean_rate,
)
from motion_tracker.core.stream_synchronizer import StreamSynchronizer
from motion_tracker.core.streams import RATE_SAMPLES, SAME, SampledStream, rate_of
from motion_tracker.core.tracked import FROM_BOX, FROM_HANDS, Notice, Output, TrackerSettings

#: Difference of the rates of box and markers up to which both come from the same cameras; the
#: rate of ten jittering stamps is no better known.
_SAME_RATE = 0.3

#: Samples of plates and box that are kept while no markers come [s]: more than the markers may
#: lag behind them, 16 s with the queue of a subscriber.
_IDLE = 20.0

#: A gap in the markers that ends a lift [s]: nobody knows what happened in it.
_LOST_SIGHT = 2.0

#: Longest time by which jittering stamps of frames may be out of order [s].
JITTER = 0.02

#: Numbers of a sample of a plate, and of the box.
_WRENCH, _PLACE = 6, 3

_SHOULDERS = slice(POINTS.index('shoulder_r'), POINTS.index('shoulder_l') + 1)


class MotionTracker:
    """Tracker of one person in one recording.

    Parameters
    ----------
    subject
        The person; with ``calibration``, when there was a static trial.
    marker_set
        Of the recording; needed without a calibration, gives the weights with one.
    box_mass, box_size
        Of the task: mass [kg] (0: nothing is lifted) and depth, width, height [m].
    plates
        Geometry by side; plates on the floor at the world's origin if absent.
    settings
        Filters and thresholds.
    first_lift
        Number of the first lift, which goes into its name.
    clock
        Current time [s], by which a missing stream is declared lost (`StreamSynchronizer`); None
        when reading files.
    session
        End of the lifts' names, by which lifts of two processes differ; '' for none.

    Attributes
    ----------
    counts : Counter
        Refused or lost input by kind.
    """

    def __init__(
        self,
        subject: Subject,
        marker_set: MarkerSet | None,
        box_mass: float = 0.0,
        box_size: npt.ArrayLike = (0.0, 0.0, 0.0),
        plates: Mapping[str, PlateGeometry] | None = None,
        settings: TrackerSettings | None = None,
        first_lift: int = 1,
        clock: Callable[[], float] | None = None,
        session: str = '',
    ) -> None:
        self.settings = settings or TrackerSettings()
        self.subject = subject
        self.skeleton = Skeleton3D.of(subject)
        self.model, self.model_source = model_for(subject, marker_set)
        self.inverse_kinematics = InverseKinematics(self.skeleton, self.model, self.settings.ik)
        self.counts: Counter[str] = Counter()
        self._plates = {name: (plates or {}).get(name, PlateGeometry(name)) for name in SIDES}
        self._wrenches = {
            name: SampledStream(f'{name} plate', _WRENCH, self.counts, self.settings.plate_cutoff)
            for name in SIDES
        }
        self._box = SampledStream('box', _PLACE, self.counts)
        self._hand_force = HandForceEstimator(box_mass, box_size, self.settings.hand_force)
        builder = LiftBuilder(
            self.skeleton, self.settings, self._plates, self._wrenches, self._box
        )
        self._frames = MarkerFrames(
            self.model.names, marker_set.names if marker_set else (), self.counts
        )
        self._detectors = {
            FROM_BOX: LiftEventDetector(self.settings.events),
            FROM_HANDS: LiftEventDetector(self.settings.events),
        }
        self._synchronizer = StreamSynchronizer(
            self.settings.wait, self.settings.longest_gap, clock
        )
        self._pending: deque[tuple[float, Array, IKSolution, float]] = deque()
        self._newest = -np.inf
        self._rate = 0.0
        self._live: LiveMotion | None = None
        self._last_q: Array | None = None
        self._status = LiveStatus(
            MassWatch(subject.mass, self.settings.mass_tolerance),
            settling_time(self.settings.motion_cutoff),
        )
        self._lifts = LiftQueue(
            builder, self.settings.margin, first_lift, self._hand_force, self._status, session
        )
        self._frame_clock: SampleClock | None = None
        self._box_clock: SampleClock | None = None
        self._box_follower = BoxFollower(self._hand_force)
        self._box_newest = -np.inf
        self._notices: list[Output] = []

    @property
    def filter_delay(self) -> float:
        """Delay of the live results [s]; 0 until the marker rate is known."""
        return self._live.delay if self._live else 0.0

    @property
    def lifts(self) -> int:
        """Number of the last lift that began; ``first_lift`` - 1 before."""
        return self._lifts.number

    @property
    def marker_rate(self) -> float:
        """Rate of the marker frames [Hz]; 0 until it is known."""
        return self._rate

    def push_markers(
        self, stamp: float, names: Sequence[str], positions: npt.ArrayLike
    ) -> list[Output]:
        """Take one marker frame.

        Parameters
        ----------
        stamp
            [s].
        names
            Markers seen.
        positions
            Shape (len(names), 3), world [m]; NaN counts as not seen.

        Raises
        ------
        TrackerError
            If names and positions do not belong together, or the positions are not in metres.
        """
        if not np.isfinite(stamp):
            self.counts['markers: not finite'] += 1
            return []
        uneven = self._frame_clock is not None and self._frame_clock.jitters
        if stamp <= self._newest and not (uneven and stamp > self._newest - JITTER):
            kind = 'duplicate stamps' if stamp == self._newest else 'unsorted stamps'
            self.counts[f'markers: {kind}'] += 1
            return []
        target, unknown = self._frames.arrange(stamp, names, positions)
        self._notices += [
            Notice(f'marker {name!r} is not tracked: it has no place in the marker model', True)
            for name in unknown
        ]
        if self._frame_clock is not None:
            stamp = self._frame_clock.even(stamp)
        self._newest = max(self._newest, stamp)
        # The fit needs nothing but markers: it is done while plates and box are on their way.
        solution = self.inverse_kinematics.solve(target, self._last_q)
        if np.isfinite(solution.rms):
            self._last_q = solution.q
        self._pending.append((stamp, target, solution, self._synchronizer.register()))
        return self._process(True)

    def push_wrench(
        self,
        side: str,
        stamp: float,
        force: Sequence[float] | Array,
        moment: Sequence[float] | Array,
    ) -> list[Output]:
        """Take one sample of a force plate: force [N] and moment about its origin [N m] (3,)."""
        stream = self._wrench_stream(side)
        sample = (*force, *moment)
        if len(sample) != _WRENCH:
            raise TrackerError(f'{stream.name}: force and moment have {len(sample)} components')
        stream.push(stamp, sample)
        return self._process(self._reaches_frame(stream))

    def push_wrenches(self, side: str, stamps: Sequence[float], samples: Array) -> list[Output]:
        """Take samples of a force plate at increasing stamps: the same as one after the other.

        Parameters
        ----------
        side : str
            Of the plate.
        stamps : sequence of float, n
            [s].
        samples : ndarray, shape (n, 6)
            Force [N] and moment about the plate's origin [N m].

        Raises
        ------
        TrackerError
            If there is no such plate.
        """
        stream = self._wrench_stream(side)
        for stamp, sample in zip(stamps, samples.tolist(), strict=True):
            stream.push(stamp, sample)
        return self._process(self._reaches_frame(stream))

    def _wrench_stream(self, side: str) -> SampledStream:
        stream = self._wrenches.get(side)
        if stream is None:
            raise TrackerError(f'plate {side!r}: sides are {", ".join(SIDES)}')
        return stream

    def push_box(self, stamp: float, position: Sequence[float] | Array) -> list[Output]:
        """Take one position of the box's centre (3,), world [m]."""
        if len(position) != _PLACE:
            raise TrackerError(f'box: position has {len(position)} components')
        # The box comes from the same cameras.
        if (
            self._box_clock is not None
            and stamp > self._box_newest
            and abs(self._box.rate / self._rate - 1.0) < _SAME_RATE
        ):
            self._box_newest = stamp
            stamp = self._box_clock.even(stamp)
        self._box.push(stamp, position)
        return self._process(self._reaches_frame(self._box))

    def flush(self) -> list[Output]:
        """End of the recording: process pending frames, and finish open lifts."""
        for stream in (*self._wrenches.values(), self._box):
            stream.settle()
        outputs = self._process_pending(True)
        for source, detector in self._detectors.items():
            outputs += self._lifts.take(detector.finish(), source)
        outputs += self._lifts.give_up(self._newest)
        self._lifts.begin(np.inf, self._rate)
        return outputs + self._lifts.finish()

    def _reaches_frame(self, stream: SampledStream) -> bool:
        """Whether the stream has a sample at or after the first pending frame."""
        return bool(self._pending) and stream.last >= self._pending[0][0] - SAME

    def _process(self, frames: bool) -> list[Output]:
        """Process pending frames, if ``frames``, and take a step of the lifts being built."""
        if not frames:
            self._forget_idle()
        outputs = self._process_pending(False) if frames else []
        return outputs + self._lifts.work(bool(outputs))

    def _forget_idle(self) -> None:
        """Bound what plates and box leave behind while no markers come."""
        for stream in (*self._wrenches.values(), self._box):
            if stream.span > 2.0 * _IDLE and stream.last - self._newest > _IDLE:
                stream.forget(stream.last - _IDLE)

    def _needed_streams(self) -> list[SampledStream]:
        streams = list(self._wrenches.values())
        return [*streams, self._box] if self._hand_force.box_mass > 0 else streams

    def _process_pending(self, final: bool) -> list[Output]:
        outputs: list[Output] = []
        if self._rate == 0.0:
            stamps = [stamp for stamp, *_ in self._pending]
            if len(stamps) <= RATE_SAMPLES and not (final and len(stamps) > 2):
                return outputs
            if len(stamps) < JITTER_SAMPLES and not final and jitters(stamps):
                return outputs
            try:
                self._start(stamps)
            except MotionTrackerError:  # such as frames too slow for the filters
                self._rate = 0.0
                self._pending.clear()
                raise
        while self._pending:
            stamp, _, solution, arrival = self._pending[0]
            synchronized, notices = self._synchronizer.synchronized(
                stamp, arrival, self._newest, self._needed_streams(), final
            )
            self._notices += notices
            if not synchronized:
                break
            self._pending.popleft()
            outputs += self._process_frame(stamp, solution)
        notices, self._notices = self._notices, []
        return notices + outputs

    def _start(self, stamps: list[float]) -> None:
        self._rate = rate_of(stamps, 'markers')
        spread = 0.0
        if jitters(stamps):
            spread = mean_deviation(stamps)
            self._rate = rate_of([0.0, 1.0 / mean_rate(stamps)], 'markers')
            text = 'markers: the stamps jitter; even times are used, as cameras expose evenly'
            self._notices.append(Notice(text))
        gap = self.settings.longest_gap
        self._frame_clock = SampleClock(self._rate, gap, spread)
        self._box_clock = SampleClock(self._rate, gap, spread)
        self._pending = deque(
            (self._frame_clock.even(stamp), target, solution, arrival)
            for stamp, target, solution, arrival in self._pending
        )
        self._newest = max(self._newest, self._pending[-1][0])
        speed = initial_speed(stamps, [target for _, target, *_ in self._pending])
        if speed > self.settings.events.rest_speed:
            self._status.settle(
                stamps[0],
                'the filters settle: the recording begins in motion, '
                f'its markers move at {speed:.2f} m/s rms',
            )
        self._live = LiveMotion(
            self.skeleton,
            self._rate,
            self.settings,
            self._plates,
            self._wrenches,
            self._hand_force,
            self._status,
            self.counts,
        )

    def _process_frame(self, stamp: float, solution: IKSolution) -> list[Output]:
        given_up = self._lifts.give_up(stamp) if self._lifts.gap(stamp) > _LOST_SIGHT else []
        for source in self._detectors if given_up else ():
            self._detectors[source] = LiftEventDetector(self.settings.events)
        return given_up + self._take_frame(stamp, solution)

    def _take_frame(self, stamp: float, solution: IKSolution) -> list[Output]:
        assert self._live is not None
        if not np.isfinite(solution.rms):
            self._lifts.record(stamp, solution)
            self.counts['markers: frames without a pelvis'] += 1
            return []
        box, hands = None, None
        if self._hand_force.box_mass > 0:
            hands = self.skeleton.points_and_frames(solution.q)[0][0, HANDS]
            box = self._box_follower.place(stamp, self._box.raw_at(stamp), hands)
            if box is not None and box.doubt:
                self.counts['box: frames in which its pose was not used'] += 1
        self._lifts.record(stamp, solution, box)
        events = self._detect(stamp, solution, box)
        frame, notices = self._live.sample(
            stamp, solution, hands, box, self._lifts.lifting, self._lifts.end_known
        )
        self._lifts.begin(stamp, self._rate)
        return [frame, *notices, *events]

    def _detect(self, stamp: float, solution: IKSolution, box: BoxPlace | None) -> list[Output]:
        carried = self._box_follower.carried
        if self._hand_force.box_mass > 0 and ('box' not in self._synchronizer.lost or carried):
            if box is None:
                return []
            events = self._detectors[FROM_BOX].push(stamp, float(box.position[2]))
            return self._lifts.take(events, FROM_BOX)
        heights = self.skeleton.point_array(solution.q)[0, :, 2]
        events = self._detectors[FROM_HANDS].push(
            stamp, float(heights[HANDS].mean()), float(heights[_SHOULDERS].mean())
        )
        return self._lifts.take(events, FROM_HANDS)
