# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A body motion on the musculoskeletal model with all that pushes it from outside, over time.

This is what the bridge writes for OpenSim and what it computes with on this side, so that both
see the same input. Everything is in OpenSim's axes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from human_model.constants import SIDES
from human_model.frames import to_opensim
from human_model.motion import BodyMotion
from human_model.typing import Array
from muscle_analyzer.core.exceptions import InputArrayError, TransferError
from muscle_analyzer.core.loads.block_solver import FEET, HANDS
from muscle_analyzer.core.multibody.inverse_dynamics import add_force
from muscle_analyzer.core.multibody.kinematics import coordinate_state
from muscle_analyzer.core.multibody.model import MultibodyModel
from muscle_analyzer.core.opensim_bridge.derivatives import differentiate
from muscle_analyzer.core.opensim_bridge.meshes import Mesh, read_meshes, scaled_meshes
from muscle_analyzer.core.opensim_bridge.setup_files import PointForce
from muscle_analyzer.core.transfer.motion_transfer import MotionTransfer

#: Stamps since 1970 are doubles of 2.4e-7 s; OpenSim writes times with eight decimals.
TIME_DECIMALS = 6


@dataclass(frozen=True, eq=False)
class MotionOnModel:
    """A motion of the musculoskeletal model.

    Attributes
    ----------
    model : MultibodyModel
    time : (n,) array
        s.
    q : (n, n_q) array
        Independent coordinates, rad or m.
    qd, qdd : (n, n_q) arrays
        Rates and accelerations that belong to `q`.
    forces : tuple of PointForce
        Of ground and box.
    meshes : tuple of Mesh
        Bones, for OpenSim's window only.
    """

    model: MultibodyModel
    time: Array
    q: Array
    qd: Array
    qdd: Array
    forces: tuple[PointForce, ...]
    meshes: tuple[Mesh, ...] = ()

    def external(self, k: int) -> Array:
        """Return the wrenches (n_b, 6) on the bodies in sample `k`, see `add_force`."""
        wrenches = np.zeros((len(self.model.body_names), 6))
        for f in self.forces:
            body = self.model.body_index(f.body)
            add_force(wrenches, body, f.force[k], f.point[k], f.moment[k])
        return wrenches

    def tree_coordinates(self) -> Array:
        """Return all coordinates (n, n_x), coupled and locked ones too, order of the tree."""
        tree = self.model.tree
        zero = np.zeros(self.q.shape[1])
        return np.array([coordinate_state(tree, q, zero, zero).value for q in self.q])

    def with_splined_rates(self) -> MotionOnModel:
        """Return the motion with the rates that OpenSim takes from `q`: of a quintic spline.

        Raises
        ------
        InputArrayError
            If there are too few samples or their steps are not even.
        """
        qd, qdd = differentiate(self.time, self.q)
        return replace(self, qd=qd, qdd=qdd)

    def rows(self, times: Array) -> NDArray[np.int64]:
        """Return the numbers of the samples nearest to the given times, each once.

        Raises
        ------
        InputArrayError
            If there are none or one is outside the motion.
        """
        wanted = np.atleast_1d(np.asarray(times, np.float64))
        if wanted.size == 0:
            raise InputArrayError('no instants to compare')
        outside = (wanted < self.time[0]) | (wanted > self.time[-1]) | ~np.isfinite(wanted)
        if np.any(outside):
            raise InputArrayError(
                f'instant {wanted[outside][0]:.6g} s is outside the lift, {self.time[0]:.6g} to '
                f'{self.time[-1]:.6g} s'
            )
        nearest = np.abs(self.time[None, :] - wanted[:, None]).argmin(axis=1)
        return np.unique(nearest).astype(np.int64)


def motion_on_model(transfer: MotionTransfer, motion: BodyMotion, start: float) -> MotionOnModel:
    """Take a motion over to the musculoskeletal model, as the analysis does.

    Parameters
    ----------
    transfer : MotionTransfer
        Of the subject and the motion's skeleton.
    motion : BodyMotion
    start : float
        Is zero of the result's time, s.

    Raises
    ------
    TransferError
        If a sample cannot be transferred.
    OsimFormatError
        If the generic model's file was damaged in the meantime.
    """
    transfer.reset()
    poses = transfer.block(motion)
    if not poses.converged.all():
        k = int(np.argmin(poses.converged))
        raise TransferError(
            f'sample at {motion.time[k] - start:.3f} s: not converged in {poses.iterations[k]} '
            'iterations'
        )
    model = transfer.subject.multibody
    return MotionOnModel(
        model=model,
        time=np.round(motion.time - start, TIME_DECIMALS),
        q=poses.q,
        qd=poses.qd,
        qdd=poses.qdd,
        forces=forces_of(motion),
        meshes=scaled_meshes(read_meshes(Path(model.source.source)), transfer.subject.factors),
    )


def forces_of(motion: BodyMotion) -> tuple[PointForce, ...]:
    """Return the forces of the ground on the feet and of the box on the hands.

    A foot without a centre of pressure is unloaded, as in the analysis.
    """
    place = to_opensim(motion.centre_of_pressure)
    loaded = np.all(np.isfinite(place), axis=2, keepdims=True)
    ground = [
        np.where(loaded, array, 0.0)
        for array in (to_opensim(motion.ground_force), place, to_opensim(motion.free_moment))
    ]
    found = [
        PointForce(f'ground_force_{side}', FEET[i], *(array[:, i] for array in ground))
        for i, side in enumerate(SIDES)
    ]
    pull = to_opensim(motion.hand_force)
    for i, side in enumerate(SIDES):
        grip = to_opensim(motion.point(HANDS[i]))
        found.append(
            PointForce(f'hand_force_{side}', HANDS[i], pull[:, i], grip, np.zeros_like(grip))
        )
    return tuple(found)
