# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Postures at rest with the box in the hands, where nothing was recorded."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.solvers.solution import InteriorPointOptions, Solution
from lift_predictor.core.solvers.solve import solve
from lift_predictor.core.solvers.spline_programme import SplineProgramme
from lift_predictor.core.spatial.grid import HAND_SCALE, LIMITED, NODE_ROWS, SpatialGrid
from lift_predictor.core.spatial.parameters import N_SPLINED, SPLINED
from lift_predictor.core.spatial.programme import posture_assembler
from lift_predictor.core.spatial.starts import SpatialStart, through
from lift_predictor.core.spatial.task import SpatialTask

Array = NDArray[np.float64]

STANDING: Final = {'ankle_mean': 5.0, 'hip_mean': 15.0, 'knee_angle': 12.0,
                   'lumbar_extension': -8.0, 'thorax_extension': -4.0, 'arm_flex': 45.0,
                   'elbow_flex': 45.0}  # fmt: skip
CROUCHING: Final = {'ankle_mean': 15.0, 'hip_mean': 110.0, 'knee_angle': 75.0,
                    'lumbar_extension': -35.0, 'thorax_extension': -12.0, 'arm_flex': 110.0,
                    'elbow_flex': 20.0}  # fmt: skip
"""Where the search of a posture begins, hands high and low: a semi-squat like the recorded ones
(our choice) [deg]."""
TURNED: Final = {'pelvis_turn': 0.4, 'lumbar_rotation': 0.35, 'thorax_rotation': 0.25}
"""Parts of the way to the side that pelvis and spine take in the first guess (our choice)."""
_LOW, _HIGH = 0.3, 1.1
"""Heights of the hands that belong to the two guesses [m]."""


class PostureFinder:
    """Finds postures of least effort at rest.

    Parameters
    ----------
    library : NodeLibrary
        `programme.spatial_library`.
    max_iterations : int
        Of one search.
    """

    def __init__(self, library: NodeLibrary, max_iterations: int = 200) -> None:
        self._assembler = posture_assembler(library)
        self._options = InteriorPointOptions(
            max_iterations=max_iterations, barrier=1e-2, tolerance=1e-6
        )

    def starts(self, task: SpatialTask, grid: SpatialGrid) -> tuple[SpatialStart, ...]:
        """Smooth steps between postures that hold the box at start and end.

        Parameters
        ----------
        task : SpatialTask
            Without a recording.
        grid : SpatialGrid
            Sizes of the programme.

        Raises
        ------
        UnreachableError
            The box cannot be held where the task wants it; names what breaks first.
        """
        # Where the mass is open, the search begins light.
        mass = float(task.bounds.box_mass[0])
        ends = [self.posture(task, end, mass) for end in (0, 1)]
        guesses = [guess(task, end) for end in (0, 1)]
        return (
            through(task, grid, (ends[0], None, ends[1]), 'between postures', mass),
            through(
                task, grid, (ends[0], 0.5 * (guesses[0] + guesses[1]), ends[1]),
                'through a middle', mass,
            ),
        )  # fmt: skip

    def posture(self, task: SpatialTask, end: int, mass: float) -> Array:
        """Posture (26,) at start (0) or end (1) that holds the box at rest with least effort.

        Raises
        ------
        UnreachableError
            There is none near the guess.
        """
        row = 0 if end == 0 else -1
        hand = task.bounds.hand[end] / HAND_SCALE
        low, high = (
            np.concatenate((node[row], angle[row], hand))
            for node, angle in (
                (task.bounds.node_lower, task.bounds.angle_lower),
                (task.bounds.node_upper, task.bounds.angle_upper),
            )
        )
        free = np.full(N_SPLINED, np.inf)
        still = (mass, 1.0)
        programme = SplineProgramme(
            self._assembler,
            task.parameters.pack(),
            (np.append(-free, still), np.append(free, still)),
            (low, high),
            _row_name,
            lambda index: (*SPLINED, 'mass of the box', 'duration')[index],
        )
        solution: Solution = solve(
            programme, np.append(guess(task, end), still), self._options
        )
        if not solution.ok:
            worst = ', '.join(f'{name} ({value:.3g})' for name, value in solution.violated)
            where = task.bounds.hand[end].reshape(2, 3).mean(axis=0).round(3).tolist()
            raise UnreachableError(
                f'the box cannot be held at {where} m at the {("start", "end")[end]} of the lift: '
                f'{solution.status}; {worst or "no limit is violated"}'
            )
        return solution.x[:N_SPLINED]


def guess(task: SpatialTask, end: int) -> Array:
    """First guess (26,) of the posture at start (0) or end (1), by height and direction."""
    hands = task.bounds.hand[end].reshape(2, 3)
    middle = hands.mean(axis=0)
    up = float(np.clip((middle[2] - _LOW) / (_HIGH - _LOW), 0.0, 1.0))
    aside = float(np.arctan2(middle[1], max(middle[0], 1e-6)))
    values = []
    for name in SPLINED:
        plain = name.removesuffix('_r').removesuffix('_l')
        angle = np.radians((1.0 - up) * CROUCHING.get(plain, 0.0) + up * STANDING.get(plain, 0.0))
        values.append(angle + TURNED.get(name, 0.0) * aside)
    return np.array(values)


def _row_name(index: int) -> str:
    if index < len(NODE_ROWS):
        return NODE_ROWS[index]
    index -= len(NODE_ROWS)
    if index < len(LIMITED):
        return f'joint angle limit (4.1) of {LIMITED[index]}'
    return 'hand position (3.13)'
