# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Takes a motion over from a skeleton of `human_model` to the musculoskeletal model.

The two have different joints, so angles are not copied (the thesis does, section 4.1.2): the
second model is fitted, frame by frame, to the first one's joint centres, hands, feet and trunk.
Hands, feet and the trunk's orientation weigh most, because the box's and the ground's lever arms
hang on them.

Velocities and accelerations come from those of the skeleton's points by least squares
(`map_rates`): the same way live and for a recorded lift, and without a filter, so without further
delay.

The coordinates of the sagittal skeleton say where it is in its own plane; its points and frames
say where in the laboratory. A turn about the vertical and a shift lead from the one to the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from human_model.compiled import body_motion
from human_model.frames import ROS_FROM_OPENSIM, matrix_from_quaternion, rotation_to_opensim
from human_model.motion import FRAMES, POINTS, BodyMotion
from human_model.skeleton import Skeleton
from human_model.tree import TreeArrays
from muscle_analyzer.core.body_points import upright_coordinates
from muscle_analyzer.core.exceptions import TransferError
from muscle_analyzer.core.kinematics import forward_kinematics
from muscle_analyzer.core.pose_fit import Rates, Targets, fit_pose, map_rates, misfit
from muscle_analyzer.core.subject_model import SubjectModel

Array = NDArray[np.float64]

# The skeletons have no neck: the head stays as it is on the thorax.
HELD_COORDINATES = ('neck_flexion', 'neck_bending', 'neck_rotation')
# The limbs' coordinates have the same names and meanings in both models: a weak pull to the
# skeleton's values decides what the points leave open. So many radians weigh as much as one sigma
# of a point.
REFERENCE_SIGMA = 0.2
PELVIS_COORDINATES = (
    'pelvis_tx', 'pelvis_ty', 'pelvis_tz', 'pelvis_tilt', 'pelvis_list', 'pelvis_rotation',
)  # fmt: skip
UNREFERENCED = ('pelvis_', 'L5_S1_', 'neck_')
TOLERANCE = 1e-5
MAX_ITERATIONS = 200
# Points of a motion must be those of its skeleton, or its rates would belong to another motion.
SAME_POINT = 1e-3


class SkeletonState(NamedTuple):
    """A skeleton at its coordinates, REP-103 axes; velocities and accelerations of its points.

    Attributes
    ----------
    point, velocity, acceleration : (n_p, 3) arrays
        m, m/s, m/s^2.
    rotation : (n_f, 3, 3) array
        World <- frame.
    omega, alpha : (n_f, 3) arrays
        Angular, rad/s and rad/s^2.
    """

    point: Array
    velocity: Array
    acceleration: Array
    rotation: Array
    omega: Array
    alpha: Array


@dataclass(frozen=True, eq=False)
class TransferredPose:
    """One sample of a motion on the musculoskeletal model.

    Attributes
    ----------
    q, qd, qdd : (n_q,) arrays
        Independent coordinates in rad or m, rates, accelerations.
    point_distance : (n_p,) array
        Remaining distance of each point, m.
    frame_angle : (n_f,) array
        Remaining angle of each frame, rad.
    iterations : int
    converged : bool
    at_limit : tuple of str
        Coordinates at a limit of their range.
    """

    q: Array
    qd: Array
    qdd: Array
    point_distance: Array
    frame_angle: Array
    iterations: int
    converged: bool
    at_limit: tuple[str, ...]


class MotionTransfer:
    """Fits a subject's musculoskeletal model to the motion of a skeleton, sample after sample.

    Parameters
    ----------
    subject : SubjectModel
    skeleton : Skeleton
        The skeleton that the motions belong to (2D or 3D), of the same subject.

    Raises
    ------
    TransferError
        If the model lacks a coordinate that is held.
    """

    def __init__(self, subject: SubjectModel, skeleton: Skeleton) -> None:
        self.subject = subject
        self.skeleton = skeleton
        model, points = subject.multibody, subject.points
        names = model.coordinate_names
        self._fitted = np.array([name not in HELD_COORDINATES for name in names])
        clamped = {
            c.name: c.clamped for joint in model.source.joints for c in joint.coordinates
        }
        bounded = self._fitted & np.array([clamped[name] for name in names])
        self._lower = np.where(bounded, model.lower, -np.inf)
        self._upper = np.where(bounded, model.upper, np.inf)
        which_points = _positions(points.names, POINTS)
        self._segments = skeleton.point_segment[which_points]
        self._locals = np.ascontiguousarray(skeleton.point_local[which_points])
        self._frame_segments = skeleton.frame_segment[_positions(points.frame_names, FRAMES)]
        self._sagittal = 'pelvis_rotation' not in skeleton.coordinates
        self._pelvis = points.names.index('pelvis')
        self._pelvis_frame = points.frame_names.index('pelvis')
        self._columns = cache(_positions)
        self._upright_q = upright_coordinates(model)
        self._reference_weight = np.array(
            [0.0 if name.startswith(UNREFERENCED) else 1.0 / REFERENCE_SIGMA for name in names]
        )
        self._same = _same_coordinates(names, skeleton.coordinates)
        self._start: Array | None = None

    def reset(self) -> None:
        """Forget the last pose; the next fit starts from the skeleton's coordinates."""
        self._start = None

    def step(self, motion: BodyMotion, sample: int = 0) -> TransferredPose:
        """Take over one sample; the fit starts from the sample before.

        Raises
        ------
        TransferError
            If the motion is of another skeleton, or its points are not those of this subject.
        """
        if motion.coordinates != self.skeleton.coordinates:
            raise TransferError(
                f'motion of skeleton {motion.skeleton!r} does not have the coordinates of '
                f'{self.skeleton.name!r}'
            )
        points = self.subject.points
        place = motion.points[sample, self._columns(points.names, motion.point_names)]
        frames = matrix_from_quaternion(
            motion.frames[sample, self._columns(points.frame_names, motion.frame_names)]
        )
        own = _skeleton_state(
            self.skeleton.tree,
            motion.position[sample],
            motion.velocity[sample],
            motion.acceleration[sample],
            self._segments,
            self._locals,
            self._frame_segments,
        )
        turn = self._turn(own, frames)
        self._check_points(motion, sample, own, turn, place)
        targets = self._targets(motion, sample, place, frames)
        tree = self.subject.multibody.tree
        start = self._first(targets) if self._start is None else self._start
        fit = fit_pose(
            tree, targets, start, self._lower, self._upper, self._fitted, TOLERANCE, MAX_ITERATIONS
        )
        at_limit = (fit.q <= self._lower) | (fit.q >= self._upper)
        axes = turn.T @ ROS_FROM_OPENSIM
        qd, qdd = map_rates(
            tree,
            targets,
            fit.q,
            self._fitted & ~at_limit,
            Rates(
                own.velocity @ axes,
                own.omega @ axes,
                self._referenced(motion.velocity[sample]),
            ),
            Rates(
                own.acceleration @ axes,
                own.alpha @ axes,
                self._referenced(motion.acceleration[sample]),
            ),
        )
        self._start = fit.q if fit.converged else None
        distance, angle = self._remaining(targets, fit.q)
        names = self.subject.multibody.coordinate_names
        return TransferredPose(
            q=fit.q,
            qd=qd,
            qdd=qdd,
            point_distance=distance,
            frame_angle=angle,
            iterations=fit.iterations,
            converged=fit.converged,
            at_limit=tuple(names[k] for k in np.flatnonzero(at_limit)),
        )

    def _turn(self, own: SkeletonState, frames: Array) -> Array:
        """Return the turn (3, 3) about the vertical that leads from the coordinates to the motion.

        A 3D skeleton's coordinates hold its heading: nothing is left to turn.
        """
        if not self._sagittal:
            return np.eye(3)
        between = frames[self._pelvis_frame] @ own.rotation[self._pelvis_frame].T
        heading = np.arctan2(between[1, 0] - between[0, 1], between[0, 0] + between[1, 1])
        c, s = np.cos(heading), np.sin(heading)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    def _targets(self, motion: BodyMotion, sample: int, place: Array, frames: Array) -> Targets:
        points = self.subject.points
        return Targets(
            points.body,
            points.local,
            place @ ROS_FROM_OPENSIM,
            1.0 / points.sigma,
            points.frame_body,
            rotation_to_opensim(frames) @ points.frame_upright,
            1.0 / points.frame_sigma,
            self._upright_q + self._referenced(motion.position[sample]),
            self._reference_weight,
        )

    def _referenced(self, values: Array) -> Array:
        """Return the skeleton's values (n_q,) of the model's coordinates, 0 where it has none."""
        return np.where(self._same >= 0, values[self._same], 0.0)

    def _check_points(
        self, motion: BodyMotion, sample: int, own: SkeletonState, turn: Array, place: Array
    ) -> None:
        off = own.point @ turn.T - place
        if self._sagittal:
            # Where in the laboratory the plane is; the height is a coordinate.
            off[:, :2] -= off[self._pelvis, :2]
        distance = np.linalg.norm(off, axis=1)
        worst = int(np.argmax(distance))
        if distance[worst] > SAME_POINT:
            raise TransferError(
                f'motion at {motion.time[sample]:.3f} s: '
                f'point {self.subject.points.names[worst]!r} is {distance[worst]:.4f} m '
                'away from the skeleton of the subject'
            )

    def _first(self, targets: Targets) -> Array:
        """Return a start without a sample before: the target pelvis, the skeleton's limbs."""
        model = self.subject.multibody
        start = np.where(self._fitted, self._upright_q, model.default)
        start = np.where(self._reference_weight > 0.0, targets.reference, start)
        place = targets.point[self._pelvis] - self.subject.points.local[self._pelvis]
        # Turns about z, x and y one after the other, each in the frame that the last one left.
        frame = targets.frame[self._pelvis_frame]
        turns = (
            np.arctan2(-frame[0, 1], frame[1, 1]),
            np.arcsin(np.clip(frame[2, 1], -1.0, 1.0)),
            np.arctan2(-frame[2, 0], frame[2, 2]),
        )
        for name, value in zip(PELVIS_COORDINATES, (*place, *turns), strict=True):
            start[model.coordinate_index(name)] = value
        return np.asarray(np.clip(start, self._lower, self._upper))

    def _remaining(self, targets: Targets, q: Array) -> tuple[Array, Array]:
        zero = np.zeros(q.size)
        state = forward_kinematics(self.subject.multibody.tree, q, zero, zero)
        off = misfit(targets, state).reshape(-1, 3)
        size = np.linalg.norm(off, axis=1)
        n_p = targets.point_weight.size
        return size[:n_p] / targets.point_weight, size[n_p:] / targets.frame_weight


def _same_coordinates(names: tuple[str, ...], skeleton: tuple[str, ...]) -> NDArray[np.int64]:
    """Return for each coordinate its place in the skeleton's, also without its side, or -1."""
    return np.array(
        [
            next((skeleton.index(n) for n in (name, name[:-2]) if n in skeleton), -1)
            for name in names
        ],
        dtype=np.int64,
    )


def _positions(wanted: tuple[str, ...], names: tuple[str, ...]) -> NDArray[np.int64]:
    if missing := [name for name in wanted if name not in names]:
        raise TransferError(f'point or frame {missing[0]!r} is not among those of the motion')
    return np.array([names.index(name) for name in wanted], dtype=np.int64)


@njit(cache=True)
def _skeleton_state(
    tree: TreeArrays,
    q: Array,
    qd: Array,
    qdd: Array,
    segment: NDArray[np.int64],
    local: Array,
    frame_segment: NDArray[np.int64],
) -> SkeletonState:
    rotation, origin, _, omega, alpha, velocity, acceleration = body_motion(tree, q, qd, qdd)
    n_p = segment.size
    n_f = frame_segment.size
    x = np.empty((n_p, 3))
    v = np.empty((n_p, 3))
    a = np.empty((n_p, 3))
    r = np.empty((n_f, 3, 3))
    w = np.empty((n_f, 3))
    al = np.empty((n_f, 3))
    for i in range(n_p):
        b = tree.segment_body[segment[i]]
        arm = rotation[b] @ (tree.segment_offset[segment[i]] + local[i])
        x[i] = origin[b] + arm
        v[i] = velocity[b] + np.cross(omega[b], arm)
        a[i] = (
            acceleration[b] + np.cross(alpha[b], arm) + np.cross(omega[b], np.cross(omega[b], arm))
        )
    for i in range(n_f):
        b = tree.segment_body[frame_segment[i]]
        r[i] = rotation[b]
        w[i] = omega[b]
        al[i] = alpha[b]
    return SkeletonState(x, v, a, r, w, al)
