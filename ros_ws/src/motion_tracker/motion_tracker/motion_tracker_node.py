# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node round the motion tracker: markers and plates in, body motion and lifts out."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any, Final

from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped
from lifting_interfaces.msg import BodyMotion, LiftEvent, Markers, MeasuredLift, Subject, Task
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from human_model.errors import HumanModelError
from lifting_node import qos
from lifting_node.pipeline_node import PipelineNode
from lifting_node.run import run_node
from motion_tracker import conversions
from motion_tracker.core import tracked
from motion_tracker.core.errors import MotionTrackerError
from motion_tracker.core.force_plates import SIDES
from motion_tracker.core.tracker import MotionTracker

WAITING: Final = 100_000
"""Input messages kept until subject and task are known."""

Step = Callable[[MotionTracker], list[tracked.Output]]


class MotionTrackerNode(PipelineNode):
    """Tracks the person at one station; the namespace is the station."""

    PACKAGE = 'motion_tracker'
    INPUT_ERRORS = (MotionTrackerError, HumanModelError)

    def build(self) -> None:
        """Create publishers and subscriptions; the tracker comes with subject and task."""
        self._subject: Subject | None = None
        self._task: Task | None = None
        self._tracker: MotionTracker | None = None
        self._waiting: deque[Step] = deque(maxlen=WAITING)
        self._motion = self.advertise(BodyMotion, 'body_motion', qos.FRAMES)
        self._joints = self.advertise(JointState, 'joint_states', qos.FRAMES)
        self._total = self.advertise(WrenchStamped, 'ground_reaction/wrench', qos.FRAMES)
        self._total_cop = self.advertise(PointStamped, 'ground_reaction/cop', qos.FRAMES)
        self._cops = [
            self.advertise(PointStamped, f'force_plates/{side}/cop', qos.FRAMES) for side in SIDES
        ]
        self._events = self.advertise(LiftEvent, 'lift_event', qos.RESULTS)
        self._lifts = self.advertise(MeasuredLift, 'measured_lift', qos.RESULTS)
        self.subscribe(Subject, 'subject', self._on_subject, qos.LATCHED)
        self.subscribe(Task, 'task', self._on_task, qos.LATCHED)
        self.subscribe(Markers, 'markers', self._on_markers, qos.FRAMES)
        self.subscribe(PoseStamped, 'box/pose', self._on_box, qos.FRAMES)
        for side in SIDES:
            topic = f'force_plates/{side}/wrench'
            self.subscribe(
                WrenchStamped, topic, partial(self._on_wrench, side), qos.PLATES, raw=True
            )
        self._flush = self.create_service(Trigger, '~/flush', self._on_flush)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the service with the rest."""
        self.destroy_service(self._flush)
        return super().on_cleanup(state)

    def _on_subject(self, message: Subject) -> None:
        self._subject = message
        self._begin()

    def _on_task(self, message: Task) -> None:
        self._task = message
        self._begin()

    def _begin(self) -> None:
        """Begin a recording: a new tracker, fed with what has waited for it."""
        if self._subject is None or self._task is None:
            return
        if self._tracker is not None:
            self._publish(self._tracker.flush())
        self._tracker = conversions.tracker_for(self._subject, self._task, self.values)
        self.get_logger().info(f'marker model: {self._tracker.model_source}')
        while self._waiting:
            self._feed(self._waiting.popleft())

    def _feed(self, step: Step) -> None:
        if self._tracker is None:
            self._waiting.append(step)
            return
        self._publish(step(self._tracker))

    def _on_markers(self, message: Markers) -> None:
        stamp, names, positions = conversions.markers_from_msg(message)
        self._feed(lambda tracker: tracker.push_markers(stamp, names, positions))

    def _on_wrench(self, side: str, data: bytes) -> None:
        stamp, force, moment = conversions.wrench_from_cdr(data)
        self._feed(lambda tracker: tracker.push_wrench(side, stamp, force, moment))

    def _on_box(self, message: PoseStamped) -> None:
        stamp, position = conversions.box_from_msg(message)
        self._feed(lambda tracker: tracker.push_box(stamp, position))

    def _on_flush(self, request: Trigger.Request, response: Trigger.Response) -> Any:
        response.success = self._tracker is not None
        if self._tracker is None:
            response.message = 'nothing was tracked: no subject and task came'
            return response
        self._publish(self._tracker.flush())
        lost = {name: count for name, count in self._tracker.counts.items() if count}
        response.message = ', '.join(f'{name}: {count}' for name, count in lost.items())
        return response

    def _publish(self, outputs: list[tracked.Output]) -> None:
        if not self.active:
            self.counts['outputs while not active'] += len(outputs)
            return
        for output in outputs:
            match output:
                case tracked.TrackedFrame():
                    self._publish_frame(output)
                case tracked.DetectedEvent():
                    self._events.publish(conversions.event_to_msg(output))
                case tracked.MeasuredLift():
                    assert self._tracker is not None
                    self._lifts.publish(
                        conversions.measured_to_msg(output, self._tracker.subject)
                    )
                case tracked.Notice(information=True):
                    self.get_logger().info(output.text)
                case tracked.Notice():
                    self.report_error(output.text)

    def _publish_frame(self, frame: tracked.TrackedFrame) -> None:
        self.counts['frames'] += 1
        if frame.status != 0:
            self.counts[f'frames: {frame.status.name}'] += 1
        self._motion.publish(conversions.frame_to_msg(frame))
        self._joints.publish(conversions.frame_to_joint_state(frame))
        self._total.publish(conversions.total_to_msg(frame))
        time = float(frame.motion.time[0])
        cops = (frame.total_cop, *frame.motion.cop[0])
        for publisher, cop in zip((self._total_cop, *self._cops), cops, strict=True):
            message = conversions.point_to_msg(time, cop)
            if message is not None:
                publisher.publish(message)


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    run_node(MotionTrackerNode, args)


if __name__ == '__main__':
    main()
