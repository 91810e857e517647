# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Transfers a motion from a skeleton of `human_model` to the musculoskeletal model.

The two have different joints, so angles are not copied (the thesis does, section 4.1.2): the
second model is fitted, sample by sample, to the first one's joint centres, hands, feet and trunk.
Hands, feet and the trunk's orientation weigh most, because the lever arms of box and ground
depend on them.

Velocities and accelerations come from those of the skeleton's points by least squares
(`map_rates`): the same way live and for a recorded lift, and without a filter, so without further
delay.

The coordinates of the sagittal skeleton give its place in its own plane; its points and frames
give the place in the laboratory. A turn about the vertical and a shift relate the two.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from human_model.motion import FRAMES, POINTS, BodyMotion
from human_model.skeleton import Skeleton
from human_model.typing import Array
from muscle_analyzer.core.boxed_tuple import boxed
from muscle_analyzer.core.exceptions import TransferError
from muscle_analyzer.core.subject.body_points import upright_coordinates
from muscle_analyzer.core.subject.model import SubjectModel
from muscle_analyzer.core.transfer.pose_misfit import Targets
from muscle_analyzer.core.transfer.sample_transfer import TransferSetup, transfer_samples
from muscle_analyzer.core.transfer.skeleton_state import SkeletonMotion

# The skeletons have no neck: the head stays as it is on the thorax.
FIXED_COORDINATES = ('neck_flexion', 'neck_bending', 'neck_rotation')
# The limbs' coordinates have the same names and meanings in both models: a weak pull to the
# skeleton's values determines what the points do not. This many radians weigh as much as one
# sigma of a point.
REFERENCE_SIGMA = 0.2
PELVIS_COORDINATES = (
    'pelvis_tx', 'pelvis_ty', 'pelvis_tz', 'pelvis_tilt', 'pelvis_list', 'pelvis_rotation',
)  # fmt: skip
UNREFERENCED = ('pelvis_', 'L5_S1_', 'neck_')
TOLERANCE = 1e-5
MAX_ITERATIONS = 200
# Points of a motion must be those of its skeleton, or its rates would belong to another motion.
SAME_POINT = 1e-3


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


@dataclass(frozen=True, eq=False)
class TransferredMotion:
    """A block of n samples on the musculoskeletal model; arrays as in `TransferredPose`.

    Attributes
    ----------
    q, qd, qdd : (n, n_q) arrays
    point_distance : (n, n_p) array
    frame_angle : (n, n_f) array
    iterations : (n,) int array
    converged : (n,) bool array
    at_limit : (n, n_q) bool array
        Whether a coordinate is at a limit of its range.
    names : tuple of str, n_q
        Of the coordinates.
    """

    q: Array
    qd: Array
    qdd: Array
    point_distance: Array
    frame_angle: Array
    iterations: NDArray[np.int64]
    converged: NDArray[np.bool_]
    at_limit: NDArray[np.bool_]
    names: tuple[str, ...]

    def limits(self, k: int) -> tuple[str, ...]:
        """Return the names of the coordinates at a limit in sample `k`."""
        return tuple(self.names[c] for c in np.flatnonzero(self.at_limit[k]))

    def pose(self, k: int) -> TransferredPose:
        """Return sample `k`."""
        return TransferredPose(
            q=self.q[k],
            qd=self.qd[k],
            qdd=self.qdd[k],
            point_distance=self.point_distance[k],
            frame_angle=self.frame_angle[k],
            iterations=int(self.iterations[k]),
            converged=bool(self.converged[k]),
            at_limit=self.limits(k),
        )


class MotionTransfer:
    """Fits a subject's musculoskeletal model to the motion of a skeleton, sample after sample.

    Parameters
    ----------
    subject : SubjectModel
    skeleton : Skeleton
        The skeleton that the motions belong to (2D or 3D), of the same subject.

    Raises
    ------
    UnknownNameError
        If the model lacks a coordinate of the pelvis.
    """

    def __init__(self, subject: SubjectModel, skeleton: Skeleton) -> None:
        self.subject = subject
        self.skeleton = skeleton
        model, points = subject.multibody, subject.points
        names = model.coordinate_names
        fitted = np.array([name not in FIXED_COORDINATES for name in names])
        clamped = {c.name: c.clamped for joint in model.source.joints for c in joint.coordinates}
        bounded = fitted & np.array([clamped[name] for name in names])
        which_points = _positions(points.names, POINTS)
        segment = skeleton.point_segment[which_points]
        self._setup = TransferSetup(
            tree=model.tree,
            skeleton=skeleton.tree,
            point_body=skeleton.tree.segment_body[segment],
            local=skeleton.tree.segment_offset[segment] + skeleton.point_local[which_points],
            frame_body=skeleton.tree.segment_body[
                skeleton.frame_segment[_positions(points.frame_names, FRAMES)]
            ],
            targets=Targets(
                point_body=points.body,
                point_local=points.local,
                point=np.empty((len(points.names), 3)),
                point_weight=1.0 / points.sigma,
                frame_body=points.frame_body,
                frame=np.empty((len(points.frame_names), 3, 3)),
                frame_weight=1.0 / points.frame_sigma,
                reference=np.empty(len(names)),
                reference_weight=np.array(
                    [0.0 if n.startswith(UNREFERENCED) else 1.0 / REFERENCE_SIGMA for n in names]
                ),
            ),
            upright=np.ascontiguousarray(points.frame_upright),
            upright_q=upright_coordinates(model),
            same=_same_coordinates(names, skeleton.coordinates),
            lower=np.where(bounded, model.lower, -np.inf),
            upper=np.where(bounded, model.upper, np.inf),
            fitted=fitted,
            fixed=model.default,
            pelvis_coordinates=np.array(
                [model.coordinate_index(name) for name in PELVIS_COORDINATES], np.int64
            ),
            pelvis=points.names.index('pelvis'),
            pelvis_frame=points.frame_names.index('pelvis'),
            sagittal='pelvis_rotation' not in skeleton.coordinates,
            tolerance=TOLERANCE,
            max_iterations=MAX_ITERATIONS,
        )
        # Boxed once; a motion's columns are kept while its names stay the same.
        self._boxed = boxed(self._setup)
        self._given: tuple[tuple[str, ...], ...] = ()
        self._columns = (which_points, which_points)
        self._start = np.full(len(names), np.nan)

    def reset(self) -> None:
        """Clear the last pose; the next fit starts from the skeleton's coordinates."""
        self._start = np.full_like(self._start, np.nan)

    def step(self, motion: BodyMotion, sample: int = 0) -> TransferredPose:
        """Transfer one sample; the fit starts from the sample before.

        Raises
        ------
        TransferError
            If the motion is of another skeleton, or its points are not those of this subject.
        """
        return self._transfer(motion, slice(sample, sample + 1)).pose(0)

    def block(self, motion: BodyMotion) -> TransferredMotion:
        """Transfer all samples, one after the other; see `step`."""
        return self._transfer(motion, slice(None))

    def _transfer(self, motion: BodyMotion, samples: slice) -> TransferredMotion:
        if motion.coordinates != self.skeleton.coordinates:
            raise TransferError(
                f'motion of skeleton {motion.skeleton!r} does not have the coordinates of '
                f'{self.skeleton.name!r}'
            )
        points = self.subject.points
        given = (motion.point_names, motion.frame_names)
        if given != self._given:
            self._columns = (
                _positions(points.names, motion.point_names),
                _positions(points.frame_names, motion.frame_names),
            )
            self._given = given
        done, out = transfer_samples(
            self._boxed,
            SkeletonMotion(
                motion.position[samples],
                motion.velocity[samples],
                motion.acceleration[samples],
                motion.points[samples],
                motion.frames[samples],
                *self._columns,
            ),
            self._start,
            SAME_POINT,
        )
        if done < len(out.q):
            worst = int(np.argmax(out.off[done]))
            raise TransferError(
                f'motion at {motion.time[samples][done]:.3f} s: '
                f'point {points.names[worst]!r} is {out.off[done, worst]:.4f} m '
                'away from the skeleton of the subject'
            )
        return TransferredMotion(*out[:-1], self.subject.multibody.coordinate_names)


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
