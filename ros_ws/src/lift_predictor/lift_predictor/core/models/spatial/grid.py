# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes, rows and bounds of the spatial programme, without its functions (no CasADi)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from human_model.constants import SIDES
from human_model.typing import Array
from lift_predictor.core.models.spatial.parameters import (
    ARM_POINTS,
    DEPENDENT,
    N_SCALARS,
    N_SPLINED,
    SPHERE_NAMES,
    SPLINED,
    STRONG,
    TRUNK,
)
from lift_predictor.core.problem.grid import TimeGrid

N_NODE: Final = 3 * N_SPLINED
"""Node variables: splined coordinates, first and second derivatives by normalised time."""

TORQUE_CONSTRAINTS: Final = tuple(f'joint torque limit (4.2) of {joint}' for joint in STRONG)
ANGLE_CONSTRAINTS: Final = tuple(f'joint angle (4.1, 3.15) of {joint}' for joint in DEPENDENT)
GROUND_CONSTRAINTS: Final = (
    'balance (4.3) between heels and tips of the toes',
    *(f'vertical ground reaction of the {side} foot' for side in SIDES),
)
COLLISION_CONSTRAINTS: Final = tuple(
    f'collision (3.10) of the box with the {n}' for n in SPHERE_NAMES
)
WAY_CONSTRAINTS: Final = (
    'box in its sector, right edge', 'box in its sector, left edge', 'box above its lower place',
)  # fmt: skip
ARM_CONSTRAINTS: Final = tuple(
    f'{point} out of the {segment}' for segment in TRUNK for point in ARM_POINTS
)
BODY_CONSTRAINTS: Final = (
    *(
        f'hip flexion with the {side} knee so far extended (hamstrings)'
        for side in ('right', 'left')
    ),
    'acceleration of the box',
)
HAND_CONSTRAINTS: Final = ('distance of the hands (3.11)', 'box level (3.12)')
TECHNIQUE_CONSTRAINTS: Final = (
    'technique: largest Stoop-Squat-Index of the first posture',
    'technique: least Stoop-Squat-Index of the first posture',
)
NODE_CONSTRAINTS: Final = (
    *TORQUE_CONSTRAINTS,
    *ANGLE_CONSTRAINTS,
    *GROUND_CONSTRAINTS,
    *COLLISION_CONSTRAINTS,
    *WAY_CONSTRAINTS,
    *ARM_CONSTRAINTS,
    *BODY_CONSTRAINTS,
    *HAND_CONSTRAINTS,
)
"""Constraints of every node. Units: torques 0 at the lower and 1 at the upper dynamic limit;
angles [rad]; balance 0 at the heels, 1 at the tips of the toes; ground reactions per body weight;
collision `contact.clearance`; way and hands `HAND_SCALE`; arms squared distance per squared
semi-axes, less 1; hamstrings [rad]; acceleration 1 less its square per squared bound."""

LIMITED: Final = SPLINED[4:]
"""Splined coordinates with joint limits: knees, spine, arms."""

REPORT_OUTPUTS: Final = (
    ('torque', len(STRONG)),
    ('lower', len(STRONG)),
    ('upper', len(STRONG)),
    ('ground_force', 6),
    ('pressure', 6),
    ('free_moment', 2),
    ('hand_force', 6),
    ('hand', 6),
    ('effort', 1),
    ('angles', len(DEPENDENT)),
    ('offset', 3 * len(SPHERE_NAMES)),
    ('clear', len(SPHERE_NAMES)),
    ('arms', len(ARM_CONSTRAINTS)),
    ('hamstrings', 2),
    ('pull', 1),
    ('fraction', 1),
    ('inside', 3),
)
"""Outputs of the report and their sizes, in physical units."""

HAND_SCALE: Final = 0.1
"""Unit of the hand constraints [m]: 10 cm of reach weigh as much as the whole range of a joint
torque."""

HAND_BAND: Final = 5e-4
"""How far the distance of the hands may be off, and one hand above the other, at the nodes [m]."""


def constraint_slice(names: tuple[str, ...]) -> slice:
    """Place of a family of constraints, one of the tuples above, within `NODE_CONSTRAINTS`."""
    start = NODE_CONSTRAINTS.index(names[0])
    return slice(start, start + len(names))


@dataclass(frozen=True)
class SpatialGrid(TimeGrid):
    """Sizes of the spatial NLP."""

    N_COORDINATES = N_SPLINED
    N_SCALARS = N_SCALARS

    @cached_property
    def constraint_names(self) -> tuple[str, ...]:
        """Name of every constraint, for messages; those of a technique come last."""
        percent = [f'{100 * s:.0f} % of the lift' for s in self.times]
        return (
            *(f'{row} at {when}' for when in percent for row in NODE_CONSTRAINTS),
            *(f'joint angle (4.1, 3.15) of {j} at {when}' for when in percent for j in LIMITED),
            *(
                f'{side} hand (3.13) {axis} at the {end}'
                for end in ('start', 'end')
                for side in SIDES
                for axis in ('forward', 'left', 'up')
            ),
            *TECHNIQUE_CONSTRAINTS,
        )

    def variable_name(self, index: int) -> str:
        """Name of a variable, for messages."""
        if index >= self.n_splined:
            return ('mass of the box', 'duration of the lift')[index - self.n_splined]
        point, coordinate = divmod(index, N_SPLINED)
        return f'control value {point + 1} of {SPLINED[coordinate]}'


@dataclass(frozen=True, eq=False)
class SpatialBounds:
    """What the task demands of the programme, beside its parameters.

    Attributes
    ----------
    node_lower, node_upper : array, shape (n_nodes, 89)
        Bounds of `NODE_CONSTRAINTS` at each node; posture (3.15) and ground reaction windows
        (3.16, 5.1) are narrower bounds at some nodes.
    angle_lower, angle_upper : array, shape (n_nodes, 22)
        Bounds of `LIMITED` at each node [rad].
    hand : array, shape (2, 6)
        Right and left grip at start and end (3.13) [m].
    box_mass, duration : array, shape (2,)
        Lower and upper bound [kg], [s]; equal: given.
    technique : bool
        Whether the first posture is held in the technique of the parameters.
    """

    node_lower: Array
    node_upper: Array
    angle_lower: Array
    angle_upper: Array
    hand: Array
    box_mass: Array
    duration: Array
    technique: bool = False

    def variables(self, grid: SpatialGrid) -> tuple[Array, Array]:
        """Bounds of the variables; control values have none, their coordinates are constrained."""
        free = np.full(grid.n_splined, np.inf)
        low, high = ([self.box_mass[k], self.duration[k]] for k in (0, 1))
        return np.concatenate((-free, low)), np.concatenate((free, high))

    def constraints(self) -> tuple[Array, Array]:
        """Bounds of the constraints, in the order of `SpatialGrid.constraint_names`."""
        hand = self.hand.ravel() / HAND_SCALE
        style = np.zeros(len(TECHNIQUE_CONSTRAINTS) if self.technique else 0)
        return (
            np.concatenate((self.node_lower.ravel(), self.angle_lower.ravel(), hand, style)),
            np.concatenate(
                (self.node_upper.ravel(), self.angle_upper.ravel(), hand, style + np.inf)
            ),
        )


def plain_bounds(
    n: int, leg_limits: tuple[Array, Array], angle_limits: tuple[Array, Array]
) -> tuple[Array, Array, Array, Array]:
    """Bounds of n nodes without windows: node constraints and joint limits.

    Parameters
    ----------
    n : int
        Nodes.
    leg_limits, angle_limits : pair of array
        Lower and upper joint limits of `DEPENDENT` and `LIMITED` [rad].

    Returns
    -------
    node_lower, node_upper, angle_lower, angle_upper : array
        As in `SpatialBounds`.
    """
    lower, upper = np.zeros(len(NODE_CONSTRAINTS)), np.full(len(NODE_CONSTRAINTS), np.inf)
    upper[constraint_slice(TORQUE_CONSTRAINTS)] = 1.0
    lower[constraint_slice(ANGLE_CONSTRAINTS)], upper[constraint_slice(ANGLE_CONSTRAINTS)] = (
        leg_limits
    )
    upper[constraint_slice(GROUND_CONSTRAINTS).start] = 1.0
    lower[constraint_slice(HAND_CONSTRAINTS)] = -HAND_BAND / HAND_SCALE
    upper[constraint_slice(HAND_CONSTRAINTS)] = HAND_BAND / HAND_SCALE
    repeat = (n, 1)
    return (
        np.tile(lower, repeat),
        np.tile(upper, repeat),
        np.tile(angle_limits[0], repeat),
        np.tile(angle_limits[1], repeat),
    )
