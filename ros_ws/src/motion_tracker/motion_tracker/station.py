# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The motion tracker in the graph: markers, plates and box in, motion and lifts out."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from itertools import pairwise
from typing import Any, Final, TypeAlias
from uuid import uuid4

import numpy as np

from human_model.constants import SIDES
from human_model.exceptions import LiftingError
from human_model.subject import Subject
from human_model.typing import Array
from lifting_messages import Message
from lifting_messages.conversions import subject_from_msg
from lifting_messages.exceptions import TopicError
from lifting_messages.plate_blocks import block_samples
from lifting_messages.station import Log, Output, Station
from motion_tracker import conversions, inputs, topics
from motion_tracker.core.configuration import tracker_from
from motion_tracker.core.recording_segmenter import LEAP, RecordingSegmenter
from motion_tracker.core.tracked import DetectedEvent, MeasuredLift, TrackedFrame, TrackerSettings
from motion_tracker.core.tracked import Output as Tracked
from motion_tracker.core.tracker import MotionTracker
from motion_tracker.core.warm_up import warm_up

#: Samples kept until person and task are known: 20 s of two 2500 Hz plates.
EARLY_SAMPLES: Final = 100_000

#: Marker frames between two reports of refused input.
COUNT_FRAMES: Final = 500

#: A sample, bound to the method of the tracker that takes it.
Sample: TypeAlias = Callable[[MotionTracker], list[Tracked]]


class TrackerStation(Station):
    """Tracks the person at one station.

    Samples that come before person and task wait for them. Stamps that go back, or another
    person or task, begin another recording.

    Parameters
    ----------
    values, name, log, clock
        See `Station`.
    settings : TrackerSettings, optional
        Replace those of `values`.

    Attributes
    ----------
    tracker : MotionTracker or None
        Of the recording, once person and task are known and its first sample has come.
    lifts : int
        Number of lifts in finished recordings.
    session : str
        End of the names of this station's lifts; '' for files.
    """

    PACKAGE = 'motion_tracker'
    INPUTS = topics.INPUTS
    OUTPUTS = topics.OUTPUTS

    def __init__(
        self,
        values: Mapping[str, Any] | None = None,
        name: str = '',
        log: Log | None = None,
        clock: Callable[[], float] | None = None,
        settings: TrackerSettings | None = None,
    ) -> None:
        super().__init__(values, name, log, clock)
        self._settings = settings
        self.tracker: MotionTracker | None = None
        self.lifts = 0
        # A restarted tracker counts its lifts from 1: their names must differ from those before.
        # Lifts of a file meet no others, and their names are the same each time.
        self.session = '' if clock is None else uuid4().hex[:8]
        self._subject: tuple[Subject, str] | None = None
        self._task: tuple[float, Array] | None = None
        self._early: deque[Sample] = deque(maxlen=EARLY_SAMPLES)
        self._segmenter: RecordingSegmenter[Sample] = RecordingSegmenter(clock=clock)
        self._recording = 0
        self._frames = 0
        self._inputs: dict[str, Callable[[Message], Iterator[Tracked]]] = {
            'subject': self._on_subject,
            'task': self._on_task,
            topics.MARKERS.name: self._on_markers,
            topics.BOX.name: self._on_box,
            **{topics.PLATES[side].name: partial(self._on_wrench, side) for side in SIDES},
            **{topics.BLOCKS[side].name: partial(self._on_block, side) for side in SIDES},
        }
        self.handlers = {
            topic: partial(self._convert, handler) for topic, handler in self._inputs.items()
        }

    @property
    def waiting(self) -> int:
        """Number of samples that wait for person and task."""
        return len(self._early)

    def warm_up(self) -> None:
        """Load the compiled functions."""
        warm_up()

    def flush(self) -> Iterator[Output]:
        """End the recording: process the frames that wait."""
        for output in self.end():
            yield from self._messages(output)

    def track(self, topic: str, message: Message) -> Iterator[Tracked]:
        """Take a message; yield the results themselves.

        Raises
        ------
        MotionTrackerError
            If the tracker refuses it.
        TopicError
            If the topic is none of `INPUTS`.
        """
        handler = self._inputs.get(topic)
        if handler is None:
            raise TopicError(self.PACKAGE, topic)
        return handler(message)

    def end(self) -> Iterator[Tracked]:
        """End the recording; yield the results themselves."""
        yield from self._feed(self._segmenter.end())
        yield from self._end_recording()
        self._recording = self._segmenter.current

    def enter_subject(self, subject: Subject, marker_set: str) -> Iterator[Tracked]:
        """Set the person and the marker set of the recording; another one ends the recording."""
        known = self._subject
        if known and (known[0].to_dict(), known[1]) == (subject.to_dict(), marker_set):
            return
        yield from self._end_recording()
        self._subject = subject, marker_set
        yield from self._feed_early()

    def enter_task(self, box_mass: float, box_size: Array) -> Iterator[Tracked]:
        """Set mass [kg] and size (3,) [m] of the box; another one ends the recording."""
        known = self._task
        if known and known[0] == box_mass and np.array_equal(known[1], box_size):
            return
        yield from self._end_recording()
        self._task = box_mass, box_size
        yield from self._feed_early()

    def _convert(
        self, handler: Callable[[Message], Iterator[Tracked]], message: Message
    ) -> Iterator[Output]:
        for output in handler(message):
            yield from self._messages(output)

    def _on_subject(self, message: Message) -> Iterator[Tracked]:
        return self.enter_subject(subject_from_msg(message), message.marker_set)

    def _on_task(self, message: Message) -> Iterator[Tracked]:
        return self.enter_task(*inputs.task_from_msg(message))

    def _on_markers(self, message: Message) -> Iterator[Tracked]:
        stamp, names, positions = inputs.markers_from_msg(message)
        self._frames += 1
        if self._frames % COUNT_FRAMES == 0:
            self._report_counts()
        return self._take('markers', stamp, lambda t: t.push_markers(stamp, names, positions))

    def _on_box(self, message: Message) -> Iterator[Tracked]:
        stamp, position = inputs.box_from_msg(message)
        return self._take('box', stamp, lambda tracker: tracker.push_box(stamp, position))

    def _on_wrench(self, side: str, message: Message) -> Iterator[Tracked]:
        stamp, force, moment = inputs.wrench_from_msg(message)
        return self._take(side, stamp, lambda t: t.push_wrench(side, stamp, force, moment))

    def _on_block(self, side: str, message: Message) -> Iterator[Tracked]:
        stamps, samples = block_samples(message)
        if all(0.0 < after - before < LEAP for before, after in pairwise(stamps)):
            block = _block(side, stamps, samples)
            yield from self._take(side, stamps[0], block, stamps[-1])
            return
        for k, stamp in enumerate(stamps):
            yield from self._take(side, stamp, _block(side, [stamp], samples[k : k + 1]))

    def _take(
        self, stream: str, stamp: float, sample: Sample, last: float | None = None
    ) -> Iterator[Tracked]:
        """Pass a sample, or a block up to the stamp `last`, to the tracker of its recording."""
        if self._segmenter.idle:
            published = (self.has_publishers(topic.name) for topic in topics.STREAMS)
            streams = ('markers', 'box', *SIDES, *SIDES)
            self._segmenter.expect(
                stream for stream, one in zip(streams, published, strict=True) if one
            )
        passed = self._segmenter.push(stream, stamp, sample, last)
        while self._segmenter.notices:
            self.report_error(self._segmenter.notices.pop(0))
        return self._feed(passed)

    def _feed(self, samples: Iterable[tuple[int, Sample]]) -> Iterator[Tracked]:
        """Pass samples on, or keep them until person and task are known."""
        for recording, sample in samples:
            if recording != self._recording:
                self.log.info('stamps went back: another recording begins')
                yield from self._end_recording()
                self._recording = recording
            tracker = self._ready()
            if tracker is not None:
                yield from sample(tracker)
                continue
            if len(self._early) == EARLY_SAMPLES:
                self.counts['samples lost before person and task'] += 1
            self._early.append(sample)

    def _feed_early(self) -> Iterator[Tracked]:
        while self._early and (tracker := self._ready()) is not None:
            try:
                yield from self._early.popleft()(tracker)
            except LiftingError as error:
                self.report_error(str(error))

    def _ready(self) -> MotionTracker | None:
        """Return the tracker of this recording, made when person and task are known."""
        if self.tracker is None and self._subject is not None and self._task is not None:
            subject, marker_set = self._subject
            self.tracker = tracker_from(
                self.values,
                subject,
                marker_set,
                *self._task,
                first_lift=self.lifts + 1,
                session=self.session,
                clock=self.clock,
                settings=self._settings,
            )
            self.log.info(
                f'{subject.pseudonym}: {len(self.tracker.model.names)} markers, '
                f'{self.tracker.model_source}'
            )
            if self.tracker.inverse_kinematics.unobservable:
                names = ', '.join(self.tracker.inverse_kinematics.unobservable)
                self.log.warning(f'no marker sees {names}: they stay at neutral')
        return self.tracker

    def _end_recording(self) -> Iterator[Tracked]:
        """Process the frames that wait and drop the tracker; the next sample makes a new one."""
        if self.tracker is not None:
            yield from self.tracker.flush()
            self._report_counts()
            self.lifts = self.tracker.lifts
            self.tracker = None

    def _report_counts(self) -> None:
        if self.tracker is None:
            return
        for kind, number in (self.tracker.counts + self._segmenter.counts).items():
            if number > self.counts[kind]:
                self.report_error(f'{kind}: {number - self.counts[kind]}')
                self.counts[kind] = number

    def _messages(self, output: Tracked) -> Iterator[Output]:
        match output:
            case TrackedFrame():
                # First the input of the next node of the chain.
                yield 'body_motion', conversions.body_motion_to_msg(output)
                yield from self._optional_messages(output)
                if output.message and not output.solution.ok:
                    self.report_error(f'frame not good: {output.message}')
            case DetectedEvent():
                yield 'lift_event', conversions.event_to_msg(output)
                self.log.info(
                    f'{output.lift_id} {output.event.phase.name.lower()} at '
                    f'{output.event.time:.3f} s from the {output.detected_from}'
                )
            case MeasuredLift():
                assert self._subject is not None  # A tracker exists only with a person.
                lift = conversions.measured_lift_to_msg(output, self._subject[0])
                yield 'measured_lift', lift
                self.log.info(f'{output.lift.lift_id}: {output.lift.report.message}')
            case _ if output.information:
                self.log.info(output.text)
            case _:
                self.log.warning(output.text)

    def _optional_messages(self, frame: TrackedFrame) -> Iterator[Output]:
        """Yield the messages of a frame that no other node needs, if they have subscribers."""
        if self.has_subscribers('joint_states'):
            yield 'joint_states', conversions.joint_state_to_msg(frame)
        if self.has_subscribers('ground_reaction/wrench'):
            reaction = conversions.ground_reaction_to_msg(frame)
            if reaction is not None:
                yield 'ground_reaction/wrench', reaction
        for side, topic in _COP:
            if self.has_subscribers(topic):
                point = conversions.cop_to_msg(frame, side)
                if point is not None:
                    yield topic, point


#: Topics of the centre of pressure, by side; None: both feet.
_COP: Final[tuple[tuple[int | None, str], ...]] = (
    (None, 'ground_reaction/cop'),
    *((k, f'force_plates/{side}/cop') for k, side in enumerate(SIDES)),
)


def _block(side: str, stamps: list[float], samples: Array) -> Sample:
    return lambda tracker: tracker.push_wrenches(side, stamps, samples)
