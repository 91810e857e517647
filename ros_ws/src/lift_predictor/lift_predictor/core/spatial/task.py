# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The task of one lift in space: box, feet, hands, windows, time (sections 3.3 and 5.1)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from human_model.motion import BodyMotion, Lift
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.sagittal.task import Box
from lift_predictor.core.spatial.clearance import recorded_gaps
from lift_predictor.core.spatial.frame import StanceFrame, splined_motion
from lift_predictor.core.spatial.grid import (
    ANGLE_ROWS,
    GROUND_ROWS,
    LIMITED,
    SpatialBounds,
    SpatialGrid,
    plain_bounds,
    row_slice,
)
from lift_predictor.core.spatial.parameters import DEPENDENT, SIDES, SpatialParameters
from lift_predictor.core.spatial.person import SpatialPerson

Array = NDArray[np.float64]

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


@dataclass(frozen=True)
class Windows:
    """How near the predicted lift has to stay to the recorded one; infinite: no window.

    Attributes
    ----------
    posture_ends, posture_middle : float
        Epsilon of equation 3.15 at start and end, and at half time [rad].
    ground : float
        Of the vertical ground reaction of each foot [N] (equations 3.16: 40 N, 5.1: 50 N).
    ground_at : tuple of float
        Times of it, as parts of the lift (5.1: start, middle, end; 3.16 also the thirds).
    duration : tuple of float
        Least and largest duration, as parts of the recorded one; equal: given.
    """

    posture_ends: float = float(np.radians(10.0))
    posture_middle: float = float(np.radians(5.0))
    ground: float = 50.0
    ground_at: tuple[float, ...] = (0.0, 0.5, 1.0)
    duration: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, eq=False)
class Recorded:
    """A recorded lift in the stance frame.

    Attributes
    ----------
    time : array, shape (n,)
        From the start of the lift [s].
    q : array, shape (n, 26)
        Programme's coordinates.
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


@dataclass(frozen=True, eq=False)
class PlacedBox:
    """A box and where it goes, in the stance frame.

    Attributes
    ----------
    mass : tuple of float
        Lower and upper bound [kg]; equal: given.
    depth, width : float
        Extent away from the person and between the hands [m].
    places : array, shape (2, 3)
        Middle of the hands at start and end [m].
    turns : array, shape (2,)
        Direction the box is turned to about the vertical, 0: facing forward [rad].
    from_hand : array, shape (3,)
        Its centre from the middle of the hands, in its own axes [m].
    """

    mass: tuple[float, float]
    depth: float
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
        Sizes of the programme.
    lift_id : str
        Name of the lift.
    way : array, shape (n, 3), optional
        Recorded way of the hands' middle [m].

    Raises
    ------
    TaskError
        Sizes that are not positive, or bounds in the wrong order.
    """
    if not (box.width > 0.0 and box.depth >= 0.0 and 0.0 <= box.mass[0] <= box.mass[1]):
        raise TaskError(
            f'box: width {box.width} m, depth {box.depth} m, mass {box.mass} kg are no box'
        )
    if not 0.0 < duration[0] <= duration[1]:
        raise TaskError(f'duration = {duration} s: positive, in ascending order is needed')
    fields = person.fields()
    if box.depth == 0.0:
        fields['sphere'] = fields['sphere'] * np.array([1.0, 1.0, 1.0, 0.0])
    parameters = SpatialParameters(
        **fields,
        ankle=frame.ankle,
        foot_turn=frame.foot_turn,
        box_radius=0.5 * box.depth,
        box_width=box.width,
        # A uniform cuboid.
        box_turning=(box.depth**2 + box.width**2) / (12.0 * box.width**2),
        box_from_hand=box.from_hand,
        way=box.way(way),
    )
    rows = plain_bounds(grid.n_nodes, person.limits(DEPENDENT), person.limits(LIMITED))
    bounds = SpatialBounds(*rows, box.grips(), np.array(box.mass), np.array(duration))
    middle = float(np.clip(np.sqrt(duration[0] * duration[1]), *duration))
    return SpatialTask(lift_id, 0.0, person, frame, parameters, bounds, middle, None)


def recorded_task(
    person: SpatialPerson,
    lift: Lift,
    box: Box,
    grid: SpatialGrid,
    windows: Windows | None = None,
    mass: tuple[float, float] | None = None,
) -> SpatialTask:
    """Build the task of a recorded lift.

    Parameters
    ----------
    person : SpatialPerson
        Who lifted.
    lift : Lift
        The recorded lift, on the 3D skeleton.
    box : Box
        What was lifted.
    grid : SpatialGrid
        Sizes of the programme.
    windows : Windows, optional
        How near to stay to the recording.
    mass : tuple of float, optional
        Bounds of the box's mass [kg], in place of the box's own.

    Raises
    ------
    TaskError
        The recording has no usable feet, hands, postures or samples.
    """
    windows = windows or Windows()
    motion = lift.window
    frame = StanceFrame.of(motion, person)
    recorded = _recorded(motion, lift, frame, person)
    duration = lift.end - lift.start
    placed, way = _placed_box(motion, frame, box, mass or (box.mass, box.mass))
    limits = (duration * windows.duration[0], duration * windows.duration[1])
    task = place_task(person, frame, placed, limits, grid, lift.lift_id, way)
    parameters, notes = _fit_spheres(task.parameters, motion, frame, person)
    bounds = _windows(task, recorded, windows, grid, duration)
    return replace(
        task,
        start=lift.start,
        duration=float(np.clip(duration, *limits)),
        recorded=recorded,
        parameters=parameters,
        bounds=bounds,
        notes=notes,
    )


def _recorded(
    motion: BodyMotion, lift: Lift, frame: StanceFrame, person: SpatialPerson
) -> Recorded:
    q = splined_motion(motion, frame, person)
    return Recorded(
        motion.time - lift.start,
        q,
        {name: motion.coordinate(name) for name in KEY_JOINTS},
        motion.ground_force[:, :, 2],
        motion.ground_force.sum(axis=1) @ frame.rotation()[:, 0],
    )


def _placed_box(
    motion: BodyMotion, frame: StanceFrame, box: Box, mass: tuple[float, float]
) -> tuple[PlacedBox, Array]:
    """Hands as recorded, made level and given one distance: the box is rigid."""
    hands = np.stack([frame.into(motion.point(f'hand_{side}')) for side in SIDES], axis=1)
    line = hands[:, 1] - hands[:, 0]
    width = float(np.linalg.norm(line, axis=1).mean())
    if not width > 0.0:
        raise TaskError('hands: right and left coincide during the lift, so that nothing is held')
    turns = np.arctan2(-line[:, 0], line[:, 1])
    middle = hands.mean(axis=1)
    c, s = np.cos(turns), np.sin(turns)
    offset = frame.into(motion.box_position) - middle
    tracked = np.all(np.isfinite(offset), axis=1)
    from_hand = np.zeros(3)
    if tracked.any():
        own = np.stack(
            (c * offset[:, 0] + s * offset[:, 1], c * offset[:, 1] - s * offset[:, 0],
             offset[:, 2]), axis=1,
        )  # fmt: skip
        from_hand = own[tracked].mean(axis=0)
    places = middle[[0, -1]].copy()
    for row, (index, wanted) in enumerate(((0, box.start), (-1, box.end))):
        if wanted is not None:
            a, b = c[index], s[index]
            turned = np.array([[a, -b, 0.0], [b, a, 0.0], [0.0, 0.0, 1.0]]) @ from_hand
            places[row] = frame.into(np.asarray(wanted, dtype=float)) - turned
    return PlacedBox(mass, box.depth, width, places, turns[[0, -1]], from_hand), middle


def _fit_spheres(
    parameters: SpatialParameters,
    motion: BodyMotion,
    frame: StanceFrame,
    person: SpatialPerson,
) -> tuple[SpatialParameters, tuple[str, ...]]:
    """Shrink the spheres that the recorded lift itself went through: the body is thinner."""
    gaps = recorded_gaps(parameters, motion, frame, person).min(axis=0)
    sphere = parameters.sphere.copy()
    used = sphere[:, 3] > 0.0
    deep = used & (gaps < 0.0)
    if not deep.any():
        return parameters, ()
    sphere[deep, 3] = np.maximum(sphere[deep, 3] + gaps[deep], 0.0)
    note = (
        f'{int(deep.sum())} of {int(used.sum())} collision spheres were reduced, as the recorded '
        f'lift came up to {-1e3 * gaps[deep].min():.0f} mm closer'
    )
    return replace(parameters, sphere=sphere), (note,)


def _windows(
    task: SpatialTask, recorded: Recorded, windows: Windows, grid: SpatialGrid, duration: float
) -> SpatialBounds:
    """Bounds with the windows of equations 3.15 and 3.16 (or 5.1) put in."""
    bounds = task.bounds
    node = bounds.node_lower.copy(), bounds.node_upper.copy()
    angle = bounds.angle_lower.copy(), bounds.angle_upper.copy()
    first = row_slice(ANGLE_ROWS).start
    last = grid.n_nodes - 1
    postures = ((0, windows.posture_ends), (last // 2, windows.posture_middle),
                (last, windows.posture_ends))  # fmt: skip
    for when, (row, epsilon) in zip(INSTANTS, postures, strict=True):
        for name in KEY_JOINTS:
            value = float(np.interp(duration * row / last, recorded.time, recorded.key[name]))
            target, column = (
                (node, first + DEPENDENT.index(name)) if name in DEPENDENT
                else (angle, LIMITED.index(name))
            )  # fmt: skip
            low = max(value - epsilon, target[0][row, column])
            high = min(value + epsilon, target[1][row, column])
            if low > high:
                limits = np.degrees((target[0][row, column], target[1][row, column]))
                raise TaskError(
                    f'{name} at the {when} of the lift: {np.degrees(value):.1f} deg is outside '
                    f'its limits of {limits[0]:.1f} to {limits[1]:.1f} deg'
                )
            target[0][row, column], target[1][row, column] = low, high
    if np.isfinite(windows.ground):
        weight = task.parameters.body_mass * task.parameters.gravity
        columns = slice(row_slice(GROUND_ROWS).start + 1, row_slice(GROUND_ROWS).stop)
        for part in windows.ground_at:
            row = round(part * last)
            if abs(row - part * last) > 1e-6:
                raise TaskError(
                    f'ground_at = {part:g}: no node of {grid.n_nodes} is there; choose a number '
                    'of nodes that has one'
                )
            force = recorded.at(recorded.vertical, duration * part)
            node[0][row, columns] = np.maximum(force - windows.ground, 0.0) / weight
            node[1][row, columns] = (force + windows.ground) / weight
    return replace(
        bounds, node_lower=node[0], node_upper=node[1], angle_lower=angle[0], angle_upper=angle[1]
    )


def without_ground_windows(task: SpatialTask) -> SpatialTask:
    """Task whose feet may carry any load (no 3.16, 5.1), as with another weight in the hands."""
    part = slice(row_slice(GROUND_ROWS).start + 1, row_slice(GROUND_ROWS).stop)
    lower, upper = task.bounds.node_lower.copy(), task.bounds.node_upper.copy()
    lower[:, part], upper[:, part] = 0.0, np.inf
    return replace(task, bounds=replace(task.bounds, node_lower=lower, node_upper=upper))
