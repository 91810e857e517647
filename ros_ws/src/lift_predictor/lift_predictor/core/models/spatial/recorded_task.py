# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The spatial task of a recorded lift: its box, feet, hands and windows (sections 3.3 and 5.1)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from human_model.motion import BodyMotion, Lift
from human_model.task import Box
from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError
from lift_predictor.core.models.ranges import hamstring_room, ranges
from lift_predictor.core.models.spatial.clearance import recorded_arms, recorded_gaps
from lift_predictor.core.models.spatial.frame import StanceFrame, splined_motion
from lift_predictor.core.models.spatial.grid import (
    GROUND_CONSTRAINTS,
    SpatialBounds,
    SpatialGrid,
    constraint_slice,
)
from lift_predictor.core.models.spatial.parameters import SIDES, SpatialParameters
from lift_predictor.core.models.spatial.person import SpatialPerson
from lift_predictor.core.models.spatial.task import (
    INSTANTS,
    KEY_JOINTS,
    PlacedBox,
    Recorded,
    SpatialTask,
    place_task,
)
from lift_predictor.core.models.spatial.windows import near_posture
from lift_predictor.core.options import Windows


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
        Sizes of the NLP.
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
    person, notes = _with_range(person, motion, recorded.q)
    duration = lift.end - lift.start
    placed, way = _placed_box(motion, frame, box, mass or (box.mass, box.mass))
    limits = (duration * windows.duration[0], duration * windows.duration[1])
    task = place_task(person, frame, placed, limits, grid, lift.lift_id, way)
    parameters, closer = _fit_spheres(task.parameters, motion, frame, person)
    bounds = _windows(task, recorded, windows, grid, duration)
    return replace(
        task,
        start=lift.start,
        duration=float(np.clip(duration, *limits)),
        recorded=recorded,
        parameters=parameters,
        bounds=bounds,
        notes=(*notes, *closer),
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
    return PlacedBox(mass, box.size, width, places, turns[[0, -1]], from_hand), middle


def _with_range(
    person: SpatialPerson, motion: BodyMotion, q: Array
) -> tuple[SpatialPerson, tuple[str, ...]]:
    """Widen the ranges that the recorded lift itself exceeded: this person has more.

    Ranges of motion up to the limits of the skeleton, the hamstrings' length, and the trunk that
    the arms stay out of.
    """
    skeleton = person.skeleton
    wider, more = dict(person.ranges), {}
    for name in ranges(skeleton.name):
        values = motion.coordinate(name)
        known = skeleton.limits[skeleton.index(name)]
        low = max(min(person.ranges[name][0], float(values.min())), float(known[0]))
        high = min(max(person.ranges[name][1], float(values.max())), float(known[1]))
        beyond = max(person.ranges[name][0] - low, high - person.ranges[name][1])
        if beyond > 0.0:
            wider[name], more[name] = (low, high), beyond
    room = min(
        float(
            hamstring_room(
                motion.coordinate(f'hip_flexion_{side}'),
                motion.coordinate(f'knee_angle_{side}'),
                person.hip_range,
            ).min()
        )
        for side in SIDES
    )
    hip = person.hip_range - np.array([min(room, 0.0), 0.0])
    if room < 0.0:
        more['hip_flexion with the knee'] = -room
    notes = tuple(
        f'the range of {name} is {np.degrees(amount):.0f} deg wider than published, as recorded'
        for name, amount in more.items()
    )
    trunk = person.trunk.copy()
    thinner = np.minimum(recorded_arms(trunk, motion, person).min(axis=(0, 2)), 1.0)
    trunk[:, 2:] *= thinner[:, None]
    return replace(person, ranges=wider, hip_range=hip, trunk=trunk), notes


def _fit_spheres(
    parameters: SpatialParameters, motion: BodyMotion, frame: StanceFrame, person: SpatialPerson
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
    last = grid.n_nodes - 1
    postures = ((0, windows.posture_ends), (last // 2, windows.posture_middle),
                (last, windows.posture_ends))  # fmt: skip
    for when, (row, epsilon) in zip(INSTANTS, postures, strict=True):
        angles = {
            name: float(np.interp(duration * row / last, recorded.time, recorded.key[name]))
            for name in KEY_JOINTS
        }
        bounds = near_posture(bounds, row, angles, epsilon, when)
    node = bounds.node_lower.copy(), bounds.node_upper.copy()
    if np.isfinite(windows.ground):
        weight = task.parameters.body_mass * task.parameters.gravity
        columns = slice(
            constraint_slice(GROUND_CONSTRAINTS).start + 1,
            constraint_slice(GROUND_CONSTRAINTS).stop,
        )
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
    return replace(bounds, node_lower=node[0], node_upper=node[1])
