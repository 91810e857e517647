# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The live sample of one marker frame; all its parts belong to one instant.

The instant is the stamp of the frame minus the delay of the motion filter; the plates, whose
filter is faster, are read that much earlier.
"""

from collections import Counter
from collections.abc import Mapping

import numpy as np

from human_model.constants import SIDES
from human_model.motion import POINTS
from human_model.skeleton import Skeleton
from human_model.typing import Array
from motion_tracker.core.dynamics import needed_force
from motion_tracker.core.filters import CausalFilter
from motion_tracker.core.forces.box_watch import BoxPlace
from motion_tracker.core.forces.force_plates import PlateGeometry
from motion_tracker.core.forces.hand_force import HandForceEstimator
from motion_tracker.core.forces.plate_kernel import feet
from motion_tracker.core.inverse_kinematics.solution import IKSolution
from motion_tracker.core.live_status import LiveStatus
from motion_tracker.core.streams import SampledStream
from motion_tracker.core.tracked import Notice, TrackedFrame, TrackerSettings

#: Right, then left grip centre among the shared points.
HANDS = slice(POINTS.index('hand_r'), POINTS.index('hand_l') + 1)


class LiveMotion:
    """Causal filters of one recording, and the live samples computed from them.

    Parameters
    ----------
    skeleton
        Of the person.
    rate
        Of the marker frames [Hz].
    settings
        Of the tracker.
    plates, wrenches
        Geometry, and streams of force and moment, by side.
    hand_force, status
        Of the recording; each sample updates them.
    counts
        Where lost frames are counted.
    """

    def __init__(
        self,
        skeleton: Skeleton,
        rate: float,
        settings: TrackerSettings,
        plates: Mapping[str, PlateGeometry],
        wrenches: Mapping[str, SampledStream],
        hand_force: HandForceEstimator,
        status: LiveStatus,
        counts: Counter[str],
    ) -> None:
        self._skeleton = skeleton
        self._rate = rate
        self._settings = settings
        self._rotation = np.array([plates[name].rotation for name in SIDES])
        self._origin = np.array([plates[name].origin for name in SIDES])
        self._surface = np.array([plates[name].surface_height for name in SIDES])
        self._wrenches = [wrenches[name] for name in SIDES]
        self._hand_force = hand_force
        self._status = status
        self._counts = counts
        self._filter = CausalFilter(rate, settings.motion_cutoff, len(skeleton.coordinates))
        self._box_filter = CausalFilter(rate, settings.motion_cutoff, 3)
        self._box_late = False
        self._hands_filter = CausalFilter(rate, settings.motion_cutoff, 3)
        self._input: tuple[float, Array, tuple[Array, Array] | None] | None = None

    @property
    def delay(self) -> float:
        """Delay of the samples [s]."""
        return self._filter.delay

    def sample(
        self,
        stamp: float,
        solution: IKSolution,
        grips: Array | None,
        box: BoxPlace | None,
        lifting: bool,
        end_known: float | None,
    ) -> tuple[TrackedFrame, list[Notice]]:
        """Return the sample that a marker frame completes, and notices about the masses.

        Parameters
        ----------
        stamp, solution
            Of the marker frame [s].
        grips
            Grip centres (2, 3) of the frame [m]; None if nothing is lifted.
        box
            Place of the box at the stamp; None if it is not known.
        lifting, end_known
            Whether a lift is under way, and the stamp at which the end of the last one was known.
        """
        (q, qd, qdd), box_motion = self._filtered(stamp, solution.q, grips, box)
        time = stamp - self.delay
        forces, silent = self._ground(time)
        places = self._skeleton.points_and_frames(q)
        hands = places[0][0, HANDS]
        notices: list[Notice] = []
        missing = None
        if not silent:
            right, left = forces['ground_force'][0, :, 2].tolist()
            vertical = right + left
            need = float(needed_force(self._skeleton, q, qd, qdd)[2])
            missing = need - vertical
        if box_motion is not None:
            forces |= self._hand_force_and_box(
                time, hands, box_motion, missing, self._status.settling(stamp), lifting, end_known
            )
        doubt = '' if grips is None else 'the box has not been seen'
        self._box_late |= grips is not None and box is None
        if box_motion is not None and box is not None:
            doubt = self._box_doubt(box, hands, box_motion[0], missing, forces['hand_force'][0])
        if missing is not None:
            mass = self._carried_mass(
                hands, None if box_motion is None else box_motion[0], lifting
            )
            check = self._status.weigh(stamp, vertical, need, mass, self._rate)
            if check is not None:
                notices.append(Notice(str(check), check.ok))
        motion = self._skeleton.body_motion(time, q, qd, qdd, places=places, **forces)
        status, message = self._status.judge(stamp, solution, ' and '.join(silent), doubt)
        return TrackedFrame(motion, solution, status, message, self.delay), notices

    def _filtered(
        self, stamp: float, q: Array, grips: Array | None, box: BoxPlace | None
    ) -> tuple[tuple[Array, Array, Array], tuple[Array, Array, Array] | None]:
        """Pass one frame, and the lost ones before it by interpolation, through the filters."""
        lost = 0
        if self._input is not None:
            lost = round((stamp - self._input[0]) * self._rate) - 1
        if lost > 0:
            self._counts['markers: lost frames'] += lost
        if lost > self._settings.longest_gap * self._rate + 1e-9:
            self._filter.reset()
            self._box_filter.reset()
            self._hands_filter.reset()
            self._status.settle(stamp, 'the filters settle after a gap in the markers')
            lost = 0
        places = self._places(grips, box)
        for i in range(1, lost + 1):
            share = i / (lost + 1)
            assert self._input is not None
            self._filter.step((1.0 - share) * self._input[1] + share * q)
            if places is not None and self._input[2] is not None:
                before, after = self._input[2], places
                self._hands_filter.step((1.0 - share) * before[0] + share * after[0])
                self._box_filter.step((1.0 - share) * before[1] + share * after[1])
        self._input = stamp, q, places
        motion = self._filter.step(q)
        if box is None or places is None:
            self._box_filter.reset()
            self._hands_filter.reset()
            return motion, None
        hands, place = places
        if box.jumped and box.offset is None:
            self._box_filter.reset()
        elif box.jumped and box.offset is not None:
            self._box_filter.follow(self._hands_filter, box.offset)
        self._hands_filter.step(hands)
        return motion, self._box_filter.step(place)

    @staticmethod
    def _places(grips: Array | None, box: BoxPlace | None) -> tuple[Array, Array] | None:
        """Middle of the hands and centre of the box (3,) [m]; None without a box."""
        if grips is None or box is None:
            return None
        return 0.5 * (grips[0] + grips[1]), box.position

    def _ground(self, time: float) -> tuple[dict[str, Array], list[str]]:
        """Ground reaction (1, 2, 3) if all plates have samples; else those that have none."""
        wrench = np.empty((len(SIDES), 6))
        silent = []
        for side, stream in enumerate(self._wrenches):
            row = stream.filtered_at(time)
            if row is None:
                silent.append(f'the {SIDES[side]} plate')
            else:
                wrench[side] = row
        if silent:
            return {}, silent
        force, centre_of_pressure, free = feet(
            wrench, self._rotation, self._origin, self._surface, self._settings.force_threshold
        )
        return {
            'ground_force': force,
            'centre_of_pressure': centre_of_pressure,
            'free_moment': free,
        }, silent

    def _box_doubt(
        self, box: BoxPlace, hands: Array, place: Array, missing: float | None, force: Array
    ) -> str:
        """Reason why the load of the box cannot be right; empty without doubt."""
        reason = box.doubt if box.offset is None else ''
        if not reason and self._box_late and self._hand_force.bias is None:
            reason = 'it was first seen in the hands'
        if reason and self._hand_force.gate(hands, place) > 0.0:
            return reason
        return self._hand_force.doubt(missing, force)

    def _carried_mass(self, hands: Array, box: Array | None, lifting: bool) -> float | None:
        """Mass in the hands [kg]; None while it is not known."""
        if self._hand_force.box_mass == 0.0:
            return 0.0
        if box is None:
            return None if lifting else 0.0
        return self._hand_force.carried_mass(
            hands, box, self._hand_force.support if lifting else None
        )

    def _hand_force_and_box(
        self,
        time: float,
        hands: Array,
        box: tuple[Array, Array, Array],
        missing: float | None,
        settling: bool,
        lifting: bool,
        end_known: float | None,
    ) -> dict[str, Array]:
        """Hand forces (1, 2, 3) [N] and box position (1, 3) [m] of the live sample.

        Only samples of settled filters update the bias of `missing`.
        """
        position, speed, acceleration = box
        since = None if end_known is None else time - end_known
        released = since is None or since > self._settings.hand_force.release_time
        self._hand_force.observe(
            None if settling else missing,
            hands,
            position,
            float(speed[2]),
            lifting or not released,
            1.0 / self._rate,
            self._settings.events.rest_speed,
        )
        force = self._hand_force.estimate(
            missing, hands, position, acceleration, self._hand_force.support, since
        )
        return {'hand_force': force[None], 'box_position': position[None]}
