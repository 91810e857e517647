# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded motion seen from the side, left and right averaged (section 4.3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from human_model.frames import matrix_from_quaternion
from human_model.motion import BodyMotion
from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError

_MIN_SAMPLES = 6
_SPLINE_DEGREE = 5


@dataclass(frozen=True)
class SagittalPlane:
    """Vertical plane through the middle of the ankles, along the feet.

    Attributes
    ----------
    heading : float
        Direction of the feet about the vertical, 0 along the laboratory's x axis [rad].
    lateral : float
        Distance of the plane to the left of the laboratory's origin [m].
    """

    heading: float
    lateral: float

    @classmethod
    def of(cls, motion: BodyMotion) -> SagittalPlane:
        """Plane of the mean foot positions of a motion.

        Raises
        ------
        TaskError
            Heels and toes coincide, so that the feet have no direction.
        """
        heel, toe, ankle = (
            _pair(motion, name).mean(axis=(0, 1)) for name in ('heel', 'toe', 'ankle')
        )
        forward = (toe - heel)[:2]
        if not np.linalg.norm(forward) > 0.0:
            raise TaskError(
                f'heel and toe points coincide at {heel.tolist()}: the feet have no direction'
            )
        heading = float(np.arctan2(forward[1], forward[0]))
        left = np.array([-np.sin(heading), np.cos(heading)])
        return cls(heading, float(ankle[:2] @ left))

    def into(self, points: Array) -> Array:
        """Positions or vectors (..., 3) as (..., 2), forward and up."""
        forward = points[..., 0] * np.cos(self.heading) + points[..., 1] * np.sin(self.heading)
        return np.stack((forward, points[..., 2]), axis=-1)

    def rotation(self) -> Array:
        """Rotation (3, 3) from axes along the plane (forward, left, up) to the laboratory."""
        c, s = np.cos(self.heading), np.sin(self.heading)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    def to_world(self, points: Array) -> Array:
        """Positions (..., 3) given in the plane's axes, turned and moved into the laboratory."""
        return np.asarray((points + np.array([0.0, self.lateral, 0.0])) @ self.rotation().T)


@dataclass(frozen=True)
class SagittalMotion:
    """Joint coordinates of the sagittal model over a recorded window.

    Attributes
    ----------
    time : array, shape (n,)
        From the start of the lift [s].
    q, dq, ddq : array, shape (n, 6)
        Mean of right and left, in the order of `parameters.JOINTS` [rad], per s, per s^2.
    side_difference : array, shape (n, 6)
        Right minus left [rad]; 0 for the spine.
    grip : array, shape (n, 2)
        Middle of the hands, forward and up [m].
    ground_force : array, shape (n, 2)
        Force of the ground on both feet, forward and up [N].
    """

    time: Array
    q: Array
    dq: Array
    ddq: Array
    side_difference: Array
    grip: Array
    ground_force: Array


@dataclass(frozen=True)
class SideView:
    """A recorded lift seen from the side: where its plane is, and the motion in it."""

    plane: SagittalPlane
    motion: SagittalMotion

    @classmethod
    def of(cls, motion: BodyMotion, start: float, neutral: dict[str, Array]) -> SideView:
        """Project a motion on the plane of its feet; parameters and errors as of both."""
        plane = SagittalPlane.of(motion)
        return cls(plane, sagittal_motion(motion, start, neutral, plane))


def sagittal_motion(
    motion: BodyMotion, start: float, neutral: dict[str, Array], plane: SagittalPlane
) -> SagittalMotion:
    """Project a motion on its sagittal plane.

    A limb segment's angle is that of the line between its joint centres in the plane, from its
    direction in upright standing; the pelvis angle is that of its forward axis. The spine angle is
    that of the line from L5-S1 to the middle of the shoulders against the pelvis, so that
    shoulders and hands stay where they were recorded although the recorded spine has more joints.

    Parameters
    ----------
    motion : BodyMotion
        Either skeleton; the window of the lift.
    start : float
        Start of the lift on the clock of the motion [s].
    neutral : dict of array, shape (3,)
        Points of the sagittal skeleton in upright standing, by name.
    plane : SagittalPlane
        Where to look from.

    Raises
    ------
    TaskError
        Fewer than six samples: no accelerations.
    """
    if len(motion) < _MIN_SAMPLES:
        raise TaskError(
            f'motion: {len(motion)} samples in the lift, at least {_MIN_SAMPLES} are needed'
        )
    sides = np.stack([_side_angles(motion, side, neutral, plane) for side in (0, 1)])
    q = sides.mean(axis=0)
    time = motion.time - start
    # Loads for long, and a node that starts does not need it.
    from scipy.interpolate import make_interp_spline

    spline = make_interp_spline(time, q, k=_SPLINE_DEGREE)
    return SagittalMotion(
        time=time,
        q=q,
        dq=spline(time, nu=1),
        ddq=spline(time, nu=2),
        side_difference=sides[0] - sides[1],
        grip=plane.into(_pair(motion, 'hand').mean(axis=1)),
        ground_force=plane.into(motion.ground_force.sum(axis=1)),
    )


def _pair(motion: BodyMotion, name: str) -> Array:
    """Right and left point, shape (n, 2, 3)."""
    return np.stack([motion.point(f'{name}_{side}') for side in 'rl'], axis=1)


def _side_angles(
    motion: BodyMotion, side: int, neutral: dict[str, Array], plane: SagittalPlane
) -> Array:
    mark = 'rl'[side]
    shoulders = plane.into(_pair(motion, 'shoulder').mean(axis=1))
    own = {
        name: plane.into(motion.point(f'{name}_{mark}'))
        for name in ('hip', 'knee', 'ankle', 'shoulder', 'elbow', 'hand')
    }
    spine = plane.into(motion.point('l5_s1'))

    def turn(lower: Array, upper: Array, low_name: str, high_name: str) -> Array:
        """Angle of a line against its neutral direction, continuous over time."""
        line = upper - lower
        rest = (neutral[high_name] - neutral[low_name])[[0, 2]]
        angle = np.arctan2(line[:, 1], line[:, 0]) - np.arctan2(rest[1], rest[0])
        return np.asarray(np.unwrap((angle + np.pi) % (2.0 * np.pi) - np.pi))

    shank = turn(own['ankle'], own['knee'], 'ankle_r', 'knee_r')
    thigh = turn(own['knee'], own['hip'], 'knee_r', 'hip_r')
    front = plane.into(matrix_from_quaternion(motion.frame('pelvis'))[..., 0])
    pelvis = np.unwrap(np.arctan2(front[:, 1], front[:, 0]))
    trunk = turn(spine, shoulders, 'l5_s1', 'shoulder_r')
    upper_arm = turn(own['shoulder'], own['elbow'], 'shoulder_r', 'elbow_r')
    forearm = turn(own['elbow'], own['hand'], 'elbow_r', 'hand_r')
    return np.stack(
        (
            trunk - pelvis,
            upper_arm - trunk,
            forearm - upper_arm,
            thigh - pelvis,
            thigh - shank,
            -shank,
        ),
        axis=1,
    )
