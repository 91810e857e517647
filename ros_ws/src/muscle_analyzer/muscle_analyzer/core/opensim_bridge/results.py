# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Results of this project and of OpenSim for the same motion, in the same arrays.

Torques are of all samples, everything else of the few instants that OpenSim solved. Everything is
in OpenSim's ground axes.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from human_model.opensim_storage import Storage, read_storage
from human_model.typing import Array
from muscle_analyzer.core.exceptions import OpenSimError
from muscle_analyzer.core.multibody.model import MultibodyModel
from muscle_analyzer.core.opensim_bridge import setup_files as files
from muscle_analyzer.core.opensim_bridge.motion_on_model import MotionOnModel

Rows = NDArray[np.int64]

#: Instants are one if they are so close [s].
SAME_TIME = 1e-6


@dataclass(frozen=True, eq=False)
class Answer:
    """One program's answer.

    Attributes
    ----------
    torque : (n, n_x) array
        Of all coordinates of the tree, coupled ones apart, N m or N; NaN where OpenSim
        has none.
    length : (k, n_m) array
        Muscle path lengths, m.
    moment_arm : (k, n_m, n_c) array
        About the balanced coordinates, m.
    activation, force : (k, n_m) arrays
        Force along the tendon, N.
    reserve : (k, n_c) array
        N m.
    reaction : (k, n_b, 6) array
        Moment about the joint's centre and force of the parent on each body, N m and N.
    """

    torque: Array
    length: Array
    moment_arm: Array
    activation: Array
    force: Array
    reserve: Array
    reaction: Array


@dataclass(frozen=True, eq=False)
class OpenSimRun:
    """OpenSim's answer and how it came about.

    Attributes
    ----------
    answer : Answer
    version : str
    seconds : mapping of str to list of float
        Wall time of each run of a tool, loading of the model included.
    """

    answer: Answer
    version: str
    seconds: dict[str, list[float]]


def read_opensim(
    folder: Path,
    motion: MotionOnModel,
    muscle_names: tuple[str, ...],
    coordinate_names: tuple[str, ...],
    rows: Rows,
) -> OpenSimRun:
    """Read what OpenSim's tools left in the results of an exported folder.

    Parameters
    ----------
    folder : Path
    motion : MotionOnModel
        That was exported.
    muscle_names, coordinate_names : tuples of str
        Order of muscles and of balanced coordinates in the answer.
    rows : (k,) int array
        Samples that were solved.

    Raises
    ------
    StorageError
        If a table is damaged or lacks a column.
    OpenSimError
        If results are missing or belong to other instants.
    """
    results = folder / files.RESULTS
    model = motion.model
    stored = _read_script_result(results / files.SCRIPT_RESULT)
    times = motion.time[rows]
    solved = np.asarray(stored['times'], np.float64)
    if solved.shape != times.shape or np.abs(times - solved).max() > SAME_TIME:
        raise OpenSimError(f'{results / files.SCRIPT_RESULT}: at {solved} s, not at {times} s')
    tables = {
        name: read_storage(results / name)
        for name in (
            files.TORQUES_RESULT,
            files.FORCES_RESULT,
            files.ACTIVATIONS_RESULT,
            files.REACTIONS_RESULT,
        )
    }
    muscles = [stored['muscles'].index(name) for name in muscle_names]
    about = [stored['coordinates'].index(name) for name in coordinate_names]
    reserves = [f'{files.RESERVE_PREFIX}{name}' for name in coordinate_names]
    force = tables[files.FORCES_RESULT]
    answer = Answer(
        torque=_torques(tables[files.TORQUES_RESULT], model.tree_coordinate_names, motion),
        length=np.array(stored['length'])[:, muscles],
        moment_arm=np.array(stored['moment_arm'])[:, muscles][:, :, about],
        activation=tables[files.ACTIVATIONS_RESULT].select(muscle_names)[: rows.size],
        force=force.select(muscle_names)[: rows.size],
        reserve=force.select(reserves)[: rows.size],
        reaction=_reactions(tables[files.REACTIONS_RESULT], model)[: rows.size],
    )
    for name in (files.FORCES_RESULT, files.REACTIONS_RESULT):
        if np.abs(tables[name].time[: rows.size] - times).max() > SAME_TIME:
            raise OpenSimError(f'{results / name}: rows at {tables[name].time}, not at {times}')
    return OpenSimRun(answer, str(stored['opensim']), dict(stored['seconds']))


def _read_script_result(path: Path) -> dict[str, Any]:
    try:
        found: dict[str, Any] = json.loads(path.read_text(encoding='utf-8'))
    except (OSError, ValueError) as error:
        raise OpenSimError(f'{path}: cannot be read: {error}') from error
    return found


def _torques(table: Storage, names: tuple[str, ...], motion: MotionOnModel) -> Array:
    """Return the columns of all coordinates; OpenSim calls them moment or force."""
    values = table.at(motion.time)
    torque = np.full((motion.time.size, len(names)), np.nan)
    for k, name in enumerate(names):
        for label in (f'{name}_moment', f'{name}_force'):
            if label in table.columns:
                torque[:, k] = values[:, table.columns.index(label)]
    return torque


def _reactions(table: Storage, model: MultibodyModel) -> Array:
    """Return moment and force of the parent on each body; the ground has none."""
    found = np.zeros((table.time.size, len(model.body_names), 6))
    for b, (joint, body) in enumerate(zip(model.joint_names, model.body_names, strict=True)):
        if joint:
            labels = [f'{joint}_on_{body}_in_ground_{kind}{a}' for kind in 'mf' for a in 'xyz']
            found[:, b] = table.select(labels)
    return found
