# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The visualization in the graph: motion and loads in, markers, /tf and URDF out."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from human_model.typing import Array
from lifting_messages import Message, make, message_type
from lifting_messages.conversions import (
    LABORATORY,
    lift_from_msg,
    motion_from_msg,
    quality_from_msg,
    subject_from_msg,
)
from lifting_messages.stamps import to_stamp
from lifting_messages.station import Output, Station
from lifting_visualization import conversions, topics
from lifting_visualization.core.drawing import SpineScale
from lifting_visualization.core.shapes import Shape
from lifting_visualization.core.spine_loads import SpineLoads
from lifting_visualization.core.visualizer import Options, Visualizer

#: Value of the parameter frame_prefix that means the namespace.
STATION_NAME: Final = 'station'

_SPINE_LOAD = message_type('SpineLoad')


class VisualizerStation(Station):
    """Draws the person, the loads and the predicted lift.

    Parameters
    ----------
    values, name, log, clock
        See `Station`; `clock` is that of the machine by default.

    Attributes
    ----------
    visualizer : Visualizer
    """

    PACKAGE = 'lifting_visualization'
    INPUTS = topics.INPUTS
    OUTPUTS = topics.OUTPUTS

    def prepare(self) -> None:
        """Create the pipeline and the functions of the inputs."""
        self.handlers = {
            'subject': self._on_subject,
            'task': self._on_task,
            'box/pose': self._on_box,
            'body_motion': self._on_body_motion,
            'spine_load': self._on_spine_load,
            'measured_lift': self._on_measured_lift,
            'predicted_lift': self._on_predicted_lift,
        }
        self.visualizer = Visualizer(
            Options(
                rate=self.values['rate'],
                force_length=self.values['force_length'],
                compression=SpineScale(
                    self.values['compression_action'],
                    self.values['compression_maximum'],
                    self.values['compression_length'],
                ),
                fresh=self.values['fresh'],
                pause=self.values['pause'],
                prefix=self._prefix(),
            )
        )
        self._time = self.clock or time.monotonic
        self._transforms: bool = self.values['transforms']
        # Last stamp of live motion and its arrival by the clock of the machine.
        self._last = (0.0, self._time())
        self._shown = 0.0

    def start(self) -> Iterator[Output]:
        """Yield the messages of the person."""
        links = self.visualizer.links
        if links is None:
            return
        now = self._now()
        yield 'visualization', conversions.clear_msg(now)
        yield 'robot_description', make('std_msgs/String', data=self.visualizer.urdf)
        if self._transforms:
            yield '/tf_static', conversions.fixed_to_msg(links, now)

    def ghost(self) -> Iterator[Output]:
        """Yield the next picture of the predicted lift, which is shown again and again."""
        if self.visualizer.ghost is not None:
            elapsed = self._time() - self._shown
            yield from self._draw(self.visualizer.ghost_picture(elapsed), self._now())

    def _prefix(self) -> str:
        if self.values['frame_prefix'] != STATION_NAME:
            return str(self.values['frame_prefix'])
        return f'{self.name}/' if self.name else ''

    def _on_subject(self, message: Message) -> Iterator[Output]:
        if self.visualizer.set_subject(subject_from_msg(message)):
            yield from self.start()

    def _on_task(self, message: Message) -> Iterator[Output]:
        self.visualizer.set_box_size(message.box_size)
        return iter(())

    def _on_box(self, message: Message) -> Iterator[Output]:
        turn = message.pose.orientation
        self.visualizer.set_box_orientation((turn.x, turn.y, turn.z, turn.w))
        return iter(())

    def _on_body_motion(self, message: Message) -> Iterator[Output]:
        motion = motion_from_msg(message)
        status = int(quality_from_msg(message).status[-1])
        self._last = (float(motion.time[-1]), self._time())
        stamp, links = message.header.stamp, self.visualizer.links
        if self._transforms and links is not None and status == 0:
            places = self.visualizer.transforms(motion)
            if places is not None:
                yield _frames(links.parents, links.children, stamp, places)
        yield from self._draw(self.visualizer.picture(motion, status), stamp)

    def _on_spine_load(self, message: Message) -> Iterator[Output]:
        loads = conversions.loads_from_msg(message)
        if message.source == _SPINE_LOAD.LIVE:
            yield from self._move_disc(message.header, loads)
            yield from self._draw(self.visualizer.load_picture(loads), message.header.stamp)
        elif message.source == _SPINE_LOAD.PREDICTED:
            self.visualizer.set_predicted_load(message.lift_id, loads)

    def _move_disc(self, header: Message, loads: SpineLoads) -> Iterator[Output]:
        """Yield the pose of the disc's frame, under the name in the header of the loads."""
        place = np.concatenate([loads.position[-1], loads.orientation[-1]])
        if self._transforms and np.isfinite(place).all():
            yield _frames([LABORATORY], [header.frame_id], header.stamp, place[None])

    def _on_measured_lift(self, message: Message) -> Iterator[Output]:
        return self._draw(self.visualizer.set_measured(lift_from_msg(message)), self._now())

    def _on_predicted_lift(self, message: Message) -> Iterator[Output]:
        motion = motion_from_msg(message.motion) if message.report.status == 0 else None
        self._shown = self._time()
        shapes = self.visualizer.set_predicted(message.lift_id, motion, message.box_mass)
        return self._draw(shapes, self._now())

    def _draw(self, shapes: list[Shape], stamp: Message) -> Iterator[Output]:
        if shapes:
            yield 'visualization', conversions.markers_to_msg(shapes, stamp)

    def _now(self) -> Message:
        """Return the time of the data: the last live stamp plus the time passed since."""
        stamp, came = self._last
        return to_stamp(stamp + self._time() - came if stamp else 0.0)


def _frames(
    parents: Sequence[str], children: Sequence[str], stamp: Message, places: Array
) -> Output:
    return '/tf', conversions.transforms_to_msg(parents, children, stamp, places)
