# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Postures at rest with the box in the hands, where nothing was recorded."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import UnreachableError
from lift_predictor.core.models.spatial.assembly import posture_assembler
from lift_predictor.core.models.spatial.grid import (
    HAND_SCALE,
    LIMITED,
    NODE_CONSTRAINTS,
    SpatialGrid,
)
from lift_predictor.core.models.spatial.parameters import N_SPLINED, SPLINED
from lift_predictor.core.models.spatial.starts import leads_right, mirrored, through
from lift_predictor.core.models.spatial.task import SpatialTask
from lift_predictor.core.problem.run import Start
from lift_predictor.core.solvers.library import NodeLibrary
from lift_predictor.core.solvers.solution import InteriorPointOptions, Solution
from lift_predictor.core.solvers.solve import solve
from lift_predictor.core.solvers.spline_nlp import SplineNlp

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
GUESSES: Final = 4
"""Searches of each posture: there are several local minima."""
SPREAD: Final = 0.35
"""Standard deviation of the other guesses from the first (our choice) [rad]."""
SEED: Final = 5
SAME: Final = 0.05
"""Postures that differ less are the same [rad]."""
OTHER_BARRIER: Final = 1e-2
"""First barrier parameter from the second best postures, to leave them if others are better."""


class PostureFinder:
    """Finds postures of least effort at rest.

    Parameters
    ----------
    library : NodeLibrary
        `assembly.spatial_library`.
    max_iterations : int
        Of one search.
    """

    def __init__(self, library: NodeLibrary, max_iterations: int = 200) -> None:
        self._assembler = posture_assembler(library)
        self._options = InteriorPointOptions(
            max_iterations=max_iterations, barrier=1e-2, tolerance=1e-6
        )

    def starts(
        self, task: SpatialTask, grid: SpatialGrid, guesses: int = GUESSES
    ) -> tuple[Start, ...]:
        """Smooth steps between postures that hold the box at start and end.

        Parameters
        ----------
        task : SpatialTask
            Without a recording.
        grid : SpatialGrid
            Sizes of the NLP.
        guesses : int
            Searches of each posture.

        Raises
        ------
        UnreachableError
            The box cannot be held at the place of the task; names the violated constraint.
        """
        # Where the mass is open, the search begins light.
        mass = float(task.bounds.box_mass[0])
        ends = [self.postures(task, end, mass, guesses) for end in (0, 1)]
        pairs = [(one[1] + other[1], one[0], other[0]) for one in ends[0] for other in ends[1]]
        best, *others = sorted(pairs, key=lambda pair: pair[0])
        starts = [through(task, grid, (best[1], None, best[2]), 'between postures', mass)]
        if others:
            second = others[0][1], None, others[0][2]
            other = through(task, grid, second, 'other postures', mass)
            starts.append(replace(other, barrier=OTHER_BARRIER))
        middle = 0.5 * (guess(task, 0) + guess(task, 1))
        starts.append(through(task, grid, (best[1], middle, best[2]), 'through a middle', mass))
        return tuple(starts)

    def postures(
        self, task: SpatialTask, end: int, mass: float, guesses: int
    ) -> tuple[tuple[Array, float], ...]:
        """Different postures (26,) at start (0) or end (1), and effort, the least effort first.

        Parameters
        ----------
        task : SpatialTask
            Where the box is.
        end : int
            0 or 1.
        mass : float
            Of the box [kg].
        guesses : int
            Searches, each from another guess.

        Raises
        ------
        UnreachableError
            No search found one; from the first guess.
        """
        rng, first = np.random.default_rng(SEED + end), guess(task, end)
        found: list[tuple[Array, float]] = []
        failed: UnreachableError | None = None
        for number in range(guesses):
            shift = SPREAD * rng.normal(size=len(first)) if number else np.zeros(len(first))
            begin = first + (mirrored(shift) if leads_right(task) else shift)
            try:
                posture, effort = self._search(task, end, mass, begin)
            except UnreachableError as error:
                failed = failed or error
                continue
            if all(np.abs(posture - other).max() > SAME for other, _ in found):
                found.append((posture, effort))
        if failed is not None and not found:
            raise failed
        return tuple(sorted(found, key=lambda one: one[1]))

    def posture(self, task: SpatialTask, end: int, mass: float) -> Array:
        """Posture (26,) at start (0) or end (1) that holds the box at rest with least effort.

        Raises
        ------
        UnreachableError
            There is none near the guess.
        """
        return self._search(task, end, mass, guess(task, end))[0]

    def _search(
        self, task: SpatialTask, end: int, mass: float, begin: Array
    ) -> tuple[Array, float]:
        """Posture near a guess, and its effort."""
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
        nlp = SplineNlp(
            self._assembler,
            task.parameters.pack(),
            (np.append(-free, still), np.append(free, still)),
            (low, high),
            _constraint_name,
            lambda index: (*SPLINED, 'mass of the box', 'duration')[index],
        )
        solution: Solution = solve(nlp, np.append(begin, still), self._options)
        if not solution.ok:
            worst = ', '.join(f'{name} ({value:.3g})' for name, value in solution.violated)
            where = task.bounds.hand[end].reshape(2, 3).mean(axis=0).round(3).tolist()
            raise UnreachableError(
                f'the box cannot be held at {where} m at the {("start", "end")[end]} of the lift: '
                f'{solution.status}; {worst or "no limit is violated"}'
            )
        return solution.x[:N_SPLINED], solution.objective


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


def _constraint_name(index: int) -> str:
    if index < len(NODE_CONSTRAINTS):
        return NODE_CONSTRAINTS[index]
    index -= len(NODE_CONSTRAINTS)
    if index < len(LIMITED):
        return f'joint angle limit (4.1) of {LIMITED[index]}'
    return 'hand position (3.13)'
