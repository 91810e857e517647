# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Postures in space that hold the box at a place and are near a guess, by kinematics alone."""

from __future__ import annotations

from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.models.sagittal.parameters import JOINTS
from lift_predictor.core.models.spatial.evaluation import evaluate, lowering
from lift_predictor.core.models.spatial.grid import COLLISION_CONSTRAINTS, WAY_CONSTRAINTS
from lift_predictor.core.models.spatial.parameters import DEPENDENT, SPLINED
from lift_predictor.core.models.spatial.postures import TURNED
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.planning.postures import GUESSES, Posture, nearest_posture
from lift_predictor.core.planning.technique import Technique, off_technique, technique_range
from lift_predictor.core.solvers.library import NodeLibrary

RHYTHM: Final = {'lumbar_extension': 0.63, 'thorax_extension': 0.37}
"""Shares of both spine joints in the bending of the trunk: the lumbar rhythm of the lifting
full-body model (see `human_model`, `strength_map.csv`)."""
_SAME: Final = {
    'arm_flex_r': 'arm_flex', 'arm_flex_l': 'arm_flex', 'elbow_flex_r': 'elbow_flex',
    'elbow_flex_l': 'elbow_flex', 'hip_mean': 'hip_flexion', 'ankle_mean': 'ankle_angle',
    'knee_angle_r': 'knee_angle', 'knee_angle_l': 'knee_angle',
}  # fmt: skip
"""Coordinates in space that are those of the plane in a symmetric posture."""
_NO_POSTURE: Final = 10.0
"""Residual where the legs would have to be longer than they are [m]."""


def spatial_guess(name: str, task: SpatialTask, end: int) -> Array:
    """Return a guess of the plane (key of `GUESSES`) turned towards the box, (26,) [rad]."""
    plane = dict(zip(JOINTS, np.radians(GUESSES[name]), strict=True))
    x, y, _ = task.bounds.hand[end].reshape(2, 3).mean(axis=0)
    aside = float(np.arctan2(y, max(x, 1e-6)))
    values = []
    for joint in SPLINED:
        value = plane[_SAME[joint]] if joint in _SAME else 0.0
        value += RHYTHM.get(joint, 0.0) * plane['lumbar_extension']
        values.append(value + TURNED.get(joint, 0.0) * aside)
    return np.array(values)


def near_guess(
    name: str,
    task: SpatialTask,
    end: int,
    library: NodeLibrary,
    technique: Technique | None = None,
) -> Posture:
    """Find the posture nearest to a guess that holds the box, clear of it and in balance.

    Parameters
    ----------
    name : str
        Key of `GUESSES`.
    task : SpatialTask
        Person, feet and box.
    end : int
        0: at the start, 1: at the end of the lift.
    library : NodeLibrary
        `programme.spatial_library`.
    technique : Technique, optional
        Range of the Stoop-Squat-Index to be in.
    """
    person, parameters = task.person, task.parameters
    lower, upper = person.limits(SPLINED)
    leg_lower, leg_upper = person.limits(DEPENDENT)
    wanted = task.bounds.hand[end]
    mass = float(task.bounds.box_mass[0])
    length = float(parameters.sole[1] - parameters.sole[0])
    weight = parameters.body_mass * parameters.gravity
    index = technique_range(technique)

    def errors(q: Array) -> Array:
        still = np.zeros_like(q)
        loads = evaluate(library, q, still, still, mass, parameters)
        style = np.zeros(len(q))
        if index is not None:
            style = off_technique(*lowering(library, q, parameters), index)
        outside = np.maximum(np.maximum(-loads.fraction, loads.fraction - 1.0), 0.0)
        residual = np.column_stack(
            (
                loads.hand.reshape(len(q), 6) - wanted,
                np.minimum(loads.gaps, 0.0),
                np.minimum(loads.inside, 0.0),
                np.minimum(loads.arms, 0.0),
                np.minimum(loads.hamstrings, 0.0),
                np.maximum(np.maximum(leg_lower - loads.angles, loads.angles - leg_upper), 0.0),
                length * outside,
                np.minimum(loads.ground_force[:, :, 2] / weight, 0.0),
                style,
            )
        )
        return np.where(np.isnan(residual), _NO_POSTURE, residual)

    clear = 6 + len(COLLISION_CONSTRAINTS) + len(WAY_CONSTRAINTS)
    q, rest = nearest_posture(errors, spatial_guess(name, task, end), lower, upper)
    return Posture(
        name,
        q,
        distance=float(np.linalg.norm(rest[:6].reshape(2, 3), axis=1).max()),
        depth=float(-rest[6:clear].min()),
        unbalanced=float(np.abs(rest[clear:-1]).max()),
        off_technique=float(rest[-1]),
    )


def first_good(
    field: str,
    guesses: tuple[str, ...],
    task: SpatialTask,
    end: int,
    library: NodeLibrary,
    technique: Technique | None = None,
) -> Posture:
    """Find the first good posture from several guesses.

    Raises
    ------
    UnreachableError
        There is none: names field, place and what is missing.
    """
    found = []
    for name in guesses:
        posture = near_guess(name, task, end, library, technique)
        if posture.good:
            return posture
        found.append(posture)
    best = min(found, key=lambda posture: posture.miss)
    place = task.bounds.hand[end].reshape(2, 3).mean(axis=0)
    problems = best.problems(
        'the body or out of its way', 'legs or balance leave their limits',
        technique.name if technique else 'technique',
    )  # fmt: skip
    raise UnreachableError(
        f'task.{field}: with the hands at forward {place[0]:.3f} m, left {place[1]:.3f} m, up '
        f'{place[2]:.3f} m from between the ankles, {problems}'
    )
