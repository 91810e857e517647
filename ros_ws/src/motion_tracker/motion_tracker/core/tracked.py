# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Outputs and settings of the tracker."""

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from human_model.motion import BodyMotion, Lift
from human_model.report import SolveStatus
from human_model.typing import Array
from motion_tracker.core.exceptions import TrackerError
from motion_tracker.core.filters import MOTION_CUTOFF, PLATE_CUTOFF
from motion_tracker.core.forces.box_watch import BoxPlace
from motion_tracker.core.forces.force_plates import total_centre_of_pressure
from motion_tracker.core.forces.hand_force import HandForceSettings
from motion_tracker.core.inverse_kinematics.solution import IKSettings, IKSolution
from motion_tracker.core.lifts.lift_events import LiftEvent, LiftEventSettings

FROM_BOX = 'box'
FROM_HANDS = 'hands'


@dataclass(frozen=True)
class TrackerSettings:
    """Settings of the tracker.

    Attributes
    ----------
    motion_cutoff, plate_cutoff : float
        Of the Butterworth filters [Hz] (thesis section 3.4).
    force_threshold : float
        Vertical force below which a foot counts as off its plate [N]. A setting of this project:
        well above the noise of a plate, well below the weight of a foot.
    wait : float
        How long the markers wait for a plate or the box, by the clock of this machine and while
        they come themselves, before they go on without it [s].
    longest_gap : float
        Longest stretch of lost or bad frames that is bridged by interpolation [s].
    margin : float
        Time before and after a lift that takes part in its zero-phase filters [s].
    mass_tolerance : float
        Accepted relative deviation of the plates from the masses of subject and carried box.
    ik, events, hand_force
        Settings of the parts.
    """

    motion_cutoff: float = MOTION_CUTOFF
    plate_cutoff: float = PLATE_CUTOFF
    force_threshold: float = 20.0
    wait: float = 2.0
    longest_gap: float = 0.1
    margin: float = 0.5
    mass_tolerance: float = 0.05
    ik: IKSettings = field(default_factory=IKSettings)
    events: LiftEventSettings = field(default_factory=LiftEventSettings)
    hand_force: HandForceSettings = field(default_factory=HandForceSettings)

    def __post_init__(self) -> None:
        """Check that every number is positive."""
        for name in (
            'motion_cutoff',
            'plate_cutoff',
            'force_threshold',
            'wait',
            'longest_gap',
            'margin',
            'mass_tolerance',
        ):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise TrackerError(f'tracker.{name}: must be positive, got {value}')


@dataclass(frozen=True, eq=False)
class TrackedFrame:
    """One live sample.

    Attributes
    ----------
    motion : BodyMotion
        One sample; its time is the stamp of the marker frame minus the filter delay.
    solution : IKSolution
        Of the marker frame the sample was completed by.
    status : SolveStatus
    message : str
    filter_delay : float
        Time the sample left the tracker after it was taken [s].
    """

    motion: BodyMotion
    solution: IKSolution
    status: SolveStatus
    message: str
    filter_delay: float

    @property
    def total_force(self) -> Array:
        """Ground reaction of both feet (3,) [N]."""
        return np.asarray(self.motion.ground_force[0].sum(axis=0))

    @property
    def total_centre_of_pressure(self) -> Array:
        """Centre of pressure of both feet (3,) [m]; NaN while neither is loaded."""
        return np.asarray(
            total_centre_of_pressure(self.motion.ground_force, self.motion.centre_of_pressure)[0]
        )


@dataclass(frozen=True)
class DetectedEvent:
    """Start or end of a lift, with the lift's name and what it was detected from."""

    event: LiftEvent
    lift_id: str
    detected_from: str


@dataclass(frozen=True, eq=False)
class MeasuredLift:
    """A whole lift, zero-phase filtered.

    Attributes
    ----------
    lift : Lift
    status : ndarray of int (n,)
        Per sample.
    marker_rms, marker_max : ndarray (n,)
        Per sample [m]; NaN where the frame was lost and bridged.
    """

    lift: Lift
    status: npt.NDArray[np.int64]
    marker_rms: Array
    marker_max: Array


@dataclass(frozen=True)
class Notice:
    """Notice to the user: text, and whether it is information only."""

    text: str
    information: bool = False


Output = TrackedFrame | DetectedEvent | MeasuredLift | Notice


@dataclass(frozen=True, eq=False)
class FrameRecord:
    """Stored result of one marker frame, for the lift that it may belong to.

    Attributes
    ----------
    stamp : float
        [s].
    solution : IKSolution
    box : BoxPlace or None
        Place of the box; None without one.
    """

    stamp: float
    solution: IKSolution
    box: BoxPlace | None = None
