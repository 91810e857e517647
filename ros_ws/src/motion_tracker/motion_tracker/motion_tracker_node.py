# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node round the motion tracker: markers, plates and box in, motion and lifts out."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped
from lifting_interfaces.msg import (
    BodyMotion,
    LiftEvent,
    Markers,
    MeasuredLift,
    Task,
    WrenchBlock,
)
from lifting_interfaces.msg import Subject as SubjectMsg
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from human_model.constants import SIDES
from human_model.exceptions import HumanModelError
from human_model.subject import Subject
from human_model.typing import Array
from lifting_messages import LiftingMessagesError, Message, encode
from lifting_messages.conversions import subject_from_msg
from lifting_messages.plate_blocks import block_samples
from lifting_node import qos
from lifting_node.pipeline_node import PipelineNode
from lifting_node.run import run_node
from motion_tracker import conversions, inputs
from motion_tracker.core.configuration import tracker_from
from motion_tracker.core.exceptions import MotionTrackerError
from motion_tracker.core.recording_segmenter import RecordingSegmenter
from motion_tracker.core.tracked import DetectedEvent, Notice, Output, TrackedFrame
from motion_tracker.core.tracked import MeasuredLift as TrackedLift
from motion_tracker.core.tracker import MotionTracker
from motion_tracker.core.warm_up import warm_up

#: Samples kept until person and task are known: 20 s of two 2500 Hz plates.
EARLY_SAMPLES: Final = 100_000

#: Topics of the input streams.
STREAMS: Final = {
    'markers': 'markers',
    'box': 'box/pose',
    **{side: f'force_plates/{side}/wrench' for side in SIDES},
}
#: Topics of the plates' samples in blocks.
BLOCKS: Final = {side: f'force_plates/{side}/wrench_block' for side in SIDES}

#: Marker frames between two reports of refused input.
COUNT_FRAMES: Final = 500

Feed = Callable[[MotionTracker], list[Output]]


class MotionTrackerNode(PipelineNode):
    """Tracks the person at one station; the namespace is the station."""

    PACKAGE = 'motion_tracker'
    INPUT_ERRORS = (MotionTrackerError, HumanModelError, LiftingMessagesError)
    LATER = ('scipy.signal', 'scipy.interpolate')

    def build(self) -> None:
        """Load the compiled functions; create publishers, subscriptions and the flush service."""
        warm_up()
        self._subject: tuple[Subject, str] | None = None
        self._task: tuple[float, npt.NDArray[np.float64]] | None = None
        self._tracker: MotionTracker | None = None
        self._early: deque[Feed] = deque(maxlen=EARLY_SAMPLES)
        self._segmenter: RecordingSegmenter[Feed] = RecordingSegmenter()
        self._recording = 0
        self._lifts = 0
        self._frames = 0
        self._joints = self.advertise(JointState, 'joint_states', qos.FRAMES)
        self._motion = self.advertise(BodyMotion, 'body_motion', qos.FRAMES)
        self._events = self.advertise(LiftEvent, 'lift_event', qos.RESULTS)
        self._measured = self.advertise(MeasuredLift, 'measured_lift', qos.RESULTS)
        self._reaction = self.advertise(WrenchStamped, 'ground_reaction/wrench', qos.FRAMES)
        self._total_cop = self.advertise(PointStamped, 'ground_reaction/cop', qos.FRAMES)
        self._cop = [
            self.advertise(PointStamped, f'force_plates/{side}/cop', qos.FRAMES) for side in SIDES
        ]
        self.subscribe(SubjectMsg, 'subject', self._on_subject, qos.LATCHED)
        self.subscribe(Task, 'task', self._on_task, qos.LATCHED)
        self.subscribe(Markers, STREAMS['markers'], self._on_markers, qos.FRAMES)
        self.subscribe(PoseStamped, STREAMS['box'], self._on_box, qos.FRAMES)
        for side in SIDES:
            self.subscribe(
                WrenchStamped, STREAMS[side], partial(self._on_wrench, side), qos.PLATES
            )
            self.subscribe(WrenchBlock, BLOCKS[side], partial(self._on_block, side), qos.PLATES)
        self._flush_service = self.create_service(Trigger, '~/flush', self._on_flush)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the service with the rest."""
        self.destroy_service(self._flush_service)
        return super().on_cleanup(state)

    def _on_subject(self, message: SubjectMsg) -> None:
        subject = subject_from_msg(message)
        known = self._subject
        if (
            known is not None
            and known[0].to_dict() == subject.to_dict()
            and known[1] == message.marker_set
        ):
            return
        self._end_recording()
        self._subject = (subject, message.marker_set)
        self._work_off_early()

    def _on_task(self, message: Task) -> None:
        task = inputs.task_from_msg(message)
        if (
            self._task is not None
            and self._task[0] == task[0]
            and np.array_equal(self._task[1], task[1])
        ):
            return
        self._end_recording()
        self._task = task
        self._work_off_early()

    def _on_markers(self, message: Message) -> None:
        stamp, names, positions = inputs.markers_from_msg(message)
        self._frames += 1
        if self._frames % COUNT_FRAMES == 0:
            self._report_counts()
        self._take('markers', stamp, lambda tracker: tracker.push_markers(stamp, names, positions))

    def _on_box(self, message: Message) -> None:
        stamp, position = inputs.box_from_msg(message)
        self._take('box', stamp, lambda tracker: tracker.push_box(stamp, position))

    def _on_wrench(self, side: str, message: Message) -> None:
        stamp, force, moment = inputs.wrench_from_msg(message)
        self._take(side, stamp, lambda tracker: tracker.push_wrench(side, stamp, force, moment))

    def _on_block(self, side: str, message: Message) -> None:
        stamps, samples = block_samples(message)
        if all(before < after for before, after in pairwise(stamps)):
            self._take(side, stamps[0], _block_feed(side, stamps, samples))
            return
        for k, stamp in enumerate(stamps):
            self._take(side, stamp, _block_feed(side, [stamp], samples[k : k + 1]))

    def _take(self, stream: str, stamp: float, feed: Feed) -> None:
        """Feed one sample to the tracker of its recording."""
        if not self.active:
            self.counts['samples while not active'] += 1
            return
        if self._segmenter.idle:
            self._segmenter.expect(
                name
                for name, topic in (*STREAMS.items(), *BLOCKS.items())
                if self.count_publishers(topic)
            )
        self._feed(self._segmenter.push(stream, stamp, feed))

    def _feed(self, samples: Sequence[tuple[int, Feed]]) -> None:
        """Feed samples, or keep them until person and task are known."""
        for recording, feed in samples:
            if recording != self._recording:
                self.get_logger().info('stamps went back: another recording begins')
                self._end_recording()
                self._recording = recording
            tracker = self._ready()
            if tracker is not None:
                self._publish(feed(tracker))
                continue
            if len(self._early) == EARLY_SAMPLES:
                self.counts['samples lost before person and task'] += 1
            self._early.append(feed)

    def _ready(self) -> MotionTracker | None:
        """Tracker of this recording, made when person and task are known."""
        if self._tracker is None and self._subject is not None and self._task is not None:
            subject, marker_set = self._subject
            self._tracker = tracker_from(
                self.values,
                subject,
                marker_set,
                *self._task,
                first_lift=self._lifts + 1,
                clock=time.monotonic,
            )
            self.get_logger().info(
                f'{subject.pseudonym}: {len(self._tracker.model.names)} markers, '
                f'{self._tracker.model_source}'
            )
            if self._tracker.inverse_kinematics.unobservable:
                self.get_logger().warning(
                    'no marker sees '
                    + ', '.join(self._tracker.inverse_kinematics.unobservable)
                    + ': they stay at neutral'
                )
        return self._tracker

    def _work_off_early(self) -> None:
        tracker = self._ready()
        while tracker is not None and self._early:
            try:
                self._publish(self._early.popleft()(tracker))
            except self.INPUT_ERRORS as error:
                self.report_error(str(error))

    def _end_recording(self) -> None:
        """Work off what waits and forget the tracker; the next sample makes a new one."""
        if self._tracker is not None:
            self._publish(self._tracker.flush())
            self._report_counts()
            self._lifts = self._tracker.lifts
            self._tracker = None

    def _on_flush(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """End of the recording: nothing more will come."""
        begun = self._tracker is not None
        before = self._lifts
        self._feed(self._segmenter.end())
        self._end_recording()
        self._recording = self._segmenter.current
        response.success = begun
        response.message = (
            f'{self._lifts - before} lifts'
            if begun
            else 'no recording under way: neither person, task nor samples came'
        )
        return response

    def _report_counts(self) -> None:
        if self._tracker is None:
            return
        for kind, number in self._tracker.counts.items():
            if number > self.counts[kind]:
                self.report_error(f'{kind}: {number - self.counts[kind]}')
                self.counts[kind] = number

    def _publish(self, outputs: Sequence[Output]) -> None:
        for output in outputs:
            self._publish_one(output)

    def _publish_one(self, output: Any) -> None:
        if isinstance(output, TrackedFrame):
            # First what the next node of the chain waits for.
            self._motion.publish(encode(conversions.body_motion_to_msg(output)))
            self._publish_beside(output)
            if output.message and not output.solution.ok:
                self.report_error(f'frame not good: {output.message}')
        elif isinstance(output, DetectedEvent):
            self._events.publish(encode(conversions.event_to_msg(output)))
            self.get_logger().info(
                f'{output.lift_id} {output.event.phase.name.lower()} at '
                f'{output.event.time:.3f} s from the {output.detected_from}'
            )
        elif isinstance(output, TrackedLift) and self._subject is not None:
            lift = conversions.measured_lift_to_msg(output, self._subject[0])
            self._measured.publish(encode(lift))
            self.get_logger().info(f'{output.lift.lift_id}: {output.lift.report.message}')
        elif isinstance(output, Notice) and output.information:
            self.get_logger().info(output.text)
        elif isinstance(output, Notice):
            self.get_logger().warning(output.text)

    def _publish_beside(self, frame: TrackedFrame) -> None:
        """Publish of a frame what no other node needs, where somebody listens."""
        if self._joints.get_subscription_count():
            self._joints.publish(encode(conversions.joint_state_to_msg(frame)))
        if self._reaction.get_subscription_count():
            reaction = conversions.ground_reaction_to_msg(frame)
            if reaction is not None:
                self._reaction.publish(encode(reaction))
        for side, publisher in ((None, self._total_cop), *enumerate(self._cop)):
            if publisher.get_subscription_count():
                point = conversions.cop_to_msg(frame, side)
                if point is not None:
                    publisher.publish(encode(point))


def _block_feed(side: str, stamps: list[float], samples: Array) -> Feed:
    return lambda tracker: tracker.push_wrenches(side, stamps, samples)


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    run_node(MotionTrackerNode, args)


if __name__ == '__main__':
    main()
