# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node round the visualizer: motion and loads in, markers, /tf and URDF out."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from geometry_msgs.msg import PoseStamped
from lifting_interfaces.msg import BodyMotion, MeasuredLift, PredictedLift, SpineLoad, Task
from lifting_interfaces.msg import Subject as SubjectMsg
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from human_model.exceptions import HumanModelError
from human_model.typing import Array
from lifting_messages import Message, encode
from lifting_messages.conversions import (
    LABORATORY,
    lift_from_msg,
    motion_from_msg,
    quality_from_msg,
    subject_from_msg,
)
from lifting_messages.stamps import to_stamp
from lifting_node import qos
from lifting_node.pipeline_node import PipelineNode
from lifting_node.run import run_node
from lifting_visualization import conversions
from lifting_visualization.core.drawing import SpineScale
from lifting_visualization.core.exceptions import LiftingVisualizationError
from lifting_visualization.core.shapes import Shape
from lifting_visualization.core.spine_loads import SpineLoads
from lifting_visualization.core.visualizer import Options, Visualizer

#: Value of the parameter frame_prefix that means the namespace.
STATION = 'station'


class LiftingVisualizationNode(PipelineNode):
    """Pictures of one station; the namespace is the station."""

    PACKAGE = 'lifting_visualization'
    INPUT_ERRORS = (LiftingVisualizationError, HumanModelError)

    def build(self) -> None:
        """Create the visualizer, its publishers and subscriptions."""
        values = self.values
        self.visualizer = Visualizer(
            Options(
                rate=values['rate'],
                force_length=values['force_length'],
                compression=SpineScale(
                    values['compression_action'],
                    values['compression_maximum'],
                    values['compression_length'],
                ),
                fresh=values['fresh'],
                pause=values['pause'],
                prefix=self._prefix(),
            )
        )
        # Last stamp of live motion and when it came, by the data's and by the machine's clock.
        self._last = (0.0, time.monotonic())
        self._shown = 0.0
        self._markers = self.advertise(MarkerArray, 'visualization', qos.VIEW)
        self._description = self.advertise(String, 'robot_description', qos.LATCHED)
        self._moving = self.advertise(TFMessage, '/tf', qos.TRANSFORMS)
        self._fixed = self.advertise(TFMessage, '/tf_static', qos.LATCHED)
        self.subscribe(SubjectMsg, 'subject', self._on_subject, qos.LATCHED)
        self.subscribe(Task, 'task', self._on_task, qos.LATCHED)
        self.subscribe(BodyMotion, 'body_motion', self._on_body_motion, qos.FRAMES)
        self.subscribe(PoseStamped, 'box/pose', self._on_box, qos.FRAMES)
        self.subscribe(SpineLoad, 'spine_load', self._on_spine_load, qos.FRAMES)
        self.subscribe(MeasuredLift, 'measured_lift', self._on_measured_lift, qos.RESULTS)
        self.subscribe(PredictedLift, 'predicted_lift', self._on_predicted_lift, qos.RESULTS)
        self._ghost_timer = self.create_timer(1.0 / values['rate'], self._show_ghost)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start publishing, with the person that is known already."""
        result = super().on_activate(state)
        self._publish_person()
        return result

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the timer with the rest."""
        self.destroy_timer(self._ghost_timer)
        return super().on_cleanup(state)

    def _prefix(self) -> str:
        if self.values['frame_prefix'] != STATION:
            return str(self.values['frame_prefix'])
        station = self.get_namespace().strip('/')
        return f'{station}/' if station else ''

    def _on_subject(self, message: Message) -> None:
        another = self.visualizer.set_subject(subject_from_msg(message))
        if another:
            self._publish_person()

    def _publish_person(self) -> None:
        links = self.visualizer.links
        if links is None or not self.active:
            return
        now = self._now()
        self._markers.publish(encode(conversions.clear_msg(now)))
        self._description.publish(String(data=self.visualizer.urdf))
        if self.values['transforms']:
            self._fixed.publish(encode(conversions.fixed_to_msg(links, now)))

    def _on_task(self, message: Message) -> None:
        self.visualizer.set_box_size(message.box_size)

    def _on_box(self, message: Message) -> None:
        turn = message.pose.orientation
        self.visualizer.set_box_orientation((turn.x, turn.y, turn.z, turn.w))

    def _on_body_motion(self, message: Message) -> None:
        if not self.active:
            self.counts['samples while not active'] += 1
            return
        motion = motion_from_msg(message)
        status = int(quality_from_msg(message).status[-1])
        stamp = float(motion.time[-1])
        self._last = (stamp, time.monotonic())
        links = self.visualizer.links
        if self.values['transforms'] and links is not None and status == 0:
            places = self.visualizer.transforms(motion)
            if places is not None:
                self._publish_frames(links.parents, links.children, message.header.stamp, places)
        self._draw(self.visualizer.picture(motion, status), message.header.stamp)

    def _on_spine_load(self, message: Message) -> None:
        loads = conversions.loads_from_msg(message)
        if message.source == SpineLoad.LIVE:
            self._move_disc(message.header, loads)
            self._draw(self.visualizer.load_picture(loads), message.header.stamp)
        elif message.source == SpineLoad.PREDICTED:
            self.visualizer.set_predicted_load(message.lift_id, loads)

    def _move_disc(self, header: Message, loads: SpineLoads) -> None:
        """Publish where the disc's frame is, under the name that the loads have it by."""
        place = np.concatenate([loads.position[-1], loads.orientation[-1]])
        if not self.active or not self.values['transforms'] or not np.isfinite(place).all():
            return
        self._publish_frames([LABORATORY], [header.frame_id], header.stamp, place[None])

    def _publish_frames(
        self, parents: Sequence[str], children: Sequence[str], stamp: Message, places: Array
    ) -> None:
        self._moving.publish(
            encode(conversions.transforms_to_msg(parents, children, stamp, places))
        )

    def _on_measured_lift(self, message: Message) -> None:
        self._draw(self.visualizer.set_measured(lift_from_msg(message)), self._now())

    def _on_predicted_lift(self, message: Message) -> None:
        motion = motion_from_msg(message.motion) if message.report.status == 0 else None
        self._shown = time.monotonic()
        self._draw(
            self.visualizer.set_predicted(message.lift_id, motion, message.box_mass), self._now()
        )

    def _show_ghost(self) -> None:
        if self.active and self.visualizer.ghost is not None:
            elapsed = time.monotonic() - self._shown
            self._draw(self.visualizer.ghost_picture(elapsed), self._now())

    def _draw(self, shapes: list[Shape], stamp: Message) -> None:
        if shapes:
            self._markers.publish(encode(conversions.markers_to_msg(shapes, stamp)))

    def _now(self) -> Message:
        """Return the data's time: that of the last live sample and what has passed since."""
        stamp, came = self._last
        return to_stamp(stamp + time.monotonic() - came if stamp else 0.0)


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    run_node(LiftingVisualizationNode, args)


if __name__ == '__main__':
    main()
