# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The task of one lift in space: box, feet, hands, windows, time (sections 3.3 and 5.1)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.spatial.frame import StanceFrame
from lift_predictor.core.models.spatial.grid import (
    GROUND_CONSTRAINTS,
    LIMITED,
    SpatialBounds,
    SpatialGrid,
    constraint_slice,
    plain_bounds,
)
from lift_predictor.core.models.spatial.parameters import DEPENDENT, SIDES, SpatialParameters
from lift_predictor.core.models.spatial.person import SpatialPerson
from lift_predictor.core.problem.task import NO_BOX, largest_acceleration

SECTOR_MARGIN: Final = float(np.radians(20.0))
"""How far the box may leave the sector of its way to either side (our choice) [rad]."""

LOWEST_MARGIN: Final = 2e-3
"""How far the box may sink below the lower of its places: what the grip gives [m]."""

KEY_JOINTS: Final = (
    *(f'{joint}_{side}' for side in SIDES for joint in (
        'ankle_angle', 'knee_angle', 'hip_flexion', 'elbow_flex',
    )),
    'lumbar_extension', 'thorax_extension', 'lumbar_rotation', 'thorax_rotation',
)  # fmt: skip
"""Key joints of equation 3.15: ankle, knee, hip and elbow flexion, spine flexion and rotation."""
INSTANTS: Final = ('start', 'middle', 'end')


@dataclass(frozen=True, eq=False)
class Recorded:
    """A recorded lift in the stance frame.

    Attributes
    ----------
    time : array, shape (n,)
        From the start of the lift [s].
    q : array, shape (n, 26)
        Splined coordinates.
    key : dict of array, shape (n,)
        `KEY_JOINTS` as recorded [rad].
    vertical : array, shape (n, 2)
        Vertical force of the ground on right and left foot [N].
    forward : array, shape (n,)
        Force of the ground on both feet along their mean direction [N].
    """

    time: Array
    q: Array
    key: dict[str, Array]
    vertical: Array
    forward: Array

    def at(self, values: Array, time: float) -> Array:
        """Values (n, ...) at a time [s]."""
        return np.array([np.interp(time, self.time, column) for column in values.T])


@dataclass(frozen=True, eq=False)
class SpatialTask:
    """One lift to predict.

    Attributes
    ----------
    lift_id : str
        Of the lift.
    start : float
        Start of the lift on the recording's clock [s].
    person : SpatialPerson
        Who lifts.
    frame : StanceFrame
        Where.
    parameters : SpatialParameters
        Numbers of person and task.
    bounds : SpatialBounds
        Demands of the task.
    duration : float
        First guess where it is free [s].
    recorded : Recorded or None
        The recorded lift, if there is one.
    notes : tuple of str
        What had to be adapted, in words.
    """

    lift_id: str
    start: float
    person: SpatialPerson
    frame: StanceFrame
    parameters: SpatialParameters
    bounds: SpatialBounds
    duration: float
    recorded: Recorded | None
    notes: tuple[str, ...] = ()

    @property
    def is_recorded(self) -> bool:
        """Whether there is a recorded lift to compare with."""
        return self.recorded is not None

    @property
    def gravity(self) -> float:
        """[m/s^2]."""
        return self.parameters.gravity

    @property
    def mass(self) -> tuple[float, float]:
        """Least and largest mass of the box [kg]; equal: given."""
        return float(self.bounds.box_mass[0]), float(self.bounds.box_mass[1])

    def with_mass(self, least: float, largest: float) -> SpatialTask:
        """Return the task with other bounds of the box's mass [kg]."""
        return replace(self, bounds=replace(self.bounds, box_mass=np.array([least, largest])))

    def with_objective(self, effort: float, weight: float) -> SpatialTask:
        """Return the task with other factors of effort and log-weight (equation 3.9)."""
        parameters = replace(self.parameters, objective=np.array([effort, weight]))
        return replace(self, parameters=parameters)


@dataclass(frozen=True, eq=False)
class PlacedBox:
    """A box and where it goes, in the stance frame.

    Attributes
    ----------
    mass : tuple of float
        Lower and upper bound [kg]; equal: given.
    size : tuple of float
        Extent away from the person, to the side and up [m].
    width : float
        Distance of the hands [m].
    places : array, shape (2, 3)
        Middle of the hands at start and end [m].
    turns : array, shape (2,)
        Direction the box is turned to about the vertical, 0: facing forward [rad].
    from_hand : array, shape (3,)
        Its centre from the middle of the hands, in its own axes [m].
    """

    mass: tuple[float, float]
    size: tuple[float, float, float]
    width: float
    places: Array
    turns: Array
    from_hand: Array = field(default_factory=lambda: np.zeros(3))

    def grips(self) -> Array:
        """Right and left grip at start and end, shape (2, 6) [m]."""
        left = np.stack((-np.sin(self.turns), np.cos(self.turns), np.zeros(2)), axis=1)
        half = 0.5 * self.width * left
        return np.hstack((self.places - half, self.places + half))

    def way(self, recorded: Array | None = None) -> Array:
        """Half-spaces of `SpatialParameters.way`.

        Parameters
        ----------
        recorded : array, shape (n, 3), optional
            A recorded way of the hands' middle, which belongs to it too [m].

        Raises
        ------
        TaskError
            The sector, with its margins, is wider than half a turn.
        """
        places = self.places
        if recorded is not None:
            places = np.vstack((self.places[:1], recorded, self.places[1:]))
        seen = np.unwrap(np.arctan2(places[:, 1], places[:, 0]))
        right, left = seen.min() - SECTOR_MARGIN, seen.max() + SECTOR_MARGIN
        if left - right >= np.pi:
            raise TaskError(
                f'box: its way turns {np.degrees(np.ptp(seen)):.0f} deg round the ankles; at most '
                f'{180.0 - 2.0 * np.degrees(SECTOR_MARGIN):.0f} deg can be predicted'
            )
        lowest = float(places[:, 2].min() + self.from_hand[2]) - LOWEST_MARGIN
        return np.array(
            [
                [-np.sin(right), np.cos(right), 0.0, 0.0],
                [np.sin(left), -np.cos(left), 0.0, 0.0],
                [0.0, 0.0, 1.0, -lowest],
            ]
        )


def place_task(
    person: SpatialPerson,
    frame: StanceFrame,
    box: PlacedBox,
    duration: tuple[float, float],
    grid: SpatialGrid,
    lift_id: str = 'lift',
    way: Array | None = None,
) -> SpatialTask:
    """Task without a recording, from the places alone: no windows.

    Parameters
    ----------
    person : SpatialPerson
        Who lifts.
    frame : StanceFrame
        Where the feet are.
    box : PlacedBox
        What is lifted from where to where.
    duration : tuple of float
        Least and largest duration [s]; equal: given.
    grid : SpatialGrid
        Sizes of the NLP.
    lift_id : str
        Name of the lift.
    way : array, shape (n, 3), optional
        Recorded way of the hands' middle [m].

    Raises
    ------
    TaskError
        Sizes that are not positive, or bounds in the wrong order.
    """
    if not (box.width > 0.0 and min(box.size) >= 0.0 and 0.0 <= box.mass[0] <= box.mass[1]):
        raise TaskError(
            f'box: hands {box.width} m apart, size {box.size} m, mass {box.mass} kg are no box'
        )
    if not 0.0 < duration[0] <= duration[1]:
        raise TaskError(f'duration = {duration} s: positive, in ascending order is needed')
    fields = person.fields()
    if box.size[0] == 0.0:
        fields['sphere'] = fields['sphere'] * np.array([1.0, 1.0, 1.0, 0.0])
    parameters = SpatialParameters(
        **fields,
        ankle=frame.ankle,
        foot_turn=frame.foot_turn,
        box_half=0.5 * np.array(box.size),
        box_acceleration=(
            largest_acceleration(box.places, duration[0]) if box.size[0] > 0.0 else NO_BOX
        ),
        box_width=box.width,
        # A uniform cuboid.
        box_turning=(box.size[0] ** 2 + box.width**2) / (12.0 * box.width**2),
        box_from_hand=box.from_hand,
        way=box.way(way),
    )
    rows = plain_bounds(grid.n_nodes, person.limits(DEPENDENT), person.limits(LIMITED))
    bounds = SpatialBounds(*rows, box.grips(), np.array(box.mass), np.array(duration))
    middle = float(np.clip(np.sqrt(duration[0] * duration[1]), *duration))
    return SpatialTask(lift_id, 0.0, person, frame, parameters, bounds, middle, None)


def without_ground_windows(task: SpatialTask) -> SpatialTask:
    """Task whose feet may carry any load (no 3.16, 5.1), as with another weight in the hands."""
    part = slice(
        constraint_slice(GROUND_CONSTRAINTS).start + 1, constraint_slice(GROUND_CONSTRAINTS).stop
    )
    lower, upper = task.bounds.node_lower.copy(), task.bounds.node_upper.copy()
    lower[:, part], upper[:, part] = 0.0, np.inf
    return replace(task, bounds=replace(task.bounds, node_lower=lower, node_upper=upper))
