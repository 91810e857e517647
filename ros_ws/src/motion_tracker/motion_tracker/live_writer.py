# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Live samples straight as serialised messages.

From sample to sample only stamp and numbers change: they are written into the bytes of the first
message. Building a message object and serialising it would take longer than the inverse
kinematics of its frame.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from geometry_msgs.msg import PointStamped, WrenchStamped
from lifting_interfaces.msg import BodyMotion
from sensor_msgs.msg import JointState

from human_model.report import SolveStatus
from lifting_messages import encode
from lifting_messages.stamps import to_stamp
from lifting_node.cdr import HEAD
from lifting_node.message_view import MessageView
from motion_tracker import conversions
from motion_tracker.core.tracked import TrackedFrame

_TYPES: Final = {
    'lifting_interfaces/msg/BodyMotion': BodyMotion,
    'sensor_msgs/msg/JointState': JointState,
    'geometry_msgs/msg/WrenchStamped': WrenchStamped,
    'geometry_msgs/msg/PointStamped': PointStamped,
}

#: Arrays of a body motion's message, and the fields they are taken from.
_MOTION: Final = {
    'position': 'position',
    'velocity': 'velocity',
    'acceleration': 'acceleration',
    'points': 'points',
    'frames': 'frames',
    'ground_force': 'ground_force',
    'centre_of_pressure': 'centre_of_pressure',
    'free_moment': 'free_moment',
    'hand_force': 'hand_force',
    'box_position': 'box_position',
}


class _Template:
    """Bytes of a message that begins with a header; its numbers are arrays in these bytes.

    Attributes
    ----------
    view
        The message's fields; sequences of numbers can be written to.
    """

    def __init__(self, message: Any) -> None:
        data, reader = encode(message), MessageView(_TYPES[message.__msgtype__])
        # Without the head doubles lie where the processor wants them.
        self._head, self._octets = data[:HEAD], bytearray(data[HEAD:])
        self._stamp = np.frombuffer(self._octets, '<i4', 2)
        # NumPy views of the bytearray, which can be written to.
        octets: Any = self._octets
        self.view = reader.read_at(octets, 0)[0]

    def last(self, count: int) -> npt.NDArray[np.float64]:
        """Return the last doubles of the message, as an array that can be written to."""
        return np.frombuffer(self._octets, '<f8', count, len(self._octets) - 8 * count)

    def stamped(self, time: float) -> bytes:
        """Return the message with the stamp ``time`` [s]."""
        stamp = to_stamp(time)
        self._stamp[0], self._stamp[1] = stamp.sec, stamp.nanosec
        return self._head + self._octets


class LiveWriter:
    """Writes the messages of one recording's live samples.

    Each is what `conversions` makes of the sample, serialised.
    """

    def __init__(self) -> None:
        self._templates: dict[str, tuple[Any, _Template, Any]] = {}

    def body_motion(self, frame: TrackedFrame) -> bytes:
        """Return a `BodyMotion`."""
        motion, solution = frame.motion, frame.solution
        template, arrays = self._template(
            'body_motion',
            (motion.coordinates, frame.filter_delay),
            lambda: conversions.body_motion_to_msg(frame),
            lambda made: [(getattr(made.view, to), of) for to, of in _MOTION.items()],
        )
        for array, field in arrays:
            array[:] = getattr(motion, field).reshape(-1)
        view = template.view
        view.status[0] = int(frame.status)
        view.marker_rms[0], view.marker_max[0] = solution.rms, solution.maximum
        return template.stamped(float(motion.time[0]))

    def joint_state(self, frame: TrackedFrame) -> bytes:
        """Return a `JointState`."""
        motion = frame.motion
        template, _ = self._template(
            'joint_state', motion.coordinates, lambda: conversions.joint_state_to_msg(frame)
        )
        template.view.position[:] = motion.position[0]
        template.view.velocity[:] = motion.velocity[0]
        return template.stamped(float(motion.time[0]))

    def ground_reaction(self, frame: TrackedFrame) -> bytes | None:
        """Return a `WrenchStamped`; None without plates."""
        if frame.status == SolveStatus.TRACKER_NO_GROUND_FORCE:
            return None
        template, numbers = self._template(
            'ground_reaction',
            None,
            lambda: conversions.ground_reaction_to_msg(frame),
            lambda made: made.last(6),
        )
        numbers[:3] = frame.total_force
        return template.stamped(float(frame.motion.time[0]))

    def cop(self, frame: TrackedFrame, side: int | None = None) -> bytes | None:
        """Return a `PointStamped` of the right (0), left (1) or both feet (None).

        None while unloaded.
        """
        at = (
            frame.total_centre_of_pressure
            if side is None
            else frame.motion.centre_of_pressure[0, side]
        )
        if not math.isfinite(at.sum()):
            return None
        template, numbers = self._template(
            'cop',
            None,
            lambda: conversions.cop_to_msg(frame, side),
            lambda made: made.last(3),
        )
        numbers[:] = at
        return template.stamped(float(frame.motion.time[0]))

    def _template(
        self,
        kind: str,
        layout: Any,
        message: Callable[[], Any],
        arrays: Callable[[_Template], Any] = lambda _: None,
    ) -> tuple[_Template, Any]:
        """Return the template of a kind of message, and its arrays; made anew with its layout."""
        known = self._templates.get(kind)
        if known is None or known[0] != layout:
            made = _Template(message())
            known = self._templates[kind] = layout, made, arrays(made)
        return known[1], known[2]
