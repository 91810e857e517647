# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a motion as a folder that OpenSim's tools run unchanged, and reads its motions back.

The model is the subject's as it is computed with here. Coordinates are written in radians: OpenSim
turns degrees only where a coordinate is itself an angle, which a patella's on a spline is not.
All coordinates of the tree are written, those that a coupler drives and those that are locked too:
the tools would put missing ones at their default.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from human_model.exceptions import StorageError
from human_model.opensim_storage import Storage, read_storage, write_storage
from human_model.typing import Array
from muscle_analyzer.core.multibody.model import MultibodyModel
from muscle_analyzer.core.opensim_bridge import setup_files as files
from muscle_analyzer.core.opensim_bridge.model_writer import write_osim
from muscle_analyzer.core.opensim_bridge.motion_on_model import MotionOnModel
from muscle_analyzer.core.recruitment.reserves import read_reserves

#: The set-ups for a whole lift solve one sample in so many; each takes OpenSim seconds.
SAMPLES_PER_SOLUTION = 10


@dataclass(frozen=True)
class ExportOptions:
    """Settings of OpenSim's static optimisation.

    Attributes
    ----------
    exponent : float
        Of the activations in the cost.
    physiology : bool
        Whether muscle force depends on the fibre's length and velocity.
    samples_per_solution : int
        One sample in so many is solved by the set-ups for the whole motion.
    tolerance : float
        At which its optimiser stops.
    iterations : int
        After which that gives up.
    """

    exponent: float = 2.0
    physiology: bool = False
    samples_per_solution: int = SAMPLES_PER_SOLUTION
    tolerance: float = files.OPTIMIZER_TOLERANCE
    iterations: int = files.OPTIMIZER_ITERATIONS


def export_motion(
    folder: Path, motion: MotionOnModel, options: ExportOptions | None = None
) -> tuple[Path, ...]:
    """Write model, coordinates, external loads, reserves and the set-ups of three tools.

    Parameters
    ----------
    folder : Path
        Made if it is not there; files of the same names are replaced.
    motion : MotionOnModel
    options : ExportOptions, optional

    Returns
    -------
    tuple of Path
        The files.

    Raises
    ------
    ModelWriteError
        If the model holds something that cannot be written.
    StorageError
        If a coordinate or force is not finite, or times do not increase.
    OptionError
        If a coordinate has no reserve.
    """
    options = options or ExportOptions()
    folder.mkdir(parents=True, exist_ok=True)
    start, end = float(motion.time[0]), float(motion.time[-1])
    step = options.samples_per_solution
    write_osim(folder / files.MODEL, motion.model.source, motion.meshes)
    write_storage(folder / files.COORDINATES, coordinates_storage(motion))
    write_storage(folder / files.LOADS_DATA, loads_storage(motion))
    files.write_external_loads(folder / files.LOADS, motion.forces)
    files.write_reserves(folder / files.RESERVES, read_reserves(motion.model.coordinate_names))
    files.write_inverse_dynamics(folder / files.INVERSE_DYNAMICS, start, end)
    files.write_static_optimization(
        folder / files.STATIC_OPTIMIZATION, start, end, step, options.exponent,
        options.physiology, options.tolerance, options.iterations,
    )  # fmt: skip
    files.write_joint_reaction(folder / files.JOINT_REACTION, start, end, step)
    names = (
        files.MODEL, files.COORDINATES, files.LOADS_DATA, files.LOADS, files.RESERVES,
        files.INVERSE_DYNAMICS, files.STATIC_OPTIMIZATION, files.JOINT_REACTION,
    )  # fmt: skip
    return tuple(folder / name for name in names)


def coordinates_storage(motion: MotionOnModel) -> Storage:
    """Return all coordinates of the tree over time, rad and m."""
    return Storage(
        'Coordinates', motion.model.tree_coordinate_names, motion.time, motion.tree_coordinates()
    )


def loads_storage(motion: MotionOnModel) -> Storage:
    """Return force, point and free moment of every force from outside, ground axes."""
    columns = tuple(label for force in motion.forces for label in force.columns())
    parts = [part for f in motion.forces for part in (f.force, f.point, f.moment)]
    return Storage('External loads', columns, motion.time, np.concatenate(parts, axis=1))


def rotational_coordinates(model: MultibodyModel) -> tuple[str, ...]:
    """Return the coordinates that are angles: those whose values may be in degrees.

    As for OpenSim (`CustomJoint::getMotionType`), those that turn an axis by a straight line.
    """
    turning = {
        axis.coordinate
        for joint in model.source.joints
        for axis in joint.rotations
        if axis.coordinate is not None and axis.function.is_line()
    }
    return tuple(name for name in model.tree_coordinate_names if name in turning)


def read_coordinates(path: Path, model: MultibodyModel) -> tuple[Array, Array]:
    """Read the times (n,) and independent coordinates (n, n_q) of a motion file, rad and m.

    Parameters
    ----------
    path : Path
        `.mot` or `.sto`, in degrees or radians, for example of OpenSim's inverse kinematics.
    model : MultibodyModel

    Raises
    ------
    StorageError
        If the file is damaged or lacks a coordinate of the model.
    """
    storage = read_storage(path).in_radians(rotational_coordinates(model))
    missing = [name for name in model.coordinate_names if name not in storage.columns]
    if missing:
        raise StorageError(path, f'there is no column for the coordinate {missing[0]!r}')
    return storage.time, storage.select(model.coordinate_names)
