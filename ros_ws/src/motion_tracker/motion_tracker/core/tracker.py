# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The motion tracker: marker frames, wrenches and box poses in; body motion and lifts out.

Streams may arrive in any interleaving: a marker frame waits until both plates and the box (if
there are any) have delivered samples up to its stamp, so the results depend on the stamps
alone and are the same live, replayed and offline. All live results of one frame belong to one
instant: the stamp of the frame minus the delay of the motion filter; the plates, whose filter is
faster, are read that much earlier.
"""

from collections import Counter, deque
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from human_model.motion import POINTS
from human_model.skeleton_3d import Skeleton3D
from human_model.subject import Subject
from motion_tracker.core.arrival import Arrival
from motion_tracker.core.dynamics import needed_force
from motion_tracker.core.errors import TrackerError
from motion_tracker.core.filters import CausalFilter, settling_time
from motion_tracker.core.force_plates import (
    SIDES,
    PlateGeometry,
    ground_reaction,
    total_reaction,
)
from motion_tracker.core.hand_force import HandForceEstimator
from motion_tracker.core.initial_rest import initial_speed
from motion_tracker.core.inverse_kinematics import IKSolution, InverseKinematics
from motion_tracker.core.lift_events import LiftEvent, LiftEventDetector, LiftPhase
from motion_tracker.core.live_status import LiveStatus
from motion_tracker.core.marker_frames import MarkerFrames
from motion_tracker.core.marker_model import model_for
from motion_tracker.core.marker_set import MarkerSet
from motion_tracker.core.mass_watch import MassWatch
from motion_tracker.core.measured_lift import LiftBuilder
from motion_tracker.core.streams import RATE_SAMPLES, SampledStream, rate_of
from motion_tracker.core.tracked import (
    FROM_BOX,
    FROM_HANDS,
    DetectedEvent,
    FrameRecord,
    Notice,
    Output,
    TrackedFrame,
    TrackerSettings,
)

Array = npt.NDArray[np.float64]

_HANDS = (POINTS.index('hand_r'), POINTS.index('hand_l'))
_SHOULDERS = (POINTS.index('shoulder_r'), POINTS.index('shoulder_l'))

#: Frames older than this are forgotten unless a lift needs them [s].
_HISTORY = 15.0


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
        Time now [s] by which a missing stream is given up (`Arrival`); None when reading files.

    Attributes
    ----------
    counts : Counter
        Refused or lost input by kind.
    """

    def __init__(self, subject: Subject, marker_set: MarkerSet | None, box_mass: float = 0.0,
                 box_size: npt.ArrayLike = (0.0, 0.0, 0.0),
                 plates: Mapping[str, PlateGeometry] | None = None,
                 settings: TrackerSettings | None = None, first_lift: int = 1,
                 clock: Callable[[], float] | None = None) -> None:
        self.settings = settings or TrackerSettings()
        self.subject = subject
        self.skeleton = Skeleton3D.of(subject)
        self.model, self.model_source = model_for(subject, marker_set)
        self.inverse_kinematics = InverseKinematics(self.skeleton, self.model, self.settings.ik)
        self.counts: Counter[str] = Counter()
        self._plates = {name: (plates or {}).get(name, PlateGeometry(name)) for name in SIDES}
        self._wrenches = {name: SampledStream(f'{name} plate', 6, self.counts,
                                              self.settings.plate_cutoff) for name in SIDES}
        self._box = SampledStream('box', 3, self.counts)
        self._hand_force = HandForceEstimator(box_mass, box_size, self.settings.hand_force)
        self._builder = LiftBuilder(self.skeleton, self.settings, self._plates, self._wrenches,
                                    self._box)
        self._frames = MarkerFrames(self.model.names, marker_set.names if marker_set else (),
                                    self.counts)
        self._detectors = {FROM_BOX: LiftEventDetector(self.settings.events),
                           FROM_HANDS: LiftEventDetector(self.settings.events)}
        self._arrival = Arrival(self.settings.wait, self.settings.longest_gap, clock)
        self._queue: deque[tuple[float, Array, float]] = deque()
        self._newest = -np.inf
        self._rate = 0.0
        self._filter: CausalFilter | None = None
        self._box_filter: CausalFilter | None = None
        self._records: list[FrameRecord] = []
        self._input: Array | None = None
        self._passed: float | None = None
        self._last_q: Array | None = None
        self._lift: tuple[str, LiftEvent, float | None] | None = None
        self._due: list[tuple[str, LiftEvent, LiftEvent, float | None]] = []
        self._lifts = first_lift - 1
        self._end_known: float | None = None
        self._status = LiveStatus(MassWatch(subject.mass, self.settings.mass_tolerance),
                                  settling_time(self.settings.motion_cutoff))
        self._notices: list[Output] = []

    @property
    def filter_delay(self) -> float:
        """Delay of the live results [s]; 0 until the marker rate is known."""
        return self._filter.delay if self._filter else 0.0

    @property
    def lifts(self) -> int:
        """Number of the last lift that began; ``first_lift`` - 1 before."""
        return self._lifts

    @property
    def marker_rate(self) -> float:
        """Rate of the marker frames [Hz]; 0 until it is known."""
        return self._rate

    def push_markers(self, stamp: float, names: Sequence[str], positions: npt.ArrayLike,
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
        if stamp <= self._newest:
            kind = 'duplicate stamps' if stamp == self._newest else 'unsorted stamps'
            self.counts[f'markers: {kind}'] += 1
            return []
        target, unknown = self._frames.arrange(stamp, names, positions)
        self._notices += [Notice(f'marker {name!r} is not tracked: it has no place in the marker '
                                 'model', True) for name in unknown]
        self._newest = stamp
        self._queue.append((stamp, target, self._arrival.arrive()))
        return self._drain(False)

    def push_wrench(self, side: str, stamp: float, force: npt.ArrayLike, moment: npt.ArrayLike,
                    ) -> list[Output]:
        """Take one sample of a force plate: force [N] and moment about its origin [N m] (3,)."""
        if side not in SIDES:
            raise TrackerError(f'plate {side!r}: sides are {", ".join(SIDES)}')
        sample = np.concatenate([np.asarray(force, dtype=np.float64).reshape(3),
                                 np.asarray(moment, dtype=np.float64).reshape(3)])
        self._wrenches[side].push(stamp, sample)
        return self._drain(False)

    def push_box(self, stamp: float, position: npt.ArrayLike) -> list[Output]:
        """Take one position of the box's centre (3,), world [m]."""
        self._box.push(stamp, np.array(position, dtype=np.float64).reshape(3))
        return self._drain(False)

    def flush(self) -> list[Output]:
        """End of the recording: work off what still waits, and close open lifts."""
        for stream in (*self._wrenches.values(), self._box):
            stream.settle()
        outputs = self._drain(True)
        for source, detector in self._detectors.items():
            outputs += self._events(detector.finish(), source)
        outputs += self._lifts_due(np.inf)
        return outputs

    def _awaited(self) -> list[SampledStream]:
        streams = list(self._wrenches.values())
        return [*streams, self._box] if self._hand_force.box_mass > 0 else streams

    def _drain(self, final: bool) -> list[Output]:
        outputs: list[Output] = []
        if self._rate == 0.0:
            if len(self._queue) <= RATE_SAMPLES and not (final and len(self._queue) > 2):
                return outputs
            self._start(list(self._queue))
        while self._queue:
            stamp, target, arrived = self._queue[0]
            ready, said = self._arrival.ready(stamp, arrived, self._newest, self._awaited(), final)
            self._notices += said
            if not ready:
                break
            self._queue.popleft()
            outputs += self._frame(stamp, target)
        notices, self._notices = self._notices, []
        return notices + outputs

    def _start(self, frames: Sequence[tuple[float, Array, float]]) -> None:
        stamps = [stamp for stamp, _, _ in frames]
        self._rate = rate_of(stamps, 'markers')
        speed = initial_speed(stamps, [target for _, target, _ in frames])
        if speed > self.settings.events.rest_speed:
            self._status.settle(stamps[0], 'the filters settle: the recording begins in motion, '
                                           f'its markers move at {speed:.2f} m/s rms')
        self._filter = CausalFilter(self._rate, self.settings.motion_cutoff,
                                    len(self.skeleton.coordinates))
        self._box_filter = CausalFilter(self._rate, self.settings.motion_cutoff, 3)

    def _frame(self, stamp: float, target: Array) -> list[Output]:
        solution = self.inverse_kinematics.solve(target, self._last_q)
        self._records.append(FrameRecord(stamp, solution))
        outputs: list[Output] = []
        if not np.isfinite(solution.rms):
            self.counts['markers: frames without a pelvis'] += 1
            return outputs
        outputs += self._detect(stamp, solution)
        outputs += self._live(stamp, self._passed, solution)
        self._passed = stamp
        self._last_q = solution.q
        outputs += self._lifts_due(stamp)
        self._forget(stamp)
        return outputs

    def _detect(self, stamp: float, solution: IKSolution) -> list[Output]:
        if self._hand_force.box_mass > 0 and 'box' not in self._arrival.absent:
            box = self._box.raw_at(stamp)
            if box is None:
                return []
            return self._events(self._detectors[FROM_BOX].push(stamp, float(box[2])), FROM_BOX)
        points = self.skeleton.point_array(solution.q)[0]
        hands = float(points[list(_HANDS), 2].mean())
        shoulders = float(points[list(_SHOULDERS), 2].mean())
        return self._events(self._detectors[FROM_HANDS].push(stamp, hands, shoulders), FROM_HANDS)

    def _events(self, events: Sequence[LiftEvent], source: str) -> list[Output]:
        outputs: list[Output] = []
        for event in events:
            if event.phase is LiftPhase.START:
                self._lifts += 1
                support = event.height if source == FROM_BOX else None
                self._lift = (f'lift_{self._lifts:03d}', event, support)
                self._end_known = None
                outputs.append(DetectedEvent(event, self._lift[0], source))
            elif self._lift is not None:
                lift_id, start, support = self._lift
                self._due.append((lift_id, start, event, support))
                self._lift = None
                self._end_known = event.time + event.detection_delay
                outputs.append(DetectedEvent(event, lift_id, source))
        return outputs

    def _step_filters(self, stamp: float, previous: float | None, q: Array, box: Array | None,
                      ) -> tuple[tuple[Array, Array, Array], tuple[Array, Array, Array] | None]:
        """Pass one frame, and the lost ones before it by interpolation, through the filters."""
        assert self._filter is not None and self._box_filter is not None
        lost = 0 if previous is None else round((stamp - previous) * self._rate) - 1
        if lost > 0:
            self.counts['markers: lost frames'] += lost
        if self._input is None or lost > self.settings.longest_gap * self._rate + 1e-9:
            self._filter.reset()
            self._box_filter.reset()
            if self._input is not None:
                self._status.settle(stamp, 'the filters settle after a gap in the markers')
            lost = 0
        for i in range(1, lost + 1):
            share = i / (lost + 1)
            assert self._input is not None
            self._filter.step((1.0 - share) * self._input + share * q)
        self._input = q
        if box is None:
            self._box_filter.reset()
            return self._filter.step(q), None
        for _ in range(lost):
            self._box_filter.step(box)
        return self._filter.step(q), self._box_filter.step(box)

    def _live(self, stamp: float, previous: float | None, solution: IKSolution) -> list[Output]:
        box_raw = self._box.raw_at(stamp) if self._hand_force.box_mass > 0 else None
        (q, qd, qdd), box = self._step_filters(stamp, previous, solution.q, box_raw)
        time = stamp - self.filter_delay
        rows = {name: self._wrenches[name].filtered_at(time) for name in SIDES}
        feet = [ground_reaction(row[:3], row[3:], self._plates[name],
                                self.settings.force_threshold)
                for name, row in rows.items() if row is not None]
        forces: dict[str, Array] = {}
        total_force, total_cop = np.zeros(3), np.full(3, np.nan)
        missing = None
        if len(feet) == len(SIDES):
            forces = {'ground_force': np.stack([foot.force for foot in feet], axis=1),
                      'cop': np.stack([foot.cop for foot in feet], axis=1),
                      'free_moment': np.stack([foot.free_moment for foot in feet], axis=1)}
            force, cop = total_reaction(feet)
            total_force, total_cop = force[0], cop[0]
            need = needed_force(self.skeleton, q, qd, qdd)
            missing = float(need[2] - total_force[2])
        if box is not None:
            settled = None if self._status.settling(stamp) else missing
            forces |= self._carry(time, q, box, missing, settled)
        if missing is not None:
            vertical, held = float(total_force[2]), self._held(q, None if box is None else box[0])
            check = self._status.weigh(stamp, vertical, vertical + missing, held, self._rate)
            if check is not None:
                self._notices.append(Notice(str(check), check.ok))
        motion = self.skeleton.body_motion(time, q, qd, qdd, **forces)
        silent = ' and '.join(f'the {name} plate' for name, row in rows.items() if row is None)
        status, message = self._status.judge(stamp, solution, silent)
        return [*self._take_notices(), TrackedFrame(motion, solution, status, message,
                                                    self.filter_delay, total_force, total_cop)]

    def _held(self, q: Array, box: Array | None) -> float | None:
        """Mass in the hands [kg]; None while it is not known."""
        mass = self._hand_force.box_mass
        if mass == 0.0:
            return 0.0
        if box is None:
            return None if self._lift is not None else 0.0
        hands = self.skeleton.point_array(q)[0][list(_HANDS)]
        support = self._hand_force.support if self._lift is not None else None
        return self._hand_force.held(hands, box, support)

    def _carry(self, time: float, q: Array, box: tuple[Array, Array, Array],
               missing: float | None, settled: float | None) -> dict[str, Array]:
        """Hand forces (1, 2, 3) [N] and box position (1, 3) [m] of the live sample.

        The bias of `missing` is learnt from the samples that have it `settled` too.
        """
        hands = self.skeleton.point_array(q)[0][list(_HANDS)]
        position, speed, acceleration = box
        since = None if self._end_known is None else time - self._end_known
        released = since is None or since > self.settings.hand_force.release_time
        self._hand_force.observe(settled, hands, position, float(speed[2]),
                                 self._lift is not None or not released, 1.0 / self._rate,
                                 self.settings.events.rest_speed)
        force = self._hand_force.estimate(missing, hands, position, acceleration,
                                          self._hand_force.support, since)
        return {'hand_force': force[None], 'box_position': position[None]}

    def _take_notices(self) -> list[Output]:
        notices, self._notices = self._notices, []
        return notices

    def _lifts_due(self, now: float) -> list[Output]:
        """Measured lifts whose samples after the end have come in."""
        outputs: list[Output] = []
        margin = self.settings.margin
        while self._due and now >= self._due[0][2].time + margin:
            lift_id, start, end, support = self._due.pop(0)
            records = [record for record in self._records
                       if start.time - margin <= record.stamp <= end.time + margin]
            outputs.append(self._builder.build(lift_id, start.time, end.time, records, self._rate,
                                               self._hand_force, support,
                                               self._status.doubt_since(start.time)))
        return outputs

    def _forget(self, now: float) -> None:
        keep = now - _HISTORY
        for start in [item[1] for item in self._due] + ([self._lift[1]] if self._lift else []):
            keep = min(keep, start.time - 2 * self.settings.margin)
        if self._records[0].stamp < keep - _HISTORY:
            self._records = [record for record in self._records if record.stamp >= keep]
            for stream in (*self._wrenches.values(), self._box):
                stream.forget(keep)
