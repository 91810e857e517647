# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""From the arrays of a motion to those of the solver and back, compiled.

Motions and results are in REP-103 axes (forward, left, up), the solver in OpenSim's (forward, up,
right).  For a single sample, renaming the axes in numpy takes as long as solving it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from human_model.compiled_cache import njit
from human_model.typing import Array, BoolArray, IntArray
from muscle_analyzer.core.boxed_tuple import Boxed
from muscle_analyzer.core.loads.disc_frame import DEGREE
from muscle_analyzer.core.loads.disc_pose import world_poses
from muscle_analyzer.core.multibody.inverse_dynamics import add_force

#: Distance [m] and angle [rad] that hands, feet and trunk should keep in the transfer (the
#: project's goals); larger ones are in the report's message.
DISTANCE_GOAL, ANGLE_GOAL = 0.005, math.radians(1.0)


class Places(NamedTuple):
    """Numbers of a model's parts; pairs are [right, left].

    Attributes
    ----------
    n_bodies : int
    feet, hands : (2,) int
        Bodies that the ground and the box push.
    lumbosacral : int
        Of the joints with loads.
    hand_points, foot_points : (2, n) int
        Points of hands and feet.
    thorax : int
        Frame.
    hand_frames, foot_frames : (2,) int
    """

    n_bodies: int
    feet: IntArray
    hands: IntArray
    lumbosacral: int
    hand_points: IntArray
    foot_points: IntArray
    thorax: int
    hand_frames: IntArray
    foot_frames: IntArray


class OutsideForces(NamedTuple):
    """Forces on hands and feet; see `human_model.motion.BodyMotion`.

    Attributes
    ----------
    ground_force, centre_of_pressure, free_moment, hand_force : (n, 2, 3)
        N, m, N m, N.
    points : (n, n_p, 3)
        m.
    hands : (2,) int
        Where the hands are among them.
    """

    ground_force: Array
    centre_of_pressure: Array
    free_moment: Array
    hand_force: Array
    points: Array
    hands: IntArray


class Loaded(NamedTuple):
    """Wrenches on the bodies, and which feet have a centre of pressure; see `outside_wrenches`.

    Attributes
    ----------
    external : (n, n_b, 6)
        OpenSim's axes.
    loaded : (n, 2) bool
        Whether a foot has a centre of pressure.
    complete : (n,) bool
        Whether both have.
    """

    external: Array
    loaded: BoolArray
    complete: BoolArray


class SolvedArrays(NamedTuple):
    """Arrays of a block that the solver does not have in this form; see `MuscleAnalysis`.

    Attributes
    ----------
    missed : (n,) bool
        Whether the transfer misses a goal.
    """

    disc_position: Array
    disc_orientation: Array
    l5_s1_force: Array
    l5_s1_moment: Array
    compression_per_degree: Array
    anterior_shear_per_degree: Array
    net_moment_top_down: Array
    net_moment_bottom_up: Array
    pelvis_residual: Array
    hand_distance: Array
    foot_distance: Array
    trunk_angle: Array
    hand_angle: Array
    foot_angle: Array
    missed: BoolArray

    def discard_dynamics(self, samples: list[int]) -> None:
        """Set to NaN the results that depend on motion and external forces alone."""
        if samples:
            for array in (
                self.disc_position, self.disc_orientation, self.net_moment_top_down,
                self.net_moment_bottom_up, self.pelvis_residual,
            ):  # fmt: skip
                array[samples] = np.nan

    def discard_muscles(self, samples: list[int]) -> None:
        """Set to NaN the results that depend on the muscle forces."""
        if samples:
            for array in (
                self.l5_s1_force, self.l5_s1_moment, self.compression_per_degree,
                self.anterior_shear_per_degree,
            ):  # fmt: skip
                array[samples] = np.nan


@njit
def _to_opensim(vector: Array, out: Array) -> None:
    out[0], out[1], out[2] = vector[0], vector[2], -vector[1]


@njit
def _from_opensim(vector: Array, out: Array) -> None:
    out[0], out[1], out[2] = vector[0], -vector[2], vector[1]


@njit
def outside_wrenches(boxed: Boxed[Places], forces: OutsideForces) -> Loaded:
    """Return the wrenches of ground and box on the bodies.

    A foot without centre of pressure has none.

    Parameters
    ----------
    boxed : Boxed of Places
    forces
        Of the block.
    """
    places = boxed.content
    n = forces.centre_of_pressure.shape[0]
    out = Loaded(
        np.zeros((n, places.n_bodies, 6)), np.empty((n, 2), np.bool_), np.empty(n, np.bool_)
    )
    force, place, moment = np.empty(3), np.empty(3), np.empty(3)
    for k in range(n):
        for side in range(2):
            cop = forces.centre_of_pressure[k, side]
            out.loaded[k, side] = np.isfinite(cop[0] + cop[1] + cop[2])
            if out.loaded[k, side]:
                _to_opensim(forces.ground_force[k, side], force)
                _to_opensim(cop, place)
                _to_opensim(forces.free_moment[k, side], moment)
                add_force(out.external[k], places.feet[side], force, place, moment)
        out.complete[k] = out.loaded[k, 0] and out.loaded[k, 1]
        moment[:] = 0.0
        for side in range(2):
            _to_opensim(forces.hand_force[k, side], force)
            _to_opensim(forces.points[k, forces.hands[side]], place)
            add_force(out.external[k], places.hands[side], force, place, moment)
    return out


@njit
def _largest(values: Array, index: IntArray) -> float:
    """Return the largest of some values; NaN if one is."""
    out = float(values[index[0]])
    for i in range(1, index.size):
        value = values[index[i]]
        if value > out or np.isnan(value):
            out = value
    return out


@njit
def _empty_arrays(n: int, position: Array, orientation: Array) -> SolvedArrays:
    """Return arrays for n samples, with the poses of the disc."""
    return SolvedArrays(
        position,
        orientation,
        np.empty((n, 3)),
        np.empty((n, 3)),
        np.empty(n),
        np.empty(n),
        np.empty((n, 3)),
        np.empty((n, 3)),
        np.empty((n, 6)),
        np.empty((n, 2)),
        np.empty((n, 2)),
        np.empty(n),
        np.empty((n, 2)),
        np.empty((n, 2)),
        np.empty(n, np.bool_),
    )


@njit
def solved_arrays(
    boxed: Boxed[Places],
    disc_pose: Array,
    joint_force: Array,
    joint_moment: Array,
    net_moment: Array,
    pelvis_residual: Array,
    point_distance: Array,
    frame_angle: Array,
) -> SolvedArrays:
    """Return solutions in REP-103 axes, with the quality of the transfer.

    Parameters
    ----------
    boxed : Boxed of Places
    disc_pose, joint_force, joint_moment, net_moment, pelvis_residual
        Of `sample_data.SampleLoads`.
    point_distance, frame_angle
        Of `motion_transfer.TransferredMotion`.
    """
    places = boxed.content
    n, l5_s1 = disc_pose.shape[0], places.lumbosacral
    position, orientation = world_poses(disc_pose)
    out = _empty_arrays(n, position, orientation)
    for k in range(n):
        for i in range(3):
            out.l5_s1_force[k, i] = joint_force[k, l5_s1, i]
            out.l5_s1_moment[k, i] = joint_moment[k, l5_s1, i]
        # Leaning the disc's normal forward turns it towards x, and x towards -z.
        out.compression_per_degree[k] = out.l5_s1_force[k, 0] * DEGREE
        out.anterior_shear_per_degree[k] = out.l5_s1_force[k, 2] * DEGREE
        _from_opensim(net_moment[k, 0], out.net_moment_top_down[k])
        _from_opensim(net_moment[k, 1], out.net_moment_bottom_up[k])
        # The solver has moments first, the result forces.
        _from_opensim(pelvis_residual[k, 3:], out.pelvis_residual[k, :3])
        _from_opensim(pelvis_residual[k, :3], out.pelvis_residual[k, 3:])
        for side in range(2):
            out.hand_distance[k, side] = _largest(point_distance[k], places.hand_points[side])
            out.foot_distance[k, side] = _largest(point_distance[k], places.foot_points[side])
            out.hand_angle[k, side] = frame_angle[k, places.hand_frames[side]]
            out.foot_angle[k, side] = frame_angle[k, places.foot_frames[side]]
        out.trunk_angle[k] = frame_angle[k, places.thorax]
        kept = out.trunk_angle[k] <= ANGLE_GOAL
        for side in range(2):
            kept = kept and out.hand_distance[k, side] <= DISTANCE_GOAL
            kept = kept and out.foot_distance[k, side] <= DISTANCE_GOAL
            kept = kept and out.hand_angle[k, side] <= ANGLE_GOAL
            kept = kept and out.foot_angle[k, side] <= ANGLE_GOAL
        out.missed[k] = not kept
    return out
