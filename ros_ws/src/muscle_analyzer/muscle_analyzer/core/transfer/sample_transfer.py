# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Transfer of the samples of a skeleton's motion to the musculoskeletal model, compiled.

`motion_transfer` describes the method.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import njit
from human_model.tree import TreeArrays
from human_model.typing import Array, BoolArray, IntArray
from muscle_analyzer.core.boxed_tuple import Boxed
from muscle_analyzer.core.multibody.model import Tree
from muscle_analyzer.core.transfer.pose_fit import Rates, fit_pose, map_rates
from muscle_analyzer.core.transfer.pose_misfit import Targets
from muscle_analyzer.core.transfer.skeleton_state import (
    SkeletonMotion,
    SkeletonState,
    set_frame,
    skeleton_state,
)


class TransferSetup(NamedTuple):
    """Both models and their relation.

    Attributes
    ----------
    tree : Tree
        Of the musculoskeletal model.
    skeleton : TreeArrays
    point_body, local : (n_p,) int and (n_p, 3) arrays
        The points on the skeleton's bodies, m.
    frame_body : (n_f,) int array
        Bodies of the frames.
    targets : Targets
        With everything that is the same in all samples.
    upright : (n_f, 3, 3) array
        See `body_points.BodyPoints.frame_upright`.
    upright_q : (n_q,) array
        Coordinates of the model in the skeleton's zero posture, rad or m.
    same : (n_q,) int array
        Coordinate of the skeleton that each of the model's is weakly pulled to, or -1.
    lower, upper : (n_q,) arrays
        Bounds of the coordinates.
    fitted : (n_q,) bool array
    fixed : (n_q,) array
        Values of those that are not fitted.
    pelvis_coordinates : (6,) int array
        Translations, then tilt, list and rotation.
    pelvis, pelvis_frame : int
        Numbers of the point and of the frame.
    sagittal : bool
        Whether the skeleton's coordinates are those of a plane that may stand anywhere.
    tolerance, max_iterations : float, int
        See `pose_fit.fit_pose`.
    """

    tree: Tree
    skeleton: TreeArrays
    point_body: IntArray
    local: Array
    frame_body: IntArray
    targets: Targets
    upright: Array
    upright_q: Array
    same: IntArray
    lower: Array
    upper: Array
    fitted: BoolArray
    fixed: Array
    pelvis_coordinates: IntArray
    pelvis: int
    pelvis_frame: int
    sagittal: bool
    tolerance: float
    max_iterations: int


class TransferredSamples(NamedTuple):
    """Samples on the musculoskeletal model; see `motion_transfer.TransferredMotion`.

    Attributes
    ----------
    off : (n, n_p) array
        Distance of the motion's points from those of the skeleton, m.
    """

    q: Array
    qd: Array
    qdd: Array
    point_distance: Array
    frame_angle: Array
    iterations: IntArray
    converged: BoolArray
    at_limit: BoolArray
    off: Array


@njit
def _allocate_samples(n: int, n_q: int, n_p: int, n_f: int) -> TransferredSamples:
    """Return arrays for n samples."""
    return TransferredSamples(
        np.empty((n, n_q)),
        np.empty((n, n_q)),
        np.empty((n, n_q)),
        np.empty((n, n_p)),
        np.empty((n, n_f)),
        np.empty(n, np.int64),
        np.empty(n, np.bool_),
        np.empty((n, n_q), np.bool_),
        np.empty((n, n_p)),
    )


@njit
def _heading(setup: TransferSetup, own: SkeletonState, frames: Array) -> float:
    """Return the turn about the vertical from the coordinates to the motion, rad.

    A 3D skeleton's coordinates hold its heading: nothing is left to turn.
    """
    if not setup.sagittal:
        return 0.0
    there, here = frames[setup.pelvis_frame], own.rotation[setup.pelvis_frame]
    sine, cosine = 0.0, 0.0
    for k in range(3):
        sine += there[1, k] * here[0, k] - there[0, k] * here[1, k]
        cosine += there[0, k] * here[0, k] + there[1, k] * here[1, k]
    return float(np.arctan2(sine, cosine))


@njit
def _distances(
    setup: TransferSetup, own: SkeletonState, heading: float, place: Array, out: Array
) -> None:
    """Write the distances (n_p,) of the motion's points from the skeleton's, m."""
    c, s = np.cos(heading), np.sin(heading)
    away = np.empty((place.shape[0], 3))
    for i in range(place.shape[0]):
        x, y, z = own.point[i]
        away[i, 0] = c * x - s * y - place[i, 0]
        away[i, 1] = s * x + c * y - place[i, 1]
        away[i, 2] = z - place[i, 2]
    # The place of a sagittal plane in the laboratory is arbitrary; the height is a coordinate.
    x0 = away[setup.pelvis, 0] if setup.sagittal else 0.0
    y0 = away[setup.pelvis, 1] if setup.sagittal else 0.0
    for i in range(place.shape[0]):
        out[i] = np.sqrt((away[i, 0] - x0) ** 2 + (away[i, 1] - y0) ** 2 + away[i, 2] ** 2)


@njit
def _set_targets(setup: TransferSetup, place: Array, frames: Array, position: Array) -> None:
    """Write a sample into the targets: points, frames and reference values."""
    point, frame, reference = setup.targets.point, setup.targets.frame, setup.targets.reference
    for i in range(place.shape[0]):
        point[i, 0], point[i, 1], point[i, 2] = place[i, 0], place[i, 2], -place[i, 1]
    axes = np.empty((3, 3))
    for f in range(frames.shape[0]):
        # Both the world's axes and the frame's are renamed to OpenSim's.
        for j, source, sign in ((0, 0, 1.0), (1, 2, 1.0), (2, 1, -1.0)):
            axes[j, 0] = sign * frames[f, source, 0]
            axes[j, 1] = sign * frames[f, source, 2]
            axes[j, 2] = -sign * frames[f, source, 1]
        for i in range(3):
            for k in range(3):
                frame[f, i, k] = 0.0
                for j in range(3):
                    frame[f, i, k] += axes[i, j] * setup.upright[f, j, k]
    for k in range(reference.size):
        reference[k] = setup.upright_q[k]
        if setup.same[k] >= 0:
            reference[k] += position[setup.same[k]]


@njit
def _rates(
    setup: TransferSetup, heading: float, point: Array, frame: Array, values: Array
) -> Rates:
    """Return rates of the skeleton, turned by the heading, in OpenSim's axes."""
    c, s = np.cos(heading), np.sin(heading)
    moved = np.empty_like(point), np.empty_like(frame)
    for source, target in ((point, moved[0]), (frame, moved[1])):
        for i in range(source.shape[0]):
            x, y, z = source[i]
            target[i, 0], target[i, 1], target[i, 2] = c * x - s * y, z, -(s * x + c * y)
    reference = np.zeros(setup.same.size)
    for k in range(reference.size):
        if setup.same[k] >= 0:
            reference[k] = values[setup.same[k]]
    return Rates(moved[0], moved[1], reference)


@njit
def _first(setup: TransferSetup) -> Array:
    """Return a start without a sample before: the target pelvis, the skeleton's limbs."""
    targets = setup.targets
    start = setup.fixed.copy()
    for k in range(start.size):
        if targets.reference_weight[k] > 0.0:
            start[k] = targets.reference[k]
        elif setup.fitted[k]:
            start[k] = setup.upright_q[k]
    # Turns about z, x and y one after the other, each in the frame that the last one left.
    frame = targets.frame[setup.pelvis_frame]
    index = setup.pelvis_coordinates
    for i in range(3):
        place = targets.point[setup.pelvis, i] - targets.point_local[setup.pelvis, i]
        start[index[i]] = place
    start[index[3]] = np.arctan2(-frame[0, 1], frame[1, 1])
    start[index[4]] = np.arcsin(min(max(frame[2, 1], -1.0), 1.0))
    start[index[5]] = np.arctan2(-frame[2, 0], frame[2, 2])
    for k in range(start.size):
        start[k] = min(max(start[k], setup.lower[k]), setup.upper[k])
    return start


@njit
def _set_remaining(targets: Targets, off: Array, distance: Array, angle: Array) -> None:
    """Write the remaining distances (n_p,) and angles (n_f,) of a misfit, m and rad."""
    n_p = distance.size
    for i in range(n_p + angle.size):
        size = np.sqrt(off[3 * i] ** 2 + off[3 * i + 1] ** 2 + off[3 * i + 2] ** 2)
        if i < n_p:
            distance[i] = size / targets.point_weight[i]
        else:
            angle[i - n_p] = size / targets.frame_weight[i - n_p]


@njit(nogil=True)
def transfer_samples(
    boxed: Boxed[TransferSetup], motion: SkeletonMotion, start: Array, same_point: float
) -> tuple[int, TransferredSamples]:
    """Transfer sample after sample, each fit starting from the one before.

    Parameters
    ----------
    boxed : Boxed of TransferSetup
        Its targets are changed.
    motion : SkeletonMotion
    start : (n_q,) array
        Coordinates to start from, NaN without a sample before; updated.
    same_point : float
        Distance up to which the motion's points are those of the skeleton, m.

    Returns
    -------
    done : int
        Number of transferred samples: the next one's points are not those of the skeleton.
    out : TransferredSamples
        Of these samples.
    """
    setup = boxed.content
    targets = setup.targets
    n_q, n_p, n_f = start.size, motion.point_column.size, motion.frame_column.size
    out = _allocate_samples(len(motion.position), n_q, n_p, n_f)
    place, frames = np.empty((n_p, 3)), np.empty((n_f, 3, 3))
    free = np.empty(n_q, np.bool_)
    for k in range(len(motion.position)):
        position, velocity = motion.position[k], motion.velocity[k]
        acceleration = motion.acceleration[k]
        own = skeleton_state(
            setup.skeleton, setup.point_body, setup.local, setup.frame_body, position, velocity,
            acceleration,
        )  # fmt: skip
        set_frame(motion, k, place, frames)
        heading = _heading(setup, own, frames)
        _distances(setup, own, heading, place, out.off[k])
        for i in range(n_p):
            if out.off[k, i] > same_point:
                return k, out
        _set_targets(setup, place, frames, position)
        first = _first(setup) if np.isnan(start[0]) else start.copy()
        fit = fit_pose(
            setup.tree, targets, first, setup.lower, setup.upper, setup.fitted, setup.tolerance,
            setup.max_iterations,
        )  # fmt: skip
        for c in range(n_q):
            out.at_limit[k, c] = fit.q[c] <= setup.lower[c] or fit.q[c] >= setup.upper[c]
            free[c] = setup.fitted[c] and not out.at_limit[k, c]
        rate, second_rate = map_rates(
            setup.tree,
            targets,
            fit.q,
            fit.state,
            free,
            _rates(setup, heading, own.velocity, own.omega, velocity),
            _rates(setup, heading, own.acceleration, own.alpha, acceleration),
        )
        for c in range(n_q):
            out.q[k, c], out.qd[k, c], out.qdd[k, c] = fit.q[c], rate[c], second_rate[c]
            start[c] = fit.q[c] if fit.converged else np.nan
        out.iterations[k] = fit.iterations
        out.converged[k] = fit.converged
        _set_remaining(targets, fit.residual, out.point_distance[k], out.frame_angle[k])
    return len(motion.position), out
