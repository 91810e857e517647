# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes, rows and bounds of the spatial programme, without its functions (no CasADi)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.bspline import RestToRestSpline, require_nodes
from lift_predictor.core.spatial.parameters import (
    DEPENDENT,
    N_SCALARS,
    N_SPLINED,
    SPHERE_NAMES,
    SPLINED,
    STRONG,
)

N_NODE: Final = 3 * N_SPLINED
"""Node variables: splined coordinates, first and second derivatives by normalised time."""

_SIDES: Final = ('right', 'left')
TORQUE_ROWS: Final = tuple(f'joint torque limit (4.2) of {joint}' for joint in STRONG)
ANGLE_ROWS: Final = tuple(f'joint angle (4.1, 3.15) of {joint}' for joint in DEPENDENT)
GROUND_ROWS: Final = (
    'balance (4.3) between heels and tips of the toes',
    *(f'vertical ground reaction of the {side} foot' for side in _SIDES),
)
COLLISION_ROWS: Final = tuple(f'collision (3.10) of the box with the {n}' for n in SPHERE_NAMES)
WAY_ROWS: Final = (
    'box in its sector, right edge', 'box in its sector, left edge', 'box above its lower place',
)  # fmt: skip
HAND_ROWS: Final = ('distance of the hands (3.11)', 'box level (3.12)')
TECHNIQUE_ROWS: Final = (
    'technique: largest Stoop-Squat-Index of the first posture',
    'technique: least Stoop-Squat-Index of the first posture',
)
NODE_ROWS: Final = (
    *TORQUE_ROWS, *ANGLE_ROWS, *GROUND_ROWS, *COLLISION_ROWS, *WAY_ROWS, *HAND_ROWS,
)  # fmt: skip
"""Rows of every node. Units: torques 0 at the lower and 1 at the upper dynamic limit; angles
[rad]; balance 0 at the heels, 1 at the tips of the toes; ground reactions per body weight;
collision squared distance per squared sum of radii, less 1; way and hands `HAND_SCALE`."""

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
    ('gaps', len(SPHERE_NAMES)),
    ('share', 1),
    ('inside', 3),
)
"""Outputs of the report and their sizes, in physical units."""

HAND_SCALE: Final = 0.1
"""Unit of the hand rows [m]: 10 cm of reach weigh as much as the whole range of a joint torque."""

HAND_BAND: Final = 5e-4
"""How far the distance of the hands may be off, and one hand above the other, at the nodes [m]."""

WEIGHT_OFFSET: Final = 10.0
"""Added to the box's weight in the logarithm of equation 3.9 [N]."""


def row_slice(rows: tuple[str, ...]) -> slice:
    """Place of a family of rows, one of the tuples above, within `NODE_ROWS`."""
    start = NODE_ROWS.index(rows[0])
    return slice(start, start + len(rows))


@dataclass(frozen=True)
class SpatialGrid:
    """Sizes that fix the structure of the programme.

    Attributes
    ----------
    n_control : int
        Control points per coordinate.
    n_nodes : int
        Uniform time nodes of the constraints and of Simpson's rule: 2 (n_control - 3) k + 1.

    Raises
    ------
    SplineError
        Numbers that do not fit.
    """

    n_control: int
    n_nodes: int

    def __post_init__(self) -> None:
        require_nodes(self.n_control, self.n_nodes)

    @cached_property
    def spline(self) -> RestToRestSpline:
        """Spline of each coordinate."""
        return RestToRestSpline(self.n_control)

    @property
    def n_splined(self) -> int:
        """Control values, all coordinates of one point together."""
        return self.spline.n_free * N_SPLINED

    @property
    def n_variables(self) -> int:
        """Control values, box mass [kg], duration [s]."""
        return self.n_splined + N_SCALARS

    @property
    def times(self) -> Array:
        """Normalised node times, shape (n_nodes,)."""
        return np.linspace(0.0, 1.0, self.n_nodes)

    @cached_property
    def row_names(self) -> tuple[str, ...]:
        """Name of every constraint row, for messages; those of a technique come last."""
        percent = [f'{100 * s:.0f} % of the lift' for s in self.times]
        return (
            *(f'{row} at {when}' for when in percent for row in NODE_ROWS),
            *(f'joint angle (4.1, 3.15) of {j} at {when}' for when in percent for j in LIMITED),
            *(
                f'{side} hand (3.13) {axis} at the {end}'
                for end in ('start', 'end')
                for side in _SIDES
                for axis in ('forward', 'left', 'up')
            ),
            *TECHNIQUE_ROWS,
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
    node_lower, node_upper : array, shape (n_nodes, 58)
        Bounds of `NODE_ROWS` at each node; posture (3.15) and ground reaction windows (3.16, 5.1)
        are narrower bounds at some nodes.
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
        """Bounds of the variables; control values have none, their coordinates have rows."""
        free = np.full(grid.n_splined, np.inf)
        low, high = ([self.box_mass[k], self.duration[k]] for k in (0, 1))
        return np.concatenate((-free, low)), np.concatenate((free, high))

    def rows(self) -> tuple[Array, Array]:
        """Bounds of the rows, in the order of `SpatialGrid.row_names`."""
        hand = self.hand.ravel() / HAND_SCALE
        style = np.zeros(len(TECHNIQUE_ROWS) if self.technique else 0)
        return (
            np.concatenate((self.node_lower.ravel(), self.angle_lower.ravel(), hand, style)),
            np.concatenate(
                (self.node_upper.ravel(), self.angle_upper.ravel(), hand, style + np.inf)
            ),
        )


def plain_bounds(
    n: int, leg_limits: tuple[Array, Array], angle_limits: tuple[Array, Array]
) -> tuple[Array, Array, Array, Array]:
    """Bounds of n nodes without windows: node rows and joint limits.

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
    lower, upper = np.zeros(len(NODE_ROWS)), np.full(len(NODE_ROWS), np.inf)
    upper[row_slice(TORQUE_ROWS)] = 1.0
    lower[row_slice(ANGLE_ROWS)], upper[row_slice(ANGLE_ROWS)] = leg_limits
    upper[row_slice(GROUND_ROWS).start] = 1.0
    lower[row_slice(HAND_ROWS)] = -HAND_BAND / HAND_SCALE
    upper[row_slice(HAND_ROWS)] = HAND_BAND / HAND_SCALE
    repeat = (n, 1)
    return (
        np.tile(lower, repeat),
        np.tile(upper, repeat),
        np.tile(angle_limits[0], repeat),
        np.tile(angle_limits[1], repeat),
    )
