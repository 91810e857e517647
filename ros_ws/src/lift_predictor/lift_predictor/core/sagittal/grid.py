# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes, rows and bounds of the sagittal programme, without its functions (no CasADi)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.bspline import RestToRestSpline, require_nodes
from lift_predictor.core.sagittal.parameters import (
    CIRCLE_BODIES,
    CIRCLES_PER_BODY,
    JOINTS,
    N_JOINTS,
    N_SCALARS,
)

N_NODE: Final = 3 * N_JOINTS
"""Node variables: joint angles and their first and second derivatives by normalised time."""

NODE_ROWS: Final = (
    *(f'joint torque limit (4.2) of {joint}' for joint in JOINTS),
    'balance (4.3) at the rear edge of the foot support region',
    'balance (4.3) at the front edge of the foot support region',
    *(
        f'collision (4.5) of the box with the {body}'
        for body in CIRCLE_BODIES
        for _ in range(CIRCLES_PER_BODY)
    ),
    'height of the box over the lower of its places',
)
NODE_UPPER: Final = (1.0,) * N_JOINTS + (float('inf'),) * (len(NODE_ROWS) - N_JOINTS)
"""Upper bounds of the node rows; all lower bounds are 0."""

CENTRES: Final = ('ankle', 'knee', 'hip', 'lumbar', 'shoulder', 'elbow', 'hand')
REPORT_OUTPUTS: Final = (
    'torque',
    'lower',
    'upper',
    'ground_force',
    'ground_moment',
    'hand_force',
    'rows',
    'effort',
    'centres',
    'segment_angle',
)

WEIGHT_OFFSET: Final = 10.0
"""Added to the box's weight in the logarithm of equation 2.11 [N]."""

HAND_SCALE: Final = 0.01
"""Unit of the hand position rows [m]: where no motion is feasible, IPOPT ends at the least sum of
scaled violations, and 1 cm of reach should weigh as much as the whole range of a joint torque, or
it would always be the reach that gives."""


@dataclass(frozen=True)
class Grid:
    """Sizes that fix the structure of the programme.

    Attributes
    ----------
    n_control : int
        Control points per joint.
    n_nodes : int
        Uniform time nodes of the constraints, and of Simpson's rule for the effort: an even number
        of intervals in each spline piece, and so at least 2 (n_control - 3) + 1 nodes, as with
        fewer the optimiser finds motions that violate the constraints between the nodes.
    rest : str
        What is zero at both ends: 'velocity' (equation 4.7), or 'acceleration' as well.

    Raises
    ------
    SplineError
        Numbers that do not fit.
    """

    n_control: int
    n_nodes: int
    rest: str = 'velocity'

    def __post_init__(self) -> None:
        require_nodes(self.n_control, self.n_nodes)
        RestToRestSpline(self.n_control, self.rest)

    @property
    def spline(self) -> RestToRestSpline:
        """Spline of each joint."""
        return RestToRestSpline(self.n_control, self.rest)

    @property
    def n_variables(self) -> int:
        """Optimisation variables: `n_angles` control values, then the box's mass [kg]."""
        return self.n_angles + N_SCALARS

    @property
    def n_angles(self) -> int:
        """Free control values, all joints of one point together."""
        return self.spline.n_free * N_JOINTS

    @property
    def times(self) -> Array:
        """Normalised node times, shape (n_nodes,)."""
        return np.linspace(0.0, 1.0, self.n_nodes)

    @cached_property
    def row_names(self) -> tuple[str, ...]:
        """Name of every constraint row, for messages."""
        percent = [f'{100 * s:.0f} % of the lift' for s in self.times]
        return (
            *(f'{row} at {when}' for when in percent for row in NODE_ROWS),
            *(f'joint angle limit (4.1) of {j} at {when}' for when in percent for j in JOINTS),
            *(
                f'hand position (4.6) {axis} at the {end} [cm]'
                for end in ('start', 'end')
                for axis in ('forward', 'up')
            ),
            *(f'posture (4.8) of {joint} at 50 % of the lift' for joint in JOINTS),
        )


@dataclass(frozen=True)
class LiftBounds:
    """What the task demands of the programme, beside its parameters.

    Attributes
    ----------
    angle_lower, angle_upper : array, shape (6,)
        Joint limits (equation 4.1) [rad].
    posture_lower, posture_upper : array, shape (3, 6)
        Posture at 0, T/2 and T (equation 4.8) [rad], joint limits included; infinite where it is
        free.
    hand : array, shape (2, 2)
        Grip (forward, up) at start and end (equation 4.6) [m].
    box_mass : array, shape (2,)
        Lower and upper bound of the box's mass [kg]; equal: a given weight.
    margin : array, shape (2, n_nodes, n_rows + 6), optional
        Distance to keep from the lower and upper bounds of the node rows and joint angles, where
        a solution was found to leave them between the nodes; none if omitted.
    """

    angle_lower: Array
    angle_upper: Array
    posture_lower: Array
    posture_upper: Array
    hand: Array
    box_mass: Array
    margin: Array | None = None

    def variables(self, grid: Grid) -> tuple[Array, Array]:
        """Bounds of the variables: postures at both ends, which are control points, and mass."""
        lower = np.full((grid.spline.n_free, N_JOINTS), -np.inf)
        upper = -lower
        lower[0], upper[0] = self.posture_lower[0], self.posture_upper[0]
        lower[-1], upper[-1] = self.posture_lower[2], self.posture_upper[2]
        return np.append(lower, self.box_mass[0]), np.append(upper, self.box_mass[1])

    def rows(self, grid: Grid) -> tuple[Array, Array]:
        """Bounds of the constraint rows, in the order of `Grid.row_names`."""
        n, n_rows = grid.n_nodes, len(NODE_ROWS)
        margin = np.zeros((2, n, n_rows + N_JOINTS)) if self.margin is None else self.margin
        lower = np.concatenate(
            (
                (np.zeros((n, n_rows)) + margin[0, :, :n_rows]).ravel(),
                (self.angle_lower + margin[0, :, n_rows:]).ravel(),
                self.hand.ravel() / HAND_SCALE,
                self.posture_lower[1],
            )
        )
        upper = np.concatenate(
            (
                (np.array(NODE_UPPER) - margin[1, :, :n_rows]).ravel(),
                (self.angle_upper - margin[1, :, n_rows:]).ravel(),
                self.hand.ravel() / HAND_SCALE,
                self.posture_upper[1],
            )
        )
        return lower, upper
