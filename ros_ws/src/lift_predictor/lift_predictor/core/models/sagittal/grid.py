# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes, rows and bounds of the sagittal programme, without its functions (no CasADi)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.models.sagittal.parameters import (
    BODIES,
    CIRCLE_BODIES,
    JOINTS,
    N_JOINTS,
    N_SCALARS,
)
from lift_predictor.core.problem.grid import TimeGrid

N_NODE: Final = 3 * N_JOINTS
"""Node variables: joint angles and their first and second derivatives by normalised time."""

NODE_CONSTRAINTS: Final = (
    *(f'joint torque limit (4.2) of {joint}' for joint in JOINTS),
    'balance (4.3) at the rear edge of the foot support region',
    'balance (4.3) at the front edge of the foot support region',
    *(f'collision (4.5) of the box with the {body}' for body in CIRCLE_BODIES),
    'height of the box over the lower of its places',
    'hip flexion with the knee so far extended (hamstrings)',
    'acceleration of the box',
)
NODE_UPPER: Final = (1.0,) * N_JOINTS + (float('inf'),) * (len(NODE_CONSTRAINTS) - N_JOINTS)
"""Upper bounds of the node constraints; all lower bounds are 0."""

CENTRES: Final = ('ankle', 'knee', 'hip', 'lumbar', 'shoulder', 'elbow', 'hand')
REPORT_OUTPUTS: Final = (
    ('torque', N_JOINTS),
    ('lower', N_JOINTS),
    ('upper', N_JOINTS),
    ('ground_force', 2),
    ('ground_moment', 1),
    ('hand_force', 2),
    ('constraints', len(NODE_CONSTRAINTS)),
    ('effort', 1),
    ('centres', 2 * len(CENTRES)),
    ('segment_angle', len(BODIES)),
)
"""Outputs of the report and their sizes; units as in `model.chain_state`."""

HAND_SCALE: Final = 0.01
"""Unit of the hand position constraints [m]: where no motion is feasible, IPOPT ends at the least
sum of scaled violations, and 1 cm of reach should weigh as much as the whole range of a joint
torque, or it would always be the reach that is violated."""


@dataclass(frozen=True)
class SagittalGrid(TimeGrid):
    """Sizes of the sagittal NLP."""

    N_COORDINATES = N_JOINTS
    N_SCALARS = N_SCALARS

    @cached_property
    def constraint_names(self) -> tuple[str, ...]:
        """Name of every constraint, for messages."""
        percent = [f'{100 * s:.0f} % of the lift' for s in self.times]
        return (
            *(f'{row} at {when}' for when in percent for row in NODE_CONSTRAINTS),
            *(f'joint angle limit (4.1) of {j} at {when}' for when in percent for j in JOINTS),
            *(
                f'hand position (4.6) {axis} at the {end} [cm]'
                for end in ('start', 'end')
                for axis in ('forward', 'up')
            ),
            *(f'posture (4.8) of {joint} at 50 % of the lift' for joint in JOINTS),
        )

    def variable_name(self, index: int) -> str:
        """Name of a variable's bounds, for messages."""
        if index >= self.n_splined:
            return 'mass of the box'
        point, joint = divmod(index, N_JOINTS)
        if point == 0:
            return f'posture (4.8) of {JOINTS[joint]} at the start'
        if point == self.spline.n_free - 1:
            return f'posture (4.8) of {JOINTS[joint]} at the end'
        return f'control value {point + 1} of {JOINTS[joint]}'


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
        Distance to keep from the lower and upper bounds of the node constraints and joint angles,
        where a solution was found to leave them between the nodes; none if omitted.
    """

    angle_lower: Array
    angle_upper: Array
    posture_lower: Array
    posture_upper: Array
    hand: Array
    box_mass: Array
    margin: Array | None = None

    def variables(self, grid: SagittalGrid) -> tuple[Array, Array]:
        """Bounds of the variables: postures at both ends, which are control points, and mass."""
        lower = np.full((grid.spline.n_free, N_JOINTS), -np.inf)
        upper = -lower
        lower[0], upper[0] = self.posture_lower[0], self.posture_upper[0]
        lower[-1], upper[-1] = self.posture_lower[2], self.posture_upper[2]
        return np.append(lower, self.box_mass[0]), np.append(upper, self.box_mass[1])

    def constraints(self, grid: SagittalGrid) -> tuple[Array, Array]:
        """Bounds of the constraints, in the order of `SagittalGrid.constraint_names`."""
        n, n_rows = grid.n_nodes, len(NODE_CONSTRAINTS)
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
