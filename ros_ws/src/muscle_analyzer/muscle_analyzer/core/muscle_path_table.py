# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Turns the muscles of a model as read into the flat arrays of the compiled path functions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from muscle_analyzer.core.ellipsoid_wrapping import HYBRID, MIDPOINT
from muscle_analyzer.core.exceptions import OsimFormatError, UnsupportedElementError
from muscle_analyzer.core.functions import FunctionTable, function_table
from muscle_analyzer.core.multibody import MultibodyModel
from muscle_analyzer.core.osim_model import Muscle, OsimModel, PathPoint

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Kinds of wrap object the path functions know.
CYLINDER, ELLIPSOID, SPHERE, TORUS = 0, 1, 2, 3
_KINDS = {'cylinder': CYLINDER, 'ellipsoid': ELLIPSOID, 'sphere': SPHERE, 'torus': TORUS}
_METHODS = {'hybrid': HYBRID, 'midpoint': MIDPOINT}
#: A conditional point is there up to so far outside its range (constant of OpenSim), rad or m.
CONDITION_MARGIN = 1e-5
#: Active halves of a wrap object: coordinate and sign; sign 0 is the whole surface.
_HALVES = {
    'all': (0, 0),
    'x': (0, 1),
    '-x': (0, -1),
    'y': (1, 1),
    '-y': (1, -1),
    'z': (2, 1),
    '-z': (2, -1),
}


class WrapTable(NamedTuple):
    """
    Uses of wrap objects by all muscles of one model.

    Attributes
    ----------
    start : (n_m + 1,)
    kind, body : (n_w,)
    rotation, translation : (n_w, 3, 3), (n_w, 3)
        Body from wrap object's frame [m].
    dimensions : (n_w, 3)
        Cylinder: radius, length; ellipsoid: half axes; sphere: radius; torus: radius of the tube
        and of its centre line [m].
    axis, sign : (n_w,)
        Active half.
    method : (n_w,)
        How an ellipsoid's guide is chosen.
    first, last : (n_w,)
        First and last point between which the path may wrap.
    geodesic : (1,)
        Whether a path over a single cylinder is its geodesic or OpenSim's construction
        (see `wrapping`); over more than one it always is the geodesic.
    """

    start: IntArray
    kind: IntArray
    body: IntArray
    rotation: Array
    translation: Array
    dimensions: Array
    axis: IntArray
    sign: IntArray
    method: IntArray
    first: IntArray
    last: IntArray
    geodesic: NDArray[np.bool_]


class PathTable(NamedTuple):
    """
    Paths of all muscles of one model.

    Attributes
    ----------
    point_start : (n_m + 1,)
        Points of muscle m are ``point_start[m]`` to ``point_start[m + 1] - 1``; likewise the
        other ``*_start``.
    point_body, point_location : (n_p,), (n_p, 3)
        Body and place in it [m]; of a moving point where its coordinates are zero.
    point_condition, point_motion : (n_p,)
        Number of a point's condition and of its motion, or -1.
    condition_coordinate, condition_range : (n_c,), (n_c, 2)
        Tree coordinate, and the values between which a conditional point is there [rad or m].
    motion_coordinate, motion_independent, motion_function : (n_d, 3)
        Tree coordinates that move a point along x, y and z of its body, the independent ones
        behind them (-1 if locked), and the numbers of the functions.
    functions : FunctionTable
    wraps : WrapTable
    body_start, body_index : (n_m + 1,), (n_e,)
        Bodies that a muscle acts on.
    crossed_start, crossed_index : (n_m + 1,), (n_k,)
        Independent coordinates that can change a muscle's length.
    longest : (1,)
        Most points that a path can have, wrap points counted.
    """

    point_start: IntArray
    point_body: IntArray
    point_location: Array
    point_condition: IntArray
    point_motion: IntArray
    condition_coordinate: IntArray
    condition_range: Array
    motion_coordinate: IntArray
    motion_independent: IntArray
    motion_function: IntArray
    functions: FunctionTable
    wraps: WrapTable
    body_start: IntArray
    body_index: IntArray
    crossed_start: IntArray
    crossed_index: IntArray
    longest: IntArray


def path_table(multibody: MultibodyModel, geodesic: bool = False) -> PathTable:
    """
    Build the table of a compiled model's muscles.

    Parameters
    ----------
    multibody
        The compiled model.
    geodesic
        Whether to use geodesics on single cylinders rather than OpenSim's construction.

    Raises
    ------
    OsimFormatError
        For a path point that depends on a coordinate that does not exist.
    UnsupportedElementError
        For a wrap object, quadrant or method that is not modelled; names it.
    """
    model = multibody.source
    wraps = [
        _wrap_row(model, multibody, muscle, number)
        for muscle in model.muscles
        for number in range(len(muscle.wraps))
        if model.wrap_object(muscle.wraps[number].wrap_object).active
    ]
    owners = [row[0] for row in wraps]
    points = [point for muscle in model.muscles for point in muscle.points]
    conditions = [point for point in points if point.kind == 'conditional']
    motions = [point for point in points if point.kind == 'moving']
    point_body = [multibody.body_index(point.body) for point in points]
    point_start = _starts([len(muscle.points) for muscle in model.muscles])
    wrap_start = _starts([owners.count(muscle.name) for muscle in model.muscles])
    wrap_body = [row[2] for row in wraps]
    bodies = [
        sorted({*point_body[p0:p1], *wrap_body[w0:w1]})
        for p0, p1, w0, w1 in zip(
            point_start[:-1], point_start[1:], wrap_start[:-1], wrap_start[1:], strict=True
        )
    ]
    driven = _driven_motions(multibody)
    moved_by = np.array(
        [[_coordinate(multibody, p, name) for name in p.location_coordinates] for p in motions],
        np.int64,
    ).reshape(-1, 3)
    independent = multibody.tree.independent[moved_by]
    point_motion = _numbers_of('moving', points)
    crossed = []
    for begin, end, body in zip(point_start[:-1], point_start[1:], bodies, strict=True):
        moving = [number for number in point_motion[begin:end] if number >= 0]
        by_motion = {int(q) for q in independent[moving].ravel() if q >= 0}
        crossed.append(sorted({*_crossed(driven, body), *by_motion}))
    longest = (np.diff(point_start) + 2 * np.diff(wrap_start)).max(initial=0)
    n_w = len(wraps)
    return PathTable(
        point_start=point_start,
        point_body=np.array(point_body, np.int64),
        point_location=np.array([point.location for point in points]).reshape(-1, 3),
        point_condition=_numbers_of('conditional', points),
        point_motion=point_motion,
        condition_coordinate=np.array(
            [_coordinate(multibody, p, p.coordinate) for p in conditions], np.int64
        ),
        condition_range=np.array([p.range for p in conditions]).reshape(-1, 2)
        + [-CONDITION_MARGIN, CONDITION_MARGIN],
        motion_coordinate=moved_by,
        motion_independent=independent,
        motion_function=np.arange(3 * len(motions), dtype=np.int64).reshape(-1, 3),
        functions=function_table([f for p in motions for f in p.location_functions]),
        wraps=WrapTable(
            start=wrap_start,
            kind=np.array([row[1] for row in wraps], np.int64),
            body=np.array(wrap_body, np.int64),
            rotation=np.array([row[3] for row in wraps]).reshape(n_w, 3, 3),
            translation=np.array([row[4] for row in wraps]).reshape(n_w, 3),
            dimensions=np.array([row[5] for row in wraps]).reshape(n_w, 3),
            axis=np.array([row[6][0] for row in wraps], np.int64),
            sign=np.array([row[6][1] for row in wraps], np.int64),
            method=np.array([row[7] for row in wraps], np.int64),
            first=np.array([row[8] for row in wraps], np.int64),
            last=np.array([row[9] for row in wraps], np.int64),
            geodesic=np.array([geodesic]),
        ),
        body_start=_starts([len(body) for body in bodies]),
        body_index=np.array([b for body in bodies for b in body], np.int64),
        crossed_start=_starts([len(cross) for cross in crossed]),
        crossed_index=np.array([c for cross in crossed for c in cross], np.int64),
        longest=np.array([longest], np.int64),
    )


def _starts(counts: list[int]) -> IntArray:
    return np.concatenate([[0], np.cumsum(counts, dtype=np.int64)]).astype(np.int64)


def _wrap_row(
    model: OsimModel, multibody: MultibodyModel, muscle: Muscle, number: int
) -> tuple[str, int, int, Array, Array, Array, tuple[int, int], int, int, int]:
    """Give one use of a wrap object as a row of the table, after its muscle's name."""
    use = muscle.wraps[number]
    surface = model.wrap_object(use.wrap_object)
    where = f'{model.source}: muscle {muscle.name}: wrap object {surface.name}'
    if surface.kind not in _KINDS:
        raise UnsupportedElementError(f'{where}: kind {surface.kind} is not modelled')
    if surface.quadrant not in _HALVES:
        raise UnsupportedElementError(f'{where}: quadrant {surface.quadrant} is not modelled')
    # Only ellipsoids heed the method.
    method = use.method if surface.kind == 'ellipsoid' else 'hybrid'
    if method not in _METHODS or (method == 'midpoint' and surface.quadrant != 'all'):
        raise UnsupportedElementError(
            f'{where}: method {method} on quadrant {surface.quadrant} is not modelled'
        )
    dimensions = np.zeros(3)
    dimensions[: len(surface.dimensions)] = surface.dimensions
    first, last = use.range
    return (
        muscle.name,
        _KINDS[surface.kind],
        multibody.body_index(surface.frame.body),
        surface.frame.rotation,
        surface.frame.translation,
        dimensions,
        _HALVES[surface.quadrant],
        _METHODS[method],
        first - 1 if first >= 1 else 0,
        last - 1 if last >= 1 else len(muscle.points) - 1,
    )


def _numbers_of(kind: str, points: list[PathPoint]) -> IntArray:
    """Count the points of one kind, -1 for the others."""
    is_kind = np.array([point.kind == kind for point in points], dtype=np.bool_)
    return np.where(is_kind, np.cumsum(is_kind) - 1, -1).astype(np.int64)


def _coordinate(multibody: MultibodyModel, point: PathPoint, name: str | None) -> int:
    """Give the index of a coordinate that a path point depends on among all of the tree."""
    names = multibody.tree_coordinate_names
    if name not in names:
        raise OsimFormatError(
            f'{multibody.source.source}: path point {point.name}: no coordinate {name!r}'
        )
    return names.index(name)


def _driven_motions(multibody: MultibodyModel) -> list[list[set[int]]]:
    """Give, for each body and independent coordinate, the elementary motions that move it."""
    tree = multibody.tree
    n_q = len(multibody.coordinate_names)
    driven: list[list[set[int]]] = []
    for body, parent in enumerate(tree.parent):
        sets = [set(driven[parent][q]) if parent >= 0 else set() for q in range(n_q)]
        for motion in range(tree.first_motion[body], tree.first_motion[body + 1]):
            coordinate = tree.motion_coordinate[motion]
            if coordinate >= 0 and tree.independent[coordinate] >= 0:
                sets[tree.independent[coordinate]].add(motion)
        driven.append(sets)
    return driven


def _crossed(driven: list[list[set[int]]], bodies: list[int]) -> list[int]:
    """Give the coordinates that move the bodies of one muscle against each other."""
    first = driven[bodies[0]]
    return [
        q for q in range(len(first)) if any(driven[body][q] != first[q] for body in bodies[1:])
    ]
