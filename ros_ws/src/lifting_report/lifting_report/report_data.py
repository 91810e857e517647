# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Data of a report: arrays and names, without messages.

Every part of a lift may be :class:`Missing`; the page then contains the reason.
All times are seconds since the start of the lift unless said otherwise, all forces newtons.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from human_model.typing import Array, BoolArray
from lifting_report.exceptions import ReportError
from lifting_report.findings import (
    AlarmRow,
    EmgFindings,
    Lifting,
    QualityRow,
    Risk,
    SolveRow,
)

__all__ = [
    'JOINTS',
    'Activations',
    'AlarmRow',
    'BodyPoints',
    'Comparison',
    'EmgFindings',
    'GroundForces',
    'Header',
    'JointAngles',
    'LiftReport',
    'Lifting',
    'Missing',
    'Pair',
    'QualityRow',
    'ReportData',
    'Risk',
    'SolveRow',
    'SpineCurves',
    'Torques',
]

T = TypeVar('T')

#: The six joints of figures 4.10 and 4.11 of the thesis.
JOINTS = ('spine', 'shoulder', 'elbow', 'hip', 'knee', 'ankle')


@dataclass(frozen=True)
class Missing:
    """A part that is not there, and why."""

    reason: str


@dataclass(frozen=True)
class Pair(Generic[T]):
    """The same quantity of the recorded and of the optimal lift."""

    measured: T | Missing
    predicted: T | Missing

    def present(self) -> dict[str, T]:
        """Return what is there, by source."""
        return {
            source: part
            for source, part in (('measured', self.measured), ('predicted', self.predicted))
            if not isinstance(part, Missing)
        }

    def missing(self) -> dict[str, str]:
        """Return the reasons for what is not there, by source."""
        return {
            source: part.reason
            for source, part in (('measured', self.measured), ('predicted', self.predicted))
            if isinstance(part, Missing)
        }


@dataclass(frozen=True)
class Header:
    """Who lifted what, and where the data come from.

    Attributes
    ----------
    subject, sex : str
        Pseudonym; ``male`` or ``female``.
    mass, stature, age : float
        [kg], [m], [years].
    task, description, recording, source : str
    simulated : bool
        The recording was made by a simulation, not by a person.
    box_mass : float
        [kg].
    lifts_per_day, lifts_per_minute, duration_hours : float
    run : str
        How the graph ran, for example ``offline`` or ``online at 2 times real time``.
    created : str
        Date and time of the report.
    version : str
    """

    subject: str
    sex: str
    mass: float
    stature: float
    age: float
    task: str
    description: str
    recording: str
    source: str
    simulated: bool
    box_mass: float
    lifts_per_day: float
    lifts_per_minute: float
    duration_hours: float
    run: str
    created: str
    version: str


@dataclass(frozen=True)
class JointAngles:
    """Angles of the six joints; right and left are the same where the skeleton has one.

    Attributes
    ----------
    time : array (n,)
    right, left : arrays (n, 6)
        In the order of ``JOINTS`` [rad]; spine: flexion positive, the others with OpenSim's
        signs. NaN where the skeleton lacks the joint.
    """

    time: Array
    right: Array
    left: Array

    def __post_init__(self) -> None:
        """Check the shapes."""
        check(self, 'right', (len(self.time), len(JOINTS)))
        check(self, 'left', (len(self.time), len(JOINTS)))


@dataclass(frozen=True)
class Comparison:
    """Measured against predicted over normalised time (tables 2.4 and 2.5 of the thesis).

    Attributes
    ----------
    joints : tuple of str
    rmse, pearson : arrays (n_joints,)
        [deg] and r.
    vertical_rmse, vertical_pearson, horizontal_rmse, horizontal_pearson : float
        Ground reaction [N] and r.
    """

    joints: tuple[str, ...]
    rmse: Array
    pearson: Array
    vertical_rmse: float
    vertical_pearson: float
    horizontal_rmse: float
    horizontal_pearson: float


@dataclass(frozen=True)
class GroundForces:
    """Force of the ground on the feet: time (n,), force (n, 2, 3) [N], right foot first."""

    time: Array
    force: Array

    def __post_init__(self) -> None:
        """Check the shape."""
        check(self, 'force', (len(self.time), 2, 3))


@dataclass(frozen=True)
class Torques:
    """Joint torques and dynamic strength: time (n,), the rest (n, n_joints) [N m]."""

    time: Array
    joints: tuple[str, ...]
    torque: Array
    lower: Array
    upper: Array

    def __post_init__(self) -> None:
        """Check the shapes."""
        for name in ('torque', 'lower', 'upper'):
            check(self, name, (len(self.time), len(self.joints)))


@dataclass(frozen=True)
class Activations:
    """Muscle activations: time (n,), activation (n, n_muscles) [0..1], solved (n,)."""

    time: Array
    muscles: tuple[str, ...]
    activation: Array
    solved: BoolArray

    def __post_init__(self) -> None:
        """Check the shapes."""
        check(self, 'activation', (len(self.time), len(self.muscles)))
        check(self, 'solved', (len(self.time),))


@dataclass(frozen=True)
class SpineCurves:
    """L5-S1 load over a lift, (n,) each.

    Attributes
    ----------
    time, compression, anterior_shear, lateral_shear : array
        [s], [N]; lateral shear is positive where S1 pushes L5 to the left.
    solved : array of bool
        Samples whose solve report is good; the others are drawn as gaps.
    compression_per_degree, anterior_shear_per_degree : array
        What one degree of forward tilt of the disc frame changes [N/deg]; NaN if not known.
    disc_frame : str
        Name of the disc frame.
    """

    time: Array
    compression: Array
    anterior_shear: Array
    lateral_shear: Array
    solved: BoolArray
    compression_per_degree: Array
    anterior_shear_per_degree: Array
    disc_frame: str

    def __post_init__(self) -> None:
        """Check the shapes."""
        for name in (
            'compression',
            'anterior_shear',
            'lateral_shear',
            'solved',
            'compression_per_degree',
            'anterior_shear_per_degree',
        ):
            check(self, name, (len(self.time),))


@dataclass(frozen=True)
class BodyPoints:
    """Points of the body for the stick figures.

    Attributes
    ----------
    time : array (n,)
    names : tuple of n_p names
        Of ``human_model.motion.POINTS``.
    points : array (n, n_p, 3)
        x forward, y left, z up [m].
    box : array (n, 3)
        Centre of the box, NaN if there is none.
    box_size : array (3,)
        Depth (forward), width, height [m]; NaN if not known.
    """

    time: Array
    names: tuple[str, ...]
    points: Array
    box: Array
    box_size: Array

    def __post_init__(self) -> None:
        """Check the shapes."""
        check(self, 'points', (len(self.time), len(self.names), 3))
        check(self, 'box', (len(self.time), 3))
        check(self, 'box_size', (3,))


@dataclass(frozen=True)
class JointLoads:
    """Loads of n_j joints over a lift.

    Attributes
    ----------
    joints : tuple of str, n_j
        As in ``JointReactions.joint_names``.
    compression, shear : array, shape (n, n_j)
        Along the joint's axis towards the head, and across it in any direction [N].
    solved : array of bool, shape (n, n_j)
        Samples whose solve report is good for the joint.
    """

    joints: tuple[str, ...]
    compression: Array
    shear: Array
    solved: BoolArray

    def __post_init__(self) -> None:
        """Check the shapes."""
        shape = (len(self.compression), len(self.joints))
        for name in ('compression', 'shear', 'solved'):
            check(self, name, shape)

    @property
    def peak_compression(self) -> Array:
        """Largest compression of each joint in the good samples (n_j,) [N]; NaN without any."""
        return self._peak(self.compression)

    @property
    def peak_shear(self) -> Array:
        """Largest shear of each joint in the good samples (n_j,) [N]; NaN without any."""
        return self._peak(self.shear)

    def _peak(self, values: Array) -> Array:
        peak = np.where(self.solved, values, -np.inf).max(axis=0, initial=-np.inf)
        return np.where(np.isneginf(peak), np.nan, peak)


@dataclass(frozen=True)
class LiftReport:
    """Everything about one lift.

    Attributes
    ----------
    lift_id : str
    start : float
        Since the start of the recording [s].
    duration : float
        [s].
    emg : EmgFindings, Missing or None
        None: the recording has no EMG, or it is not known which recording it was.
    """

    lift_id: str
    start: float
    duration: float
    angles: Pair[JointAngles]
    comparison: Comparison | Missing
    ground: Pair[GroundForces]
    torques: Pair[Torques]
    activations: Pair[Activations]
    spine: Pair[SpineCurves]
    joints: Pair[JointLoads]
    points: Pair[BodyPoints]
    risk: Risk | Missing
    lifting: Lifting | Missing
    solves: tuple[SolveRow, ...] | Missing
    quality: tuple[QualityRow, ...] | Missing
    emg: EmgFindings | Missing | None = None


@dataclass(frozen=True)
class ReportData:
    """Everything on the page.

    Attributes
    ----------
    header : Header
    lifts : tuple of LiftReport, or Missing
    alarms : tuple of AlarmRow (may be empty: no alarm), or Missing
    recording_quality : tuple of QualityRow, or Missing
        Of the whole recording: markers, plates, samples left out.
    remarks : tuple of str
        What the user should know about this run: lost data, warnings.
    """

    header: Header
    lifts: tuple[LiftReport, ...] | Missing
    alarms: tuple[AlarmRow, ...] | Missing
    recording_quality: tuple[QualityRow, ...] | Missing
    remarks: tuple[str, ...] = ()


def check(owner: object, name: str, shape: tuple[int, ...]) -> None:
    """Raise ReportError unless a field has the given shape."""
    found = np.shape(getattr(owner, name))
    if found != shape:
        raise ReportError(f'{type(owner).__name__}.{name}', found, f'must have shape {shape}')
